#include "runtime/st/standard.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/st/token.hpp"

namespace lineshaft::st {

namespace {

constexpr int several = 64;

constexpr StandardFunction functions[] = {
    {"ABS", Rule::absolute},
    {"SQRT", Rule::real, 1, 1, Op::sqrt},
    {"LN", Rule::real, 1, 1, Op::ln},
    {"LOG", Rule::real, 1, 1, Op::log10},
    {"EXP", Rule::real, 1, 1, Op::exp},
    {"SIN", Rule::real, 1, 1, Op::sin},
    {"COS", Rule::real, 1, 1, Op::cos},
    {"TAN", Rule::real, 1, 1, Op::tan},
    {"ASIN", Rule::real, 1, 1, Op::asin},
    {"ACOS", Rule::real, 1, 1, Op::acos},
    {"ATAN", Rule::real, 1, 1, Op::atan},
    {"ATAN2", Rule::real_two, 2, 2, Op::atan2},
    {"SQR", Rule::square},
    {"FRAC", Rule::fraction},
    {"EXPT", Rule::operation, 2, 2, Op::move, Word::power},
    {"TRUNC", Rule::whole, 1, 1, Op::truncate},
    {"ROUND", Rule::whole, 1, 1, Op::round},
    {"FLOOR", Rule::whole, 1, 1, Op::floor},
    {"CEIL", Rule::whole, 1, 1, Op::ceil},
    {"MIN", Rule::extremum, 2, several, Op::min_signed},
    {"MAX", Rule::extremum, 2, several, Op::max_signed},
    {"LIMIT", Rule::limit, 3, 3},
    {"SEL", Rule::select, 3, 3},
    {"MUX", Rule::multiplex, 2, several},
    {"SHL", Rule::shift, 2, 2, Op::shl_8},
    {"SHR", Rule::shift, 2, 2, Op::shr_8},
    {"ROL", Rule::shift, 2, 2, Op::rol_8},
    {"ROR", Rule::shift, 2, 2, Op::ror_8},
    {"MOVE", Rule::move},
    {"ADD", Rule::operation, 2, several, Op::move, Word::plus},
    {"SUB", Rule::operation, 2, 2, Op::move, Word::minus},
    {"MUL", Rule::operation, 2, several, Op::move, Word::times},
    {"DIV", Rule::operation, 2, 2, Op::move, Word::divided},
    {"GT", Rule::operation, 2, 2, Op::move, Word::greater},
    {"GE", Rule::operation, 2, 2, Op::move, Word::greater_or_equal},
    {"EQ", Rule::operation, 2, 2, Op::move, Word::equal},
    {"LE", Rule::operation, 2, 2, Op::move, Word::less_or_equal},
    {"LT", Rule::operation, 2, 2, Op::move, Word::less},
    {"NE", Rule::operation, 2, 2, Op::move, Word::unequal},
    {"NORM_X", Rule::normalise, 3, 3},
    {"SCALE_X", Rule::scale, 3, 3},
    {"IS_VALID", Rule::finite},
    {"LEN", Rule::length},
    {"FIND", Rule::find, 2, 2},
    {"CONCAT", Rule::text, 2, several, Op::move, Word::end_of_file, several},
    {"LEFT", Rule::text, 2, 2},
    {"RIGHT", Rule::text, 2, 2},
    {"MID", Rule::text, 3, 3},
    {"DELETE", Rule::text, 3, 3},
    {"INSERT", Rule::text, 3, 3, Op::move, Word::end_of_file, 2},
    {"REPLACE", Rule::text, 4, 4, Op::move, Word::end_of_file, 2},
};

}  // namespace

std::span<const StandardFunction> standard_functions() {
    return functions;
}

int find_standard_function(std::string_view name) {
    const auto* it = std::ranges::find_if(
        functions, [&](const StandardFunction& f) { return same_name(f.name, name); });
    return it == std::end(functions) ? -1 : static_cast<int>(it - std::begin(functions));
}

std::string argument_name(const StandardFunction& function, int argument) {
    const auto one_of = [&](std::initializer_list<std::string_view> names) {
        return std::string(names.begin()[argument]);
    };
    switch (function.rule) {
        case Rule::limit:
            return one_of({"MN", "IN", "MX"});
        case Rule::select:
            return one_of({"G", "IN0", "IN1"});
        case Rule::multiplex:
            return argument == 0 ? "K" : fmt::format("IN{}", argument - 1);
        case Rule::shift:
            return one_of({"IN", "N"});
        case Rule::normalise:
        case Rule::scale:
            return one_of({"MIN", "VALUE", "MAX"});
        case Rule::text:
            if (argument >= function.texts)
                return argument + 1 == function.most ? function.most == 2 ? "L" : "P" : "L";
            return function.texts == 1 ? "IN" : fmt::format("IN{}", argument + 1);
        default:
            return function.most == 1 ? "IN" : fmt::format("IN{}", argument + 1);
    }
}

}  // namespace lineshaft::st
