#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include <fmt/format.h>

#include "runtime/projects/drawings/bodies.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

constexpr std::size_t most_branches = 1000;  // that one transition may go through

bool is(pugi::xml_node node, std::string_view name) {
    return node.name() == name;
}

/// One chart of PLCopen XML as the text of it.
class ChartText {
  public:
    ChartText(BodyContext& context, pugi::xml_node chart, pugi::xml_node pou)
        : context_(context), file_(context.file), chart_(chart), pou_(pou) {}

    BodyText read();

  private:
    using Nodes = std::vector<pugi::xml_node>;
    using Seen = std::set<std::string>;  ///< what was gone through, by `localId`

    // what leads where
    std::vector<pugi::xml_node> sources_of(pugi::xml_node node) const;
    void add_steps_before(pugi::xml_node node, Nodes& steps, Seen& seen);
    void add_steps_behind(pugi::xml_node node, Nodes& steps, Seen& seen);

    void add_step(pugi::xml_node step);
    void add_own_actions(pugi::xml_node step);
    void add_action(pugi::xml_node action);
    void add_transition(pugi::xml_node transition);
    void add_steps(const Nodes& steps, pugi::xml_node transition);
    Excerpts condition_of(pugi::xml_node transition);
    Excerpts inline_condition(pugi::xml_node body, const std::string& result);
    void add_networks(const Nodes& transitions);
    Excerpts drawn_condition(pugi::xml_node transition);
    Excerpts condition_of_statements(Excerpts before, const Excerpts& value, pugi::xml_node at);
    pugi::xml_node named_transition(const std::string& name) const;

    std::string text(pugi::xml_node node, const char* attribute) const {
        return file_.plain(node.attribute(attribute));
    }
    Mark place_of(pugi::xml_node node) const {
        Mark place = file_.mark_of_tag(node);
        const std::string name = text(node, "name");
        place.drawn = std::make_shared<const std::string>(
            fmt::format("{} {}", node.name(), name.empty() ? text(node, "localId") : name));
        return place;
    }
    void write(std::string_view words, pugi::xml_node at) {
        made_.statements.write(words, place_of(at));
    }
    void refuse(pugi::xml_node at, std::string why, std::string help) {
        context_.out.add(code::not_supported, place_of(at), std::move(why), std::move(help));
    }

    BodyContext& context_;
    const XmlFile& file_;
    pugi::xml_node chart_, pou_;
    std::map<std::string, pugi::xml_node> by_id_;
    std::map<std::string, Nodes> behind_;  ///< by `localId`: what lines lead to
    /// What the lines of MatIEC's transitions carry.
    std::vector<std::pair<pugi::xml_node, Excerpts>> drawn_;
    std::string networks_;  ///< the action that evaluates what leads to them
    BodyText made_;
};

double coordinate(const XmlFile& file, pugi::xml_node node, const char* axis) {
    const std::string digits = file.plain(node.child("position").attribute(axis));
    double value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
}

std::vector<pugi::xml_node> ChartText::sources_of(pugi::xml_node node) const {
    Nodes sources;
    for (const pugi::xml_node point : node.children("connectionPointIn"))
        for (const pugi::xml_node connection : point.children("connection")) {
            const auto found = by_id_.find(text(connection, "refLocalId"));
            if (found != by_id_.end()) sources.push_back(found->second);
        }
    return sources;
}

/// Those that a transition leaves: all that a simultaneous convergence joins, one otherwise. A
/// branch that ends with a jump joins nothing; CODESYS draws it on to where others join.
void ChartText::add_steps_before(pugi::xml_node node, Nodes& steps, Seen& seen) {
    Nodes sources = sources_of(node);
    std::erase_if(sources, [](pugi::xml_node source) { return is(source, "jumpStep"); });
    const bool is_only_one = sources.size() == 1 || !is(node, "selectionConvergence");
    for (const pugi::xml_node source : sources) {
        if (!seen.insert(text(source, "localId")).second) continue;
        if (is(source, "step") && is_only_one) {
            steps.push_back(source);
        } else if (seen.size() < most_branches && is_only_one &&
                   (is(source, "selectionDivergence") || is(source, "selectionConvergence") ||
                    is(source, "simultaneousConvergence"))) {
            add_steps_before(source, steps, seen);
        } else {
            refuse(source, fmt::format("a transition does not follow a {} here", source.name()),
                   "draw a step between");
        }
    }
}

/// Those that it enters.
void ChartText::add_steps_behind(pugi::xml_node node, Nodes& steps, Seen& seen) {
    const auto found = behind_.find(text(node, "localId"));
    if (found == behind_.end()) return;
    for (const pugi::xml_node next : found->second) {
        if (!seen.insert(text(next, "localId")).second) continue;
        if (is(next, "step") || is(next, "jumpStep")) {
            steps.push_back(next);
        } else if (seen.size() < most_branches &&
                   (is(next, "simultaneousDivergence") || is(next, "selectionConvergence"))) {
            add_steps_behind(next, steps, seen);
        } else {
            refuse(next, fmt::format("a {} does not follow a transition here", next.name()),
                   "draw a step between");
        }
    }
}

