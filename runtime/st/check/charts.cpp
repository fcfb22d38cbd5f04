#include <utility>

#include "runtime/source/letters.hpp"
#include "runtime/st/check/chart_writer.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

struct Qualifier {
    std::string_view name;
    bool has_time;
};

constexpr Qualifier qualifiers[] = {{"N", false},  {"S", false},  {"R", false}, {"P", false},
                                    {"P0", false}, {"P1", false}, {"L", true},  {"D", true},
                                    {"SD", true},  {"DS", true},  {"SL", true}};

bool is_known(const Routine& routine, const ChartAssociation& a) {
    if (is_step_action(a) && routine.pou->place.dialect().charts == ChartRules::codesys)
        return true;
    return find_called(qualifiers, qualifier_of(a), &Qualifier::name) != nullptr;
}

void check_transitions(Checking& c, const Chart& chart) {
    std::vector<std::string> names;
    for (const ChartStep& step : chart.steps) names.emplace_back(step.name.text);
    NameSet left;
    for (const ChartTransition& transition : chart.transitions) {
        for (const auto* steps : {&transition.from, &transition.to})
            for (const Token& step : *steps)
                if (!find_called(chart.steps, step.text, &ChartStep::name))
                    c.fail(code::not_declared, step.place,
                           fmt::format("there is no step '{}'", step.text),
                           suggest(step.text, names));
        for (const Token& step : transition.from) left.insert(step.text);
    }
    for (const ChartStep& step : chart.steps)
        if (!left.contains(step.name.text))
            c.warn(code::step_without_way_out, step.name.place,
                   fmt::format("no transition leads out of the step '{}'", step.name.text),
                   "the chart stays there: write TRANSITION FROM it TO another");
}

/// Its initial step, of which there is one.
void check_steps(Checking& c, const Pou& pou, const Chart& chart) {
    const ChartStep* initial = nullptr;
    for (const ChartStep& step : chart.steps) {
        if (!step.is_initial) continue;
        if (initial)
            c.fail(code::declared_twice, step.name.place, "a chart has one initial step",
                   fmt::format("'{}' in line {} is one already", initial->name.text,
                               initial->name.place.mark().line));
        initial = &step;
    }
    if (!initial)
        c.fail(code::something_else_expected, pou.name.place,
               fmt::format("the chart of '{}' has no initial step", pou.name.text),
               "write INITIAL_STEP in front of the step that it begins with");
    if (!pou.body.empty())
        c.fail(code::wrong_place, pou.body.front()->place, "a statement stands beside a chart",
               "put it into an ACTION of a step");
}

bool check_association(ChartWriter& w, const ChartAssociation& a) {
    Checking& c = w.c;
    const Token& q = a.qualifier;
    if (!is_known(w.routine, a))
        return c.fail(code::not_declared, q.place, fmt::format("'{}' is no qualifier", q.text),
                      "there are N, S, R, P, P0, P1, L, D, SD, DS and SL");
    const Qualifier* known = find_called(qualifiers, qualifier_of(a), &Qualifier::name);
    const bool has_time = known && known->has_time;
    if (has_time != (a.time != nullptr))
        return c.fail(code::wrong_arguments, q.place.source ? q.place : a.action.place,
                      fmt::format("{} takes {} time", qualifier_of(a), has_time ? "a" : "no"),
                      has_time ? fmt::format("write ({}, T#1s)", qualifier_of(a))
                               : fmt::format("write ({})", qualifier_of(a)));
    if (is_called(w, a.action)) return true;
    const bool is_elsewhere = a.action.text.find('.') != std::string_view::npos;
    Expression* member = is_elsewhere ? w.named(a.action) : nullptr;
    if (is_elsewhere && !check(c, member)) return false;
    const Variable* variable = is_elsewhere ? nullptr : find_variable(c, a.action);
    const Type* type = member ? member->type : variable ? variable->type : nullptr;
    if (type == &bool_type) return true;
    return c.fail(code::not_declared, a.action.place,
                  fmt::format("'{}' is neither an ACTION nor a BOOL", a.action.text),
                  fmt::format("write ACTION {}: ... END_ACTION", a.action.text));
}

