#include "runtime/st/functions/standard.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/st/syntax/token.hpp"

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
    {"SWAP", Rule::swap},
    {"DECO", Rule::decode},
    {"ENCO", Rule::encode},
    {"SCATTER", Rule::statement, 2, 2},
    {"GATHER", Rule::statement, 2, 2},
    {"RESET_TIMER", Rule::statement},
    {"PRESET_TIMER", Rule::statement, 2, 2},
    {"MOVE", Rule::move},
    {"ADD", Rule::operation, 2, several, Op::move, Word::plus},
    {"SUB", Rule::operation, 2, 2, Op::move, Word::minus},
    {"MUL", Rule::operation, 2, several, Op::move, Word::times},
    {"DIV", Rule::operation, 2, 2, Op::move, Word::divided},
    {"MOD", Rule::operation, 2, 2, Op::move, Word::mod_},
    {"AND", Rule::operation, 2, several, Op::move, Word::and_},
    {"OR", Rule::operation, 2, several, Op::move, Word::or_},
    {"XOR", Rule::operation, 2, several, Op::move, Word::xor_},
    {"GT", Rule::operation, 2, several, Op::move, Word::greater},
    {"GE", Rule::operation, 2, several, Op::move, Word::greater_or_equal},
    {"EQ", Rule::operation, 2, several, Op::move, Word::equal},
    {"LE", Rule::operation, 2, several, Op::move, Word::less_or_equal},
    {"LT", Rule::operation, 2, several, Op::move, Word::less},
    {"NE", Rule::operation, 2, 2, Op::move, Word::unequal},
    {"NORM_X", Rule::normalise, 3, 3},
    {"SCALE_X", Rule::scale, 3, 3},
    {"IS_VALID", Rule::finite},
    {"IS_VALID_BCD", Rule::valid_bcd},
    {"TIME", Rule::time, 0, 0},
    {"LTIME", Rule::time, 0, 0},
    {"TIME_TCK", Rule::time, 0, 0},
    {"ADD_TIME", Rule::operation, 2, 2, Op::move, Word::plus},
    {"ADD_LTIME", Rule::operation, 2, 2, Op::move, Word::plus},
    {"SUB_TIME", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_LTIME", Rule::operation, 2, 2, Op::move, Word::minus},
    {"MUL_TIME", Rule::operation, 2, 2, Op::move, Word::times},
    {"MUL_LTIME", Rule::operation, 2, 2, Op::move, Word::times},
    {"DIV_TIME", Rule::operation, 2, 2, Op::move, Word::divided},
    {"DIV_LTIME", Rule::operation, 2, 2, Op::move, Word::divided},
    {"MULTIME", Rule::operation, 2, 2, Op::move, Word::times},
    {"DIVTIME", Rule::operation, 2, 2, Op::move, Word::divided},
    {"ADD_TOD_TIME", Rule::operation, 2, 2, Op::move, Word::plus},
    {"ADD_LTOD_LTIME", Rule::operation, 2, 2, Op::move, Word::plus},
    {"ADD_DT_TIME", Rule::operation, 2, 2, Op::move, Word::plus},
    {"ADD_LDT_LTIME", Rule::operation, 2, 2, Op::move, Word::plus},
    {"SUB_DATE_DATE", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_LDATE_LDATE", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_TOD_TIME", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_LTOD_LTIME", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_TOD_TOD", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_LTOD_LTOD", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_DT_TIME", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_LDT_LTIME", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_DT_DT", Rule::operation, 2, 2, Op::move, Word::minus},
    {"SUB_LDT_LDT", Rule::operation, 2, 2, Op::move, Word::minus},
    {"CONCAT_DATE_TOD", Rule::operation, 2, 2, Op::move, Word::plus},
    {"CONCAT_DATE_LTOD", Rule::operation, 2, 2, Op::move, Word::plus},
    {"T_ADD", Rule::operation, 2, 2, Op::move, Word::plus},
    {"T_SUB", Rule::operation, 2, 2, Op::move, Word::minus},
    {"T_DIFF", Rule::operation, 2, 2, Op::move, Word::minus},
    {"LEN", Rule::length},
    {"MAX_LEN", Rule::capacity},
    {"LOWER_BOUND", Rule::bound, 2, 2},
    {"UPPER_BOUND", Rule::bound, 2, 2},
    {"CountOfElements", Rule::bound},
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

const StandardFunction* find_standard_function(std::string_view name) {
    const auto* it = std::ranges::find_if(
        functions, [&](const StandardFunction& f) { return same_name(f.name, name); });
    return it == std::end(functions) ? nullptr : it;
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
        case Rule::statement:
            if (function.name == "RESET_TIMER") return "TIMER";
            if (function.name == "PRESET_TIMER") return one_of({"PT", "TIMER"});
            return one_of({"IN", "OUT"});
        case Rule::multiplex:
            return argument == 0 ? "K" : fmt::format("IN{}", argument - 1);
        case Rule::bound:
            return function.most == 1 ? "IN" : one_of({"ARR", "DIM"});
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
