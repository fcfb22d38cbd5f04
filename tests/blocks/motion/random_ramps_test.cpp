#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/motion/synchronous.hpp"
#include "tests/blocks/motion/bench.hpp"
#include "tests/blocks/profile/oracle.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr double scan = 1e-3, turn = 100;

/// A slave that is led onto a periodic cam while its master runs, or comes to run.
struct RampIn {
    double speed = 0, A = 0, J = 0;            ///< of the master
    double middle = 50, height = 30;           ///< of the cam
    double from = 0, times = 0, hardness = 0;  ///< of the slave: its limits over those of the cam
    std::int64_t coupled = 0;                  ///< [ms]

    std::vector<CamPoint> points() const;
    Dynamics limits() const;
    std::string program() const;
};

RampIn draw_ramp_in(std::uint64_t seed) {
    oracle::Random random{seed};
    RampIn r;
    r.speed = random.sign() * random.between(20, 200);
    r.A = random.decades(2.5, 3.5);
    r.J = random.one_in(4) ? 0 : random.decades(4, 5);
    r.middle = random.between(30, 70);
    r.height = random.sign() * random.between(5, 40);
    r.from = random.between(-60, 60);
    r.times = random.between(2, 5);
    r.hardness = random.between(3, 20);
    r.coupled = random.one_in(3) ? static_cast<std::int64_t>(random.between(1, 100))
                                 : static_cast<std::int64_t>(random.between(500, 4000));
    return r;
}

std::vector<CamPoint> RampIn::points() const {
    constexpr CamCurve quintic = CamCurve::quintic;
    std::vector<CamPoint> points{
        {0, 0, 0, 0, quintic}, {middle, height, 0, 0, quintic}, {turn, 0, 0, 0, quintic}};
    REQUIRE(complete_cam(points, true).fault == CamFault::none);
    return points;
}

/// While a master is at its velocity the cam takes a part of them.
Dynamics RampIn::limits() const {
    const std::vector<CamPoint> all = points();
    const Cam cam{all, true};
    double slope = 0, bend = 0, twist = 0;
    for (double x = 0; x < turn; x += 0.1) {
        const CurvePoint p = cam.at(x);
        slope = std::max(slope, std::abs(p.slope));
        bend = std::max(bend, std::abs(p.bend));
        twist = std::max(twist, std::abs(p.twist));
    }
    const double v = std::abs(speed), master_jerk = J > 0 ? J : A / scan;
    Dynamics d;
    d.velocity = times * slope * v;
    d.acceleration = d.deceleration = times * (bend * v * v + slope * A);
    d.jerk = hardness * (twist * v * v * v + 3 * bend * v * A + slope * master_jerk);
    return d;
}

std::string RampIn::program() const {
    const Dynamics d = limits();
    return fmt::format(
        "tasks: {{main: {{every: 1 ms}}}}\nblocks:\n"
        "  m: {{type: axis, task: main, default_acceleration: {0} mm/s^2, default_deceleration: "
        "{0} mm/s^2, default_jerk: {1} mm/s^3}}\n"
        "  s: {{type: axis, task: main, start_position: {2} mm, default_velocity: {3} mm/s, "
        "default_acceleration: {4} mm/s^2, default_deceleration: {4} mm/s^2, default_jerk: {5} "
        "mm/s^3}}\n"
        "  table: {{type: cam_table, task: main, periodic: true, points: [[0 mm, 0 mm, 0, 0 1/mm, "
        "quintic], [{6} mm, {7} mm, 0, 0 1/mm, quintic], [{8} mm, 0 mm, 0, 0 1/mm]]}}\n"
        "  run: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {9} mm/s, Execute: true}}\n"
        "  select: {{type: MC_CamTableSelect, task: main, Master: m, Slave: s, CamTable: table, "
        "Execute: true, Periodic: true}}\n"
        "  go: {{type: MC_CamIn, task: main, Master: m, Slave: s, CamTableID: select.CamTableID, "
        "StartMode: mcRampIn}}\n",
        A, J, from, d.velocity, d.acceleration, d.jerk, middle, height, turn, speed);
}

class RampJudge {
  public:
    explicit RampJudge(const RampIn& ramp)
        : ramp_(ramp),
          limits_(ramp.limits()),
          points_(ramp.points()),
          cam_{points_, true},
          bench_(ramp.program()) {}

    /// What did not hold, and when; empty: nothing.
    std::string judge() {
        constexpr std::int64_t most = 20'000;
        for (std::int64_t i = 0; i < ramp_.coupled + most && broken_.empty(); ++i) {
            if (i == ramp_.coupled) bench_.set("go.Execute", true);
            bench_.step();
            if (bench_.is("go.Error")) return "is refused";
            if (i > ramp_.coupled) look();
            if (bench_.axis("s").sync.stage == SyncMotion::Stage::in_sync && i > ramp_.coupled)
                return broken_;
            last_ = bench_.axis("s").total();
            led_ = law();
        }
        return broken_.empty() ? "is not in sync" : broken_;
    }

  private:
    MotionState law() const {
        const MotionState master = bench_.axis("m").total();
        return cam_.at(within_period(master.position, turn)).led_by(master);
    }

    void look() {
        const MotionState now = bench_.axis("s").total();
        const bool arrives = bench_.axis("s").sync.stage == SyncMotion::Stage::in_sync;
        // A scan cannot foresee by how much the jerk of the cam changes within it.
        const double unforeseen = arrives ? std::abs(law().jerk - led_.jerk) : 0;
        keeps("velocity", now.velocity, limits_.velocity);
        keeps("acceleration", now.acceleration, limits_.acceleration);
        keeps("jerk", (now.acceleration - last_.acceleration) / scan, limits_.jerk + unforeseen);
        const double mean = 0.5 * (now.acceleration + last_.acceleration);
        keeps("velocity and acceleration", (now.velocity - last_.velocity) / scan - mean,
              0.5 * (limits_.jerk + unforeseen) * scan);
        if (arrives && std::abs(now.position - law().position) > 1e-9)
            broken_ = fmt::format("beside the cam at {} ms", bench_.now());
        if (!arrives && !bench_.is("go.StartSync") && bench_.is("go.Active"))
            broken_ = fmt::format("no StartSync at {} ms", bench_.now());
    }

    void keeps(std::string_view what, double value, double most) {
        if (std::abs(value) <= most * (1 + 1e-9) + 1e-9 * limits_.acceleration) return;
        broken_ = fmt::format("{} at {} ms: {} for {}", what, bench_.now(), value, most);
    }

    const RampIn& ramp_;
    Dynamics limits_;
    std::vector<CamPoint> points_;
    Cam cam_;
    MotionBench bench_;
    MotionState last_, led_;
    std::string broken_;
};

}  // namespace

TEST_CASE("random ramps: a slave gets onto its cam within its limits, in every scan") {
    const char* only = std::getenv("LINESHAFT_SEED");
    const auto first = static_cast<std::uint64_t>(count_of("LINESHAFT_SEED", 1));
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_RAMPS", only ? 1 : 60));
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const RampIn ramp = draw_ramp_in(seed);
        const std::string broken = RampJudge(ramp).judge();
        if (broken.empty()) continue;
        oracle::print_failure(broken, fmt::format("seed {}, coupled at {} ms:\n{}", seed,
                                                  ramp.coupled, ramp.program()));
        FAIL("seed " << seed << ": " << broken);
    }
}
