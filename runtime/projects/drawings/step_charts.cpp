#include "runtime/projects/drawings/step_charts.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/archive.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

// What elements say of themselves goes by these.
constexpr std::string_view name_id = "{38391c6d-6d4a-42f8-8ee7-9f45e5adafa8}";
constexpr std::string_view is_excluded_id = "{01580b27-6378-448b-8ecb-0e4b795b58d6}";
constexpr std::string_view is_initial_id = "{6844a48e-46c2-4cc8-a185-a478f3b99cc0}";
constexpr std::string_view is_parallel_id = "{23bdaa98-72ec-41f7-817b-9dede5697086}";
constexpr std::string_view qualifier_id = "{e174fc0d-80b0-4a9e-a530-ca239c249a50}";

/// What is called at a step's beginning, while it is active, and at its end.
struct StepAction {
    std::string_view id, qualifier, embedded;
};
constexpr StepAction step_actions[] = {
    {"{a6b08bd8-b696-47e3-9cbf-7408b61c9ff8}", "_ENTRY", "EmbeddedEntryAction"},
    {"{700a583f-b4d4-43e4-8c14-629c7cd3bec8}", "_ACTIVE", "EmbeddedMainAction"},
    {"{a2621e18-7de3-4ea6-ae6d-89e9e0b7befd}", "_EXIT", "EmbeddedExitAction"}};

struct Flag {
    std::string_view key, name, type;
};
constexpr Flag flags[] = {{"Init", "SFCInit", "BOOL"},
                          {"Reset", "SFCReset", "BOOL"},
                          {"Pause", "SFCPause", "BOOL"},
                          {"Tip", "SFCTip", "BOOL"},
                          {"TipMode", "SFCTipMode", "BOOL"},
                          {"Trans", "SFCTrans", "BOOL"},
                          {"EnableLimit", "SFCEnableLimit", "BOOL"},
                          {"Error", "SFCError", "BOOL"},
                          {"QuitError", "SFCQuitError", "BOOL"},
                          {"ErrorStep", "SFCErrorStep", "STRING"},
                          {"ErrorPOU", "SFCErrorPOU", "STRING"},
                          {"CurrentStep", "SFCCurrentStep", "STRING"}};

using Nodes = std::vector<pugi::xml_node>;

struct Transition {
    pugi::xml_node node;
    Nodes from, to = {};  ///< of `to`: steps, and jumps to them
};

/// What leads to the next element.
struct Open {
    Nodes steps = {};                          ///< that a transition leaves together
    std::vector<std::size_t> conditions = {};  ///< transitions that do not lead anywhere yet
};

struct PlacedStep {
    pugi::xml_node node;
    int row = 0;
};

class StepChart {
  public:
    StepChart(const XmlFile& file, Diagnostics& out, pugi::xml_node pou)
        : archive_(file), file_(file), out_(out), pou_(pou) {}

    Excerpts read(pugi::xml_node root);

  private:
    Nodes elements_of(pugi::xml_node object) const;
    pugi::xml_node value_of(pugi::xml_node element, std::string_view id) const;
    std::string text(pugi::xml_node element, std::string_view id) const;
    bool is(pugi::xml_node element, std::string_view id) const {
        return lower(text(element, id)) == "true";
    }

    void add_stretch(pugi::xml_node segment, Open& open, int& row);
    void add_element(pugi::xml_node element, Open& open, int& row);
    void add_transition(pugi::xml_node transition, Open& open);
    void add_branch(pugi::xml_node branch, Open& open, int& row);
    void lead_to(const Nodes& steps, Open& open);
    Nodes first_steps(pugi::xml_node element) const;

    void write_step(pugi::xml_node step);
    void write_action(pugi::xml_node association);
    void write_transition(const Transition& transition);
    void write_steps(const Nodes& steps, pugi::xml_node at);
    void write_condition(pugi::xml_node transition);

    Mark place_of(pugi::xml_node element) const;
    void write(std::string_view words, pugi::xml_node at) { made_.write(words, place_of(at)); }
    bool copy(pugi::xml_node element, std::string_view id);
    void refuse(pugi::xml_node at, std::string why, std::string help) {
        out_.add(code::not_supported, place_of(at), std::move(why), std::move(help));
    }

    const Archive archive_;
    const XmlFile& file_;
    Diagnostics& out_;
    pugi::xml_node pou_;
    std::vector<PlacedStep> steps_;
    std::vector<Transition> transitions_;
    Excerpts made_;
};

std::string_view word_of(std::string_view kind) {
    if (kind == "SFCStep") return "step";
    if (kind == "SFCTransition") return "transition";
    if (kind == "SFCBranch") return "branch";
    if (kind == "SFCJump") return "jump";
    if (kind == "SFCMacro") return "macro";
    return kind == "SFCActionAssociation" ? "action" : kind;
}

Nodes StepChart::elements_of(pugi::xml_node object) const {
    const pugi::xml_node list = Archive::member(object, "ElementList");
    Nodes all = Archive::items(Archive::member(list, "InnerList"));
    std::erase_if(all, [&](pugi::xml_node one) { return is(one, is_excluded_id); });
    return all;
}