/// Each action with its associations, in the order in which they are written.
std::vector<std::pair<Token, std::vector<ActionUse>>> actions_of(ChartWriter& w,
                                                                 const Chart& chart) {
    std::vector<std::pair<Token, std::vector<ActionUse>>> actions;
    for (const ChartStep& step : chart.steps)
        for (const ChartAssociation& a : step.associations) {
            if (is_step_action(a)) continue;
            auto* known = find_called(actions, a.action.text, [](auto& one) { return one.first; });
            if (!known) known = &actions.emplace_back(a.action, std::vector<ActionUse>());
            const std::string number = std::to_string(known->second.size() + 1);
            known->second.push_back({&step, &a, w.part_name(known->first.text, number)});
        }
    return actions;
}

/// X and T of each step, and its timer.
void write_times(ChartWriter& w, const Chart& chart) {
    constexpr Wide longest = (Wide{1} << 63) - 1;
    for (const ChartStep& step : chart.steps) {
        const Token& at = step.name;
        Expression* preset = make_constant(w.c, w.like(at), time_type, {.integer = longest});
        w.out.push_back(w.run(w.kept(at, at.text, "timer"), w.active(at), preset));
        Expression* elapsed = make_member(w.c, w.kept(at, at.text, "timer"), "et");
        Expression* time = make_member(w.c, w.name(at, at.text), "T");
        w.out.push_back(w.when(w.active(at), {w.set(time, elapsed)}));
    }
}

/// By their priorities, then as they are written. MatIEC puts one that has a priority behind those
/// written before it that have none.
std::vector<const ChartTransition*> in_order(const ChartWriter& w, const Chart& chart) {
    std::vector<const ChartTransition*> order;
    const auto number_of = [&](const ChartTransition* t) {
        const auto number = t->priority.word == Word::integer ? read_integer(t->priority.text)
                                                              : std::optional<Wide>();
        return number.value_or(w.is_matiec() ? 0 : Wide{1} << 65);
    };
    for (const ChartTransition& t : chart.transitions) {
        const auto place = std::ranges::find_if(order, [&](const ChartTransition* other) {
            return t.priority.word == Word::integer && number_of(other) > number_of(&t);
        });
        order.insert(place, &t);
    }
    return order;
}

bool shares_step(const ChartTransition& a, const ChartTransition& b) {
    return std::ranges::any_of(
        a.from, [&](const Token& step) { return find_called(b.from, step.text) != nullptr; });
}

/// The first of two from one step goes on alone; in MatIEC only if it has a priority, so that
/// several branches begin at once.
bool excludes(const ChartWriter& w, const ChartTransition& first, const ChartTransition& other) {
    const bool leaves_at_once = !w.is_matiec() || first.priority.word == Word::integer;
    return leaves_at_once && shares_step(first, other);
}

