#include "blocks/path/path_frame.hpp"

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("path_frame: it turns about z, the new y and the newest x, then moves") {
    const PathFrame about_z = PathFrame::of({50, 20, 0}, {0, 0, 90});
    CHECK(about_z.place({10, 0, 7, 30}) == PathVector{50, 30, 7, 30});
    CHECK(about_z.direction({0, 10}) == PathVector{-10, 0});
    CHECK(PathFrame::of({}, {0, 90, 0}).direction({1, 0, 0}) == PathVector{0, 0, -1});
    CHECK(PathFrame::of({}, {90, 0, 0}).direction({0, 1, 0}) == PathVector{0, 0, 1});
    CHECK(PathFrame::of({}, {0, 90, 90}).direction({0, 0, 1}) == PathVector{0, 1, 0});
    CHECK(PathFrame::of({}, {0, 0, -270}) == PathFrame::of({}, {0, 0, 90}));
    CHECK(PathFrame::of({}, {0, 0, 30}).turn[0][0] == Approx(std::sqrt(0.75)).epsilon(1e-15));
}

TEST_CASE("path_frame: lengths stay, curves turn as their points do, and the inverse leads back") {
    std::mt19937_64 numbers(11);
    const auto number = [&] { return static_cast<double>(numbers() >> 11) * 0x1p-43 - 512; };
    for (int problem = 0; problem < 500; ++problem) {
        INFO("problem " << problem);
        const PathFrame frame =
            PathFrame::of({number(), number(), number()}, {number(), number(), number()});
        const PathVector a{number(), number(), number(), number()};
        const PathVector b{number(), number(), number(), number()};
        const PathVector there = frame.inverse().place(frame.place(a));
        for (std::size_t i = 0; i < most_path_axes; ++i)
            CHECK(there[i] == Approx(a[i]).margin(1e-11));
        PathCurve arc;
        if (arc_through(in_space(a), {number(), number(), number()}, in_space(b), arc) !=
            PathFault::none)
            continue;
        let_follow(arc, a, b);
        const PathCurve turned = frame.curve(arc);
        CHECK(turned.length == arc.length);
        for (const double part : {0.0, 0.3, 1.0}) {
            const PathVector x = turned.at(part * arc.length).position;
            const PathVector y = frame.place(arc.at(part * arc.length).position);
            for (std::size_t i = 0; i < most_path_axes; ++i)
                CHECK(x[i] == Approx(y[i]).margin(1e-9 * (1 + arc.radius)));
        }
    }
}
