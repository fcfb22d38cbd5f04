#pragma once

#include <cstddef>

namespace lineshaft {

/// A problem as `planner_bench` gives it to another planner: limits and states as in
/// blocks/profile/any_state.hpp.
struct PeerProblem {
    double V, Vmin, A, D, J;  ///< Vmin < 0, D > 0
    double p0, v0, a0;        ///< from
    double pf, vf;            ///< to
    double duration;          ///< [s]; 0: the least
};

/// The three functions of the object that LINESHAFT_PEER names.
extern "C" {
/// Copies the problems into what the planner takes them from.
void* planner_peer_prepare(const PeerProblem* problems, std::size_t count);
/// Plans a problem of those: the duration [s], NaN where the planner refuses it.
double planner_peer_plan(void* prepared, std::size_t index);
void planner_peer_release(void* prepared);
}

}  // namespace lineshaft