pugi::xml_node StepChart::value_of(pugi::xml_node element, std::string_view id) const {
    for (const pugi::xml_node attribute : Archive::items(Archive::member(element, "Attributes")))
        if (archive_.text(attribute, "AttributeId") == id)
            return Archive::member(Archive::member(attribute, "Value"), "Value");
    return {};
}

std::string StepChart::text(pugi::xml_node element, std::string_view id) const {
    const pugi::xml_node value = value_of(element, id);
    return value ? archive_.text(value.parent(), "Value") : std::string();
}

Mark StepChart::place_of(pugi::xml_node element) const {
    const pugi::xml_node value = value_of(element, name_id);
    Mark place = file_.mark_of_tag(value ? value : element);
    const std::string name = value ? text(element, name_id) : std::string();
    place.drawn = std::make_shared<const std::string>(
        fmt::format("{}{}{}", word_of(Archive::kind_of(element)), name.empty() ? "" : " ", name));
    return place;
}

/// The value without its quotes, and what ends a statement; false: it says nothing.
bool StepChart::copy(pugi::xml_node element, std::string_view id) {
    bool says = false;
    for (Part part : file_.texts(value_of(element, id))) {
        const std::string_view text = file_.text(part);
        const std::size_t begin = text.find_first_not_of(" \t\r\n\"");
        const std::size_t end = text.find_last_not_of(" \t\r\n\";");
        if (begin == text.npos || end == text.npos || end < begin) continue;
        file_.copy(made_, Part{part.begin + begin, part.begin + end + 1});
        says = true;
    }
    return says;
}

/// Those that are entered where `element` is.
Nodes StepChart::first_steps(pugi::xml_node element) const {
    const std::string_view kind = Archive::kind_of(element);
    if (kind == "SFCStep" || kind == "SFCJump") return {element};
    Nodes all;
    Nodes stretches;
    if (kind == "SFCBranch" && is(element, is_parallel_id)) stretches = elements_of(element);
    if (kind == "SFCMacro") stretches = {Archive::member(element, "Segment")};
    for (const pugi::xml_node stretch : stretches) {
        const Nodes inside = elements_of(stretch);
        if (inside.empty()) continue;
        const Nodes first = first_steps(inside.front());
        all.insert(all.end(), first.begin(), first.end());
    }
    return all;
}

void StepChart::lead_to(const Nodes& steps, Open& open) {
    for (const std::size_t i : std::exchange(open.conditions, {})) transitions_[i].to = steps;
}

void StepChart::add_stretch(pugi::xml_node segment, Open& open, int& row) {
    for (const pugi::xml_node element : elements_of(segment)) add_element(element, open, row);
}

void StepChart::add_element(pugi::xml_node element, Open& open, int& row) {
    const std::string_view kind = Archive::kind_of(element);
    const Nodes entered = first_steps(element);
    if (!entered.empty()) lead_to(entered, open);
    if (kind == "SFCStep") {
        steps_.push_back({element, row++});
        open.steps = {element};
    } else if (kind == "SFCTransition") {
        add_transition(element, open);
        ++row;
    } else if (kind == "SFCBranch") {
        add_branch(element, open, row);
    } else if (kind == "SFCMacro") {
        add_stretch(Archive::member(element, "Segment"), open, row);
    } else if (kind == "SFCJump") {
        open = {};
    } else {
        refuse(element, fmt::format("'{}' of a chart is not supported", kind),
               "write it as steps and transitions");
    }
}

void StepChart::add_transition(pugi::xml_node transition, Open& open) {
    if (!open.conditions.empty() || open.steps.empty())
        return refuse(transition, "no step stands before this transition", "draw a step between");
    transitions_.push_back({transition, std::exchange(open.steps, {})});
    open.conditions = {transitions_.size() - 1};
}

/// All stretches of a parallel branch are left together; each of another goes on by itself.
void StepChart::add_branch(pugi::xml_node branch, Open& open, int& row) {
    const bool is_parallel = is(branch, is_parallel_id);
    const Open before = std::exchange(open, {});
    const int top = row;
    for (const pugi::xml_node stretch : elements_of(branch)) {
        Open inside = is_parallel ? Open{} : before;
        int below = top;
        add_stretch(stretch, inside, below);
        row = std::max(row, below);
        open.conditions.insert(open.conditions.end(), inside.conditions.begin(),
                               inside.conditions.end());
        open.steps.insert(open.steps.end(), inside.steps.begin(), inside.steps.end());
    }
    const bool is_mixed = is_parallel ? !open.conditions.empty() : !open.steps.empty();
    if (is_mixed)
        refuse(branch,
               fmt::format("a stretch of this branch ends with a {}",
                           is_parallel ? "transition" : "step"),
               fmt::format("let it end with a {} or a jump", is_parallel ? "step" : "transition"));
}

