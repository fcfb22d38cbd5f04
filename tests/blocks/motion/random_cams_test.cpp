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

constexpr double whole_turn = 360;

/// A modulo master that runs one way, and a slave that is coupled to it by a cam or a gear while it
/// stands, or in one of its first turns.
struct Coupled {
    enum class By { periodic_cam, single_cam, gear };

    By by = By::periodic_cam;
    double start = 0, speed = 0;         ///< of the master [deg], [deg/s]
    double middle = 180, height = 50;    ///< of the cam [deg], [mm]
    CamCurve curve = CamCurve::quintic;  ///< of the cam
    double from = 0, A = 1e5, J = 0;     ///< of the slave
    std::int64_t coupled = 0, run = 0;   ///< [ms]
    int turns = 1;                       ///< in sync

    std::vector<CamPoint> points() const;
    std::string program() const;
};

Coupled draw_coupled(std::uint64_t seed) {
    oracle::Random random{seed};
    Coupled c;
    using By = Coupled::By;
    c.by = random.one_in(4) ? By::gear : random.one_in(2) ? By::single_cam : By::periodic_cam;
    c.start = random.between(5, 355);
    c.speed = random.sign() * random.between(100, 700);
    c.middle = random.between(90, 270);
    c.height = random.sign() * random.between(10, 60);
    c.curve = random.one_in(2) ? CamCurve::cubic : CamCurve::quintic;
    c.from = random.one_in(2) ? 0 : random.between(-20, 20);
    c.J = random.one_in(3) ? 0 : random.decades(6, 7.5);
    c.run = static_cast<std::int64_t>(random.between(1, 50));
    c.coupled = random.one_in(2) ? 1 : c.run + static_cast<std::int64_t>(random.between(1, 9000));
    c.turns = random.one_in(2) ? 1 : 2;
    return c;
}

std::vector<CamPoint> Coupled::points() const {
    std::vector<CamPoint> points{
        {0, 0, 0, NAN, curve}, {middle, height, 0, NAN, curve}, {whole_turn, 0, 0, NAN, curve}};
    REQUIRE(complete_cam(points, by == By::periodic_cam).fault == CamFault::none);
    return points;
}

std::string Coupled::program() const {
    const bool geared = by == By::gear;
    const std::string_view unit = geared ? "deg" : "mm",
                           way = curve == CamCurve::cubic ? "cubic" : "quintic";
    std::string text = fmt::format(
        "tasks: {{main: {{every: 1 ms}}}}\nblocks:\n"
        "  m: {{type: axis, task: main, unit: deg, modulo: true, period: 360 deg, start_position: "
        "{0} deg, default_acceleration: 10000 deg/s^2, default_deceleration: 10000 deg/s^2, "
        "default_jerk: 0 deg/s^3}}\n"
        "  s: {{type: axis, task: main, unit: {1}, {2}start_position: {3} {1}, default_velocity: "
        "1e4 {1}/s, default_acceleration: {4} {1}/s^2, default_deceleration: {4} {1}/s^2, "
        "default_jerk: {5} {1}/s^3}}\n"
        "  table: {{type: cam_table, task: main, master_unit: deg, periodic: {6}, points: [[0 deg, "
        "0 mm, 0 mm/deg, ~, {7}], [{8} deg, {9} mm, 0 mm/deg, ~, {7}], [360 deg, 0 mm, 0 "
        "mm/deg]]}}\n"
        "  run: {{type: MC_MoveVelocity, task: main, Axis: m, Velocity: {10} deg/s}}\n",
        start, unit, geared ? "modulo: true, period: 360 deg, " : "",
        geared ? std::abs(from) : from, A, J, by == By::periodic_cam, way, middle, height, speed);
    if (geared) return text + "  go: {type: MC_GearInPos, task: main, Master: m, Slave: s}\n";
    return text +
           fmt::format(
               "  select: {{type: MC_CamTableSelect, task: main, Master: m, Slave: s, CamTable: "
               "table, Execute: true, Periodic: {}}}\n"
               "  go: {{type: MC_CamIn, task: main, Master: m, Slave: s, CamTableID: "
               "select.CamTableID, MasterSyncPosition: {} deg}}\n",
               by == By::periodic_cam, by == By::single_cam && speed < 0 ? whole_turn : 0);
}

enum class CamEnd { in_sync, refused, never };

struct CamJudged {
    CamEnd end = CamEnd::never;
    std::string broken;  ///< what did not hold, and when; empty: nothing
};

/// How far a slave that stands has to turn round for an acceleration that it is to begin
/// with.
double needed_way(const Coupled& c, const Cam& cam) {
    double bend = 0;
    for (const CamPoint& p : {cam.points.front(), cam.points.back()})
        bend = std::max(bend, std::abs(cam.at(p.x).bend) + std::abs(cam.last().bend));
    const double a = bend * c.speed * c.speed;
    return 1e-3 + (c.J > 0 ? 100 * a * a * a / c.J / c.J : 0);
}

