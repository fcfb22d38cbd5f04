#include "blocks/profile/any_state.hpp"

#include <cstdlib>
#include <limits>

#include <catch2/catch.hpp>

#include "tests/blocks/profile/any_state_problems.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::reference;
using oracle::Quad;

namespace {

std::string line(const Problem& p) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "Problem{%.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g}",
                  p.p0, p.v0, p.a0, p.pf, p.vf, p.V, p.Vmin, p.A, p.D, p.J);
    return text;
}

/// The length of the path within a time in which the acceleration keeps its sign.
double path_within(double v, double a, double j, double d) {
    const double end = d * (v + d * (a / 2 + d * j / 6));
    const double last = v + d * (a + d * j / 2);
    if (v * last >= 0) return std::abs(end);
    const double root = std::sqrt(std::max(a * a - 2 * j * v, 0.0));
    const double t = 2 * -v / (a + std::copysign(root, a == 0 ? last - v : a));
    const double turn = t * (v + t * (a / 2 + t * j / 6));
    return std::abs(turn) + std::abs(end - turn);
}

double path_of(double v, double a, double j, double d) {
    const double turn = j == 0 ? 0 : -a / j;
    if (!(turn > 0 && turn < d)) return path_within(v, a, j, d);
    return path_within(v, a, j, turn) + path_within(v + turn * (a + turn * j / 2), 0, j, d - turn);
}

/// The phases run blindly in quadruple precision.
struct Run {
    double position = 0, velocity = 0;  ///< errors at the end [ulp]
    double over = 0;  ///< greatest relative excess over a limit, once inside, or on a detour there
};

/// An acceleration outside its limits that does not come back as fast as it can.
bool strays(const Problem& p, double a, double j) {
    const double least = p.J * (1 - 1e-9);
    return (a > p.A * (1 + 1e-12) && -j < least) || (-a > p.D * (1 + 1e-12) && j < least);
}

Run run(const Problem& p, const MotionPlan& out, const Family& family, bool timed = false) {
    Run result;
    Quad x = p.p0, v = p.v0, a = p.a0;
    double path = 0;
    bool inside = false;
    const bool outside = family.outside;
    const Quad kept = reference::inside(p, family.entry).kept;
    const double swing = outside ? std::max(std::abs(p.v0), std::abs(turned(p))) : 0;
    const double push = outside ? std::abs(p.a0) : 0;
    const auto look = [&](Quad velocity, Quad acceleration) {
        const auto w = static_cast<double>(velocity), b = static_cast<double>(acceleration);
        const double turn = w + b * std::abs(b) / (2 * p.J);
        inside = inside || (std::max(w, turn) <= p.V * (1 + 1e-13) && b <= p.A && b >= -p.D &&
                            std::min(w, turn) >= p.Vmin * (1 + 1e-13));
        if (!inside) return;
        result.over = std::max({result.over, (w - p.V) / std::max(p.V, swing),
                                (p.Vmin - w) / std::max(-p.Vmin, swing),
                                (b - p.A) / std::max(p.A, push), (-b - p.D) / std::max(p.D, push)});
    };
    look(v, a);
    Quad begin = 0;
    for (std::size_t i = 0; i < out.count; ++i) {
        const Quad d = out.phases[i].duration, j = out.phases[i].start.jerk;
        if (std::abs(static_cast<double>(j)) > p.J * (1 + 1e-9)) result.over = 1;
        if (!inside && strays(p, static_cast<double>(a), static_cast<double>(j))) result.over = 1;
        const Quad from = inside || begin > kept ? Quad(0) : kept - begin;
        begin += d;
        if (from < d && !inside) {
            inside = true;
            look(v + from * (a + from * j / 2), a + from * j);
        }
        path += path_of(static_cast<double>(v), static_cast<double>(a), static_cast<double>(j),
                        static_cast<double>(d));
        if (const Quad turn = j == 0 ? Quad(0) : -a / j; turn > from && turn < d)
            look(v + turn * (a + turn * j / 2), 0);
        x += d * (v + d * (a / 2 + d * j / 6));
        v += d * (a + d * j / 2);
        a += d * j;
        look(v, a);
    }
    const double top = std::max({p.V, -p.Vmin, std::abs(p.v0), std::abs(turned(p))});
    // A given duration takes the mean of two motions that go as far as they can; a state outside
    // its limits leaves a rounding of its velocity, which counts over the whole duration.
    const double far = outside || timed ? top * out.duration : path;
    const double size = std::max({std::abs(p.p0), std::abs(p.pf), far});
    result.position = std::abs(static_cast<double>(x - p.pf)) / oracle::ulp(size);
    result.velocity = std::abs(static_cast<double>(v - p.vf)) / oracle::ulp(top);
    return result;
}

