#include "runtime/projects/drawings/drawing.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

struct DrawnElement {
    std::string_view tag;
    Drawn kind;
    std::string_view word;
};
constexpr DrawnElement drawn_elements[] = {{"contact", Drawn::contact, "contact"},
                                           {"coil", Drawn::coil, "coil"},
                                           {"inVariable", Drawn::in_variable, "variable"},
                                           {"outVariable", Drawn::out_variable, "variable"},
                                           {"inOutVariable", Drawn::in_out_variable, "variable"},
                                           {"block", Drawn::block, "box"},
                                           {"label", Drawn::label, "label"},
                                           {"jump", Drawn::jump, "jump"},
                                           {"return", Drawn::return_, "return"},
                                           {"connector", Drawn::connector, "connector"},
                                           {"continuation", Drawn::continuation, "continuation"},
                                           {"leftPowerRail", Drawn::left_rail, "power rail"},
                                           {"rightPowerRail", Drawn::right_rail, "power rail"},
                                           {"transition", Drawn::transition, "transition"}};

/// What stands beside networks and does nothing in them, and the elements of a chart.
constexpr std::string_view others[] = {"comment",
                                       "vendorElement",
                                       "error",
                                       "documentation",
                                       "addData",
                                       "step",
                                       "macroStep",
                                       "jumpStep",
                                       "selectionDivergence",
                                       "selectionConvergence",
                                       "simultaneousDivergence",
                                       "actionBlock",
                                       "simultaneousConvergence"};

/// What leads to a transition, where that is drawn.
pugi::xml_node condition_point(pugi::xml_node transition) {
    return transition.child("condition").child("connectionPointIn");
}

bool is_title(pugi::xml_node element) {
    for (const pugi::xml_node data : element.child("addData").children("data"))
        if (std::string_view(data.child("ElementType").child_value()) == "networktitle")
            return true;
    return false;
}

/// Reads the elements, then the lines, whose ends may come before their beginnings.
class DrawingReader {
  public:
    DrawingReader(const XmlFile& file, Diagnostics& out, DrawnOrder order)
        : file_(file), out_(out), order_(order) {}

    Drawing read(pugi::xml_node body) {
        for (const pugi::xml_node node : body.children()) add(node);
        for (Element& element : made_.elements) add_pins(element);
        for (Element& element : made_.elements)
            if (element.kind != Drawn::right_rail) count_lines(element);
        if (titles_ == 0) find_networks();
        put_in_order();
        return std::move(made_);
    }

  private:
    void add(pugi::xml_node node);
    std::int64_t order_of(pugi::xml_node node) const;
    void add_pins(Element& element);
    void count_lines(const Element& element);
    Pin pin_of(pugi::xml_node node, const char* negated = "negated");
    void add_lines(Pin& pin, pugi::xml_node point);
    void find_networks();
    void place_labels();
    void put_in_order();
    bool is_of_matiec() const;
    std::vector<std::size_t> rows() const;

    std::string text(pugi::xml_node node, const char* attribute) const {
        return file_.plain(node.attribute(attribute));
    }
    template <class Number>
    Number number(pugi::xml_node node, const char* attribute) const {
        const std::string digits = text(node, attribute);
        Number value = 0;
        std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return value;
    }

    const XmlFile& file_;
    Diagnostics& out_;
    const DrawnOrder order_;
    Drawing made_;
    std::map<std::string, std::size_t, std::less<>> by_id_;
    std::size_t titles_ = 0;
};

/// From 1 on; 0: it has none. CODESYS counts the elements of a free chart from 0 on.
std::int64_t DrawingReader::order_of(pugi::xml_node node) const {
    const bool is_free = std::string_view(node.parent().name()) == "CFC";
    return number<std::int64_t>(node, "executionOrderId") +
           (is_free && node.attribute("executionOrderId"));
}

