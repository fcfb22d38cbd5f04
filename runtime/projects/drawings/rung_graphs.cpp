#include "runtime/projects/drawings/rung_graphs.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"

namespace lineshaft::projects {

namespace {

const Node& part_of(const Node& node, std::string_view key) {
    static const Node nothing;
    const Node* found = node.find(key);
    return found ? *found : nothing;
}

std::string_view text_of(const Node& node, std::string_view key) {
    return part_of(node, key).text;
}

double number_of(const Node& node, std::string_view key) {
    const std::string_view digits = text_of(node, key);
    double value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
}

/// What a contact or a coil is by its `variant`.
struct Variant {
    std::string_view name, attributes;
};
constexpr Variant variants[] = {{"default", ""},
                                {"negated", " negated=\"true\""},
                                {"risingEdge", " edge=\"rising\""},
                                {"fallingEdge", " edge=\"falling\""},
                                {"set", " storage=\"set\""},
                                {"reset", " storage=\"reset\""}};

/// An element of a rung, with where it is drawn.
struct Placed {
    const Node* node = nullptr;
    double y = 0, x = 0;
    std::size_t id = 0;
};

/// An end of a line that is no branch of a wire.
struct Beginning {
    const Placed* from = nullptr;
    std::string_view pin;
    bool operator==(const Beginning&) const = default;
};

class Rungs {
  public:
    explicit Rungs(Diagnostics& out) : out_(out) {}

    Excerpts read(const Node& ladder) {
        made_.write("<LD>", ladder.mark);
        for (const Node& rung : part_of(ladder, "rungs").items) read_rung(rung);
        made_.write("</LD>", ladder.mark);
        return std::move(made_);
    }

  private:
    /// Coils are evaluated from top to bottom, which is their order in the element.
    void read_rung(const Node& rung) {
        constexpr double height = 100'000;
        placed_.clear();
        edges_.clear();
        for (const Node& edge : part_of(rung, "edges").items)
            edges_.emplace(text_of(edge, "target"), &edge);
        for (const Node& node : part_of(rung, "nodes").items) {
            const Node& position = part_of(node, "position");
            placed_.push_back({&node, number_of(position, "y") + height * rungs_,
                               number_of(position, "x"), ++count_});
        }
        ++rungs_;
        std::ranges::stable_sort(placed_, {}, [](const Placed& p) { return std::tie(p.y, p.x); });
        by_id_.clear();
        for (const Placed& placed : placed_) by_id_.emplace(text_of(*placed.node, "id"), &placed);
        for (const Placed& placed : placed_) add(placed);
    }

    void add(const Placed& placed) {
        const std::string_view type = text_of(*placed.node, "type");
        const Node& data = part_of(*placed.node, "data");
        if (type == "contact" || type == "coil") return add_switch(placed, type, data);
        if (type == "block") return add_box(placed, data);
        if (type == "variable") return add_variable(placed, data);
        if (type == "powerRail") return add_rail(placed, data);
        if (type != "parallel")
            out_.add(code::not_supported, mark_of_node(placed),
                     fmt::format("'{}' in a rung is not known", type),
                     "contacts, coils, boxes, variables and wires are");
    }

    void add_rail(const Placed& placed, const Node& data) {
        if (text_of(data, "variant") != "left") return;
        open(placed, "leftPowerRail", "");
        close("<connectionPointOut formalParameter=\"\"/></leftPowerRail>", placed);
    }

    void add_switch(const Placed& placed, std::string_view type, const Node& data) {
        const Node& wanted = part_of(data, "variant");
        const auto* variant = std::ranges::find(variants, wanted.text, &Variant::name);
        if (variant == std::end(variants))
            return out_.add(code::not_supported, wanted.mark,
                            fmt::format("'{}' is no kind of {}", wanted.text, type));
        open(placed, type, variant->attributes);
        add_lines(placed, "input");
        add_name(part_of(data, "variable"), "variable");
        close(fmt::format("</{}>", type), placed);
    }

    void add_variable(const Placed& placed, const Node& data) {
        const Node& variable = part_of(data, "variable");
        if (text_of(variable, "name").empty()) return;
        const bool is_input = text_of(data, "variant") == "input";
        const std::string_view tag = is_input ? "inVariable" : "outVariable";
        open(placed, tag, "");
        if (is_input)
            close("<connectionPointOut/>", placed);
        else
            add_lines(placed, "input");
        add_name(variable, "expression");
        close(fmt::format("</{}>", tag), placed);
    }

