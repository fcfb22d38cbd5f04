#include <limits>
#include <vector>

#include <ruckig/ruckig.hpp>

#include "tools/bench/planner_peer.hpp"

/// Ruckig behind the functions of planner_peer.hpp; `peers` compiles it with Ruckig's sources.
namespace {

struct Prepared {
    ruckig::Ruckig<1> planner;
    ruckig::Trajectory<1> trajectory;
    std::vector<ruckig::InputParameter<1>> inputs;
};

ruckig::InputParameter<1> input(const lineshaft::PeerProblem& p) {
    ruckig::InputParameter<1> in;
    in.max_velocity = {p.V};
    in.min_velocity = {{p.Vmin}};
    in.max_acceleration = {p.A};
    in.min_acceleration = {{-p.D}};
    in.max_jerk = {p.J};
    in.current_position = {p.p0};
    in.current_velocity = {p.v0};
    in.current_acceleration = {p.a0};
    in.target_position = {p.pf};
    in.target_velocity = {p.vf};
    if (p.duration > 0) in.minimum_duration = p.duration;
    return in;
}

}  // namespace

namespace lineshaft {

void* planner_peer_prepare(const PeerProblem* problems, std::size_t count) {
    auto* prepared = new Prepared;
    for (std::size_t i = 0; i < count; ++i) prepared->inputs.push_back(input(problems[i]));
    return prepared;
}

double planner_peer_plan(void* prepared, std::size_t index) {
    auto& all = *static_cast<Prepared*>(prepared);
    const ruckig::Result result = all.planner.calculate(all.inputs[index], all.trajectory);
    return result == ruckig::Result::Working ? all.trajectory.get_duration()
                                             : std::numeric_limits<double>::quiet_NaN();
}

void planner_peer_release(void* prepared) {
    delete static_cast<Prepared*>(prepared);
}

}  // namespace lineshaft