void DrawingReader::add(pugi::xml_node node) {
    if (node.type() != pugi::node_element) return;
    const std::string_view tag = node.name();
    if (tag == "vendorElement" && is_title(node)) {
        ++titles_;
        for (auto label = made_.elements.rbegin();
             label != made_.elements.rend() && label->kind == Drawn::label; ++label)
            label->network = titles_;
        return;
    }
    const auto* known = std::ranges::find(drawn_elements, tag, &DrawnElement::tag);
    if (known == std::end(drawn_elements)) {
        if (std::ranges::find(others, tag) == std::end(others))
            out_.add(code::not_supported, file_.mark_of_tag(node),
                     fmt::format("<{}> is no element of a network", tag), "leave it out");
        return;
    }
    if (known->kind == Drawn::transition && !condition_point(node)) return;
    const bool has_no_order = order_ != DrawnOrder::networks && known->kind == Drawn::coil;
    const pugi::xml_node position = node.child("position");
    made_.elements.push_back({.kind = known->kind,
                              .node = node,
                              .id = text(node, "localId"),
                              .order = has_no_order ? 0 : order_of(node),
                              .x = number<double>(position, "x"),
                              .y = number<double>(position, "y"),
                              .network = titles_});
    by_id_.emplace(made_.elements.back().id, made_.elements.size() - 1);
}

Pin DrawingReader::pin_of(pugi::xml_node node, const char* negated) {
    const std::string edge = text(node, "edge");
    return {.node = node,
            .name = text(node, "formalParameter"),
            .is_negated = text(node, negated) == "true",
            .edge = edge == "rising"    ? Edge::rising
                    : edge == "falling" ? Edge::falling
                                        : Edge::none};
}

void DrawingReader::add_lines(Pin& pin, pugi::xml_node point) {
    if (const pugi::xml_node expression = point.child("expression"))
        if (!file_.plain(expression).empty()) pin.expression = expression;
    for (const pugi::xml_node connection : point.children("connection")) {
        const std::string id = text(connection, "refLocalId");
        const auto from = by_id_.find(id);
        if (from != by_id_.end())
            pin.lines.push_back({from->second, text(connection, "formalParameter")});
        else
            out_.warn(
                code::not_an_object, file_.mark(file_.part(connection.attribute("refLocalId"))),
                fmt::format(
                    "a line comes from '{}', which is no element of this body, and is left out",
                    id),
                "refLocalId is the localId of another element");
    }
}

void DrawingReader::add_pins(Element& element) {
    const pugi::xml_node node = element.node;
    if (element.kind == Drawn::block) {
        for (const auto& [list, pins] : {std::pair{"inputVariables", &element.inputs},
                                         std::pair{"inOutVariables", &element.in_outs}})
            for (const pugi::xml_node variable : node.child(list).children("variable")) {
                pins->push_back(pin_of(variable));
                add_lines(pins->back(), variable.child("connectionPointIn"));
            }
        for (const pugi::xml_node variable : node.child("outputVariables").children("variable")) {
            element.outputs.push_back(pin_of(variable));
            add_lines(element.outputs.back(), variable.child("connectionPointOut"));
        }
        return;
    }
    if (element.kind == Drawn::continuation) {
        const std::string name = text(node, "name");
        const auto connector = std::ranges::find_if(made_.elements, [&](const Element& other) {
            return other.kind == Drawn::connector && st::same_name(text(other.node, "name"), name);
        });
        if (connector == made_.elements.end())
            return out_.add(code::not_declared, file_.mark_of_tag(node),
                            fmt::format("there is no connector '{}' for this continuation", name));
        Pin pin{.node = node};
        pin.lines.push_back(
            {static_cast<std::size_t>(connector - made_.elements.begin()), std::string()});
        element.inputs.push_back(std::move(pin));
        return;
    }
    const pugi::xml_node point =
        element.kind == Drawn::transition ? condition_point(node) : node.child("connectionPointIn");
    if (point) {
        const bool is_both = element.kind == Drawn::in_out_variable;
        Pin pin{.node = node, .is_negated = is_both && text(node, "negatedIn") == "true"};
        add_lines(pin, point);
        element.inputs.push_back(std::move(pin));
    }
}

void DrawingReader::count_lines(const Element& element) {
    for (const auto* pins : {&element.inputs, &element.in_outs})
        for (const Pin& pin : *pins)
            for (const Line& line : pin.lines) ++made_.elements[line.from].lines_out;
}

