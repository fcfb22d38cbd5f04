#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/networks.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

/// Functions that are written between their arguments.
struct Operator {
    std::string_view name, written;
    bool takes_many;
    Value::Form form;
};
constexpr Operator operators[] = {
    {"and", " AND ", true, Value::Form::and_},  {"or", " OR ", true, Value::Form::or_},
    {"xor", " XOR ", true, Value::Form::other}, {"add", " + ", true, Value::Form::other},
    {"mul", " * ", true, Value::Form::other},   {"sub", " - ", false, Value::Form::other},
    {"div", " / ", false, Value::Form::other},  {"mod", " MOD ", false, Value::Form::other},
    {"gt", " > ", false, Value::Form::other},   {"ge", " >= ", false, Value::Form::other},
    {"eq", " = ", false, Value::Form::other},   {"le", " <= ", false, Value::Form::other},
    {"lt", " < ", false, Value::Form::other},   {"ne", " <> ", false, Value::Form::other}};
/// Written as `NOT a`, and as the argument itself.
constexpr std::string_view prefixes[] = {"not", "move"};

bool is_en(const Pin& pin) {
    return st::same_name(pin.name, "EN");
}
bool is_eno(const Pin& pin) {
    return st::same_name(pin.name, "ENO");
}

}  // namespace

std::string NetworkText::type_name_of(const Element& box) const {
    return function_of(attribute(box, "typeName"));
}

bool NetworkText::is_operator(const Element& box) const {
    const std::string name = lower(type_name_of(box));
    return std::ranges::find(operators, name, &Operator::name) != std::end(operators) ||
           std::ranges::find(prefixes, name) != std::end(prefixes) || call_type(box) == "operator";
}

bool NetworkText::is_used(const State& state, const Pin& pin) const {
    return pin.expression || std::ranges::any_of(state.uses, [&](const Use& use) {
               return use.pin == lower(pin.name);
           });
}

/// The output that a line without a name comes from.
const Pin* NetworkText::result_of(const Element& box) const {
    const auto result =
        std::ranges::find_if(box.outputs, [](const Pin& pin) { return !is_eno(pin); });
    return result != box.outputs.end() && gives_result(box, *result) ? &*result : nullptr;
}

const Pin* NetworkText::find_output(const Element& box, std::string_view name) const {
    const auto found = std::ranges::find_if(
        box.outputs, [&](const Pin& pin) { return st::same_name(pin.name, name); });
    return found == box.outputs.end() ? nullptr : &*found;
}

/// A function is evaluated where its result is taken, unless its turn is said, or the result of the
/// last scan was taken.
bool NetworkText::waits_for_use(std::size_t i) const {
    const Element& box = drawing_.elements[i];
    const bool is_function = !is_block(box) && call_type(box) != "execute";
    const State& state = states_[i];
    const bool is_late = !state.loop.empty() || !state.enabled.is_empty();
    return is_function && box.order <= 0 && !state.uses.empty() && !is_late;
}

void NetworkText::evaluate_box(std::size_t i) {
    const Element& box = drawing_.elements[i];
    State& state = states_[i];
    if (state.is_done || state.is_active) return;
    state.is_active = true;
    const std::int64_t turn = turn_;
    if (context_.is_of_matiec) turn_ = box.order;
    if (call_type(box) == "execute")
        execute(box, state);
    else if (is_block(box))
        call_block(box, state);
    else
        call_function(i);
    turn_ = turn;
    state.is_active = false;
    state.is_done = true;
}

/// A variable for ENO, if a line comes from there, or what the block gives is taken only then.
std::string NetworkText::variable_of_eno(const Element& box, State& state) {
    const auto eno = std::ranges::find_if(box.outputs, is_eno);
    const auto is_led_to = [](const Pin& pin) { return is_en(pin) && !pin.lines.empty(); };
    const bool is_asked = context_.is_of_matiec && std::ranges::any_of(box.inputs, is_led_to);
    if (eno == box.outputs.end() || !(is_used(state, *eno) || is_asked)) return {};
    std::string name = context_.variables.make("_wire", "BOOL");
    state.enabled = words(name, place_of(box), "BOOL");
    return name;
}