struct Figures {
    std::vector<float> position, velocity;  ///< [ulp]
    double over = 0, late = 0;
    long failed = 0;

    void fail(const std::string& why, const Problem& p) {
        if (++failed <= 5) oracle::print_failure(why, line(p));
    }

    static double percentile(std::vector<float>& list, double share) {
        const auto n = static_cast<double>(list.size() - 1);
        const auto middle = list.begin() + static_cast<long>(share * n);
        std::nth_element(list.begin(), middle, list.end());
        return *middle;
    }

    void print(const char* title) {
        if (std::getenv("LINESHAFT_FIGURES") == nullptr) return;
        std::fprintf(
            stderr,
            "%-32s %8zu, position p50 %.2f p99 %5.2f max %8.1f ulp, velocity p99 %5.2f max "
            "%7.1f ulp, over %.1e, late %.1e, %ld failed\n",
            title, position.size(), percentile(position, 0.5), percentile(position, 0.99),
            percentile(position, 1), percentile(velocity, 0.99), percentile(velocity, 1), over,
            late, failed);
    }
};

void check(const Problem& p, const Family& family, Figures& figures) {
    MotionPlan out;
    if (plan_of(p, out, {family.entry, 64}) != PlanResult::ok)
        return figures.fail("not planned", p);
    if (out.end.position != p.pf || out.end.velocity != p.vf || out.end.acceleration != 0)
        figures.fail("not at the goal", p);
    for (std::size_t i = 0; i < out.count; ++i)
        if (!(out.phases[i].duration > 0)) figures.fail("a phase without duration", p);
    const Run r = run(p, out, family);
    figures.position.push_back(static_cast<float>(r.position));
    figures.velocity.push_back(static_cast<float>(r.velocity));
    figures.over = std::max(figures.over, r.over);
    if (!(r.over <= family.bar)) figures.fail("over a limit by " + std::to_string(r.over), p);
    const double wrong = family.bar / std::numeric_limits<double>::epsilon();
    if (!(r.position <= wrong && r.velocity <= wrong)) figures.fail("misses the goal", p);
    const double late = out.duration / duration(p, 0, family.entry) - 1;
    figures.late = std::max(figures.late, late);
    if (!(late <= 1e-9)) figures.fail("late by " + std::to_string(late), p);
}

}  // namespace

TEST_CASE("from any state to any goal in the least time", "[any_state]") {
    const long count = test::count_of("LINESHAFT_PROBLEMS", 1500);
    const auto seed = static_cast<std::uint64_t>(test::count_of("LINESHAFT_SEED", 21));
    const char* const chosen = std::getenv("LINESHAFT_FAMILY");
    for (const Family& family : families()) {
        if (chosen != nullptr && family.name != chosen) continue;
        Random random{seed};
        Figures figures;
        for (long i = 0; i < count; ++i) check(family.make(random), family, figures);
        INFO(family.name << ", seed " << seed);
        CHECK(figures.failed == 0);
        figures.print(family.name.c_str());
    }
}

namespace {

struct Stream {
    Problem p;
    MotionLimits limits;
    MotionPlan plan;
    double scan = 1e-3;  ///< [s]

    bool begin(Random& r, bool others) {
        if (others) {
            p = Problem{};
            p.J = r.decades(2, 5);
            p.A = p.D = r.decades(1, 4);
            if (r.one_in(2)) p.D *= r.decades(-0.5, 0.5);
            p.V = p.A * r.decades(-1.5, 0);
            p.Vmin = r.one_in(2) ? -p.V : -p.V * r.decades(-0.5, 0.5);
            limits = limits_of(p);
        }
        p.pf = p.V * r.between(-1, 1);
        p.vf = r.one_in(2) ? 0 : 0.5 * r.between(p.Vmin, p.V);
        return again();
    }

