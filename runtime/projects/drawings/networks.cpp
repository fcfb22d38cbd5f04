#include "runtime/projects/drawings/networks.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/box_calls.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

constexpr std::size_t longest_read_again = 1U << 10;

/// The editors in Python 2 sort by position; those in Python 3, which came with 2024, do not.
DrawnOrder order_of(const BodyContext& context) {
    if (!context.is_of_matiec) return DrawnOrder::networks;
    const pugi::xml_node root = context.file.root();
    std::string date =
        context.file.plain(root.child("contentHeader").attribute("modificationDateTime"));
    if (date.empty())
        date = context.file.plain(root.child("fileHeader").attribute("creationDateTime"));
    return !date.empty() && date < "2024" ? DrawnOrder::position : DrawnOrder::document;
}

}  // namespace

std::string MadeVariables::make(std::string_view prefix, std::string_view type) {
    std::string name = this->name(prefix);
    declare(name, type);
    return name;
}

void MadeVariables::declare(std::string_view name, std::string_view type) {
    const std::string line = fmt::format("    {} : {};\n", name, type);
    if (declarations_.find(line) == declarations_.npos) declarations_ += line;
}

void MadeVariables::know(std::string_view name, std::string_view type) {
    const auto [known, is_new] = known_.emplace(lower(name), lower(type));
    if (!is_new && known->second != lower(type)) known->second.clear();
}

std::string MadeVariables::known_type(std::string_view variable) const {
    if (!variable.starts_with('#')) return {};
    variable.remove_prefix(1);
    if (variable.starts_with('"') && variable.ends_with('"') && variable.size() > 2)
        variable = variable.substr(1, variable.size() - 2);
    const auto found = known_.find(lower(variable));
    return found == known_.end() ? std::string() : found->second;
}

NetworkText::NetworkText(BodyContext& context, pugi::xml_node body)
    : context_(context),
      file_(context.file),
      drawing_(read_drawing(context.file, body, context.out, order_of(context))),
      jumps_(context.variables, labels()),
      states_(drawing_.elements.size()) {
    for (std::size_t i = 0; i < drawing_.elements.size(); ++i) {
        const Element& element = drawing_.elements[i];
        if (element.kind == Drawn::right_rail) continue;
        for (const auto* pins : {&element.inputs, &element.in_outs})
            for (const Pin& pin : *pins)
                for (const Line& line : pin.lines)
                    states_[line.from].uses.push_back(
                        {i, goes_on_enabled(element, line) ? "eno" : lower(line.pin)});
    }
    for (std::size_t turn = 0; turn < drawing_.order.size(); ++turn)
        states_[drawing_.order[turn]].turn = turn;
}

std::vector<std::string> NetworkText::labels() const {
    std::vector<std::string> all;
    for (const Element& element : drawing_.elements)
        if (element.kind == Drawn::label) all.push_back(attribute(element, "label"));
    return all;
}

Excerpts NetworkText::statements() {
    for (const std::size_t i : drawing_.order) {
        if (!context_.is_of_matiec) turn_ = drawing_.elements[i].order;
        evaluate(i);
    }
    return jumps_.finish(std::exchange(now_, {}));
}

Value NetworkText::condition(pugi::xml_node transition) {
    const auto drawn = std::ranges::find(drawing_.elements, transition, &Element::node);
    if (drawn == drawing_.elements.end() || drawn->inputs.empty()) return {};
    return value_of(*drawn, drawn->inputs.front());
}

std::string NetworkText::name_of(const Element& element) const {
    return fmt::format("network {}, {} {}", element.network, word_of(element.kind), element.id);
}

/// Where the element stands, with what it is called.
Mark NetworkText::place_of(const Element& element) const {
    Mark place = file_.mark_of_tag(element.node);
    place.drawn = std::make_shared<const std::string>(name_of(element));
    return place;
}

void NetworkText::refuse(const Element& element, std::string_view why, std::string_view help) {
    context_.out.add(code::not_supported, place_of(element), std::string(why), std::string(help));
}

