#include "runtime/run/side_by_side.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("work is shared by as many threads as are wanted") {
    std::atomic<int> next = 0, done = 0;
    const auto work = [&] {
        while (next++ < 1000) ++done;
    };
    side_by_side(4, work, [] {});
    CHECK(done == 1000);
}

TEST_CASE("an exception stops the others and comes out after they have ended") {
    std::atomic<bool> stopped = false;
    std::atomic<int> first = 0, ended = 0;
    const auto work = [&] {
        if (first++ == 0) throw std::runtime_error("no memory");
        while (!stopped) std::this_thread::yield();
        ++ended;
    };
    CHECK_THROWS_WITH(side_by_side(3, work, [&] { stopped = true; }), "no memory");
    CHECK(ended == first - 1);
}