    bool again() {
        const PlanOptions options{Entry::gentle, 1024};
        return lineshaft::plan(limits, {p.p0, p.v0, p.a0, 0}, {p.pf, p.vf}, plan, options) ==
               PlanResult::ok;
    }

    /// One scan on; false when the goal has been reached.
    bool on() {
        if (plan.duration <= scan) return false;
        const MotionState s = plan.at(scan);
        p.p0 = s.position;
        p.v0 = s.velocity;
        p.a0 = s.acceleration;
        return true;
    }
};

}  // namespace

TEST_CASE("planned anew every scan, a motion neither turns off nor sticks", "[any_state]") {
    const long scans = test::count_of("LINESHAFT_SCANS", 200000);
    Random random{static_cast<std::uint64_t>(test::count_of("LINESHAFT_SEED", 7))};
    long failures = 0, detours = 0, goals = 0, over = 0;
    double worst = 0;
    Stream s;
    const auto report = [&](long& count, const char* what) {
        if (++count <= 3) oracle::print_failure(what, line(s.p));
    };
    for (long scan = 0; scan < scans;) {
        const bool others = goals % 20 == 0;
        s.scan = std::array{0.2e-3, 1e-3, 4e-3}[random.next() % 3];
        if (!s.begin(random, others)) report(failures, "not planned");
        ++goals;
        const auto stop = random.one_in(3) ? random.next() % 200 : 1000000;
        for (std::uint64_t i = 0; i < stop && scan < scans; ++i, ++scan) {
            const Problem before = s.p;
            const double left = s.plan.duration - s.scan;
            if (!s.on()) {
                s.p.p0 = s.p.pf;
                s.p.v0 = s.p.vf;
                s.p.a0 = 0;
                break;
            }
            if (!s.again()) report(failures, "not planned");
            const double growth = s.plan.duration - left;
            worst = std::max(worst, growth);
            if (!(growth <= 1e-6)) report(detours, "a detour");
            if (!(std::abs(s.p.a0 - before.a0) <= s.p.J * s.scan * (1 + 1e-9)))
                report(over, "jerk");
        }
    }
    CHECK(failures == 0);
    CHECK(detours == 0);
    CHECK(over == 0);
    CHECK(goals > scans / 20000);
    if (std::getenv("LINESHAFT_FIGURES") != nullptr)
        std::fprintf(stderr, "%ld scans, %ld goals, duration grows by %.1e s at most\n", scans,
                     goals, worst);
}

TEST_CASE("a given duration is kept, or the next feasible one is", "[any_state]") {
    const long count = test::count_of("LINESHAFT_PROBLEMS", 1500) / 10;
    const auto seed = static_cast<std::uint64_t>(test::count_of("LINESHAFT_SEED", 23));
    long blocked = 0;
    std::size_t most = 0;
    for (const Family& family : families()) {
        Random random{seed};
        Figures figures;
        for (long i = 0; i < count; ++i) {
            const Problem p = family.make(random);
            const PlanOptions options{family.entry, 64};
            MotionPlan least, out;
            if (plan_of(p, least, options) != PlanResult::ok) continue;
            const double asked =
                least.duration * (random.one_in(4) ? 1 : 1 + random.decades(-6, 2));
            if (plan(limits_of(p), {p.p0, p.v0, p.a0, 0}, {p.pf, p.vf}, asked, out, options) !=
                PlanResult::ok) {
                figures.fail("not planned", p);
                continue;
            }
            most = std::max(most, out.count);
            const Run r = run(p, out, family, true);
            figures.position.push_back(static_cast<float>(r.position));
            figures.velocity.push_back(static_cast<float>(r.velocity));
            figures.over = std::max(figures.over, r.over);
            const double wrong = family.bar / std::numeric_limits<double>::epsilon();
            if (!(r.over <= family.bar)) figures.fail("over a limit", p);
            if (!(r.position <= wrong && r.velocity <= wrong)) figures.fail("misses the goal", p);
            if (!(out.duration >= asked)) figures.fail("sooner than asked for", p);
            if (out.duration <= asked * (1 + 1e-12)) continue;
            ++blocked;
            if (!(out.duration <= duration(p, asked, family.entry) * (1 + 1e-9)))
                figures.fail("later than feasible", p);
        }
        INFO(family.name << ", seed " << seed);
        CHECK(figures.failed == 0);
        figures.print(family.name.c_str());
    }
    CHECK(blocked > 0);
    if (std::getenv("LINESHAFT_FIGURES") != nullptr)
        std::fprintf(stderr, "%ld durations blocked, %zu phases at most\n", blocked, most);
}