Value NetworkText::words(std::string_view text, const Mark& place, std::string type) const {
    Value made{.text = {}, .type = std::move(type)};
    made.text.write(text, place);
    return made;
}

/// What stands at an element, as it is written, without a ';' behind it.
Value NetworkText::written(const Element& element, pugi::xml_node text) {
    std::string plain = file_.plain(text);
    const std::size_t end = plain.find_last_not_of(" \t\r\n;") + 1;
    const bool is_ended = end < plain.size();
    plain.resize(end);
    if (plain.empty()) {
        refuse(element, fmt::format("this {} has no variable", word_of(element.kind)),
               "name one, or remove it");
        return words("FALSE", place_of(element), "BOOL");
    }
    Value made{.text = {}, .form = shape_of(plain), .type = context_.types.of_expression(plain)};
    made.text.draw(std::make_shared<const std::string>(name_of(element)));
    if (!is_ended) file_.copy(made.text, text);
    for (Part part : is_ended ? file_.texts(text) : std::vector<Part>()) {
        part.end = part.begin + file_.text(part).find_last_not_of(" \t\r\n;") + 1;
        file_.copy(made.text, part);
    }
    return made;
}

Value NetworkText::edge_of(const Value& value, Edge edge, const Element& element) {
    if (edge == Edge::none) return value;
    const Mark place = place_of(element);
    if (!context_.is_kept)
        refuse(element, "an edge needs a variable that is kept from scan to scan",
               "draw it in a function block or a program");
    const std::string name =
        context_.variables.make("_edge", edge == Edge::rising ? "R_TRIG" : "F_TRIG");
    now_.write(name + "(CLK := ", place);
    now_.append(value.text);
    now_.write(");\n", place);
    return words(name + ".Q", place, "BOOL");
}

Value NetworkText::kept_in(const std::string& variable, const Value& value, const Mark& place) {
    now_.write(variable + " := ", place);
    now_.append(value.text);
    now_.write(";\n", place);
    return words(variable, place, value.type);
}

Value NetworkText::value_of(const Element& element, const Pin& pin) {
    const Mark place = place_of(element);
    Value value;
    for (const Line& line : pin.lines)
        value = either(std::move(value), value_of(line, goes_on_enabled(element, line)), place);
    if (value.is_empty() && pin.expression) value = written(element, pin.expression);
    if (value.is_empty()) return value;
    if (pin.is_negated) value = negated(value, place);
    value = edge_of(value, pin.edge, element);
    return within_length(std::move(value), place, context_.out);
}

/// A rung of CODESYS goes on behind a box with EN at its ENO.
bool NetworkText::goes_on_enabled(const Element& to, const Line& line) const {
    const Element& from = drawing_.elements[line.from];
    const bool is_rung = to.kind == Drawn::contact || to.kind == Drawn::coil;
    return is_rung && line.pin.empty() && !context_.is_of_matiec && from.kind == Drawn::block &&
           find_output(from, "ENO");
}

Value NetworkText::value_of(const Line& line, bool is_enabled) {
    const Element& from = drawing_.elements[line.from];
    const Mark place = place_of(from);
    if (is_too_deep(depth_, place, context_.out)) return words("FALSE", place, "BOOL");
    ++depth_;
    Value value = from.kind == Drawn::block ? value_of_box(line.from, is_enabled ? "ENO" : line.pin)
                                            : value_of_element(line.from);
    --depth_;
    return value;
}