Block joined(Block first, const Block& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

/// CODESYS' `_x` of each step: whether it is active in the next scan.
void write_next(ChartWriter& w, const Chart& chart) {
    const auto order = in_order(w, chart);
    for (const bool enters : {false, true})
        for (std::size_t i = 0; i < order.size(); ++i) {
            Block changed;
            for (const Token& step : enters ? order[i]->to : order[i]->from)
                changed.push_back(w.set(w.next(step), w.truth(step, enters)));
            const Token& at = order[i]->from.front();
            w.out.push_back(w.when(w.name(at, fired_name(w, i)), std::move(changed)));
        }
}

/// All conditions; given back what they change: what is left, then what is entered.
Block write_conditions(ChartWriter& w, const Chart& chart) {
    const auto order = in_order(w, chart);
    Block leaving, entering;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const ChartTransition& t = *order[i];
        const Token& at = t.from.front();
        Expression* may = nullptr;
        for (const Token& step : t.from) may = w.joined(Word::and_, may, w.active(step));
        for (std::size_t k = 0; k < i; ++k)
            if (excludes(w, *order[k], t))
                may = w.joined(Word::and_, may, w.negated(w.name(at, fired_name(w, k))));
        w.out.push_back(w.set(w.name(at, fired_name(w, i)), w.truth(at, false)));
        w.out.push_back(w.when(may, {w.set(w.name(at, fired_name(w, i)), condition_of(w, t))}));
        Block left, entered;
        for (const Token& step : t.from)
            left.push_back(w.set(w.active(step), w.truth(step, false)));
        for (const Token& step : t.to) {
            entered.push_back(w.set(w.active(step), w.truth(step, true)));
            entered.push_back(
                w.run(w.kept(step, step.text, "timer"), w.truth(step, false), nullptr));
            entered.push_back(
                w.run(w.kept(step, step.text, "timer"), w.truth(step, true), nullptr));
            entered.push_back(w.set(make_member(w.c, w.name(step, step.text), "T"),
                                    make_constant(w.c, w.like(step), time_type, {})));
        }
        leaving.push_back(w.when(w.name(at, fired_name(w, i)), std::move(left)));
        entering.push_back(w.when(w.name(at, fired_name(w, i)), std::move(entered)));
    }
    write_transition_flag(w, chart);
    if (w.is_codesys()) write_next(w, chart);
    return joined(std::move(leaving), entering);
}

/// What the qualifier of one association asks for; null: nothing now.
Expression* write_qualifier(ChartWriter& w, const Token& action, const ActionUse& use) {
    const ChartAssociation& a = *use.association;
    const Token& at = a.action;
    const Token& step = use.step->name;
    const auto is_before = [&] { return w.kept(step, step.text, "before"); };
    const auto later = [&](Word relation) {
        return w.joined(relation, make_member(w.c, w.name(step, step.text), "T"), a.time);
    };
    const auto store = [&](Expression* when, std::string_view where) {
        w.out.push_back(w.when(when, {w.set(w.name(at, where), w.truth(at, true))}));
    };
    if (is(a, "N")) return w.active(step);
    if (is(a, "P")) return w.joined(Word::and_, w.active(step), w.negated(is_before()));
    if (is(a, "L")) return w.joined(Word::and_, w.active(step), later(Word::less));
    if (is(a, "D")) return w.joined(Word::and_, w.active(step), later(Word::greater_or_equal));
    if (is(a, "S")) return store(w.active(step), w.part_name(action.text, "stored")), nullptr;
    if (!is_stored_with_time(a)) return nullptr;
    if (is(a, "DS")) {
        store(w.joined(Word::and_, w.active(step), later(Word::greater_or_equal)), use.kept);
    } else {
        store(w.active(step), use.kept);
    }
    const auto cleared = w.kept(at, action.text, "reset");
    w.out.push_back(w.when(cleared, {w.set(w.name(at, use.kept), w.truth(at, false))}));
    if (is(a, "DS")) return w.name(at, use.kept);
    const auto timer = [&] { return w.kept(at, use.kept, "timer"); };
    w.out.push_back(w.run(timer(), w.name(at, use.kept), a.time));
    Expression* is_over = make_member(w.c, timer(), "q");
    return is(a, "SD") ? is_over : w.joined(Word::and_, w.name(at, use.kept), w.negated(is_over));
}

/// P1 as the step begins, P0 as it ends: once, without a scan behind it.
Expression* pulse_of(ChartWriter& w, const ActionUse& use) {
    const Token& step = use.step->name;
    Expression* before = w.kept(step, step.text, "before");
    if (is(*use.association, "P1")) return w.joined(Word::and_, w.active(step), w.negated(before));
    if (is(*use.association, "P0")) return w.joined(Word::and_, before, w.negated(w.active(step)));
    return nullptr;
}

/// CODESYS' `_action.x`: that it runs, and not once more behind.
std::string_view flag_of_action(ChartWriter& w, const Token& action) {
    return w.c.checked.names.emplace_back(fmt::format("_{}", action.text));
}

