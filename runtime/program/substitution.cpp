#include "runtime/program/substitution.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/formula.hpp"
#include "runtime/source/habits.hpp"

namespace lineshaft {

const Node* Substitution::find(const std::string& name) {
    const auto it = values_.find(name);
    if (it == values_.end()) return outer_ ? outer_->find(name) : nullptr;
    used_.insert(name);
    return &it->second;
}

std::vector<std::string> Substitution::names() const {
    std::vector<std::string> names = outer_ ? outer_->names() : std::vector<std::string>();
    for (const auto& [name, value] : values_) names.push_back(name);
    return names;
}

void Substitution::apply(Node& node) {
    for (auto& [key, value] : node.entries) apply(value);
    for (Node& item : node.items) apply(item);
    if (!node.is_scalar() || node.quoted) return;
    if (is_formula(node.text)) return compute(node);
    if (!node.text.starts_with('$')) return;
    const std::string name = node.text.substr(1);
    const Node* found = find(name);
    if (!found) return unknown(node, name);
    node.parameter = found->is_unknown_parameter() ? found->parameter : name;
    if (!found->is_scalar()) return;
    node.text = found->text;
    node.quoted = found->quoted;
    if (!found->mark.file) return;
    node.used_in_line = found->mark.file == node.mark.file ? node.mark.line : 0;
    node.mark = found->mark;
}

void Substitution::apply_to_program(Node& root) {
    for (auto& [key, value] : root.entries)
        if (key.text == "title" ? !is_formula(value.text)
                                : key.text != "parameters" && key.text != "templates")
            apply(value);
}

void Substitution::unknown(Node& node, const std::string& name) const {
    const std::vector<std::string> known = names();
    if (outer_ || !declared_ || declared_->is_map())
        read_.fail(code::unknown_parameter, node,
                   fmt::format("the program has no parameter '{}'", name),
                   known.empty() ? "it has no 'parameters:'" : suggest(name, known, "$"));
    node.parameter = name;
    node.text = "$" + name;
}

/// Why a parameter that stands in a formula is no number; empty if it is one.
std::string Substitution::why_not_a_number(const std::string& name) {
    const Node* value = find(name);
    if (!value || (value->is_scalar() && !value->quoted &&
                   std::holds_alternative<Quantity>(parse_quantity(value->text))))
        return {};
    return fmt::format("the parameter '{}' is '{}', which is not a number", name, value->text);
}

void Substitution::compute(Node& node) {
    std::string refused;
    const auto result = evaluate(node.text, [&](std::string_view word) -> std::optional<Amount> {
        const std::string name(word.substr(word.starts_with('$') ? 1 : 0));
        const Node* value = word.starts_with('$') ? find(name) : nullptr;
        if (!value) return {};
        if (refused.empty()) refused = why_not_a_number(name);
        if (!refused.empty()) return {};
        const auto parsed = parse_quantity(value->text);
        const auto& quantity = std::get<Quantity>(parsed);
        return Amount(quantity.number, quantity.unit);
    });
    const std::string formula = node.text;
    node.parameter = formula;
    node.text = result.amount.text();
    if (result.error.empty() && std::isfinite(result.amount.value)) return;
    Node place = node;
    place.text = formula;
    place.parameter.clear();
    if (place.mark.length == static_cast<int>(formula.size())) {
        const std::size_t at = std::min(result.position, formula.size() - 1);
        place.mark.column += static_cast<int>(at);
        place.mark.length = std::max(1, static_cast<int>(result.name.size()));
    }
    node.parameter = formula.substr(1);
    node.text = "$" + node.parameter;
    if (refused.empty() && result.name.starts_with('$')) {
        place.text = result.name;
        return unknown(place, result.name.substr(1));
    }
    const std::string help = expression_help(formula);
    const bool is_signal = split_signal(result.name).has_value();
    read_.diagnostics().add(code::expression_for_a_value, place.mark,
                            fmt::format("'{}' cannot be computed: {}", formula,
                                        !refused.empty()        ? refused
                                        : !result.error.empty() ? result.error
                                                                : "it divides by zero"),
                            is_signal ? help : "");
}

}  // namespace lineshaft