/// `instance(EN := a, IN := b, Q => c, ENO => d);`
void NetworkText::call_block(const Element& box, State& state) {
    const Mark place = place_of(box);
    const std::string eno = variable_of_eno(box, state);
    Excerpts call = called(box).text;
    std::string_view before = "(";
    const auto add = [&](const Pin& pin, std::string_view sign, const Excerpts& value) {
        call.write(fmt::format("{}{}{}", before, pin.name, sign), place);
        call.append(value);
        before = ", ";
    };
    for (const auto* pins : {&box.inputs, &box.in_outs})
        for (const Pin& pin : *pins) {
            const Value value = value_of(box, pin);
            const bool is_nothing = value.is_empty() || (is_en(pin) && value.is_always);
            if (!is_nothing) add(pin, " := ", value.text);
        }
    for (const Pin& pin : box.outputs) {
        if (is_eno(pin) && !eno.empty()) add(pin, " => ", state.enabled.text);
        if (pin.expression && !is_eno(pin) && !pin.is_negated)
            add(pin, " => ", written(box, pin.expression).text);
    }
    now_.append(call);
    now_.write(before == "(" ? "();\n" : ");\n", place);
    for (const Pin& pin : box.outputs)
        if (pin.expression && pin.is_negated)
            write_assignment(written(box, pin.expression), negated(member_of(box, pin.name), place),
                             place);
}

Value NetworkText::instance_of(const Element& box) {
    Value made;
    made.text.draw(std::make_shared<const std::string>(name_of(box)));
    file_.copy(made.text, box.node.attribute("instanceName"));
    return made;
}

Value NetworkText::member_of(const Element& box, const std::string& pin) {
    Value made = instance_of(box);
    made.text.write("." + pin, place_of(box));
    made.type = context_.types.of_output(attribute(box, "instanceName"), pin);
    return made;
}

/// A box of CODESYS with Structured Text in it.
void NetworkText::execute(const Element& box, State& state) {
    const Mark place = place_of(box);
    const Value enabled = enabled_of(box, state);
    const bool is_always = enabled.is_empty() || enabled.is_always;
    if (!is_always) {
        now_.write("IF ", place);
        now_.append(enabled.text);
        now_.write(" THEN\n", place);
    }
    for (const pugi::xml_node data : box.node.child("addData").children("data"))
        if (const pugi::xml_node code = data.child("STCode")) file_.copy(now_, code);
    now_.write(is_always ? "\n" : "\nEND_IF\n", place);
}

/// EN, kept if a line comes from ENO. Empty: the box has none.
Value NetworkText::enabled_of(const Element& box, State& state) {
    const auto en = std::ranges::find_if(box.inputs, is_en);
    Value enabled;
    if (en != box.inputs.end()) enabled = value_of(box, *en);
    const auto eno = std::ranges::find_if(box.outputs, is_eno);
    const bool is_kept =
        context_.is_of_matiec || (eno != box.outputs.end() && is_used(state, *eno));
    const Mark place = place_of(box);
    if (!state.enabled.is_empty())
        enabled = kept_in(std::string(state.enabled.text.text()), enabled, place);
    else if (is_kept && !enabled.is_empty() && !enabled.is_always)
        enabled = kept_in(context_.variables.make("_wire", "BOOL"), enabled, place);
    state.enabled = enabled;
    return enabled;
}