/// Whether it is asked for, which is reckoned first, and whether it is now.
Expression* write_control(ChartWriter& w, const Token& action, const std::vector<ActionUse>& uses) {
    Expression* reset = w.truth(action, false);
    for (const ActionUse& use : uses)
        if (is(*use.association, "R")) reset = w.joined(Word::or_, reset, w.active(use.step->name));
    const auto kept = [&](std::string_view part) { return w.kept(action, action.text, part); };
    w.out.push_back(w.set(kept("reset"), reset));
    Expression *asked = w.truth(action, false), *pulse = w.truth(action, false);
    for (const ActionUse& use : uses) {
        if (Expression* now = write_qualifier(w, action, use))
            asked = w.joined(Word::or_, asked, now);
        if (Expression* now = pulse_of(w, use)) pulse = w.joined(Word::or_, pulse, now);
    }
    w.out.push_back(w.when(kept("reset"), {w.set(kept("stored"), w.truth(action, false))}));
    asked = w.joined(Word::or_, asked, kept("stored"));
    w.out.push_back(w.set(kept("runs"), w.joined(Word::and_, asked, w.negated(kept("reset")))));
    return w.joined(Word::or_, kept("runs"), pulse);
}

Statement* call_of(ChartWriter& w, const Token& action) {
    return make_call_statement(w.c, make_call(w.c, w.like(action), w.named(action), {}));
}

/// An ACTION runs while it is asked for, and once more behind; a BOOL is whether it is.
void write_action(ChartWriter& w, const Token& action, const std::vector<ActionUse>& uses) {
    Expression* now = write_control(w, action, uses);
    if (!is_called(w, action)) return w.out.push_back(w.set(w.named(action), now));
    const auto kept = [&](std::string_view part) { return w.kept(action, action.text, part); };
    w.out.push_back(w.when(w.joined(Word::or_, now, kept("ran")), {call_of(w, action)}));
    w.out.push_back(w.set(kept("ran"), kept("runs")));
}

/// What CODESYS keeps at the steps themselves: those that end, then those that begin, then what
/// runs while they are active; none runs once more behind.
void write_step_actions(ChartWriter& w, const Chart& chart) {
    for (const std::string_view kind : step_actions)
        for (const ChartStep& step : chart.steps)
            for (const ChartAssociation& a : step.associations) {
                if (!is(a, kind)) continue;
                const Token& at = step.name;
                const auto before = [&] { return w.kept(at, at.text, "before"); };
                Expression* when = is(a, "_EXIT") ? before() : w.active(at);
                if (is(a, "_EXIT")) when = w.joined(Word::and_, when, w.negated(w.active(at)));
                if (is(a, "_ENTRY")) when = w.joined(Word::and_, when, w.negated(before()));
                w.out.push_back(w.when(when, {call_of(w, a.action)}));
            }
}

/// CODESYS runs them in the order of their names: those once more that are not asked for any more,
/// then all that are.
void write_actions_of_codesys(ChartWriter& w, const Chart& chart) {
    write_step_actions(w, chart);
    auto actions = actions_of(w, chart);
    std::ranges::stable_sort(actions, {}, [](const auto& one) { return lower(one.first.text); });
    Block once_more, running;
    for (const auto& [action, uses] : actions) {
        const Token& at = action;
        Expression* now = write_control(w, action, uses);
        const auto kept = [&](std::string_view part) { return w.kept(at, at.text, part); };
        const Variable* flag = find_in(w.routine.names, flag_of_action(w, action));
        if (flag && flag->type && flag->type->name == "ACTION")
            w.out.push_back(w.set(make_member(w.c, w.name(action, flag->text), "X"), now));
        if (!is_called(w, action)) {
            w.out.push_back(w.set(w.named(action), now));
            continue;
        }
        Expression* ends = w.joined(Word::and_, kept("ran"), w.negated(now));
        once_more.push_back(w.when(ends, {call_of(w, action)}));
        running.push_back(w.when(now, {call_of(w, action)}));
        running.push_back(w.set(kept("ran"), kept("runs")));
    }
    w.out = joined(joined(std::move(w.out), once_more), running);
}