/// Elements that lines connect are one network; a power rail connects nothing. Networks are
/// numbered from top to bottom.
void DrawingReader::find_networks() {
    auto& elements = made_.elements;
    std::vector<std::size_t> root(elements.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto root_of = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    const auto is_rail = [](const Element& element) {
        return element.kind == Drawn::left_rail || element.kind == Drawn::right_rail;
    };
    for (std::size_t i = 0; i < elements.size(); ++i)
        for (const auto* pins : {&elements[i].inputs, &elements[i].in_outs})
            for (const Pin& pin : *pins)
                for (const Line& line : pin.lines)
                    if (!is_rail(elements[i]) && !is_rail(elements[line.from]))
                        root[root_of(i)] = root_of(line.from);
    struct Place {
        double y, x;
        std::size_t root;
        auto operator<=>(const Place&) const = default;
    };
    std::map<std::size_t, Place> first;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (is_rail(elements[i]) || elements[i].kind == Drawn::label) continue;
        const Place place{elements[i].y, elements[i].x, i};
        const auto [found, is_new] = first.emplace(root_of(i), place);
        if (!is_new) found->second = std::min(found->second, place);
    }
    std::vector<Place> sorted;
    for (const auto& [number, place] : first) sorted.push_back({place.y, place.x, place.root});
    std::ranges::sort(sorted);
    std::map<std::size_t, std::size_t> numbers;
    for (const Place& place : sorted) numbers.emplace(root_of(place.root), numbers.size() + 1);
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (const auto found = numbers.find(root_of(i)); found != numbers.end())
            elements[i].network = found->second;
    place_labels();
}

/// A label belongs to the first network of which something stands beside or below it.
void DrawingReader::place_labels() {
    for (Element& label : made_.elements) {
        if (label.kind != Drawn::label) continue;
        std::optional<std::size_t> found;
        std::size_t last = 0;
        for (const Element& other : made_.elements) {
            if (other.network == 0 || other.kind == Drawn::label) continue;
            last = std::max(last, other.network);
            const double height = number<double>(other.node, "height");
            if (other.y + height >= label.y && (!found || other.network < *found))
                found = other.network;
        }
        label.network = found.value_or(last + 1);
    }
}

bool DrawingReader::is_of_matiec() const {
    return order_ != DrawnOrder::networks &&
           std::ranges::none_of(made_.elements, [](const Element& element) {
               return element.kind == Drawn::jump || element.kind == Drawn::return_;
           });
}

/// The row of each element, from top to bottom: what begins less than 10 below its first one.
std::vector<std::size_t> DrawingReader::rows() const {
    const auto& elements = made_.elements;
    std::vector<std::size_t> sorted(elements.size()), made(elements.size());
    std::iota(sorted.begin(), sorted.end(), std::size_t{0});
    std::ranges::stable_sort(sorted, {}, [&](std::size_t i) { return elements[i].y; });
    std::size_t row = 0;
    double top = 0;
    for (const std::size_t i : sorted) {
        if (row == 0 || elements[i].y >= top + 10) {
            ++row;
            top = elements[i].y;
        }
        made[i] = row;
    }
    return made;
}

void DrawingReader::put_in_order() {
    const auto& elements = made_.elements;
    made_.order.resize(elements.size());
    std::iota(made_.order.begin(), made_.order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) {
        const Element& element = elements[i];
        const bool leaves = element.kind == Drawn::jump || element.kind == Drawn::return_;
        const int rank = element.kind == Drawn::label ? 0 : leaves ? 2 : 1;
        return std::make_tuple(element.order <= 0, std::max<std::int64_t>(element.order, 0),
                               element.network, rank, element.y, element.x, i);
    };
    const bool is_by_position = order_ == DrawnOrder::position;
    const std::vector<std::size_t> row = is_by_position ? rows() : std::vector<std::size_t>();
    const auto key_of_matiec = [&](std::size_t i) {
        const Element& element = elements[i];
        return std::make_tuple(element.order <= 0, std::max<std::int64_t>(element.order, 0),
                               element.kind == Drawn::block, is_by_position ? row[i] : 0,
                               is_by_position ? element.x : 0, i);
    };
    if (is_of_matiec())
        std::ranges::sort(made_.order, {}, key_of_matiec);
    else
        std::ranges::sort(made_.order, {}, key);
}

}  // namespace

Drawing read_drawing(const XmlFile& file, pugi::xml_node body, Diagnostics& out, DrawnOrder order) {
    return DrawingReader(file, out, order).read(body);
}

std::string_view word_of(Drawn kind) {
    return std::ranges::find(drawn_elements, kind, &DrawnElement::kind)->word;
}

}  // namespace lineshaft::projects