/// The call as an expression, without EN and ENO.
Value NetworkText::call_of(std::size_t i) {
    const Element& box = drawing_.elements[i];
    const Mark place = place_of(box);
    const std::string name = lower(type_name_of(box));
    Arguments arguments;
    bool is_named = !box.in_outs.empty(), has_gap = false;
    for (const auto* pins : {&box.inputs, &box.in_outs})
        for (const Pin& pin : *pins) {
            if (is_en(pin)) continue;
            Value value = value_of(box, pin);
            is_named = is_named || (has_gap && !value.is_empty());
            has_gap = has_gap || value.is_empty();
            if (!value.is_empty()) arguments.emplace_back(&pin, std::move(value));
        }
    std::vector<std::string> types;
    for (const auto& [pin, value] : arguments) types.push_back(value.type);
    std::string type = context_.types.of_call(name, types);
    Value made = in_between(box, arguments);
    if (!made.is_empty()) {
        made.type = std::move(type);
        return made;
    }
    made.type = std::move(type);
    made.text.append(called(box).text);
    std::string_view before = "(";
    const auto add = [&](const Pin& pin, std::string_view sign, const Value& value) {
        const bool has_name = !pin.name.empty() && (is_named || sign == " => ");
        made.text.write(
            fmt::format("{}{}{}", before, has_name ? pin.name : "", has_name ? sign : ""), place);
        made.text.append(value.text);
        before = ", ";
    };
    for (const auto& [pin, value] : arguments) add(*pin, " := ", value);
    for (const auto& [pin, value] : other_outputs(i)) add(*pin, " => ", value);
    made.text.write(before == "(" ? "()" : ")", place);
    return made;
}

/// `a + b`, `NOT a`, `a`; empty: no such operator.
Value NetworkText::in_between(const Element& box, const Arguments& arguments) {
    const Mark place = place_of(box);
    const std::string name = lower(type_name_of(box));
    if (arguments.size() == 1 && name == "not") return negated(arguments.front().second, place);
    if (arguments.size() == 1 && name == "move") return arguments.front().second;
    const auto* known = std::ranges::find(operators, name, &Operator::name);
    if (known == std::end(operators) || arguments.empty()) return {};
    if (arguments.size() == 1) return known->takes_many ? arguments.front().second : Value{};
    if (arguments.size() > 2 && !known->takes_many) return {};
    Value made{.text = {}, .form = known->form};
    std::string_view before;
    for (const auto& [pin, value] : arguments) {
        made.text.write(before, place);
        const bool is_plain = value.form == known->form && known->form != Value::Form::other;
        made.text.append(is_plain ? value.text : enclosed(value, place));
        before = known->written;
    }
    return made;
}

/// What a function gives beside its result, and the variables that take it.
NetworkText::Arguments NetworkText::other_outputs(std::size_t i) {
    const Element& box = drawing_.elements[i];
    State& state = states_[i];
    Arguments made;
    for (const Pin& pin : box.outputs) {
        if (&pin == result_of(box) || is_eno(pin) || !is_used(state, pin)) continue;
        Value target;
        if (pin.expression) {
            target = written(box, pin.expression);
        } else {
            const std::string type = context_.types.of_declared(type_name_of(box), pin.name);
            if (type.empty()) {
                refuse(box, fmt::format("the type of '{}' is not known here", pin.name),
                       "connect it to a variable beside the box");
                continue;
            }
            target = words(context_.variables.make("_wire", type), place_of(box), type);
        }
        state.outputs.emplace_back(lower(pin.name), target);
        made.emplace_back(&pin, target);
    }
    return made;
}

bool NetworkText::is_evaluated(const State& state) {
    return state.is_done && !state.is_active;
}

/// The one variable that takes a function's result and nothing else does.
std::optional<std::size_t> NetworkText::only_target(std::size_t i) const {
    const State& state = states_[i];
    if (has_own_turn(i)) return std::nullopt;
    std::optional<std::size_t> target;
    for (const Use& use : state.uses) {
        if (use.pin == "eno") continue;
        const Element& to = drawing_.elements[use.by];
        if (context_.is_of_matiec && !states_[use.by].is_active) return std::nullopt;
        const bool is_plain = to.kind == Drawn::out_variable && to.inputs.size() == 1 &&
                              to.inputs.front().lines.size() == 1 &&
                              attribute(to, "negated") != "true" &&
                              edge_of_attribute(to) == Edge::none && !is_stored(to);
        if (target || !is_plain || is_evaluated(states_[use.by])) return std::nullopt;
        target = use.by;
    }
    return target;
}