/// As it begins: its initial step is active, and nothing is stored.
Block restarted(ChartWriter& w, const Chart& chart) {
    Block made;
    for (const ChartStep& step : chart.steps) {
        const Token& at = step.name;
        made.push_back(w.set(w.active(at), w.truth(at, step.is_initial)));
        if (w.is_codesys()) made.push_back(w.set(w.next(at), w.truth(at, step.is_initial)));
        made.push_back(w.run(w.kept(at, at.text, "timer"), w.truth(at, false), nullptr));
        made.push_back(w.set(make_member(w.c, w.name(at, at.text), "T"),
                             make_constant(w.c, w.like(at), time_type, {})));
        made.push_back(w.set(w.kept(at, at.text, "before"), w.truth(at, false)));
    }
    for (std::size_t i = 0; i < chart.transitions.size(); ++i) {
        const Token& at = chart.transitions[i].from.front();
        made.push_back(w.set(w.name(at, fired_name(w, i)), w.truth(at, false)));
    }
    for (const auto& [action, uses] : actions_of(w, chart)) {
        for (const std::string_view part : {"stored", "runs", w.is_matiec() ? "set" : "ran"})
            made.push_back(w.set(w.kept(action, action.text, part), w.truth(action, false)));
        for (const ActionUse& use : uses)
            if (is_stored_with_time(*use.association))
                made.push_back(w.set(w.name(action, use.kept), w.truth(action, false)));
    }
    return made;
}

/// What a chart does in a scan, in this order.
struct ChartScan {
    Block evolution = {}, actions = {}, conditions = {};
};

/// While SFCReset the chart stands at its initial step, and while SFCInit it runs no action either;
/// while SFCPause or SFCQuitError nothing is done.
Block with_flags(ChartWriter& w, const Chart& chart, ChartScan scan) {
    const bool resets = flag_of_charts(w.routine, "SFCReset");
    const bool begins = flag_of_charts(w.routine, "SFCInit");
    const Token& at = chart.steps.front().name;
    const auto any = [&](bool first, bool second) {
        Expression* flag = first ? w.name(at, "SFCInit") : nullptr;
        return second ? w.joined(Word::or_, flag, w.name(at, "SFCReset")) : flag;
    };
    Block made;
    if (begins || resets) {
        made.push_back(
            make_if(w.c, at.place, any(begins, resets), restarted(w, chart), scan.evolution));
        if (!scan.conditions.empty())
            scan.conditions = {w.when(w.negated(any(begins, resets)), scan.conditions)};
    } else {
        made = std::move(scan.evolution);
    }
    if (begins) scan.actions = {w.when(w.negated(any(true, false)), scan.actions)};
    made = joined(joined(std::move(made), scan.actions), scan.conditions);
    for (const std::string_view stops : {"SFCPause", "SFCQuitError"})
        if (flag_of_charts(w.routine, stops))
            made = {w.when(w.negated(w.name(at, stops)), std::move(made))};
    return made;
}

/// `_action` of each action, where nothing else has that name.
void declare_flags_of_actions(ChartWriter& w, const Chart& chart) {
    Type& type = w.c.make_type(Kind::structure, "ACTION");
    type.members = {&w.c.make_variable({}, "X", &bool_type)};
    for (const auto& [action, uses] : actions_of(w, chart)) {
        const std::string_view name = flag_of_action(w, action);
        if (w.routine.methods.contains(action.text) && !w.routine.names.contains(name))
            w.declare(action, name, &type);
    }
}

