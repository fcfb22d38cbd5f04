#include "runtime/st/check/chart_writer.hpp"

namespace lineshaft::st {

namespace {

/// Writes what one action of a chart does.
class MatiecAction {
  public:
    MatiecAction(ChartWriter& w, const Token& action)
        : w_(w), action_(action), is_body_(is_called(w, action)) {}

    void write(const std::vector<ActionUse>& uses) {
        if (is_body_) put(state(), w_.truth(action_, false));
        for (const std::string_view part : {"set", "reset"}) put(kept(part), truth(false));
        for (const ActionUse& use : uses) write_use(use);
        put_when(kept("set"), kept("stored"), true);
        put_when(kept("reset"), kept("stored"), false);
        is_body_ ? write_body() : write_variable();
    }

  private:
    Expression* kept(std::string_view part) { return w_.kept(action_, action_.text, part); }
    Expression* truth(bool value) { return w_.truth(action_, value); }
    Expression* both(Expression* a, Expression* b) { return w_.joined(Word::and_, a, b); }
    Expression* state() { return is_body_ ? kept("runs") : w_.named(action_); }
    Expression* active(const ActionUse& use) { return w_.active(use.step->name); }
    Expression* before(const ActionUse& use) {
        return w_.kept(use.step->name, use.step->name.text, "before");
    }
    Expression* begins(const ActionUse& use) { return both(active(use), w_.negated(before(use))); }
    Expression* ends(const ActionUse& use) { return both(before(use), w_.negated(active(use))); }

    void put(Expression* target, Expression* value) { w_.out.push_back(w_.set(target, value)); }
    void put_when(Expression* condition, Expression* target, bool value) {
        w_.out.push_back(w_.when(condition, {w_.set(target, truth(value))}));
    }

    void write_use(const ActionUse& use) {
        const ChartAssociation& a = *use.association;
        const auto after = [&](Word relation) {
            Expression* time = make_member(w_.c, w_.name(use.step->name, use.step->name.text), "T");
            return both(active(use), w_.joined(relation, time, a.time));
        };
        if (is(a, "P") || is(a, "P1")) return put(state(), begins(use));
        if (is(a, "P0")) return put(state(), ends(use));
        if (is(a, "S")) return put_when(active(use), kept("set"), true);
        if (is(a, "R")) return put_when(active(use), kept("reset"), true);
        if (is_stored_with_time(a)) return write_timed(use);
        if (is(a, "L")) put_when(active(use), state(), false);
        put_when(is(a, "L")   ? after(Word::less)
                 : is(a, "D") ? after(Word::greater_or_equal)
                              : active(use),
                 state(), true);
        put_when(ends(use), state(), false);
    }

    /// A time begins again whenever the step does.
    void write_timed(const ActionUse& use) {
        const ChartAssociation& a = *use.association;
        const auto waits = [&] { return w_.name(action_, use.kept); };
        const auto timer = [&] { return w_.kept(action_, use.kept, "timer"); };
        w_.out.push_back(w_.when(
            begins(use), {w_.set(waits(), truth(true)), w_.run(timer(), truth(false), nullptr)}));
        if (is(a, "SL")) put_when(begins(use), kept("set"), true);
        if (is(a, "DS")) put_when(ends(use), waits(), false);
        w_.out.push_back(w_.run(timer(), waits(), a.time));
        w_.out.push_back(w_.when(make_member(w_.c, timer(), "q"),
                                 {w_.set(kept(is(a, "SL") ? "reset" : "set"), truth(true)),
                                  w_.set(waits(), truth(false))}));
    }

    void write_body() {
        put(state(), w_.joined(Word::or_, state(), kept("stored")));
        Expression* call = make_call(w_.c, w_.like(action_), w_.named(action_), {});
        w_.out.push_back(w_.when(state(), {make_call_statement(w_.c, call)}));
    }

    void write_variable() {
        put_when(kept("set"), state(), true);
        put_when(kept("reset"), state(), false);
    }

    ChartWriter& w_;
    const Token& action_;
    const bool is_body_;
};

}  // namespace

void write_action_of_matiec(ChartWriter& w, const Token& action,
                            const std::vector<ActionUse>& uses) {
    MatiecAction(w, action).write(uses);
}

}  // namespace lineshaft::st
