#include "runtime/model/literal.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

constexpr std::string_view colours[] = {"red", "green"};

Node scalar(std::string text) {
    Node node;
    node.text = std::move(text);
    return node;
}

Field field_of(Type type, std::string_view unit = {}) {
    Field field;
    field.name = "port";
    field.type = type;
    field.unit = unit;
    return field;
}

/// The value as text, else the code and message.
std::string read(const Field& field, std::string text) {
    Diagnostics out;
    const auto value =
        read_literal(Reader(out), scalar(std::move(text)), field, Unit::parse(field.unit).value());
    if (value) return format(*value);
    REQUIRE(out.list().size() == 1);
    return out.list().front().code + ": " + out.list().front().message;
}

}  // namespace

TEST_CASE("literal: each type reads its own constants") {
    CHECK(read(field_of(Type::boolean), "true") == "1");
    CHECK(read(field_of(Type::integer), "12") == "12");
    CHECK(read(field_of(Type::real, "mm"), "2 cm") == "20");
    CHECK(read(field_of(Type::enumeration).one_of(colours), "green") == "1");
}

TEST_CASE("literal: a whole number with a unit comes out whole") {
    CHECK(read(field_of(Type::integer, "pulses"), "12 pulses") == "12");
    CHECK(read(field_of(Type::integer, "ns"), "2 us") == "2000");
    CHECK(read(field_of(Type::integer, "pulses"), "1.5 pulses") ==
          "L0309: '1.5 pulses' is not a whole number of pulses for 'port'");
    CHECK(read(field_of(Type::integer, "pulses"), "12") == "L0302: '12' has no unit");
}

TEST_CASE("literal: an integer without a sign has all its values, and none below 0") {
    const Field field = field_of(Type::unsigned_integer).at_least(0);
    CHECK(read(field, "18446744073709551615") == "18446744073709551615");
    CHECK(read(field, "16#8000_0000_0000_0000") == "9223372036854775808");
    CHECK(read(field, "-1") == "L0305: '-1' is out of range for 'port'");
    CHECK(read(field_of(Type::integer), "9223372036854775808") ==
          "L0305: '9223372036854775808' is out of range for 'port'");
}

TEST_CASE("literal: names are checked") {
    CHECK(read(field_of(Type::enumeration).one_of(colours), "grean") ==
          "L0306: 'grean' is not a value of 'port'");
}

TEST_CASE("literal: limits, open and closed") {
    const Field open = field_of(Type::real).above(0).below(1);
    CHECK(read(open, "0.5") == "0.5");
    CHECK(read(open, "0") == "L0305: '0' is out of range for 'port'");
    CHECK(read(open, "1") == "L0305: '1' is out of range for 'port'");
    const Field closed = field_of(Type::integer).at_least(0).at_most(1);
    CHECK(read(closed, "0") == "0");
    CHECK(read(closed, "1") == "1");
    CHECK(read(closed, "2") == "L0305: '2' is out of range for 'port'");
}

TEST_CASE("literal: limits in words") {
    CHECK(describe_limits(field_of(Type::real), "mm").empty());
    CHECK(describe_limits(field_of(Type::real).above(0), "mm") == "above 0 mm");
    CHECK(describe_limits(field_of(Type::real).at_least(0).below(2), "") == "at least 0, below 2");
}