/// Whether other elements are evaluated between the box and the one that takes its result.
bool NetworkText::has_own_turn(std::size_t i) const {
    const State& state = states_[i];
    if (drawing_.elements[i].order <= 0 || state.uses.empty()) return false;
    return states_[state.uses.front().by].turn != state.turn + 1;
}

/// A function's result: as an expression where one element takes it, else in a variable.
void NetworkText::call_function(std::size_t i) {
    const Element& box = drawing_.elements[i];
    State& state = states_[i];
    const Mark place = place_of(box);
    const Value enabled = enabled_of(box, state);
    Value value = call_of(i);
    bool is_guarded = !enabled.is_empty() && !enabled.is_always;
    const Pin* result = result_of(box);
    const bool has_eno = std::ranges::any_of(box.outputs, is_eno);
    if (is_guarded && !has_eno && value.type == "BOOL") {
        value = both(enabled, value, place);
        is_guarded = false;
    }
    const bool is_variable = result && result->expression;
    const bool is_taken =
        result && std::ranges::any_of(state.uses, [](const Use& use) { return use.pin != "eno"; });
    if (!is_taken && !is_variable) {
        const bool is_declared = context_.types.is_declared(type_name_of(box));
        const bool does_nothing = is_operator(box) || (!value.type.empty() && !is_declared);
        if (!does_nothing) write_guarded(is_guarded ? enabled : Value{}, Value{}, value, place);
        return;
    }
    const bool must_be_kept = is_guarded || !state.outputs.empty();
    const bool is_better_kept = state.uses.size() > 1 || has_own_turn(i) || ends_in_chart();
    if (!is_variable && !must_be_kept && state.loop.empty() && !is_better_kept) {
        state.value = value;
        return;
    }
    const Value target = target_of(i, value.type);
    if (target.is_empty() && must_be_kept)
        refuse(box, fmt::format("the type of what '{}' gives is not known here", type_name_of(box)),
               "connect it to a variable, and take its value from there");
    const bool is_own = context_.is_of_matiec && !only_target(i);
    if (!target.is_empty())
        write_guarded(is_guarded ? enabled : Value{}, target, value, place,
                      is_guarded && is_own ? initial_value(target.type) : std::string());
    state.value = target.is_empty() ? value : target;
    if (is_variable && !takes_result(box, state))
        write_assignment(written(box, result->expression),
                         result->is_negated ? negated(*state.value, place) : *state.value, place);
}

/// Whether the variable beside the output is what the result goes into.
bool NetworkText::takes_result(const Element& box, const State& state) const {
    const Pin* result = result_of(box);
    return result && result->expression && !result->is_negated && state.loop.empty();
}

/// What takes a result. Empty: it needs a variable, and its type is not known.
Value NetworkText::target_of(std::size_t i, const std::string& type) {
    const Element& box = drawing_.elements[i];
    State& state = states_[i];
    const Pin* result = result_of(box);
    if (takes_result(box, state)) return written(box, result->expression);
    if (!state.loop.empty()) return words(state.loop, place_of(box), type);
    if (const auto to = only_target(i); to && !(result && result->is_negated)) {
        states_[*to].is_done = states_[*to].is_written = true;
        const Element& variable = drawing_.elements[*to];
        return written(variable, variable.node.child("expression"));
    }
    const std::string known = type.empty() || type == "#" ? type_of_takers(i) : type;
    if (known.empty()) return {};
    return words(context_.variables.make("_wire", known), place_of(box), known);
}

/// What a variable of the type begins with; empty: not known.
std::string NetworkText::initial_value(const std::string& type) {
    static constexpr std::string_view numbers[] = {"#",     "sint",  "int",   "dint",  "lint",
                                                   "usint", "uint",  "udint", "ulint", "byte",
                                                   "word",  "dword", "lword"};
    const std::string name = lower(type);
    if (name == "bool") return "FALSE";
    if (name == "real" || name == "lreal") return "0.0";
    if (name == "time") return "T#0s";
    if (type.empty()) return {};
    if (std::ranges::find(numbers, name) != std::end(numbers)) return "0";
    return context_.variables.make("_none", type);
}

