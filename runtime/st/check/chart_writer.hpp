#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

/// Writes what a chart does as statements, which are checked as those of a user.
struct ChartWriter {
    Checking& c;
    Routine& routine;  ///< that has what the chart keeps
    const Pou& pou;    ///< whose chart it is: the routine's, or one of its actions'
    Block out = {};

    Expression like(const Token& token) const { return {.token = token, .place = token.place}; }
    /// `of part`, as none of a source is called: what a chart keeps beside what its user declares.
    std::string_view part_name(std::string_view of, std::string_view part) {
        return c.checked.names.emplace_back(fmt::format("{}{} {}", within(), of, part));
    }
    std::string within() const {
        return &pou == routine.pou ? std::string() : fmt::format("{}.", pou.name.text);
    }
    Expression* name(const Token& at, std::string_view text) {
        return make_name(c, like(at), text);
    }
    /// An action, or what stands in its place: `lamps.red`, whose text is one.
    Expression* named(const Token& action) {
        if (routine.methods.contains(action.text)) return name(action, action.text);
        std::string_view rest = action.text;
        Expression* made = nullptr;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find('.'), rest.size());
            const std::string_view part = rest.substr(0, end);
            made = made ? make_member(c, made, part) : name(action, part);
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        return made;
    }
    Expression* active(const Token& step) { return make_member(c, name(step, step.text), "X"); }
    Expression* next(const Token& step) { return make_member(c, name(step, step.text), "_X"); }
    bool is_codesys() const { return pou.place.dialect().charts == ChartRules::codesys; }
    bool is_matiec() const { return pou.place.dialect().charts == ChartRules::matiec; }
    Expression* kept(const Token& at, std::string_view of, std::string_view part) {
        return name(at, part_name(of, part));
    }
    Expression* joined(Word op, Expression* a, Expression* b) {
        return a ? make_binary(c, b->place, b->place, op, a, b) : b;
    }
    Expression* negated(Expression* value) { return make_not(c, value); }
    Expression* truth(const Token& at, bool value) { return make_boolean(c, like(at), value); }
    Statement* set(Expression* target, Expression* value) {
        return make_assignment(c, target->place, target, value);
    }
    Statement* when(Expression* condition, Block then) {
        return make_if(c, condition->place, condition, std::move(then), {});
    }
    /// `timer(IN := in, PT := preset);`
    Statement* run(Expression* timer, Expression* in, Expression* preset) {
        const auto named = [&](std::string_view text) {
            return Token{.word = Word::name, .place = timer->place, .text = text};
        };
        std::vector<Argument> arguments = {{.name = named("in"), .value = in}};
        if (preset) arguments.push_back({.name = named("pt"), .value = preset});
        return make_call_statement(c, make_call(c, *timer, timer, std::move(arguments)));
    }

    Variable& declare(const Token& at, std::string_view text, const Type* type) {
        Variable& made = c.make_variable(routine, at, text, type);
        routine.names.emplace(text, &made);
        depend(c, type, at.place);
        return made;
    }
    /// A step of an action's chart is seen in the action alone.
    Variable& declare_step(Routine& seen, const Token& at, const Type* type) {
        const std::string_view full = c.checked.names.emplace_back(within() + std::string(at.text));
        Variable& made = declare(at, full, type);
        seen.names.emplace(at.text, &made);
        return made;
    }
};

inline std::string_view qualifier_of(const ChartAssociation& a) {
    return a.qualifier.word == Word::end_of_file ? "N" : a.qualifier.text;
}

inline bool is(const ChartAssociation& a, std::string_view qualifier) {
    return same_name(qualifier_of(a), qualifier);
}

/// What CODESYS keeps at a step itself, in the order in which it runs that.
inline constexpr std::string_view step_actions[] = {"_EXIT", "_ENTRY", "_ACTIVE"};

inline bool is_step_action(const ChartAssociation& a) {
    return std::ranges::any_of(step_actions, [&](std::string_view kind) { return is(a, kind); });
}

/// SD, DS and SL are stored each with a time of its own.
inline bool is_stored_with_time(const ChartAssociation& a) {
    return is(a, "SD") || is(a, "DS") || is(a, "SL");
}

/// Whether it is an ACTION, of the block or of an instance; else it is a BOOL.
bool is_called(ChartWriter& w, const Token& action);

/// One association of one action, and the number that what it keeps is known by.
struct ActionUse {
    const ChartStep* step;
    const ChartAssociation* association;
    std::string_view kept = {};
};

/// What MatIEC makes of an action: each association of a step that is active, or was, writes its
/// state, the last one counts, and nothing runs once more behind. A BOOL keeps its value where no
/// association writes it. What begins with a step does not begin with the first scan.
void write_action_of_matiec(ChartWriter& w, const Token& action,
                            const std::vector<ActionUse>& uses);

// chart_flags.cpp

/// The name of the variable that tells whether a transition fires.
std::string_view fired_name(ChartWriter& w, std::size_t number);

/// A variable of CODESYS that the block declares, by whose name its charts are told what to do, or
/// tell what they are at; null: it declares none.
Variable* flag_of_charts(const Routine& block, std::string_view name, Kind kind = Kind::boolean);

/// Who calls an action of the block gives these.
inline constexpr std::string_view given_flags_of_charts[] = {
    "SFCInit", "SFCReset", "SFCPause", "SFCQuitError", "SFCTip", "SFCTipMode", "SFCEnableLimit"};

/// SFCTip goes on, whatever the condition is; in SFCTipMode nothing else does.
Expression* condition_of(ChartWriter& w, const ChartTransition& t);

/// SFCTrans: a transition fires.
void write_transition_flag(ChartWriter& w, const Chart& chart);

/// SFCCurrentStep is the name of the last step that is active.
void write_current_step(ChartWriter& w, const Chart& chart);

}  // namespace lineshaft::st
