#include "runtime/st/check/chart_writer.hpp"

namespace lineshaft::st {

std::string_view fired_name(ChartWriter& w, std::size_t number) {
    return w.part_name("transition", std::to_string(number + 1));
}

Variable* flag_of_charts(const Routine& block, std::string_view name, Kind kind) {
    const auto it = block.names.find(name);
    const bool is_flag = it != block.names.end() && it->second->type &&
                         it->second->type->kind == kind && block.pou->place.dialect().is_loose;
    return is_flag ? it->second : nullptr;
}

Expression* condition_of(ChartWriter& w, const ChartTransition& t) {
    const Token& at = t.from.front();
    Expression* condition = t.condition;
    if (flag_of_charts(w.routine, "SFCTipMode"))
        condition = w.joined(Word::and_, w.negated(w.name(at, "SFCTipMode")), condition);
    if (!flag_of_charts(w.routine, "SFCTip")) return condition;
    return w.joined(Word::or_, w.name(at, "SFCTip"), condition);
}

void write_transition_flag(ChartWriter& w, const Chart& chart) {
    if (!flag_of_charts(w.routine, "SFCTrans") || chart.transitions.empty()) return;
    const Token& at = chart.transitions.front().from.front();
    Expression* any = nullptr;
    for (std::size_t i = 0; i < chart.transitions.size(); ++i)
        any = w.joined(Word::or_, any, w.name(at, fired_name(w, i)));
    w.out.push_back(w.set(w.name(at, "SFCTrans"), any));
}

void write_current_step(ChartWriter& w, const Chart& chart) {
    if (!flag_of_charts(w.routine, "SFCCurrentStep", Kind::text)) return;
    for (const ChartStep& step : chart.steps) {
        Expression* name = make_constant(w.c, w.like(step.name), string_type,
                                         {.text = std::string(step.name.text)});
        w.out.push_back(
            w.when(w.active(step.name), {w.set(w.name(step.name, "SFCCurrentStep"), name)}));
    }
}

}  // namespace lineshaft::st