class CamJudge {
  public:
    explicit CamJudge(const Coupled& coupled)
        : c_(coupled), points_(coupled.points()), cam_{points_, false}, bench_(coupled.program()) {}

    CamJudged judge() {
        const auto most = std::max(c_.coupled, c_.run) + 6000 +
                          static_cast<std::int64_t>(5 * whole_turn / std::abs(c_.speed) * 1000);
        bool ended = false;
        for (std::int64_t i = 0; i < most && found_.broken.empty() && !ended; ++i) {
            if (i == c_.coupled) bench_.set("go.Execute", true);
            if (i == c_.run) bench_.set("run.Execute", true);
            bench_.step();
            if (c_.by != Coupled::By::gear && bench_.is("go.EndOfProfile")) ++ends_;
            if (bench_.is("go.Error")) return {CamEnd::refused, {}};
            ended = look(i);
        }
        if (found_.broken.empty() && ended) found_.end = CamEnd::in_sync;
        if (found_.broken.empty() && !ended) breaks("is not in sync", 0, 1);
        return found_;
    }

  private:
    void breaks(std::string_view what, double value, double due) {
        if (found_.broken.empty())
            found_.broken = fmt::format("{} at {} ms: {} for {}", what, bench_.now(), value, due);
    }

    /// Whether all has been seen.
    bool look(std::int64_t i) {
        const Axis& slave = bench_.axis("s");
        const double master = bench_.axis("m").total().position, y = slave.total().position;
        if (i < std::max(c_.coupled, c_.run)) from_ = master;
        const bool follows = slave.doing == Axis::Doing::following_axes;
        if (!follows || slave.sync.stage != SyncMotion::Stage::in_sync) {
            if (std::abs(master - from_) > 2 * whole_turn + 1)
                breaks("not in sync after the way", master - from_, 2 * whole_turn);
            if (c_.by != Coupled::By::gear) look_at_way(y);
            return false;
        }
        if (!synced_) synced_at_ = whole_turn * std::round(master / whole_turn);
        synced_ = true;
        const double way = std::abs(master - synced_at_);
        look_in_sync(master, y, way);
        return way > whole_turn * c_.turns + 90;
    }

    void look_at_way(double y) {
        const double more = needed_way(c_, cam_) + std::abs(c_.from) / 8;
        if (y < std::min(0.0, c_.from) - more) breaks("too far down", y, -more);
        if (y > std::max(0.0, c_.from) + more) breaks("too far up", y, more);
    }

    void look_in_sync(double master, double y, double way) {
        const double x = within_period(master, whole_turn);
        if (c_.by == Coupled::By::gear) {
            const double beside = within_period(y - x + 180, whole_turn) - 180;
            if (std::abs(beside) > 1e-9) breaks("beside the gear", y, x);
            return;
        }
        const bool over = c_.by == Coupled::By::single_cam && way >= whole_turn;
        const double due = over ? 0 : cam_.at(x).y;
        if (std::abs(y - due) > 1e-9) breaks("beside the cam", y, due);
        const double whole = c_.by == Coupled::By::single_cam
                                 ? std::min(1.0, std::floor(way / whole_turn))
                                 : std::floor(way / whole_turn);
        const double scan = std::abs(c_.speed) * 2e-3;
        if (std::fmod(way, whole_turn) > scan && ends_ != static_cast<int>(whole))
            breaks("ends of the profile", ends_, whole);
    }

    const Coupled& c_;
    std::vector<CamPoint> points_;
    Cam cam_;
    MotionBench bench_;
    CamJudged found_;
    double from_ = 0, synced_at_ = 0;
    bool synced_ = false;
    int ends_ = 0;
};

}  // namespace

TEST_CASE("random cams: a slave gets in sync whenever it is coupled, wherever its master runs") {
    const char* only = std::getenv("LINESHAFT_SEED");
    const auto first = static_cast<std::uint64_t>(count_of("LINESHAFT_SEED", 1));
    const auto count = static_cast<std::uint64_t>(count_of("LINESHAFT_CAMS", only ? 1 : 60));
    std::uint64_t in_sync = 0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const Coupled coupled = draw_coupled(seed);
        const CamJudged judged = CamJudge(coupled).judge();
        in_sync += judged.end == CamEnd::in_sync;
        if (judged.broken.empty()) continue;
        oracle::print_failure(judged.broken,
                              fmt::format("seed {}, coupled at {} ms, run at {} ms:\n{}", seed,
                                          coupled.coupled, coupled.run, coupled.program()));
        FAIL("seed " << seed << ": " << judged.broken);
    }
    if (std::getenv("LINESHAFT_FIGURES")) fmt::print("{} of {} in sync\n", in_sync, count);
    if (!only) CHECK(in_sync > count - count / 8);
}