TEST_CASE("a plan says what it cannot do and is not written then", "[any_state]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    MotionLimits limits;
    REQUIRE(limits.set(2, -1, 4, 3, 10) == PlanResult::ok);
    for (const double bad : {0.0, -1.0, nan, inf}) {
        CHECK(limits.set(bad, -1, 4, 3, 10) == PlanResult::limit_not_positive);
        CHECK(limits.set(2, -bad, 4, 3, 10) == PlanResult::limit_not_positive);
        CHECK(limits.set(2, -1, bad, 3, 10) == PlanResult::limit_not_positive);
        CHECK(limits.set(2, -1, 4, bad, 10) == PlanResult::limit_not_positive);
        CHECK(limits.set(2, -1, 4, 3, bad) == PlanResult::limit_not_positive);
    }
    CHECK(limits.set(2, -1, 1e308, 3, 1e-308) == PlanResult::not_finite);
    CHECK(limits.side[0].V == 2);
    MotionPlan out;
    REQUIRE(plan(limits, {}, {5, 0}, out) == PlanResult::ok);
    const double duration = out.duration;
    for (const double bad : {nan, inf, -inf}) {
        CHECK(plan(limits, {bad, 0, 0, 0}, {5, 0}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {0, bad, 0, 0}, {5, 0}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {0, 0, bad, 0}, {5, 0}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {}, {bad, 0}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {}, {5, bad}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {}, {5, 0}, bad, out) == PlanResult::not_finite);
    }
    CHECK(plan(limits, {}, {5, 2.5}, out) == PlanResult::velocity_above_limit);
    CHECK(plan(limits, {}, {5, -1.5}, out) == PlanResult::velocity_above_limit);
    for (const double huge : {1e308, -1e308}) {
        CHECK(plan(limits, {huge, 0, 0, 0}, {-huge, 0}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {0, huge, 0, 0}, {5, 0}, out) == PlanResult::not_finite);
        CHECK(plan(limits, {0, 0, huge, 0}, {5, 0}, out) == PlanResult::not_finite);
    }
    // An acceleration limit 120 decades below the rest: the way back would take 1e120 s.
    REQUIRE(limits.set(1, -2, 0x1p-399, 1, 4) == PlanResult::ok);
    CHECK(plan(limits, {2, -1.0001, 0.5, 0}, {-3, -0.5}, out) == PlanResult::not_finite);
    CHECK(plan(limits, {2, -1.0001, 0.5, 0}, {-3, -0.5}, 9, out) == PlanResult::not_finite);
    CHECK(out.duration == duration);
}

TEST_CASE("a goal beside the end of the direct ramp loses no digits", "[any_state]") {
    for (const Problem& p : {
             Problem{0.6528473273379396, 1.3848704785435331, -9.5279708373075991,
                     0.78703933072734222, 0, 118.98444094878565, -716.44986302238851,
                     88.133133768632959, 88.133133768632959, 32.776432772275527},
             Problem{-95.543140272823138, 10.454575332983609, -10.037780443064946,
                     -88.284022515133998, 0, 1887.0873838815312, -16199.286868371153,
                     180.51968032044422, 484.08552479463805, 4.8188010040578462},
         }) {
        Figures figures;
        check(p, families().front(), figures);
        CHECK(figures.failed == 0);
    }
}

