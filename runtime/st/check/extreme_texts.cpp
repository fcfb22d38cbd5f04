#include <fmt/format.h>

#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// The greater of two texts, or the smaller: `SEL(a < b, a, b)`.
Expression* chosen_text(Checking& c, const Expression& call, Word op, Expression* a,
                        Expression* b) {
    Expression* is_second = make_binary(c, call.place, call.place, op, a, b);
    Expression* made = make_call(c, call, make_name(c, *call.operands[0], "SEL"),
                                 {{.value = is_second}, {.value = a}, {.value = b}});
    check(c, made);  // it hangs in two places
    return made;
}

}  // namespace

const Type* check_extreme_text(Checking& c, Expression*& e) {
    const auto& given = e->arguments;
    for (const Argument& argument : given)
        if (has_call(*argument.value))
            return c.fail(code::not_supported, argument.value->place,
                          fmt::format("a function within {} of texts is not supported here",
                                      e->standard->name),
                          "assign its value to a variable first");
    Expression* chosen = given[0].value;
    if (same_name(e->standard->name, "limit")) {
        chosen = chosen_text(c, *e, Word::less, given[1].value, given[0].value);
        chosen = chosen_text(c, *e, Word::greater, chosen, given[2].value);
    } else {
        const Word op = same_name(e->standard->name, "max") ? Word::less : Word::greater;
        for (std::size_t i = 1; i < given.size(); ++i)
            chosen = chosen_text(c, *e, op, chosen, given[i].value);
    }
    e = chosen;
    return e->type;
}

}  // namespace lineshaft::st