/// The value of an element that is no box.
Value NetworkText::value_of_element(std::size_t i) {
    const Element& element = drawing_.elements[i];
    State& state = states_[i];
    const Mark place = place_of(element);
    switch (element.kind) {
        case Drawn::left_rail: {
            Value always = words("TRUE", place, "BOOL");
            always.is_always = true;
            return always;
        }
        case Drawn::in_variable: {
            Value value = written(element, element.node.child("expression"));
            if (attribute(element, "negated") == "true") value = negated(value, place);
            return edge_of(value, edge_of_attribute(element), element);
        }
        case Drawn::in_out_variable: {
            const bool waits = context_.is_of_matiec || comes_later(element);
            if (!state.is_done && !waits) evaluate(i);
            Value value = written(element, element.node.child("expression"));
            return attribute(element, "negatedOut") == "true" ? negated(value, place) : value;
        }
        case Drawn::contact:
        case Drawn::connector:
        case Drawn::continuation:
            return value_of_wire(i);
        case Drawn::coil:
            if (context_.is_of_matiec) return value_of_wire(i);
            if (!state.is_done) evaluate(i);
            if (state.value) return *state.value;
            break;
        default:
            break;
    }
    refuse(element, fmt::format("nothing comes out of a {}", word_of(element.kind)), "");
    return words("FALSE", place, "BOOL");
}

/// What goes on behind a contact or a connector; into a variable, if to several.
Value NetworkText::value_of_wire(std::size_t i) {
    const Element& element = drawing_.elements[i];
    State& state = states_[i];
    const Mark place = place_of(element);
    if (state.value) return *state.value;
    const bool is_coil = element.kind == Drawn::coil;
    if (state.is_active)
        return value_of_loop(i, is_coil || element.kind == Drawn::contact ? "BOOL" : "");
    state.is_active = true;
    const std::size_t written_before = now_.text().size();
    Value value;
    if (!element.inputs.empty()) value = value_of(element, element.inputs.front());
    if (element.kind == Drawn::contact) {
        Value own = written(element, element.node.child("variable"));
        own = edge_of(own, edge_of_attribute(element), element);
        if (attribute(element, "negated") == "true") own = negated(own, place);
        value =
            value.is_empty() ? words("FALSE", place, "BOOL") : both(std::move(value), own, place);
        value.type = "BOOL";
    }
    state.is_active = false;
    if (value.is_empty()) {
        refuse(element, "nothing leads here", "draw a line to it");
        return words("FALSE", place, "BOOL");
    }
    if (!state.loop.empty())
        state.value = kept_in(state.loop, value, place);
    else if (state.uses.size() + is_coil > 1 && !value.type.empty() && value.type != "#" &&
             !is_read_again(value))
        state.value = kept_in(context_.variables.make("_wire", value.type), value, place);
    else if (is_coil && now_.text().size() == written_before)
        state.value = value;
    return state.value.value_or(value);
}

/// MatIEC's editors write the contacts of a rung for each of its coils, which so sees what those
/// before it have assigned.
bool NetworkText::is_read_again(const Value& value) const {
    return context_.is_of_matiec && value.text.text().size() < longest_read_again;
}

/// A line that goes around: the value of the last scan.
Value NetworkText::value_of_loop(std::size_t i, const std::string& type) {
    const Element& element = drawing_.elements[i];
    State& state = states_[i];
    if (type.empty() || !context_.is_kept) {
        refuse(element,
               type.empty() ? "a line goes around through this element, and its type is not known"
                            : "a line goes around, and a function keeps no value of the last scan",
               "connect it to a variable, and take its value from there");
        return words("FALSE", place_of(element), "BOOL");
    }
    if (state.loop.empty()) state.loop = context_.variables.make("_wire", type);
    return words(state.loop, place_of(element), type);
}

/// Its turn comes behind that of the element which is evaluated, so it has the value of the last
/// scan. In MatIEC's editors a box with a number has no other evaluated before it.
bool NetworkText::comes_later(const Element& element) const {
    return turn_ > 0 && (context_.is_of_matiec || element.order > turn_);
}

/// It is set or reset by what comes.
bool NetworkText::is_stored(const Element& element) const {
    const std::string storage = attribute(element, "storage");
    return storage == "set" || storage == "reset";
}

Edge NetworkText::edge_of_attribute(const Element& element) const {
    const std::string edge = attribute(element, "edge");
    return edge == "rising" ? Edge::rising : edge == "falling" ? Edge::falling : Edge::none;
}

