#include "runtime/projects/drawings/s7_boxes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects::s7 {

using st::same_name;

namespace {

/// To `out`, or to all outputs of a Move.
Value result(Running& r, const Value& value) {
    const Value power = r.enable();
    r.open(power);
    for (const auto& pin : r.it.pins)
        if (pin.is_output) r.assign(pin.value, value);
    r.close(power);
    return power;
}

/// What the function gives, to where `out` is.
Value result_of(Running& r, std::string_view function, const std::vector<Argument>& given) {
    const auto is_target = [](const auto& pin) { return pin.is_output && !pin.value.is_empty(); };
    const auto target = std::ranges::find_if(r.it.pins, is_target);
    if (r.tells() && target != r.it.pins.end()) return r.told(target->value, function, given);
    return result(r, r.call(function, given));
}

Value counted(Running& r, std::string_view sign) {
    const Value power = r.enable(), target = r.operand("operand");
    r.open(power), r.assign(target, r.binary(target, sign, r.word("1"))), r.close(power);
    return power;
}

/// `min`, `value`, `max`, of one type: a whole number is given as it is.
Value scaled(Running& r, std::string_view function) {
    return result_of(
        r, function,
        {{"MIN", r.operand("min")}, {"VALUE", r.operand("value")}, {"MAX", r.operand("max")}});
}

/// Whether the result may be outside its type.
bool has_bounds(std::string_view name) {
    static constexpr std::string_view all[] = {"add", "sub", "mul", "div"};
    return std::ranges::any_of(all, st::is_called(name));
}

/// The number of places alone stays what it is.
std::vector<Argument> typed_inputs(const Running& r) {
    std::vector<Argument> given = r.inputs();
    for (Argument& each : given)
        if (!same_name(each.pin, "n")) each.value = r.typed(each.value);
    return given;
}

std::vector<Argument> positions(std::vector<Argument> given) {
    for (Argument& each : given) each.pin.clear();
    return given;
}

Value executed(Running& r, std::string_view input, std::string_view output) {
    if (r.it.callee.is_empty()) {
        r.out.add(code::something_else_expected, r.it.place,
                  fmt::format("{} has no instance", r.it.name),
                  fmt::format("write '#timer.{}(...)'", r.it.name));
        return r.power;
    }
    const Value behind = r.goes_on ? r.wire() : Value{};
    const std::vector<Argument> given =
        r.pins("", {{std::string(input), r.power}, {std::string(output), behind, true}});
    r.to.append(r.call(fmt::format(".{}", upper(r.it.name)), given).text);
    r.write(";\n");
    return behind.is_empty() ? r.power : behind;
}

/// `target := callee.NAME(...);`, or the call alone.
void statement(Running& r, const S7Instruction::Pin* target, std::string_view function) {
    const Value call = r.call(function, r.pins(target ? target->name : ""));
    if (target && !target->value.is_empty()) return r.assign(target->value, call);
    r.to.append(call.text);
    r.write(";\n");
}

/// Whose OUT is no result but something that it writes to.
bool writes_to_out(std::string_view name) {
    static constexpr std::string_view all[] = {"move_blk", "umove_blk", "fill_blk", "ufill_blk",
                                               "scatter",  "gather",    "rd_sys_t", "rd_loc_t",
                                               "strg_val", "val_strg",  "scale",    "unscale"};
    return std::ranges::any_of(all, st::is_called(name));
}

}  // namespace

Value move(Running& r) {
    return result(r, r.call("MOVE", {{"", r.operand("in")}}));
}

Value text_move(Running& r) {
    return result(r, r.operand("in"));
}

Value arithmetic(Running& r) {
    if (r.tells() && has_bounds(r.it.name))
        return result_of(r, upper(r.it.name), positions(typed_inputs(r)));
    const std::string name = same_name(r.it.name, "and") || same_name(r.it.name, "or")
                                 ? fmt::format(" {} ", upper(r.it.name))
                                 : std::string(infix_of(r.it.name));
    Value made;
    for (const Argument& each : r.inputs())
        if (!each.value.is_empty())
            made =
                made.is_empty() ? r.typed(each.value) : r.binary(made, name, r.typed(each.value));
    return result(r, made);
}

Value negation(Running& r) {
    const Value given = r.typed(r.operand("in"));
    if (r.tells()) return result_of(r, "MUL", {{"", r.word("-1")}, {"", given}});
    Value made = r.word("-");
    made.text.append(enclosed(given, r.it.place));
    return result(r, made);
}

Value inversion(Running& r) {
    return result(r, negated(r.typed(r.operand("in")), r.it.place));
}