/// `seen` has the chart, and `routine`, if it is another, what this keeps.
void declare_chart(Checking& c, Routine& routine, Routine& seen) {
    if (!seen.pou->chart) return;
    const Chart& chart = *seen.pou->chart;
    ChartWriter w{c, routine, *seen.pou};
    Type& type = c.make_type(Kind::structure, "STEP");
    type.members = {&c.make_variable({}, "X", &bool_type), &c.make_variable({}, "T", &time_type)};
    if (w.is_codesys()) type.members.push_back(&c.make_variable({}, "_X", &bool_type));
    for (const ChartStep& step : chart.steps) {
        const Token& at = step.name;
        if (const Variable* known = find_in(seen.names, at.text)) {
            c.fail(code::declared_twice, at.place, fmt::format("'{}' is declared twice", at.text),
                   fmt::format("first in line {}", known->name.place.mark().line));
            continue;
        }
        Variable& variable = w.declare_step(seen, at, &type);
        if (step.is_initial) {
            Expression* list = make(c, E::list, w.like(at));
            Token x = at;
            x.text = "X";
            list->arguments = {{.name = x, .value = w.truth(at, true)}};
            x.text = "_X";
            if (w.is_codesys()) list->arguments.push_back({.name = x, .value = w.truth(at, true)});
            variable.initial = list;
        }
        w.declare(at, w.part_name(at.text, "timer"), standard_type(c, "ton"));
        Variable& before = w.declare(at, w.part_name(at.text, "before"), &bool_type);
        if (w.is_matiec() && step.is_initial) before.initial = w.truth(at, true);
    }
    for (std::size_t i = 0; i < chart.transitions.size(); ++i)
        w.declare(chart.transitions[i].from.front(), fired_name(w, i), &bool_type);
    if (w.is_codesys()) declare_flags_of_actions(w, chart);
    for (const auto& [action, uses] : actions_of(w, chart)) {
        for (const std::string_view part :
             {"stored", "reset", "runs", w.is_matiec() ? "set" : "ran"})
            w.declare(action, w.part_name(action.text, part), &bool_type);
        for (const ActionUse& use : uses) {
            if (!is_stored_with_time(*use.association)) continue;
            w.declare(action, use.kept, &bool_type);
            w.declare(action, w.part_name(use.kept, "timer"), standard_type(c, "ton"));
        }
    }
    check_steps(c, *seen.pou, chart);
    check_transitions(c, chart);
}

}  // namespace

void declare_charts(Checking& c, Routine& routine) {
    if (routine.owner) return;
    declare_chart(c, routine, routine);
    for (Routine* method : routine.own_methods) declare_chart(c, routine, *method);
    for (const std::string_view flag : given_flags_of_charts)
        if (Variable* variable = flag_of_charts(routine, flag);
            variable && variable->section == Section::local)
            variable->section = Section::input;  // who calls an action gives it
}

bool is_called(ChartWriter& w, const Token& action) {
    const std::size_t point = action.text.rfind('.');
    if (w.routine.methods.contains(action.text)) return true;
    if (point == std::string_view::npos) return false;
    Token owner = action, first = action;
    owner.text = action.text.substr(0, point);
    first.text = action.text.substr(0, action.text.find('.'));
    if (!find_variable(w.c, first)) return false;
    Expression* instance = w.named(owner);
    const Type* type = check(w.c, instance);
    return type && type->kind == Kind::block &&
           find_in(type->routine->methods, action.text.substr(point + 1)) != nullptr;
}

Block chart_statements(Checking& c, Routine& routine) {
    if (!routine.pou->chart) return {};
    const Chart& chart = *routine.pou->chart;
    Routine& keeper = routine.owner ? *routine.owner : routine;
    ChartWriter w{c, keeper, *routine.pou};
    bool is_right = c.out.empty();
    for (const ChartStep& step : chart.steps)
        for (const ChartAssociation& association : step.associations)
            is_right = check_association(w, association) && is_right;
    if (!is_right) return {};
    write_times(w, chart);
    Block times = std::exchange(w.out, {});
    const Block change = write_conditions(w, chart);
    Block conditions = std::exchange(w.out, {});
    write_current_step(w, chart);
    if (w.is_codesys())
        write_actions_of_codesys(w, chart);
    else
        for (const auto& [action, uses] : actions_of(w, chart))
            w.is_matiec() ? write_action_of_matiec(w, action, uses) : write_action(w, action, uses);
    for (const ChartStep& step : chart.steps)
        w.out.push_back(w.set(w.kept(step.name, step.name.text, "before"), w.active(step.name)));
    if (w.is_codesys())
        return with_flags(w, chart, {joined(change, times), w.out, std::move(conditions)});
    return with_flags(w, chart, {joined(joined(std::move(times), conditions), change), w.out, {}});
}

}  // namespace lineshaft::st