TEST_CASE("a state of a plan is on its way as exactly as rounding allows", "[any_state]") {
    Random random{27};
    for (int i = 0; i < 2000; ++i) {
        const Problem p = any(random);
        MotionPlan out, again;
        REQUIRE(plan_of(p, out, {Entry::gentle, 1024}) == PlanResult::ok);
        Problem q = p;
        const double t = out.duration * random.between(0.01, 0.9999);
        const MotionState s = out.at(t);
        q.p0 = s.position;
        q.v0 = s.velocity;
        q.a0 = s.acceleration;
        INFO(line(p) << ", at " << t);
        REQUIRE(plan_of(q, again, {Entry::gentle, 1024}) == PlanResult::ok);
        REQUIRE(std::abs(again.duration - (out.duration - t)) <= 1e-9 * out.duration);
    }
}

TEST_CASE("the example of a dip and of a lowered velocity", "[any_state]") {
    MotionLimits limits;
    MotionPlan out;
    REQUIRE(limits.set(10, -10, 10, 10, 1) == PlanResult::ok);
    REQUIRE(plan(limits, {0, 4, -2, 0}, {5.063, 0}, out) == PlanResult::ok);
    CHECK(out.duration == Approx(3.2577).margin(1e-4));
    REQUIRE(out.count == 3);
    CHECK(out.phases[0].duration == Approx(0.724).margin(1e-3));
    CHECK(out.phases[1].duration == Approx(0.629).margin(1e-3));
    CHECK(out.phases[2].duration == Approx(1.905).margin(1e-3));

    REQUIRE(limits.set(1, -1, 2, 2, 2) == PlanResult::ok);
    MotionPlan soonest;
    REQUIRE(plan(limits, {0, 3, 0, 0}, {20, 0}, out) == PlanResult::ok);
    REQUIRE(plan(limits, {0, 3, 0, 0}, {20, 0}, soonest, {Entry::soonest, 64}) == PlanResult::ok);
    double least = 3, least_soonest = 3;
    for (double t = 0; t < out.duration - 2; t += 1e-3) {
        least = std::min(least, out.at(t).velocity);
        least_soonest = std::min(least_soonest, soonest.at(t).velocity);
    }
    CHECK(least == Approx(1));
    CHECK(least_soonest < 0.5);
    CHECK(out.at(1.4).velocity > 1);
    CHECK(soonest.at(1.5).velocity <= 1);
}

TEST_CASE("a velocity that must fall past the other limit is brought back from there",
          "[any_state]") {
    const Family soonest{"", nullptr, 1e-12, true, Entry::soonest};
    const std::pair<Problem, double> examples[] = {
        {{0, 1.1, -1.5, -4, -0.5, 1, -1, 1, 1, 0.5}, 6.3639},
        {{0, 1.1, -2.2, -20, 0, 1, -1, 3, 3, 1}, 22.2517},
        {{0, 1.1, -1.5, 0, 0.3, 1, -1, 1, 1, 0.5}, 9.4995},
    };
    for (const auto& [example, duration] : examples) {
        for (const Problem& p : {example, mirrored(example)}) {
            INFO(line(p));
            Figures figures;
            check(p, soonest, figures);
            CHECK(figures.failed == 0);
            MotionPlan out;
            REQUIRE(plan_of(p, out, {Entry::soonest, 64}) == PlanResult::ok);
            CHECK(out.duration == Approx(duration).margin(1e-4));
        }
    }
}

TEST_CASE("a plan is evaluated from state to state without jumps, to its exact end",
          "[any_state]") {
    Random random{26};
    for (int i = 0; i < 2000; ++i) {
        const Problem p = any(random);
        MotionPlan out;
        REQUIRE(plan_of(p, out) == PlanResult::ok);
        INFO(line(p));
        if (out.count == 0) continue;
        CHECK(out.at(-1).position == p.p0);
        CHECK(out.at(0).velocity == p.v0);
        CHECK(out.at(out.duration).position == p.pf);
        CHECK(out.at(out.duration).velocity == p.vf);
        std::size_t phase = 0;
        for (int k = 0; k <= 100; ++k) {
            const double t = out.duration * k / 100;
            REQUIRE(out.at(t, phase).position == out.at(t).position);
        }
        const double size = std::max({std::abs(p.p0), std::abs(p.pf), p.V * out.duration});
        for (std::size_t k = 1; k < out.count; ++k) {
            const double t = out.phases[k].begin;
            const double before = std::nextafter(t, 0.0);
            CHECK(std::abs(out.at(t).position - out.at(before).position) <= 1e-13 * size);
        }
    }
}