Value power_of(Running& r) {
    const Value base = r.typed(r.operand("in1"), "SrcType1"),
                exponent = r.typed(r.operand("in2"), "SrcType2");
    if (r.tells()) return result_of(r, "EXPT", {{"", base}, {"", exponent}});
    return result(r, r.binary(base, " ** ", exponent));
}

Value increment(Running& r) {
    return counted(r, " + ");
}

Value decrement(Running& r) {
    return counted(r, " - ");
}

Value conversion(Running& r) {
    const std::string from = type_of(r.it, "SrcType"), to = type_of(r.it, "DestType");
    if (from.empty() || to.empty() || same_name(from, to)) return result(r, r.operand("in"));
    return result_of(r, upper(fmt::format("{}_TO_{}", from, to)), {{"", r.operand("in")}});
}

Value limit(Running& r) {
    return result_of(
        r, "LIMIT",
        {{"MN", r.operand("mn", "min")}, {"IN", r.operand("in")}, {"MX", r.operand("mx", "max")}});
}

/// SCALE of the S7-300 has other pins.
Value scale(Running& r) {
    if (r.it.find("hi_lim")) return other_function(r);
    return scaled(r, "SCALE_X");
}

Value normalize(Running& r) {
    return scaled(r, "NORM_X");
}

/// A function of what stands at its inputs, whose names are those of SCL where it has some.
Value plain_function(Running& r) {
    return result_of(r, upper(r.it.name), positions(r.inputs()));
}

/// What it gives has the type of what it takes, or that decides how it is calculated.
Value typed_function(Running& r) {
    return result_of(r, upper(r.it.name), positions(typed_inputs(r)));
}

Value multiplexer(Running& r) {
    std::vector<Argument> given = r.inputs();
    for (Argument& each : given)
        if (same_name(each.pin, "else")) each.pin = "INELSE";
    return result_of(r, "MUX", given);
}

namespace {

/// `in1 * in2`, with what stands at the pins, or `TO_LREAL` of that; `has_words`: there is more in
/// it than these, numbers and signs.
Value with_pins(const Running& r, std::string_view before, bool& has_words) {
    const auto is_part = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
    const std::string_view text = r.it.formula;
    Value made{.text = {}, .form = Value::Form::other};
    for (const auto* at = text.begin(); at != text.end();) {
        const auto* const word = std::find_if(at, text.end(), is_part);
        made.text.write({at, word}, r.it.place);
        at = std::find_if_not(word, text.end(), is_part);
        const auto* pin = word == at ? nullptr : r.it.find({word, at});
        if (pin && !pin->is_output && !pin->name.empty()) {
            made.text.write(before, r.it.place);
            if (!before.empty()) made.text.write("(", r.it.place);
            made.text.append(enclosed(r.typed(pin->value), r.it.place));
            if (!before.empty()) made.text.write(")", r.it.place);
        } else {
            has_words = has_words || (word != at && is_letter(*word));
            made.text.write({word, at}, r.it.place);
        }
    }
    return made;
}

/// The bits of a whole number; 0 of any other type.
int bits_of(std::string_view type) {
    static constexpr std::pair<std::string_view, int> all[] = {
        {"sint", 8}, {"usint", 8}, {"int", 16}, {"uint", 16}, {"dint", 32}, {"udint", 32}};
    for (const auto& [name, bits] : all)
        if (same_name(name, type)) return bits;
    return 0;
}

/// Whether what a box calculates is a number of its type: what is beyond its bounds comes out by a
/// multiple of their distance away. Empty: it cannot fail.
Value is_calculated(const Running& r) {
    std::string type = type_of(r.it, "SrcType");
    if (type.empty()) type = type_of(r.it, "value_type");
    bool has_words = false;
    const Value plain = with_pins(r, "", has_words);
    const bool is_real = same_name(type, "real") || same_name(type, "lreal");
    const int bits = bits_of(type);
    if (!is_real && (bits == 0 || has_words)) return {};
    Value made{.text = {}, .form = Value::Form::other};
    if (is_real) {
        made.text.write("IS_VALID(", r.it.place);
        made.text.append(plain.text);
        made.text.write(")", r.it.place);
        return made;
    }
    made.text.write("ABS((", r.it.place);
    made.text.append(with_pins(r, "TO_LREAL", has_words).text);
    made.text.write(") - TO_LREAL(", r.it.place);
    made.text.append(plain.text);
    made.text.write(fmt::format(")) < {}.0", std::int64_t{1} << (bits - 1)), r.it.place);
    return made;
}

}  // namespace