    void add_box(const Placed& placed, const Node& data) {
        const Node& variant = part_of(data, "variant");
        std::string attributes = fmt::format(" typeName=\"{}\"", as_xml(text_of(variant, "name")));
        if (text_of(variant, "type") == "function-block")
            attributes += fmt::format(" instanceName=\"{}\"",
                                      as_xml(text_of(part_of(data, "variable"), "name")));
        if (const std::string_view order = text_of(data, "executionOrder"); order != "0")
            attributes += fmt::format(" executionOrderId=\"{}\"", as_xml(order));
        open(placed, "block", attributes);
        close("<inputVariables>", placed);
        for (const Node& pin : part_of(data, "inputHandles").items) {
            const std::string_view name = text_of(pin, "id");
            if (beginnings_of(placed, name).empty()) continue;
            open_pin(placed, name);
            add_lines(placed, name);
            close("</variable>", placed);
        }
        close("</inputVariables><inOutVariables/><outputVariables>", placed);
        for (const Node& pin : part_of(data, "outputHandles").items) {
            open_pin(placed, text_of(pin, "id"));
            close("<connectionPointOut/></variable>", placed);
        }
        close("</outputVariables></block>", placed);
    }

    void open_pin(const Placed& placed, std::string_view name) {
        close(fmt::format("<variable formalParameter=\"{}\">", as_xml(name)), placed);
    }

    void open(const Placed& placed, std::string_view tag, std::string_view attributes) {
        close(fmt::format("<{0} localId=\"{1}\"{2}><position x=\"{3}\" y=\"{4}\"/>", tag, placed.id,
                          attributes, placed.x, placed.y),
              placed);
    }

    void close(std::string_view words, const Placed& placed) {
        made_.write(words, mark_of_node(placed));
    }

    void add_name(const Node& variable, std::string_view tag) {
        const Node& name = part_of(variable, "name");
        made_.write(fmt::format("<{0}>{1}</{0}>", tag, as_xml(name.text)), name.mark);
    }

    void add_lines(const Placed& placed, std::string_view pin) {
        close("<connectionPointIn>", placed);
        for (const Beginning& line : beginnings_of(placed, pin)) {
            const bool is_of_box = text_of(*line.from->node, "type") == "block";
            const std::string of_pin =
                is_of_box ? fmt::format(" formalParameter=\"{}\"", as_xml(line.pin)) : "";
            close(fmt::format("<connection refLocalId=\"{}\"{}/>", line.from->id, of_pin), placed);
        }
        close("</connectionPointIn>", placed);
    }

    /// Where lines to that pin begin, through the branches between.
    std::vector<Beginning> beginnings_of(const Placed& placed, std::string_view pin) const {
        std::vector<Beginning> found;
        std::vector<std::pair<std::string_view, std::string_view>> ends{
            {text_of(*placed.node, "id"), pin}};
        std::set<std::string_view> branches;
        while (!ends.empty()) {
            const auto [target, handle] = ends.back();
            ends.pop_back();
            const auto [first, end] = edges_.equal_range(target);
            for (auto it = first; it != end; ++it) {
                const Node& edge = *it->second;
                if (!handle.empty() && text_of(edge, "targetHandle") != handle) continue;
                const auto from = by_id_.find(text_of(edge, "source"));
                if (from == by_id_.end()) continue;
                const Beginning line{from->second, text_of(edge, "sourceHandle")};
                if (text_of(*line.from->node, "type") == "parallel") {
                    if (branches.insert(from->first).second) ends.emplace_back(from->first, "");
                } else if (!is_nothing(*line.from->node) &&
                           std::ranges::find(found, line) == found.end()) {
                    found.push_back(line);
                }
            }
        }
        return found;
    }

    /// What the editor puts at each pin where a name may be written.
    static bool is_nothing(const Node& node) {
        return text_of(node, "type") == "variable" &&
               text_of(part_of(part_of(node, "data"), "variable"), "name").empty();
    }

    static Mark mark_of_node(const Placed& placed) {
        const Node& name = part_of(part_of(part_of(*placed.node, "data"), "variable"), "name");
        return name.text.empty() ? part_of(*placed.node, "type").mark : name.mark;
    }

    Diagnostics& out_;
    Excerpts made_;
    std::vector<Placed> placed_;
    std::map<std::string_view, const Placed*> by_id_;
    std::multimap<std::string_view, const Node*> edges_;  ///< by where they lead to
    std::size_t count_ = 0;
    int rungs_ = 0;
};

}  // namespace

Excerpts ladder_of_rungs(const Node& ladder, Diagnostics& out) {
    return Rungs(out).read(ladder);
}

std::string as_xml(std::string_view text) {
    std::string made;
    for (const char c : text)
        made += c == '<'   ? "&lt;"
                : c == '>' ? "&gt;"
                : c == '&' ? "&amp;"
                : c == '"' ? "&quot;"
                           : std::string(1, c);
    return made;
}

}  // namespace lineshaft::projects