Excerpts StepChart::read(pugi::xml_node root) {
    Open open;
    int row = 0;
    add_stretch(root, open, row);
    std::ranges::stable_sort(steps_, {}, &PlacedStep::row);
    for (const PlacedStep& step : steps_) write_step(step.node);
    for (const Transition& transition : transitions_) write_transition(transition);
    return std::move(made_);
}

void StepChart::write_step(pugi::xml_node step) {
    write(is(step, is_initial_id) ? "INITIAL_STEP " : "STEP ", step);
    copy(step, name_id);
    write(":\n", step);
    for (const pugi::xml_node association : elements_of(step)) write_action(association);
    for (const StepAction& kind : step_actions) {
        if (!Archive::is_null(Archive::member(step, kind.embedded)))
            refuse(step, "an action that is kept in its step is not read",
                   "make it an action of the block, to which the step refers");
        if (text(step, kind.id).empty()) continue;
        write("    ", step);
        copy(step, kind.id);
        write(fmt::format("({});\n", kind.qualifier), step);
    }
    write("END_STEP\n", step);
}

/// A time stands behind the qualifier: `L T#5s`.
void StepChart::write_action(pugi::xml_node association) {
    write("    ", association);
    copy(association, name_id);
    std::string qualifier = text(association, qualifier_id);
    std::ranges::replace(qualifier, ',', ' ');
    const std::size_t end = qualifier.find(' '), time = qualifier.find_first_not_of(' ', end);
    if (!qualifier.empty())
        write(time == qualifier.npos
                  ? fmt::format("({})", qualifier.substr(0, end))
                  : fmt::format("({}, {})", qualifier.substr(0, end), qualifier.substr(time)),
              association);
    write(";\n", association);
}

void StepChart::write_steps(const Nodes& steps, pugi::xml_node at) {
    if (steps.size() != 1) write("(", at);
    for (const pugi::xml_node step : steps) {
        if (step != steps.front()) write(", ", at);
        copy(step, name_id);
    }
    if (steps.size() != 1) write(")", at);
}

void StepChart::write_transition(const Transition& transition) {
    const pugi::xml_node at = transition.node;
    if (transition.to.empty())
        return refuse(at, "no step stands behind this transition", "end with a jump or a step");
    write("TRANSITION FROM ", at);
    write_steps(transition.from, at);
    write(" TO ", at);
    write_steps(transition.to, at);
    write(" := ", at);
    write_condition(at);
    write(";\nEND_TRANSITION\n", at);
}

void StepChart::write_condition(pugi::xml_node transition) {
    if (!Archive::is_null(Archive::member(transition, "EmbeddedTransition")))
        refuse(transition, "a condition that is drawn in its transition is not read",
               "write it as an expression, or make it a transition of the block");
    const std::string name = text(transition, name_id);
    const bool is_named = std::ranges::any_of(pou_.children("Transition"), [&](auto named) {
        return st::same_name(file_.plain(named.attribute("Name")), name);
    });
    if (!copy(transition, name_id)) {
        refuse(transition, "this transition has no condition", "write TRUE if it needs none");
        write("FALSE", transition);
    }
    if (is_named) write("()", transition);
}

/// As a word of its own, not `SFCTip` in SFCTipMode.
bool names(std::string_view text, std::string_view word) {
    const auto goes_on = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
    for (std::size_t at = 0; (at = text.find(word, at)) != text.npos; ++at)
        if (at + word.size() == text.size() || !goes_on(text[at + word.size()])) return true;
    return false;
}

/// Those that the chart, of the block or of one of its actions, looks at, which the block does not
/// declare, and which are written about.
void declare_flags(const XmlFile& file, MadeVariables& variables, pugi::xml_node body,
                   pugi::xml_node pou) {
    const Archive archive(file);
    const pugi::xml_node properties = body.parent().parent().child("ObjectProperties");
    const pugi::xml_node used = Archive::member(Archive::root(properties), "Flags");
    const std::string declared = lower(file.plain(pou.child("Declaration")));
    const std::string text = lower(file.text());
    const Nodes entries = Archive::items(used);
    for (std::size_t i = 0; i + 1 < entries.size(); i += 2)
        for (const Flag& flag : flags) {
            if (file.plain(entries[i]) != flag.key) continue;
            const bool is_used = archive.is_true(entries[i + 1], "Use") &&
                                 archive.is_true(entries[i + 1], "Declare");
            const bool is_named = names(text, lower(flag.name));
            const bool is_declared = names(declared, lower(flag.name));
            if (is_used && is_named && !is_declared) variables.declare(flag.name, flag.type);
        }
}

}  // namespace

Excerpts text_of_step_chart(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                            pugi::xml_node body, pugi::xml_node pou) {
    const pugi::xml_node root = Archive::member(Archive::root(body), "Root");
    if (Archive::kind_of(root) != "SFCSegment") {
        out.add(code::not_supported, file.mark_of_tag(body),
                "this chart is not as TwinCAT keeps one",
                "save it anew in TwinCAT, or leave it out");
        return {};
    }
    declare_flags(file, variables, body, pou);
    return StepChart(file, out, pou).read(root);
}

}  // namespace lineshaft::projects
