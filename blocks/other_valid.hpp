#pragma once

#include "blocks/circle/circle_fit.hpp"
#include "blocks/circle/path_move.hpp"
#include "blocks/contour/contour_comparison.hpp"
#include "blocks/contour/contour_error.hpp"
#include "blocks/logic/counter.hpp"
#include "blocks/logic/edge.hpp"
#include "blocks/logic/signal.hpp"
#include "blocks/logic/timer.hpp"
#include "blocks/pulse/pto.hpp"
#include "runtime/model/kept_state.hpp"

/// Which states that were kept blocks can go on with that command no axis.
namespace lineshaft {

template <bool falling>
bool is_valid(const Edge<falling>& edge, const KeptState&) {
    return are_booleans(edge.last);
}

template <TimerKind kind>
bool is_valid(const Timer<kind>& timer, const KeptState& machine) {
    return are_booleans(timer.running, timer.last_in, timer.keeps_pt, timer.answers_later) &&
           machine.is_moment(timer.start);
}

bool is_valid(const Ctu& counter, const KeptState&);
bool is_valid(const Ctd& counter, const KeptState&);
bool is_valid(const Ctud& counter, const KeptState&);
bool is_valid(const FilterPt1& filter, const KeptState& machine);
bool is_valid(const CircleFit& fit, const KeptState&);
bool is_valid(const PathMove& move, const KeptState& machine);
bool is_valid(const ContourError& error, const KeptState&);
bool is_valid(const ContourComparison& comparison, const KeptState&);
bool is_valid(const Pto& output, const KeptState& machine);

}  // namespace lineshaft