BodyText ChartText::read() {
    for (const pugi::xml_node node : chart_.children())
        if (node.type() == pugi::node_element) by_id_.emplace(text(node, "localId"), node);
    Nodes steps, transitions;
    for (const pugi::xml_node node : chart_.children()) {
        if (is(node, "macroStep"))
            refuse(node, fmt::format("the macro step '{}' is not read", text(node, "name")),
                   "draw its steps in the chart itself");
        if (is(node, "step")) steps.push_back(node);
        if (is(node, "transition")) transitions.push_back(node);
        for (const pugi::xml_node source : sources_of(node))
            behind_[text(source, "localId")].push_back(node);
    }
    if (context_.is_of_matiec) add_networks(transitions);
    const auto place = [&](pugi::xml_node node) {
        return std::make_pair(coordinate(file_, node, "y"), coordinate(file_, node, "x"));
    };
    std::ranges::stable_sort(steps, {}, place);
    for (const pugi::xml_node step : steps) add_step(step);
    const auto from_left = [&](pugi::xml_node node) { return coordinate(file_, node, "x"); };
    std::ranges::stable_sort(transitions, {}, from_left);
    for (const pugi::xml_node transition : transitions) add_transition(transition);
    return std::move(made_);
}

void ChartText::add_step(pugi::xml_node step) {
    write(text(step, "initialStep") == "true" ? "INITIAL_STEP " : "STEP ", step);
    file_.copy(made_.statements, step.attribute("name"));
    write(":\n", step);
    const auto found = behind_.find(text(step, "localId"));
    if (found != behind_.end())
        for (const pugi::xml_node block : found->second)
            if (is(block, "actionBlock"))
                for (const pugi::xml_node action : block.children("action")) add_action(action);
    add_own_actions(step);
    if (!networks_.empty() && text(step, "initialStep") == "true")
        write(fmt::format("    {}(S);\n", networks_), step);
    write("END_STEP\n", step);
}

/// MatIEC's editors have the boxes that lead to transitions in an action that the initial step
/// sets, so that they run in every scan; transitions look at what they gave in the last one.
void ChartText::add_networks(const Nodes& transitions) {
    NetworkText networks(context_, chart_);
    for (const pugi::xml_node transition : transitions)
        if (transition.child("condition").child("connectionPointIn"))
            drawn_.emplace_back(transition, networks.condition(transition).text);
    if (networks.before().is_empty()) return;
    networks_ = context_.variables.name("_networks");
    made_.members.write(fmt::format("ACTION {}:\n", networks_), place_of(chart_));
    made_.members.append(networks.before());
    made_.members.write("END_ACTION\n", place_of(chart_));
}

/// Those that CODESYS keeps at the step itself: at its beginning, while it is active, at its end.
void ChartText::add_own_actions(pugi::xml_node step) {
    static constexpr std::pair<std::string_view, std::string_view> kinds[] = {
        {"a6b08bd8-b696-47e3-9cbf-7408b61c9ff8", "(_ENTRY)"},
        {"700a583f-b4d4-43e4-8c14-629c7cd3bec8", "(_ACTIVE)"},
        {"a2621e18-7de3-4ea6-ae6d-89e9e0b7befd", "(_EXIT)"}};
    for (const auto& [kind, qualifier] : kinds)
        for (const pugi::xml_node data : step.child("addData").children("data"))
            for (const pugi::xml_node own : data.child("attributes").children("attribute")) {
                if (text(own, "guid") != kind || file_.plain(own).empty()) continue;
                write("    ", own);
                file_.copy(made_.statements, own);
                write(fmt::format("{};\n", qualifier), own);
            }
}

void ChartText::add_action(pugi::xml_node action) {
    const pugi::xml_attribute named = action.child("reference").attribute("name");
    write("    ", action);
    if (named) {
        file_.copy(made_.statements, named);
    } else {
        const std::string name = context_.variables.name("_action");
        write(name, action);
        made_.members.write(fmt::format("ACTION {}:\n", name), place_of(action));
        made_.members.append(body_text(context_, action.child("inline"), name).statements);
        made_.members.write("\nEND_ACTION\n", place_of(action));
    }
    const std::string qualifier = text(action, "qualifier"), duration = text(action, "duration");
    if (!qualifier.empty()) {
        write("(", action);
        file_.copy(made_.statements, action.attribute("qualifier"));
        if (!duration.empty()) {
            write(", ", action);
            file_.copy(made_.statements, action.attribute("duration"));
        }
        write(")", action);
    }
    write(";\n", action);
}

