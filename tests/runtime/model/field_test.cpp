#include "runtime/model/field.hpp"

#include <cstring>
#include <limits>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

enum class Mode : std::int64_t { slow, fast };
constexpr std::string_view mode_names[] = {"slow", "fast"};

struct Sample {
    bool on = false;
    double limit = 1;
    std::int64_t count = 0;
    Mode mode = Mode::slow;
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a field knows type and place of its member") {
    Sample sample{true, 2.5, -3, Mode::fast};
    const auto* bytes = reinterpret_cast<const std::byte*>(&sample);
    const Field on = input("on", &Sample::on, "", "switch");
    const Field limit = parameter("limit", &Sample::limit, "mm", "limit");
    const Field count = output("count", &Sample::count, "", "count");
    const Field mode = input("mode", &Sample::mode, "", "mode").one_of(mode_names);
    CHECK(on.type == Type::boolean);
    CHECK(load(on.type, bytes + on.offset) == Value(true));
    CHECK(limit.type == Type::real);
    CHECK(load(limit.type, bytes + limit.offset) == Value(2.5));
    CHECK(count.type == Type::integer);
    CHECK(load(count.type, bytes + count.offset) == Value(std::int64_t{-3}));
    CHECK(mode.type == Type::enumeration);
    CHECK(load(mode.type, bytes + mode.offset) == Value(std::int64_t{1}));
    CHECK(mode.names.size() == 2);
    CHECK(on.direction == Direction::input);
    CHECK(limit.direction == Direction::parameter);
    CHECK(count.direction == Direction::output);
    CHECK(limit.unit == "mm");
    CHECK(limit.doc == "limit");
}

TEST_CASE("limits are included by at_least and at_most, excluded by above and below") {
    const Field f = parameter("limit", &Sample::limit, "", "");
    CHECK(f.admits(-1e300));
    CHECK(f.admits(infinite));
    CHECK_FALSE(f.admits(not_a_number));
    CHECK_FALSE(f.above(0).admits(0));
    CHECK(f.above(0).admits(5e-324));
    CHECK(f.at_least(0).admits(0));
    CHECK_FALSE(f.at_least(0).admits(-5e-324));
    CHECK_FALSE(f.below(1).admits(1));
    CHECK(f.below(1).admits(0.9));
    CHECK(f.at_most(1).admits(1));
    CHECK_FALSE(f.at_most(1).admits(1.1));
    const Field both = f.above(0).at_most(1);
    CHECK_FALSE(both.admits(0));
    CHECK(both.admits(1));
    CHECK_FALSE(both.admits(2));
}

TEST_CASE("a changed field leaves the one it was made from") {
    const Field f = parameter("limit", &Sample::limit, "", "");
    CHECK(f.must_be_set().required);
    CHECK_FALSE(f.required);
    CHECK(f.above(3).minimum == 3);
    CHECK(f.minimum == -infinite);
}
