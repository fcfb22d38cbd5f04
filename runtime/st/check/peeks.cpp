#include "runtime/source/letters.hpp"
#include "runtime/st/check/calls.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

using Area = ImageAddress::Area;

constexpr std::string_view byte_names[] = {"b0", "b1", "b2", "b3", "b4", "b5", "b6", "b7"};
constexpr int area_of_blocks = 0x84;

Token named(const Expression& like, std::string_view text) {
    return {.word = Word::name, .place = like.place, .text = text};
}

/// ENO of the call, taken out of its arguments.
std::vector<Argument> take_eno(Checking& c, Expression*& e) {
    std::vector<Argument> eno, others;
    for (const Argument& each : e->arguments)
        (same_name(each.name.text, "eno") ? eno : others).push_back(each);
    if (!eno.empty()) e = make_with(c, *e, std::move(others));
    return eno;
}

/// What the call gives for `names`, in their order, by name or by place; empty, and told, where it
/// gives something else.
std::vector<Expression*> given_for(Checking& c, const Expression& call,
                                   const std::vector<std::string_view>& names) {
    std::vector<Expression*> given;
    for (const std::string_view name : names) {
        const Argument* one = find_called(call.arguments, name, &Argument::name);
        const std::size_t place = given.size();
        if (!one && place < call.arguments.size() && !call.arguments[place].is_named())
            one = &call.arguments[place];
        if (one) given.push_back(one->value);
    }
    if (given.size() == names.size() && given.size() == call.arguments.size()) return given;
    c.fail(code::wrong_arguments, call.operands[0]->place,
           fmt::format("{} takes {}", call.operands[0]->token.text, fmt::join(names, ", ")));
    return {};
}

/// The data block that has the number; null: it is told that there is none.
Expression* numbered_block(Checking& c, Expression*& number) {
    if (!check(c, number)) return nullptr;
    become_lint(c, number);
    if (!is_constant(*number))
        return c.fail(code::not_supported, number->place,
                      "PEEK and POKE of a data block whose number is no constant are not supported",
                      "use a variable of the data block by its name");
    const std::string name = fmt::format("DB{}", to_string(number->constant.integer));
    Expression* block = make_function_name(c, *number, c.checked.names.emplace_back(name));
    if (!find_variable(c, block->token))
        return c.fail(code::not_declared, number->place,
                      fmt::format("there is no data block with the number {}",
                                  to_string(number->constant.integer)),
                      "one of TIA Portal's exports has its number, and so has DATA_BLOCK DB5");
    return check(c, block) ? block : nullptr;
}

bool is_area_of_blocks(Checking& c, Expression*& area) {
    if (!check(c, area)) return false;
    return is_constant(*area) && area->constant.integer == area_of_blocks;
}

std::optional<Area> area_of(Checking& c, Expression*& number) {
    if (!check(c, number)) return {};
    become_lint(c, number);
    constexpr int first = 0x81, first_of_periphery = 1, last_of_periphery = 2;
    const Wide code = is_constant(*number) ? number->constant.integer : 0;
    const bool is_of_periphery = code >= first_of_periphery && code <= last_of_periphery;
    const Wide area = code - (is_of_periphery ? first_of_periphery : first);
    if (area >= 0 && area < Wide{areas}) return static_cast<Area>(area);
    c.fail(code::not_supported, number->place,
           "PEEK and POKE are of the areas 16#81, 16#82, 16#83 and 16#84: inputs, outputs, memory "
           "bits and data blocks, and of 16#1 and 16#2, which are inputs and outputs, too",
           "write one of these numbers");
    return {};
}

/// How many bytes are read or written; 0: what is written has no such number, which was told.
int count_of(Checking& c, std::string_view function, Expression*& value) {
    if (function.ends_with("_WORD")) return 2;
    if (function.ends_with("_DWORD")) return 4;
    if (function != "POKE") return 1;
    const Type* type = check(c, value);
    if (!type) return 0;
    if (type->is_any()) return 1;
    if (type->kind == Kind::bits || type->is_integer()) return type->bits / 8;
    c.fail(code::type_does_not_fit, value->place,
           fmt::format("POKE writes a BYTE, a WORD, a DWORD or an LWORD, not {}", describe(*type)));
    return 0;
}

}  // namespace

bool take_bytes(Checking& c, Expression*& e, const Routine& called) {
    const std::string function = upper(called.pou->name.text);
    const bool writes = function.starts_with("POKE");
    const bool is_one = is_prelude(called.pou->name) && (writes || function.starts_with("PEEK"));
    if (!is_one || e->place.source->is_prelude()) return true;
    std::vector<std::string_view> names{"area", "dbNumber", "byteOffset"};
    const bool is_bit = function.ends_with("_BOOL");
    if (is_bit) names.emplace_back("bitOffset");
    if (writes) names.emplace_back("value");
    const std::vector<Argument> eno = take_eno(c, e);
    std::vector<Expression*> given = given_for(c, *e, names);
    if (given.empty()) return false;
    const bool is_of_block = is_area_of_blocks(c, given[0]);
    Expression* const block = is_of_block ? numbered_block(c, given[1]) : nullptr;
    const auto area = is_of_block ? std::nullopt : area_of(c, given[0]);
    const int count = count_of(c, function, given.back());
    if ((!area && !block) || count == 0 || !check(c, given[2])) return false;
    if (block && !bytes_of_block(c, *e, block)) return false;
    if (has_call(*given[2]))
        return c.fail(code::not_supported, given[2]->place, "a call as byteOffset is not supported",
                      "assign it to a variable");
    become_lint(c, given[2]);
    const auto byte_at = [&](int i) {
        Expression* element = make(c, E::index, *e);
        element->operands[0] = block ? bytes_of_block(c, *e, block)
                                     : make_use(c, *e, bytes_of_area(c, e->token, *area));
        element->arguments.push_back(
            {.value = make_binary(c, e->place, e->place, Word::plus, given[2],
                                  make_constant(c, *e, lint_type, {.integer = i}))});
        return element;
    };
    std::vector<Argument> arguments;
    for (int i = 0; i < count; ++i)
        arguments.push_back(
            {.name = named(*e, byte_names[i]), .is_output = writes, .value = byte_at(i)});
    if (is_bit) arguments.push_back({.name = named(*e, "bitOffset"), .value = given[3]});
    if (is_bit && writes) arguments.push_back({.name = named(*e, "before"), .value = byte_at(0)});
    if (writes) arguments.push_back({.name = named(*e, "value"), .value = given.back()});
    arguments.insert(arguments.end(), eno.begin(), eno.end());
    e = make_with(c, *e, std::move(arguments));
    return true;
}

}  // namespace lineshaft::st
