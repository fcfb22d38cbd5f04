#include <fmt/ranges.h>

#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view space = "AxUnit.Assert";

/// Its arguments, as they are declared, and which of them ASSERT_EQ and the others have first.
struct OtherAssertion {
    std::string_view name, same;
    std::vector<std::string_view> declared;
    bool is_turned;  ///< the second one, the value that was found
};
const OtherAssertion assertions[] = {
    {"AxUnit.Assert.Equal", "ASSERT_EQ", {"expected", "actual"}, true},
    {"AxUnit.Assert.NotEqual", "ASSERT_NEQ", {"expected", "actual"}, true},
    {"AxUnit.Assert.LessThan", "ASSERT_LT", {"left", "right"}, false},
    {"AxUnit.Assert.GreaterThan", "ASSERT_GT", {"left", "right"}, false},
    {"AxUnit.Assert.LessOrEqual", "ASSERT_LE", {"left", "right"}, false},
    {"AxUnit.Assert.GreaterOrEqual", "ASSERT_GE", {"left", "right"}, false},
    {"AxUnit.Assert.Tolerated", "ASSERT_NEAR", {"expected", "actual", "tolerance"}, true},
    {"AxUnit.ResultFunctions.axunit_Fail", "ASSERT_TRUE", {"message", "file", "line"}, false},
    {"AxUnit.ResultFunctions.axunit_Succeed", "ASSERT_TRUE", {}, false},
    {"ASSERT_EQUAL", "ASSERT_EQ", {"expected", "actual"}, true},
    {"ASSERT_NOT_EQUAL", "ASSERT_NEQ", {"expected", "actual"}, true},
    {"ASSERT_GREATER", "ASSERT_GT", {"value", "bound"}, false},
    {"ASSERT_LESS", "ASSERT_LT", {"value", "bound"}, false},
    {"ASSERT_GREATER_OR_EQUAL", "ASSERT_GE", {"value", "bound"}, false},
    {"ASSERT_LESS_OR_EQUAL", "ASSERT_LE", {"value", "bound"}, false},
    {"ASSERT_NEAR", "ASSERT_NEAR", {"expected", "actual", "delta"}, true},
    {"ASSERT_TRUE", "ASSERT_TRUE", {"in"}, false},
    {"ASSERT_FALSE", "ASSERT_FALSE", {"in"}, false},
};

bool is_meant(Checking& c, const Expression& call, const OtherAssertion& known) {
    const Expression& callee = *call.operands[0];
    if (!same_name(callee.token.text, known.name.substr(known.name.rfind('.') + 1)) ||
        !is_full_name(c, callee, known.name))
        return false;
    if (known.name.find('.') != known.name.npos) return true;
    const auto is_declared = [&](const Argument& argument) {
        return find_called(known.declared, argument.name.text) != nullptr;
    };
    const bool is_own = known.name == known.same;  // where it is not by the arguments' names
    return is_own ? !call.arguments.empty() && std::ranges::all_of(call.arguments, is_declared)
                  : !c.find_routine(callee.token);
}

const OtherAssertion* find(Checking& c, const Expression& call) {
    const E kind = call.operands[0]->kind;
    if (kind != E::name && kind != E::member) return nullptr;
    const auto* known = std::ranges::find_if(
        assertions, [&](const OtherAssertion& assertion) { return is_meant(c, call, assertion); });
    return known == std::end(assertions) ? nullptr : known;
}

}  // namespace

bool is_namespace_of_assertions(std::string_view path) {
    return same_name(path, space) || same_name(path, space.substr(0, space.find('.'))) ||
           same_name(path, "AxUnit.ResultFunctions");
}

Expression* assertion_call(Checking& c, const Expression& call) {
    const OtherAssertion* known = find(c, call);
    if (!known) return nullptr;
    const auto& declared = known->declared;
    std::vector<Argument> arguments(declared.size());
    const auto wrong = [&](Place place) {
        return c.fail(code::wrong_arguments, place,
                      fmt::format("{} takes '{}'", known->name, fmt::join(declared, "' and '")));
    };
    std::size_t position = 0;
    for (const Argument& given : call.arguments) {
        const auto name = std::ranges::find_if(declared, is_called(given.name.text));
        std::size_t at = position++;
        if (given.is_named()) at = static_cast<std::size_t>(name - declared.begin());
        if (at >= declared.size() || arguments[at].value) return wrong(given.value->place);
        arguments[at].value = given.value;
    }
    const bool is_result = known->name.starts_with("AxUnit.R");
    if (is_result) {  // the file and the line are those of the call here
        arguments.resize(std::min<std::size_t>(arguments.size(), 1));
        arguments.insert(arguments.begin(), {.value = make_boolean(c, call, arguments.empty())});
    }
    for (const Argument& argument : arguments)
        if (!argument.value) return wrong(call.operands[0]->place);
    if (known->is_turned) std::swap(arguments[0], arguments[1]);
    return make_call(c, call, make_name(c, *call.operands[0], known->same), std::move(arguments));
}

}  // namespace lineshaft::st