void NetworkText::evaluate(std::size_t i) {
    const Element& element = drawing_.elements[i];
    State& state = states_[i];
    if (state.is_done) return;
    switch (element.kind) {
        case Drawn::coil:
        case Drawn::out_variable:
        case Drawn::in_out_variable:
            state.is_done = true;
            return assign(i);
        case Drawn::block:
            return waits_for_use(i) ? void() : evaluate_box(i);
        case Drawn::label:
            state.is_done = true;
            return jumps_.label(attribute(element, "label"), std::exchange(now_, {}),
                                place_of(element));
        case Drawn::jump:
        case Drawn::return_:
            state.is_done = true;
            return leave(element);
        default:
            return;
    }
}

/// A jump or a return, if what leads there is TRUE.
void NetworkText::leave(const Element& element) {
    const Mark place = place_of(element);
    Value when;
    if (!element.inputs.empty()) when = value_of(element, element.inputs.front());
    const bool is_always = when.is_empty() || when.is_always;
    const bool is_jump = element.kind == Drawn::jump;
    const std::string target = attribute(element, "label");
    if (is_jump && jumps_.number_of(target) == 0)
        return context_.out.add(code::not_declared, place,
                                fmt::format("there is no label '{}' in this body", target));
    const std::string what = is_jump ? jumps_.leaving(target) : "RETURN;";
    if (!is_always) {
        now_.write("IF ", place);
        now_.append(when.text);
        now_.write(" THEN ", place);
    }
    now_.write(what + (is_always ? "\n" : " END_IF\n"), place);
    if (is_jump) jumps_.jump(target, std::exchange(now_, {}), place);
}

/// A coil or a variable takes what comes to it, negated, at an edge, or set or reset by it.
void NetworkText::assign(std::size_t i) {
    const Element& element = drawing_.elements[i];
    const Mark place = place_of(element);
    const bool is_coil = element.kind == Drawn::coil;
    if (element.inputs.empty() && element.kind == Drawn::in_out_variable) return;
    const bool is_passed = is_coil && !states_[i].uses.empty();
    Value value;
    if (is_passed && context_.is_of_matiec) value = value_of_wire(i);
    states_[i].is_active = true;
    if (value.is_empty() && !element.inputs.empty())
        value = value_of(element, element.inputs.front());
    states_[i].is_active = false;
    if (is_passed && context_.is_of_matiec && element.inputs.front().lines.size() > 1)
        context_.out.warn(code::not_supported, place,
                          "what is behind this coil is reached by any line that leads to it here; "
                          "Beremiz and OpenPLC ask for all of them there",
                          "draw what is behind it at those lines, too");
    if (states_[i].is_written) return;
    if (value.is_empty())
        return context_.out.warn(code::not_supported, place,
                                 fmt::format("nothing leads to this {}", word_of(element.kind)),
                                 "it keeps its value: draw a line to it, or remove it");
    if (is_passed && !context_.is_of_matiec)
        states_[i].value = value =
            value.is_always ? value
                            : kept_in(context_.variables.make("_wire", "BOOL"), value, place);
    if (element.kind != Drawn::in_out_variable) {
        if (attribute(element, "negated") == "true") value = negated(value, place);
        value = edge_of(value, edge_of_attribute(element), element);
    }
    const Value target = written(element, element.node.child(is_coil ? "variable" : "expression"));
    if (!is_stored(element)) return write_guarded(enabled_with(element), target, value, place);
    now_.write("IF ", place);
    now_.append(value.text);
    now_.write(" THEN ", place);
    now_.append(target.text);
    now_.write(
        attribute(element, "storage") == "set" ? " := TRUE; END_IF\n" : " := FALSE; END_IF\n",
        place);
}

void NetworkText::write_assignment(const Value& target, const Value& value, const Mark& place) {
    now_.append(target.text);
    now_.write(" := ", place);
    now_.append(value.text);
    now_.write(";\n", place);
}

}  // namespace lineshaft::projects