Value formula(Running& r) {
    bool has_words = false;
    const Value made = with_pins(r, "", has_words);
    const Value succeeds = r.tells() ? is_calculated(r) : Value{};
    if (succeeds.is_empty()) return result(r, made);
    const Value power = r.enable(), behind = r.wire();
    r.assign(behind, r.word("FALSE"));
    r.open(power);
    r.assign(behind, succeeds);
    for (const auto& pin : r.it.pins)
        if (pin.is_output) r.assign(pin.value, made);
    r.close(power);
    return behind;
}

// What is executed in each scan, and has power as an input.

Value timer(Running& r) {
    return executed(r, "IN", "Q");
}

namespace {

/// `FOR _bit1 := 0 TO count - 1 DO list[3 + _bit1] := TRUE; END_FOR`, and none behind the last
Value bits_assigned(Running& r, std::string_view value) {
    const Value power = r.enable(), first = r.operand("s_bit", "operand"),
                count = r.operand("count", "n");
    const std::string_view text = first.text.text();
    const std::size_t index = text.rfind('[');
    if (!text.ends_with("]") || text.find(',', index) != text.npos) {
        r.out.add(code::not_supported, r.it.place,
                  fmt::format("{} is supported from an element of an ARRAY of BOOL of one "
                              "dimension on, and this is no such element",
                              r.it.name),
                  "write it in a network of SCL");
        return power;
    }
    const std::string bit = r.variables.make("_bit", "DINT");
    const std::string_view list = text.substr(0, index),
                           place = text.substr(index + 1, text.size() - index - 2);
    r.open(power);
    r.write(fmt::format("FOR {} := 0 TO MIN(", bit));
    r.to.append(count.text);
    r.write(fmt::format(" - 1, UPPER_BOUND({}, 1) - ({})) DO\n", list, place));
    r.write(fmt::format("{} + {}] := {};\n", text.substr(0, text.size() - 1), bit, value));
    r.write("END_FOR\n");
    r.close(power);
    return power;
}

}  // namespace

Value bits_set(Running& r) {
    return bits_assigned(r, "TRUE");
}

Value bits_reset(Running& r) {
    return bits_assigned(r, "FALSE");
}

Value up_counter(Running& r) {
    return executed(r, "CU", "Q");
}

Value down_counter(Running& r) {
    return executed(r, "CD", "Q");
}

Value up_down_counter(Running& r) {
    return executed(r, "CU", "QU");
}

// Calls.

/// A block of the user's, or an instance of a technology block.
Value called(Running& r) {
    const auto* target = r.it.find("ret_val");
    if (r.tells())
        return r.told(target ? target->value : Value{}, "", r.pins(target ? target->name : ""));
    const Value power = r.enable();
    r.open(power), statement(r, target, ""), r.close(power);
    return power;
}

/// How many characters an integer has behind S_CONV, but in SCL: 0: of that nothing is known.
int width_of(std::string_view type) {
    static constexpr std::pair<std::string_view, int> widths[] = {
        {"sint", 4}, {"usint", 4}, {"int", 6}, {"uint", 6}, {"dint", 11}, {"udint", 11}};
    for (const auto& [name, width] : widths)
        if (same_name(name, type)) return width;
    return 0;
}

/// A number goes to the right end of its characters, and no sign before what is not negative.
Value text_conversion(Running& r) {
    std::string type = type_of(r.it, "src_type");
    if (type.empty()) type = r.variables.known_type(r.it.value("in").text.text());
    const int width = width_of(type);
    const bool is_text = same_name(type_of(r.it, "dest_type"), "string");
    if (width == 0 || !is_text) return other_function(r);
    const std::vector<Argument> given{
        {"IN", r.operand("in")}, {"SIZE", r.word(std::to_string(width))},
        {"PREC", r.word("0")},   {"FORMAT", r.word("0")},
        {"P", r.word("1")},      {"OUT", r.operand("out"), true}};
    if (r.tells()) return r.told({}, "VAL_STRG", given);
    const Value power = r.enable();
    r.open(power);
    r.to.append(r.call("VAL_STRG", given).text);
    r.write(";\n");
    r.close(power);
    return power;
}

/// Calls a function of Siemens that has the same name in SCL.
Value other_function(Running& r) {
    const auto* target = r.it.find("ret_val");
    if (!target && !writes_to_out(r.it.name)) target = r.it.find("out");
    if (r.tells())
        return r.told(target ? target->value : Value{}, upper(r.it.name),
                      r.pins(target ? target->name : ""));
    const Value power = r.enable();
    r.open(power), statement(r, target, upper(r.it.name)), r.close(power);
    return power;
}

}  // namespace lineshaft::projects::s7
