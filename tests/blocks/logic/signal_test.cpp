#include "blocks/logic/signal.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <catch2/catch.hpp>
#include <sleef.h>

#include "tests/blocks/logic/scan_table.hpp"
#include "tests/blocks/scanning.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

TEST_CASE("scale is a straight line through its two points") {
    check_tables("scale", Calls::once_and_twice, {{"a card's 0 to 27648 as -10 to 10", R"(
    in     in_low in_high out_low out_high | out   error error_id
    0      0      27648   -10     10       | -10   0     none
    27648  .      .       .       .        | 10    0     none
    13824  .      .       .       .        | 0     0     none
    6912   .      .       .       .        | -5    0     none
    -6912  .      .       .       .        | -15   0     none
    41472  .      .       .       .        | 20    0     none
    41472  .      0       .       .        | 20    1     wrong_limits
    nan    .      27648   .       .        | 20    1     not_finite
    0      .      -27648  .       .        | -10   0     none
    -27648 .      .       .       .        | 10    0     none
    0      -1.7e308 1.7e308 .     .        | 10    1     overflow )"}});
}

namespace {

FilterPt1 filter_at(double out) {
    FilterPt1 filter;
    filter.in = out;
    filter.time_constant = 0.02;
    filter.scan({});
    return filter;
}

}  // namespace

TEST_CASE("a filter begins at its input, and passes on all of it without a time constant") {
    FilterPt1 filter = filter_at(5);
    CHECK(filter.out == 5);
    filter.in = 7;
    filter.time_constant = 0;
    filter.scan({.time = millisecond, .interval = {}, .index = 1});
    CHECK(filter.out == 7);
}

TEST_CASE("a filter's step response is the exponential, whatever the scans") {
    for (const std::int64_t interval : {millisecond, 3 * millisecond, 7 * millisecond + 11}) {
        FilterPt1 filter = filter_at(0);
        filter.in = 1;
        for (std::int64_t i = 1; i <= 50; ++i) {
            const std::int64_t time = i * interval;
            filter.scan({.time = time, .interval = interval, .index = i});
            INFO("interval " << interval << " ns, scan " << i);
            REQUIRE(std::abs(filter.out - (1 - std::exp(-seconds(time) / 0.02))) < 50 * epsilon);
        }
    }
}

TEST_CASE("filters that come upon each other's intervals go by their own to the last bit") {
    std::mt19937_64 draw(24);
    const std::int64_t steps[] = {0, 1, millisecond, millisecond + 1};
    const double constants[] = {0, 1e-9, 0.02, std::nextafter(0.02, 1)};
    FilterPt1 filters[3];
    std::int64_t times[3] = {};
    for (int i = 0; i < 10'000; ++i) {
        const std::size_t which = draw() % 3;
        FilterPt1& filter = filters[which];
        const std::int64_t step =
            draw() % 2 ? steps[draw() % 4] : static_cast<std::int64_t>(draw() % 4000);
        const double from = filter.started ? filter.out : 1, T = constants[draw() % 4];
        const double share = T == 0 ? 1 : -Sleef_cinz_expm1d1_u10purec(-seconds(step) / T);
        filter.in = filter.started ? static_cast<double>(draw() % 9) : 1;
        filter.time_constant = T;
        filter.scan({.time = times[which] += step, .interval = millisecond, .index = i});
        INFO("filter " << which << ", call " << i << ", " << step << " ns, T " << T << " s");
        REQUIRE(filter.out == from + (filter.in - from) * share);
    }
}

TEST_CASE("a filter called twice in a scan goes no further") {
    FilterPt1 filter = filter_at(0);
    filter.in = 1;
    filter.scan({.time = millisecond, .interval = {}, .index = 1});
    const double once = filter.out;
    filter.scan({.time = millisecond, .interval = {}, .index = 1});
    CHECK(filter.out == once);
}

TEST_CASE("a filter refuses a time constant below 0 and goes on after it") {
    FilterPt1 filter = filter_at(3);
    filter.in = 4;
    filter.time_constant = -1;
    filter.scan({.time = millisecond, .interval = {}, .index = 1});
    CHECK(filter.out == 3);
    CHECK(filter.error_id == NumberError::wrong_limits);
    filter.time_constant = 0.02;
    filter.scan({.time = 2 * millisecond, .interval = {}, .index = 2});
    CHECK_FALSE(filter.error);
    CHECK(filter.out > 3);
    CHECK(filter.out < 4);
}

TEST_CASE("a filter holds and says why when it has no result") {
    const double inf = std::numeric_limits<double>::infinity();
    const double most = std::numeric_limits<double>::max();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    struct Refused {
        double in, time_constant;
        NumberError why;
    };
    for (const auto& [in, time_constant, why] :
         {Refused{nan, 0.02, NumberError::not_finite}, Refused{-inf, 0.02, NumberError::not_finite},
          Refused{1, nan, NumberError::not_finite}, Refused{1, inf, NumberError::not_finite},
          Refused{1, -0.02, NumberError::wrong_limits},
          Refused{nan, -1, NumberError::not_finite}}) {
        INFO("in " << in << ", time constant " << time_constant);
        for (FilterPt1 filter : {FilterPt1{}, filter_at(3)}) {
            const double held = filter.out;
            filter.in = in;
            filter.time_constant = time_constant;
            for (std::int64_t i = 1; i <= 2; ++i) {
                filter.scan({.time = i * millisecond, .interval = {}, .index = i});
                CHECK(filter.error);
                CHECK(filter.error_id == why);
                CHECK(filter.out == held);
            }
        }
    }
    FilterPt1 far = filter_at(-most);
    far.in = most;
    far.scan({.time = millisecond, .interval = {}, .index = 1});
    CHECK(far.error_id == NumberError::overflow);
    CHECK(far.out == -most);
}
