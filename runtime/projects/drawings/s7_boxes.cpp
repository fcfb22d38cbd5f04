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

Value counted(Running& r, std::string_view sign) {
    const Value power = r.enable(), target = r.operand("operand");
    r.open(power), r.assign(target, r.binary(target, sign, r.word("1"))), r.close(power);
    return power;
}

/// `MN` and `MX` of an edition are `min` and `max` of others.
Value operand_of(const Running& r, std::string_view pin, std::string_view other) {
    return r.operand(r.it.find(pin) ? pin : other);
}

/// `min`, `value`, `max`, of one type: a whole number is given as it is.
Value scaled(Running& r, std::string_view function) {
    return result(r, r.call(function, {{"MIN", r.operand("min")},
                                       {"VALUE", r.operand("value")},
                                       {"MAX", r.operand("max")}}));
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
    return result(r, r.operand("in"));
}

Value arithmetic(Running& r) {
    const std::string name = same_name(r.it.name, "and") || same_name(r.it.name, "or")
                                 ? fmt::format(" {} ", upper(r.it.name))
                                 : std::string(infix_of(r.it.name));
    Value made;
    for (const auto& pin : r.it.pins)
        if (!pin.is_output && !pin.value.is_empty())
            made = made.is_empty() ? r.typed(pin.value) : r.binary(made, name, r.typed(pin.value));
    return result(r, made);
}

Value negation(Running& r) {
    Value made = r.word("-");
    made.text.append(enclosed(r.typed(r.operand("in")), r.it.place));
    return result(r, made);
}

Value inversion(Running& r) {
    return result(r, negated(r.typed(r.operand("in")), r.it.place));
}

Value power_of(Running& r) {
    return result(r, r.binary(r.typed(r.operand("in1"), "SrcType1"), " ** ",
                              r.typed(r.operand("in2"), "SrcType2")));
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
    return result(r, r.call(upper(fmt::format("{}_TO_{}", from, to)), {{"", r.operand("in")}}));
}

Value limit(Running& r) {
    return result(r, r.call("LIMIT", {{"MN", operand_of(r, "mn", "min")},
                                      {"IN", r.operand("in")},
                                      {"MX", operand_of(r, "mx", "max")}}));
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
    return result(r, r.call(upper(r.it.name), positions(r.inputs())));
}

/// What it gives has the type of what it takes, or that decides how it is calculated.
Value typed_function(Running& r) {
    std::vector<Argument> given = r.inputs();
    for (Argument& each : given)
        if (!same_name(each.pin, "n")) each.value = r.typed(each.value);
    return result(r, r.call(upper(r.it.name), positions(std::move(given))));
}

Value multiplexer(Running& r) {
    std::vector<Argument> given = r.inputs();
    for (Argument& each : given)
        if (same_name(each.pin, "else")) each.pin = "INELSE";
    return result(r, r.call("MUX", given));
}

/// `in1 * in2`, with what stands at the pins.
Value formula(Running& r) {
    const auto is_part = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
    const std::string_view text = r.it.formula;
    Value made{.text = {}, .form = Value::Form::other};
    for (const auto* at = text.begin(); at != text.end();) {
        const auto* const word = std::find_if(at, text.end(), is_part);
        made.text.write({at, word}, r.it.place);
        at = std::find_if_not(word, text.end(), is_part);
        const auto* pin = word == at ? nullptr : r.it.find({word, at});
        if (pin && !pin->is_output && !pin->name.empty())
            made.text.append(enclosed(r.typed(pin->value), r.it.place));
        else
            made.text.write({word, at}, r.it.place);
    }
    return result(r, made);
}

// What is executed in each scan, and has power as an input.

Value timer(Running& r) {
    return executed(r, "IN", "Q");
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
    const Value power = r.enable();
    r.open(power), statement(r, r.it.find("ret_val"), ""), r.close(power);
    return power;
}

/// Of Siemens' functions that have the same names in SCL.
Value other_function(Running& r) {
    const auto* target = r.it.find("ret_val");
    if (!target && !writes_to_out(r.it.name)) target = r.it.find("out");
    const Value power = r.enable();
    r.open(power), statement(r, target, upper(r.it.name)), r.close(power);
    return power;
}

}  // namespace lineshaft::projects::s7
