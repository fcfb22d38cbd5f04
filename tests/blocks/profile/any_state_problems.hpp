#pragma once

#include "tests/blocks/profile/any_state_reference.hpp"

/// Problems from any state: at random, and at the edges of what a plan can be.
namespace lineshaft::reference {

using oracle::Random;

inline MotionLimits limits_of(const Problem& p) {
    MotionLimits limits;
    limits.set(p.V, p.Vmin, p.A, p.D, p.J);
    return limits;
}

inline PlanResult plan_of(const Problem& p, MotionPlan& out, const PlanOptions& options = {}) {
    return plan(limits_of(p), {p.p0, p.v0, p.a0, 0}, {p.pf, p.vf}, out, options);
}

/// The velocity once a0 is at zero.
inline double turned(const Problem& p) {
    return p.v0 + p.a0 * std::abs(p.a0) / (2 * p.J);
}

inline Problem random_limits(Random& r) {
    Problem p;
    p.J = r.decades(-1, 5);
    p.A = r.decades(-1, 4);
    p.D = r.one_in(2) ? p.A : p.A * r.decades(-1, 1);
    p.V = p.A * p.A / p.J * r.decades(-1.5, 1.5);
    p.Vmin = r.one_in(2) ? -p.V : -p.V * r.decades(-1, 1);
    return p;
}

inline void random_way(Random& r, Problem& p) {
    const double size = p.V * ramp_duration(p.V, std::min(p.A, p.D), p.J);
    p.p0 = r.one_in(2) ? 0 : size * r.between(-10, 10);
    p.pf = p.p0 + r.sign() * size * r.decades(-3, 1);
}

inline void random_start(Random& r, Problem& p) {
    do {
        p.v0 = r.between(p.Vmin, p.V);
        p.a0 = r.one_in(3) ? 0 : r.between(-p.D, p.A);
    } while (turned(p) > p.V || turned(p) < p.Vmin);
}

inline Problem any(Random& r) {
    Problem p = random_limits(r);
    p.vf = r.one_in(3) ? 0 : r.between(p.Vmin, p.V);
    random_start(r, p);
    random_way(r, p);
    return p;
}

inline Problem mirrored(Problem p) {
    for (double* x : {&p.p0, &p.v0, &p.a0, &p.pf, &p.vf}) *x = -*x;
    std::swap(p.V, p.Vmin);
    p.V = -p.V;
    p.Vmin = -p.Vmin;
    std::swap(p.A, p.D);
    return p;
}

/// A state within a motion becomes the start.
inline Problem under_way(Problem p, double share) {
    MotionPlan out;
    if (plan_of(p, out) != PlanResult::ok) return p;
    const MotionState s = out.at(out.duration * share);
    p.p0 = s.position;
    p.v0 = s.velocity;
    p.a0 = s.acceleration;
    return p;
}

/// The goal is where the direct ramp ends.
inline Problem direct(Problem p) {
    State s{p.p0, p.v0, p.a0};
    for (const Piece& piece : ramp(s, p.vf, {p.V, p.A, p.D, p.J}))
        s = s.after(piece.time, piece.jerk);
    p.pf = static_cast<double>(s.x);
    return p;
}

inline Problem dip(Random& r) {
    Problem p = random_limits(r);
    do {
        p.v0 = r.between(p.Vmin, p.V);
        p.a0 = -p.D * r.unit();
        p.vf = r.between(p.Vmin, p.V);
    } while (turned(p) > p.V || turned(p) < p.Vmin || p.vf >= turned(p));
    p = direct(p);
    const double tau = p.a0 / p.J;
    p.pf += std::abs(tau * p.v0) * r.decades(-6, 0);
    return p;
}

struct Family {
    std::string name;
    Problem (*make)(Random&);
    double bar = 1e-12;  ///< relative, over a limit
    bool outside = false;
    Entry entry = Entry::gentle;
};

inline std::vector<Family> gentle_families() {
    return {
        {"random", any},
        {"rest target",
         [](Random& r) {
             Problem p = any(r);
             p.v0 = p.a0 = p.vf = 0;
             return p;
         }},
        {"vf = v0 = V",
         [](Random& r) {
             Problem p = any(r);
             p.vf = p.v0 = p.V;
             p.a0 = 0;
             return r.one_in(2) ? p : mirrored(p);
         }},
        {"way of the direct ramp", [](Random& r) { return direct(any(r)); }},
        {"one ulp beside the direct ramp",
         [](Random& r) {
             Problem p = direct(any(r));
             p.pf = std::nextafter(p.pf, r.sign() * HUGE_VAL);
             return p;
         }},
        {"a0 = A",
         [](Random& r) {
             Problem p = any(r);
             p.a0 = p.A;
             p.v0 = r.between(p.Vmin, p.V) - p.A * p.A / (2 * p.J);
             return p.v0 < p.Vmin ? any(r) : p;
         }},
        {"a0 = -D",
         [](Random& r) {
             Problem p = any(r);
             p.a0 = -p.D;
             p.v0 = r.between(p.Vmin, p.V) + p.D * p.D / (2 * p.J);
             return p.v0 > p.V ? any(r) : p;
         }},
        {"a0 just reaches V",
         [](Random& r) {
             Problem p = any(r);
             p.a0 = p.A * r.decades(-9, 0);
             p.v0 = p.V - p.a0 * p.a0 / (2 * p.J);
             return p.v0 < p.Vmin ? any(r) : r.one_in(2) ? p : mirrored(p);
         }},
        {"tiny way",
         [](Random& r) {
             Problem p = any(r);
             p.pf = p.p0 + (p.pf - p.p0) * r.decades(-15, -3);
             return p;
         }},
        {"no way",
         [](Random& r) {
             Problem p = any(r);
             p.pf = p.p0;
             return p;
         }},
        {"scales",
         [](Random& r) {
             Problem p = any(r);
             const double length = r.decades(-6, 6), time = r.decades(-6, 6);
             for (double* x : {&p.p0, &p.pf}) *x *= length;
             for (double* x : {&p.v0, &p.vf, &p.V, &p.Vmin}) *x *= length / time;
             for (double* x : {&p.a0, &p.A, &p.D}) *x *= length / time / time;
             p.J *= length / time / time / time;
             return p;
         }},
        {"moving away",
         [](Random& r) {
             Problem p = any(r);
             if ((p.pf - p.p0) * p.v0 > 0) p.pf = 2 * p.p0 - p.pf;
             return p;
         }},
        {"velocity outside",
         [](Random& r) {
             Problem p = any(r);
             p.v0 = p.V * (1 + r.decades(-6, 1));
             if (r.one_in(2)) p.a0 = r.between(-p.D, p.A);
             return r.one_in(2) ? p : mirrored(p);
         },
         1e-12, true},
        {"acceleration outside",
         [](Random& r) {
             Problem p = any(r);
             p.a0 = r.one_in(2) ? p.A * (1 + r.decades(-6, 1)) : -p.D * (1 + r.decades(-6, 1));
             return p;
         },
         1e-12, true},
        {"velocity and acceleration outside",
         [](Random& r) {
             Problem p = any(r);
             p.v0 = p.V * (1 + r.decades(-6, 1));
             if (r.one_in(2))
                 p.a0 = r.one_in(2) ? p.A * (1 + r.decades(-6, 1)) : -p.D * (1 + r.decades(-6, 1));
             else  // about Vmin is passed on the other side
                 p.a0 = -std::sqrt(2 * p.J * (p.v0 - p.Vmin)) * (1 + r.sign() * r.decades(-6, 0));
             return r.one_in(2) ? p : mirrored(p);
         },
         1e-12, true},
        {"velocity lowered under way",
         [](Random& r) {
             Problem p = under_way(any(r), r.unit());
             p.V *= r.unit();
             p.vf = std::min(p.vf, p.V);
             return p;
         },
         1e-12, true},
        {"another goal under way",
         [](Random& r) {
             Problem p = under_way(any(r), r.unit());
             random_way(r, p);
             return p;
         }},
        {"dip", dip},
        {"dip backwards", [](Random& r) { return mirrored(dip(r)); }},
        {"asymmetric limits",
         [](Random& r) {
             Problem p = random_limits(r);
             p.D = p.A * r.decades(-4, 4);
             p.Vmin = -p.V * r.decades(-4, 4);
             p.vf = r.one_in(2) ? 0 : r.between(p.Vmin, p.V);
             random_start(r, p);
             random_way(r, p);
             return p;
         },
         1e-10},
        {"far from zero",
         [](Random& r) {
             Problem p = any(r);
             const double offset = p.pf * r.sign() * r.decades(3, 9);
             p.p0 += offset;
             p.pf += offset;
             return p;
         }},
        {"tiny vf",
         [](Random& r) {
             Problem p = any(r);
             p.vf *= r.decades(-16, -3);
             return p;
         }},
        {"last moments", [](Random& r) { return under_way(any(r), 1 - r.decades(-9, -1)); }},
    };
}

/// Those that start outside their limits with either way back.
inline const std::vector<Family>& families() {
    static const std::vector<Family> list = [] {
        std::vector<Family> all = gentle_families();
        for (std::size_t i = 0, count = all.size(); i < count; ++i) {
            if (!all[i].outside) continue;
            all.push_back(all[i]);
            all.back().name += ", soonest";
            all.back().entry = Entry::soonest;
        }
        return all;
    }();
    return list;
}

}  // namespace lineshaft::reference
