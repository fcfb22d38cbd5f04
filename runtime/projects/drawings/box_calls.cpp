#include "runtime/projects/drawings/box_calls.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

constexpr int deepest_boxes = 400;
constexpr std::size_t longest_taken = 1U << 16;

bool is(const BoxCall& box, std::string_view name) {
    return st::same_name(box.type, name);
}

Value joined(const BoxCall& box, bool is_and) {
    Value made;
    const std::string type = box.inputs.front().type;
    for (const Value& input : box.inputs)
        made = is_and ? both(std::move(made), input, box.place)
                      : either(std::move(made), input, box.place);
    if (!made.is_always) made.type = type;
    return made;
}

Value joined(const BoxCall& box, std::string_view infix) {
    Value made{.text = {}, .form = Value::Form::other, .type = box.inputs.front().type};
    for (const Value& input : box.inputs) {
        if (!made.is_empty()) made.text.write(infix, box.place);
        made.text.append(enclosed(input, box.place));
    }
    if (compares(box.type)) made.type = "BOOL";
    return made;
}

}  // namespace

bool is_type_name(std::string_view type) {
    return !type.empty() && shape_of(type) == Value::Form::atom && !is_digit(type.front());
}

bool is_operator(std::string_view type) {
    constexpr std::string_view others[] = {"and", "or", "not", "move"};
    return !infix_of(type).empty() || std::ranges::any_of(others, [&](std::string_view name) {
        return st::same_name(type, name);
    });
}

bool has_own_outputs(std::string_view call, std::string_view instance) {
    if (call == "Method") return false;
    return !instance.empty() || call == "FunctionBlock" || call == "Program" || call == "Action";
}

bool calls_member(std::string_view call, std::string_view instance) {
    return !instance.empty() && (st::same_name(call, "method") || st::same_name(call, "action"));
}

std::string_view member_of_type(std::string_view type) {
    return type.substr(type.rfind('.') + 1);
}

bool names_result(std::string_view output, std::string_view type) {
    return output.empty() || st::same_name(output, member_of_type(type));
}

Excerpts arguments_of(const BoxCall& box,
                      const std::vector<std::pair<std::string, Excerpts>>& outputs) {
    Excerpts made;
    made.write("(", box.place);
    const bool is_named =
        box.names.size() >= box.inputs.size() &&
        std::ranges::none_of(box.names, [](const auto& name) { return name.empty(); });
    std::string_view comma;
    for (std::size_t i = 0; i < box.inputs.size(); ++i) {
        if (box.inputs[i].is_empty()) continue;
        made.write(comma, box.place);
        if (is_named) made.write(box.names[i] + " := ", box.place);
        made.append(box.inputs[i].text);
        comma = ", ";
    }
    for (const auto& [name, target] : outputs) {
        made.write(fmt::format("{}{} => ", comma, name), box.place);
        made.append(target);
        comma = ", ";
    }
    made.write(")", box.place);
    return made;
}

bool is_too_deep(int depth, const Mark& place, Diagnostics& out) {
    if (depth < deepest_boxes) return false;
    out.add(code::too_deep_or_large, place,
            fmt::format("more than {} elements stand one behind the other", deepest_boxes),
            "put a variable between");
    return true;
}

Value within_length(Value value, const Mark& place, Diagnostics& out) {
    if (value.text.text().size() <= longest_taken) return value;
    out.add(
        code::too_deep_or_large, place,
        fmt::format("what this takes is longer than {} characters as an expression", longest_taken),
        "put a variable between");
    return words("FALSE", place, "BOOL");
}

Value result_of_operator(const BoxCall& box) {
    if (box.inputs.empty() || std::ranges::any_of(box.inputs, &Value::is_empty)) return {};
    if (is(box, "move")) return box.inputs.front();
    if (is(box, "not")) return negated(box.inputs.front(), box.place);
    if (is(box, "and") || is(box, "or")) return joined(box, is(box, "and"));
    return joined(box, infix_of(box.type));
}

}  // namespace lineshaft::projects
