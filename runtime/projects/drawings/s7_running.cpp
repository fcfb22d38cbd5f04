#include "runtime/projects/drawings/s7_running.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects::s7 {

Value Running::operand(std::string_view pin) const {
    Value given = it.value(pin);
    if (given.is_empty())
        out.add(code::something_else_expected, it.place,
                fmt::format("there is nothing at {} of {}", pin, it.name), "connect it");
    return given;
}

Value Running::typed(const Value& value, std::string_view which) const {
    if (value.is_empty()) return value;
    static constexpr std::string_view numbers[] = {"SInt",  "USInt", "Int",   "UInt", "DInt",
                                                   "UDInt", "LInt",  "ULInt", "Real", "LReal",
                                                   "Byte",  "Word",  "DWord", "LWord"};
    std::string type = type_of(it, which);
    if (type.empty()) type = type_of(it, "value_type");
    const std::string_view text = value.text.text();
    const std::string known = value.type.empty() ? variables.known_type(text) : value.type;
    const bool is_literal = std::string_view("#\"%_(").find(text.front()) == text.npos;
    if (is_literal || st::same_name(known, type) ||
        !std::ranges::any_of(numbers, st::is_called(type)))
        return value;
    Value made = word(fmt::format("TO_{}(", upper(type)));
    made.text.append(value.text);
    made.text.write(")", it.place);
    made.form = Value::Form::atom;
    return made;
}

Value Running::enable() {
    if (goes_on) power = all.fixed(to, std::move(power), it.place);
    return power;
}

Value Running::told(const Value& target, std::string_view function, std::vector<Argument> given) {
    const Value behind = wire();
    if (!power.is_always) given.insert(given.begin(), {"EN", power});
    given.push_back({"ENO", behind, true});
    const Value made = call(function, given);
    if (!target.is_empty()) return assign(target, made), behind;
    to.append(made.text);
    write(";\n");
    return behind;
}

void Running::assign(const Value& target, const Value& value) {
    if (target.is_empty()) return;
    to.append(target.text);
    write(" := ");
    to.append(value.text);
    write(";\n");
}

Value Running::not_(const Value& value) const {
    return value.is_always ? words("FALSE", it.place, "BOOL") : negated(value, it.place);
}

Value Running::binary(const Value& a, std::string_view sign, const Value& b) const {
    Value made{.text = enclosed(a, it.place), .form = Value::Form::other};
    made.text.write(sign, it.place);
    made.text.append(enclosed(b, it.place));
    return made;
}

Value Running::call(std::string_view function, const std::vector<Argument>& given) const {
    Value made{.text = it.callee.text, .form = Value::Form::atom};
    made.text.write(fmt::format("{}(", function), it.place);
    std::string_view between;
    for (const auto& [pin, value, is_output] : given) {
        if (value.is_empty()) continue;
        made.text.write(between, it.place);
        if (!pin.empty())
            made.text.write(fmt::format("{0}{1}{0} {2} ", is_identifier(pin) ? "" : "\"", pin,
                                        is_output ? "=>" : ":="),
                            it.place);
        made.text.append(value.text);
        between = ", ";
    }
    made.text.write(")", it.place);
    return made;
}

std::vector<Argument> Running::pins(std::string_view but, std::vector<Argument> first) const {
    for (const auto& pin : it.pins)
        if (but.empty() || !st::same_name(pin.name, but))
            first.push_back({pin.name, pin.value, pin.is_output});
    return first;
}

std::vector<Argument> Running::inputs() const {
    std::vector<Argument> made;
    for (const auto& pin : it.pins)
        if (!pin.is_output) made.push_back({pin.name, pin.value});
    const auto key = [](const Argument& each) {
        const std::string small = lower(each.pin);
        const std::size_t stem = small.find_last_not_of("0123456789") + 1;
        return std::tuple(small.substr(0, stem), small.size(), small);
    };
    std::ranges::stable_sort(made, {}, key);
    return made;
}

std::string type_of(const S7Instruction& instruction, std::string_view which) {
    const std::string_view all = instruction.types;
    for (std::size_t at = 0; at < all.size();) {
        const auto is_part = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
        const auto* begin = std::find_if(all.begin() + at, all.end(), is_part);
        const auto* end = std::find_if_not(begin, all.end(), is_part);
        at = static_cast<std::size_t>(end - all.begin());
        if (begin == end || !st::same_name({begin, end}, which)) continue;
        begin = std::find_if(end, all.end(), is_part);
        end = std::find_if_not(begin, all.end(), is_part);
        return {begin, end};
    }
    return {};
}

}  // namespace lineshaft::projects::s7
