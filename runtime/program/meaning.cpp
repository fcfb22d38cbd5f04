#include "runtime/program/meaning.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/source/text_hash.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

std::string measured(const Quantity& quantity) {
    constexpr double exact = 0x1p53;
    if (quantity.unit.text == "%") return format_number(quantity.number) + " %";
    if (quantity.is_integer && !quantity.has_unit && std::abs(quantity.number) >= exact)
        return fmt::format("{}", quantity.integer);
    Unit base;
    base.exponents = quantity.unit.exponents;
    return fmt::format("{} {}", format_number(convert(quantity.number, quantity.unit, base)),
                       fmt::join(base.exponents, " "));
}

/// An input of the program takes its type and its unit from how its value is written.
std::string typed(const Quantity& quantity) {
    const bool whole = quantity.is_integer && !quantity.has_unit;
    return whole ? fmt::format("integer {}", quantity.integer)
                 : fmt::format("{} {}", format_number(quantity.number), quantity.unit.text);
}

/// Writes a tree in one form, whatever way it was written.
class Canonical {
  public:
    enum class Parameters { named, in_force };
    using Keys = std::vector<std::string_view>;

    explicit Canonical(Parameters parameters) : parameters_(parameters) {}

    /// A file's root, without some of its keys.
    std::string root(const Node& node, const Keys& without) const {
        std::vector<std::string> parts;
        for (const auto& [key, value] : node.entries)
            if (std::ranges::find(without, key.text) == without.end())
                parts.push_back(text(key.text) + section(key.text, value));
        return sorted(std::move(parts));
    }

    std::string scalar(const Node& node, std::string (*quantity_text)(const Quantity&)) const {
        if (parameters_ == Parameters::named && !node.parameter.empty())
            return text("$" + node.parameter);
        const auto parsed = parse_quantity(node.text);
        const auto* quantity = std::get_if<Quantity>(&parsed);
        if (!quantity) return text(node.text);
        return node.quoted ? "'" + text(node.text) : "#" + text(quantity_text(*quantity));
    }

  private:
    std::string section(const std::string& key, const Node& value) const {
        if (key == "tasks" || key == "blocks") return map(value, measured, false);
        if (key == "inputs") return any(value, typed);
        if (key != "run" || parameters_ == Parameters::in_force) return any(value, measured);
        return root(value, {"seed"});
    }

    std::string any(const Node& node, std::string (*quantity_text)(const Quantity&)) const {
        if (node.is_map()) return map(node, quantity_text, true);
        if (node.is_scalar()) return scalar(node, quantity_text);
        std::string list = "[";
        for (const Node& item : node.items) list += any(item, quantity_text);
        return list + "]";
    }

    std::string map(const Node& node, std::string (*quantity_text)(const Quantity&),
                    bool any_order) const {
        std::vector<std::string> parts;
        for (const auto& [key, value] : node.entries)
            parts.push_back(text(key.text) + any(value, quantity_text));
        return any_order ? sorted(std::move(parts)) : joined(parts);
    }

    static std::string sorted(std::vector<std::string> parts) {
        std::ranges::sort(parts);
        return joined(parts);
    }
    static std::string joined(const std::vector<std::string>& parts) {
        return fmt::format("{{{}}}", fmt::join(parts, ""));
    }
    /// With its length, so that what stands side by side cannot be read in two ways.
    static std::string text(const std::string& text) {
        return fmt::format("{}:{}", text.size(), text);
    }

    Parameters parameters_;
};

/// Keys of a program that make no other run, or are told beside its meaning.
const Canonical::Keys without_meaning{"title",      "notes", "slow",  "parameters",
                                      "controller", "force", "report"};

std::string hash_of_form(const Program& program) {
    std::string text = Canonical(Canonical::Parameters::named).root(program.root, without_meaning);
    std::vector<std::string> names;
    for (const auto& [name, value] : program.parameters) names.push_back(name);
    std::ranges::sort(names);
    return text_hash(text + fmt::format("{}", fmt::join(names, " ")));
}

}  // namespace

Meaning meaning_of(const Program& program) {
    const Canonical canonical(Canonical::Parameters::in_force);
    Meaning meaning{.in_force = {}, .form = hash_of_form(program), .controller = {}};
    if (program.controller)
        meaning.controller = text_hash(canonical.root(*program.controller, {"title", "notes"}));
    std::string text = canonical.root(program.root, without_meaning);
    for (const ForcePlan& force : program.forces)
        text += fmt::format("{} {} {} {} ", force.from, force.until, force.signal.text,
                            canonical.scalar(force.value, measured));
    for (const auto& source : program.texts) text += text_hash(source->text);
    meaning.in_force = text_hash(meaning.controller + text);
    return meaning;
}

}  // namespace lineshaft