void ChartText::add_steps(const Nodes& steps, pugi::xml_node transition) {
    if (steps.size() != 1) write("(", transition);
    std::string_view before;
    for (const pugi::xml_node step : steps) {
        write(before, transition);
        file_.copy(made_.statements, step.attribute(is(step, "step") ? "name" : "targetName"));
        before = ", ";
    }
    if (steps.size() != 1) write(")", transition);
}

void ChartText::add_transition(pugi::xml_node transition) {
    Nodes before, behind;
    Seen seen_before, seen_behind;
    add_steps_before(transition, before, seen_before);
    add_steps_behind(transition, behind, seen_behind);
    if (before.empty() || behind.empty())
        return refuse(
            transition,
            fmt::format("no step stands {} this transition", before.empty() ? "before" : "behind"),
            "draw a line between them");
    const Excerpts condition = condition_of(transition);
    write("TRANSITION ", transition);
    const std::string priority = text(transition, "priority");
    if (!priority.empty() && priority != "0") {
        write("(PRIORITY := ", transition);
        file_.copy(made_.statements, transition.attribute("priority"));
        write(") ", transition);
    }
    write("FROM ", transition);
    add_steps(before, transition);
    write(" TO ", transition);
    add_steps(behind, transition);
    write(" := ", transition);
    made_.statements.append(condition);
    write(";\nEND_TRANSITION\n", transition);
}

pugi::xml_node ChartText::named_transition(const std::string& name) const {
    for (const pugi::xml_node named : pou_.child("transitions").children("transition"))
        if (st::same_name(text(named, "name"), name)) return named;
    return {};
}

Excerpts ChartText::condition_of(pugi::xml_node transition) {
    const pugi::xml_node condition = transition.child("condition");
    const Mark place = place_of(transition);
    Excerpts made;
    if (const pugi::xml_node reference = condition.child("reference")) {
        const pugi::xml_node named = named_transition(text(reference, "name"));
        if (named)
            made = inline_condition(named.child("body"), text(named, "name"));
        else
            file_.copy(made, reference.attribute("name"));
    } else if (const pugi::xml_node own = condition.child("inline")) {
        made = inline_condition(own, text(own, "name"));
    } else if (condition.child("connectionPointIn")) {
        made = drawn_condition(transition);
    }
    if (made.is_empty()) {
        refuse(transition, "this transition has no condition", "write TRUE if it needs none");
        made.write("FALSE", place);
    }
    if (text(condition, "negated") != "true") return made;
    Excerpts negated;
    negated.write("NOT (", place);
    negated.append(made);
    negated.write(")", place);
    return negated;
}

Excerpts ChartText::drawn_condition(pugi::xml_node transition) {
    const auto known =
        std::ranges::find(drawn_, transition, &std::pair<pugi::xml_node, Excerpts>::first);
    if (known != drawn_.end()) return known->second;
    NetworkText networks(context_, chart_);
    const Value value = networks.condition(transition);
    return condition_of_statements(networks.before(), value.text, transition);
}

/// `:= a;` and `a` are what they say; a network that ends at `result` is what comes there.
Excerpts ChartText::inline_condition(pugi::xml_node body, const std::string& result) {
    Excerpts made;
    const pugi::xml_node written = body.child("ST");
    if (!written) {
        Excerpts statements = body_text(context_, body, result).statements;
        if (statements.is_empty()) return made;
        Excerpts value;
        value.write(result, file_.mark_of_tag(body));
        return condition_of_statements(std::move(statements), value, body);
    }
    for (Part part : file_.texts(written)) {
        const std::string_view text = file_.text(part);
        const std::size_t begin = text.find_first_not_of(" \t\r\n");
        if (begin == text.npos) continue;
        if (text.substr(begin).starts_with(":=")) part.begin += begin + 2;
        const std::size_t end = file_.text(part).find_last_not_of(" \t\r\n;");
        part.end = end == text.npos ? part.begin : part.begin + end + 1;
        file_.copy(made, part);
    }
    return made;
}

/// A condition that needs more than an expression is a method's result.
Excerpts ChartText::condition_of_statements(Excerpts before, const Excerpts& value,
                                            pugi::xml_node at) {
    if (before.is_empty()) return value;
    const Mark place = file_.mark_of_tag(at);
    const std::string name = context_.variables.name("_transition");
    made_.members.write(fmt::format("METHOD {} : BOOL\n", name), place);
    const bool is_named = is(at, "body") || is(at, "inline");
    if (is_named) {
        made_.members.write("VAR\n    ", place);
        made_.members.append(value);
        made_.members.write(" : BOOL;\nEND_VAR\n", place);
    }
    made_.members.append(before);
    made_.members.write(name + " := ", place);
    made_.members.append(value);
    made_.members.write(";\nEND_METHOD\n", place);
    Excerpts call;
    call.write(name + "()", place);
    return call;
}

}  // namespace

BodyText chart_text(BodyContext& context, pugi::xml_node chart, pugi::xml_node pou) {
    return ChartText(context, chart, pou).read();
}

}  // namespace lineshaft::projects
