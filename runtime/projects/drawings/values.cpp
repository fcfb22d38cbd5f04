#include "runtime/projects/drawings/values.hpp"

#include <algorithm>
#include <utility>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

/// As an operand of AND or OR, of which `form` is the one.
Excerpts operand(const Value& a, Value::Form form, const Mark& place) {
    return a.form == form || a.form == Value::Form::not_ ? a.text : enclosed(a, place);
}

Value joined(const Value& a, std::string_view word, const Value& b, Value::Form form,
             const Mark& place) {
    Value made{.text = operand(a, form, place), .form = form, .type = "BOOL"};
    made.text.write(word, place);
    made.text.append(operand(b, form, place));
    return made;
}

}  // namespace

Excerpts enclosed(const Value& a, const Mark& place) {
    if (a.form == Value::Form::atom) return a.text;
    Excerpts made;
    made.write("(", place);
    made.append(a.text);
    made.write(")", place);
    return made;
}

Value both(Value a, Value b, const Mark& place) {
    if (a.is_empty() || a.is_always) return b;
    if (b.is_empty() || b.is_always) return a;
    return joined(a, " AND ", b, Value::Form::and_, place);
}

Value either(Value a, Value b, const Mark& place) {
    if (a.is_empty()) return b;
    if (b.is_empty()) return a;
    return joined(a, " OR ", b, Value::Form::or_, place);
}

Value negated(const Value& a, const Mark& place) {
    Value made{.text = {}, .form = Value::Form::not_, .type = a.type};
    made.text.write("NOT ", place);
    made.text.append(enclosed(a, place));
    return made;
}

Value words(std::string_view text, const Mark& place, std::string type) {
    Value made{.text = {}, .form = shape_of(text), .type = std::move(type)};
    made.text.write(text, place);
    return made;
}

Value always(const Mark& place) {
    Value made = words("TRUE", place, "BOOL");
    made.is_always = true;
    return made;
}

void write_if(Excerpts& to, const Value& condition, const Mark& place) {
    if (condition.is_empty() || condition.is_always) return;
    to.write("IF ", place);
    to.append(condition.text);
    to.write(" THEN\n", place);
}

void write_end_if(Excerpts& to, const Value& condition, const Mark& place) {
    const bool is_open = !condition.is_empty() && !condition.is_always;
    to.write(is_open ? "END_IF\n" : "", place);
}

Value kept_in(Excerpts& to, const std::string& variable, const Value& value, const Mark& place) {
    to.write(variable + " := ", place);
    to.append(value.text);
    to.write(";\n", place);
    return words(variable, place, value.type);
}

std::string function_of(std::string_view box) {
    static constexpr std::pair<std::string_view, std::string_view> all[] = {
        {"+", "ADD"}, {"-", "SUB"}, {"*", "MUL"}, {"/", "DIV"}, {">", "GT"},    {">=", "GE"},
        {"<", "LT"},  {"<=", "LE"}, {"=", "EQ"},  {"<>", "NE"}, {":=", "MOVE"}, {"&", "AND"}};
    for (const auto& [sign, name] : all)
        if (box == sign) return std::string(name);
    return std::string(box);
}

std::string_view infix_of(std::string_view function) {
    static constexpr std::pair<std::string_view, std::string_view> all[] = {
        {"xor", " XOR "}, {"add", " + "},   {"sub", " - "}, {"mul", " * "},
        {"div", " / "},   {"mod", " MOD "}, {"gt", " > "},  {"ge", " >= "},
        {"lt", " < "},    {"le", " <= "},   {"eq", " = "},  {"ne", " <> "}};
    for (const auto& [name, sign] : all)
        if (st::same_name(name, function)) return sign;
    return {};
}

bool compares(std::string_view function) {
    return is_any(function, {"gt", "ge", "lt", "le", "eq", "ne"});
}

bool is_any(std::string_view name, std::initializer_list<std::string_view> of) {
    return std::ranges::any_of(of, st::is_called(name));
}

Value::Form shape_of(std::string_view expression) {
    constexpr std::string_view more = "_.%#^:$'";
    const bool is_atom = std::ranges::all_of(expression, [&](char c) {
        return is_letter(c) || is_digit(c) || more.find(c) != more.npos;
    });
    return is_atom ? Value::Form::atom : Value::Form::other;
}

}  // namespace lineshaft::projects