/// MatIEC's editors let a variable keep its value where the one box that leads to it has done
/// nothing.
Value NetworkText::enabled_with(const Element& variable) const {
    const bool is_variable =
        variable.kind == Drawn::out_variable || variable.kind == Drawn::in_out_variable;
    const auto& inputs = variable.inputs;
    if (!context_.is_of_matiec || !is_variable || inputs.front().lines.size() != 1) return {};
    const std::size_t from = inputs.front().lines.front().from;
    const Value& enabled = states_[from].enabled;
    return enabled.is_always ? Value{} : enabled;
}

/// Where transitions look at what was evaluated at the end of the last scan.
bool NetworkText::ends_in_chart() const {
    return context_.is_of_matiec && std::ranges::find(drawing_.elements, Drawn::transition,
                                                      &Element::kind) != drawing_.elements.end();
}

/// `IF enabled THEN target := value; ELSE target := otherwise; END_IF`
void NetworkText::write_guarded(const Value& enabled, const Value& target, const Value& value,
                                const Mark& place, std::string_view otherwise) {
    if (!enabled.is_empty()) {
        now_.write("IF ", place);
        now_.append(enabled.text);
        now_.write(" THEN ", place);
    }
    if (target.is_empty()) {
        now_.append(value.text);
        now_.write(";", place);
    } else {
        now_.append(target.text);
        now_.write(" := ", place);
        now_.append(value.text);
        now_.write(";", place);
    }
    if (!otherwise.empty()) {
        now_.write(" ELSE ", place);
        now_.append(target.text);
        now_.write(fmt::format(" := {};", otherwise), place);
    }
    now_.write(enabled.is_empty() ? "\n" : " END_IF\n", place);
}

/// What a box that is evaluated later has at ENO. Empty: it has no EN.
Value NetworkText::eno_of_last_scan(std::size_t i) {
    const Element& box = drawing_.elements[i];
    State& state = states_[i];
    const auto en = std::ranges::find_if(box.inputs, is_en);
    if (en == box.inputs.end() || en->lines.empty()) return {};
    if (is_block(box)) return member_of(box, "ENO");
    if (state.enabled.is_empty())
        state.enabled = words(context_.variables.make("_wire", "BOOL"), place_of(box), "BOOL");
    return state.enabled;
}

/// What a line takes from a box.
Value NetworkText::value_of_box(std::size_t i, const std::string& name) {
    const Element& box = drawing_.elements[i];
    State& state = states_[i];
    const Mark place = place_of(box);
    const Pin* pin = name.empty() ? result_of(box) : find_output(box, name);
    if (!pin && is_block(box) && !name.empty()) {
        if (!state.is_active && !state.is_done && !comes_later(box)) evaluate_box(i);
        return member_of(box, name);
    }
    if (!pin) {
        refuse(box, fmt::format("this box has no output '{}'", name), "");
        return words("FALSE", place);
    }
    const bool waits = !state.is_done && comes_later(box);
    if (!state.is_active && !state.is_done && !waits) evaluate_box(i);
    Value value;
    if (is_eno(*pin)) {
        const bool is_late = waits || state.is_active;
        value = is_late ? eno_of_last_scan(i) : state.enabled;
        if (value.is_empty()) value = words("TRUE", place, "BOOL"), value.is_always = true;
    } else if (is_block(box)) {
        value = member_of(box, pin->name);
    } else if (state.is_active || waits) {
        std::set<std::size_t> seen;
        const std::string type = type_of_result(i, seen);
        value = value_of_loop(i, type.empty() ? type_of_takers(i) : type);
    } else {
        const auto other = std::ranges::find(state.outputs, lower(pin->name),
                                             &std::pair<std::string, Value>::first);
        if (other != state.outputs.end())
            value = other->second;
        else if (state.value)
            value = *state.value;
        else
            value = words("FALSE", place);
    }
    return pin->is_negated ? negated(value, place) : value;
}

}  // namespace lineshaft::projects
