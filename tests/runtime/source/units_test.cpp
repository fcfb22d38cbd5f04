#include "runtime/source/units.hpp"

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Unit unit(const std::string& text) {
    INFO(text);
    const std::optional<Unit> parsed = Unit::parse(text);
    REQUIRE(parsed.has_value());
    CHECK(parsed->text == text);
    return *parsed;
}

double in(double value, const std::string& from, const std::string& to) {
    return convert(value, unit(from), unit(to));
}

Quantity quantity(const std::string& text) {
    INFO(text);
    const auto parsed = parse_quantity(text);
    REQUIRE(std::holds_alternative<Quantity>(parsed));
    return std::get<Quantity>(parsed);
}

/// The quantity's number in `to`.
double value_in(const std::string& text, const std::string& to) {
    const Quantity parsed = quantity(text);
    return convert(parsed.number, parsed.unit, unit(to));
}

bool fails_as(std::string_view text, QuantityError error) {
    const auto parsed = parse_quantity(text);
    return std::holds_alternative<QuantityError>(parsed) &&
           std::get<QuantityError>(parsed) == error;
}

std::optional<std::int64_t> nanoseconds(const std::string& text) {
    return to_nanoseconds(quantity(text));
}

}  // namespace

TEST_CASE("every named unit has its dimension") {
    for (const char* name : {"m", "cm", "mm", "um", "nm"}) {
        CHECK(unit(name).dimension_name() == "length");
    }
    for (const char* name : {"rad", "mrad", "deg", "rev"}) {
        CHECK(unit(name).dimension_name() == "angle");
    }
    for (const char* name : {"s", "ms", "us", "ns", "min", "h"}) {
        CHECK(unit(name).dimension_name() == "time");
    }
    for (const char* name : {"Hz", "kHz", "MHz", "1/s"}) {
        CHECK(unit(name).dimension_name() == "1/time");
    }
    for (const char* name : {"pulse", "pulses"}) CHECK(unit(name).dimension_name() == "pulses");
    for (const char* name : {"%", "", "mm/m", "s*Hz"}) {
        CHECK(unit(name).dimension_name() == "number");
    }
    CHECK(unit_names().size() == 22);
    for (const std::string& name : unit_names()) unit(name);
}

TEST_CASE("units are multiplied, divided and raised") {
    CHECK(unit("mm/s").dimension_name() == "length/time");
    CHECK(unit("mm/s^3").dimension_name() == "length/time^3");
    CHECK(unit("pulses/cm").dimension_name() == "pulses/length");
    CHECK(unit("m^2*rad/s/pulse").dimension_name() == "length^2*angle/time/pulses");
    CHECK(unit("1/s^2").dimension_name() == "1/time^2");
    CHECK(unit("mm/s/s").same_dimension(unit("m/s^2")));
    CHECK(unit("mm*Hz").same_dimension(unit("mm/s")));
    CHECK(unit("m/s*s").same_dimension(unit("m")));
    CHECK_FALSE(unit("mm").same_dimension(unit("deg")));
    CHECK_FALSE(unit("rad").same_dimension(unit("")));
    CHECK_FALSE(unit("pulses").same_dimension(unit("")));
}

TEST_CASE("what is no unit") {
    for (const std::string text :
         {"x",   "inch",  "MM",  "Mm",   "hz",    "mm ",   " mm",    "mm /s", "mm/", "/s",
          "*s",  "mm//s", "mm^", "mm^0", "mm^10", "mm^-1", "mm^2^2", "1",     "1/",  "1*s",
          "2/s", "1/1",   "m/1", "^2",   "mm2",   "/",     "*",      "1//s",  "%%",  "mm\n"}) {
        INFO(text);
        CHECK_FALSE(Unit::parse(text).has_value());
    }
    CHECK_FALSE(Unit::parse(std::string("m\0", 2)).has_value());
    CHECK_FALSE(Unit::parse(std::string(100'000, 'm')).has_value());
    CHECK_FALSE(Unit::parse("nm^9*nm^9*nm^9*nm^9*nm^9*nm^9*nm^9*nm^9*nm^9*nm^9").has_value());
    CHECK(Unit::parse("mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm*mm").has_value());
}

TEST_CASE("conversions by whole and decimal ratios carry no rounding noise") {
    CHECK(in(2, "cm", "mm") == 20);
    CHECK(in(3, "ms", "s") == 0.003);
    CHECK(in(1.005, "m", "mm") == 1005);
    CHECK(in(0.57, "m", "cm") == 57);
    CHECK(in(4.35, "m", "cm") == 435);
    CHECK(in(5, "mm/s", "m/s") == 0.005);
    CHECK(in(50'000, "mm/s^3", "m/s^3") == 50);
    CHECK(in(10, "pulses/cm", "pulses/mm") == 1);
    CHECK(in(20, "%", "") == 0.2);
    CHECK(in(0.07, "", "%") == 7);
    CHECK(in(2.5, "kHz", "Hz") == 2500);
    CHECK(in(2, "kHz", "1/ms") == 2);
    CHECK(in(1.1, "min", "s") == 66);
    CHECK(in(0.1, "h", "min") == 6);
    CHECK(in(3, "mrad", "rad") == 0.003);
    CHECK(in(7, "pulse", "pulses") == 7);
    CHECK(in(1, "m^3", "nm^3") == 1e27);
    CHECK(in(-1.005, "m", "mm") == -1005);
    CHECK(in(1e300, "m", "mm") == 1e303);
    CHECK(in(123.456, "mm", "mm") == 123.456);
}

TEST_CASE("ratios that are no decimals are rounded once") {
    CHECK(in(90, "min", "h") == 1.5);
    CHECK(in(90, "s", "min") == 1.5);
    CHECK(in(1, "s", "min") == 1.0 / 60);
    CHECK(in(60, "m/min", "mm/s") == 1000);
    CHECK(in(3, "m/min", "mm/s") == 50);
    CHECK(in(0.7, "s", "h") == 0.7 / 3600);
}

TEST_CASE("a turn is 360 degrees exactly and 2 pi as a double") {
    CHECK(in(1, "rev", "deg") == 360);
    CHECK(in(90, "deg", "rev") == 0.25);
    CHECK(in(0.1, "rev", "deg") == 36);
    CHECK(in(600, "rev/min", "rev/s") == 10);
    CHECK(in(600, "rev/min", "deg/s") == 3600);
    CHECK(in(1000, "pulses/rev", "pulses/deg") == Approx(1000.0 / 360).epsilon(1e-15));
    CHECK(in(1, "rev", "rad") == 2 * std::numbers::pi);
    CHECK(in(180, "deg", "rad") == std::numbers::pi);
    CHECK(in(std::numbers::pi, "rad", "deg") == 180);
    CHECK(in(1, "deg^2", "rad^2") == Approx(std::pow(std::numbers::pi / 180, 2)).epsilon(1e-15));
}

TEST_CASE("extremes stay what they are") {
    CHECK(in(0, "m", "mm") == 0);
    CHECK(std::signbit(in(-0.0, "m", "mm")));
    CHECK(std::signbit(in(-0.0, "min", "s")));
    CHECK(in(infinity, "m", "mm") == infinity);
    CHECK(in(-infinity, "s", "min") == -infinity);
    CHECK(std::isnan(in(std::nan(""), "m", "mm")));
    CHECK(in(1.7e308, "m", "mm") == infinity);
    CHECK(in(1.7e308, "m/min", "mm/s") == infinity);
    CHECK(in(1.7e308, "h", "min/s*s") == infinity);
    CHECK(in(5e-324, "nm", "m") == 0);
    CHECK(in(5e-324, "m", "m") == 5e-324);
}

TEST_CASE("decimal conversions agree with exact arithmetic on many numbers") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100'000; ++i) {
        const auto micrometres = static_cast<std::int64_t>(random() % 1'000'000'000'000);
        const double millimetres = std::stod(std::to_string(micrometres / 1000) + "." +
                                             std::to_string(1000 + micrometres % 1000).substr(1));
        REQUIRE(in(millimetres, "mm", "um") == static_cast<double>(micrometres));
        REQUIRE(in(static_cast<double>(micrometres), "um", "mm") == millimetres);
    }
}

TEST_CASE("numbers as C++ reads them, and with a plus") {
    const auto number = [](const std::string& text) { return quantity(text).number; };
    CHECK(number("5") == 5);
    CHECK(number("-5") == -5);
    CHECK(number("+5") == 5);
    CHECK(number("0") == 0);
    CHECK(number("0.5") == 0.5);
    CHECK(number(".5") == 0.5);
    CHECK(number("-.5") == -0.5);
    CHECK(number("5.") == 5);
    CHECK(number("1e3") == 1000);
    CHECK(number("1E+3") == 1000);
    CHECK(number("1.5e-3") == 0.0015);
    CHECK(number("0e5") == 0);
    CHECK(number("1_000.000_1") == 1000.0001);
    CHECK(number("1e1_0") == 1e10);
    CHECK(number("1.7976931348623157e308") == std::numeric_limits<double>::max());
    CHECK(number("5e-324") == 5e-324);
    CHECK(number("0." + std::string(400, '0') + "1e401") == 1);
    CHECK(number(std::string("1") + std::string(5000, '0') + "e-5000") == 1);
}

TEST_CASE("integers are kept exactly") {
    const auto integer = [](const std::string& text) {
        CHECK(quantity(text).is_integer);
        return quantity(text).integer;
    };
    CHECK(integer("5") == 5);
    CHECK(integer("+5 mm") == 5);
    CHECK(integer("-7") == -7);
    CHECK(integer("-0") == 0);
    CHECK(integer("1_000_000") == 1'000'000);
    CHECK(integer("9223372036854775807") == std::numeric_limits<std::int64_t>::max());
    CHECK(integer("-9223372036854775808") == std::numeric_limits<std::int64_t>::min());
    CHECK(integer("16#E0") == 0xE0);
    CHECK(integer("16#e_0") == 0xE0);
    CHECK(integer("2#1010_0001") == 0xA1);
    CHECK(integer("8#017") == 15);
    CHECK(integer("16#7FFF_FFFF_FFFF_FFFF") == std::numeric_limits<std::int64_t>::max());
    CHECK(quantity("16#10 ms").unit.text == "ms");
    CHECK(quantity("16#10").number == 16);
    CHECK(integer("9223372036854775808") == std::uint64_t{1} << 63);
    CHECK(integer("18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
    CHECK(integer("16#FFFF_FFFF_FFFF_FFFF") == std::numeric_limits<std::uint64_t>::max());
    CHECK_FALSE(quantity("18446744073709551616").is_integer);
    CHECK_FALSE(quantity("-9223372036854775809").is_integer);
    CHECK(quantity("9223372036854775808").number == 9223372036854775808.0);
    CHECK(quantity("16#FFFF_FFFF_FFFF_FFFF").number == 18446744073709551615.0);
    for (const char* text : {"5.", "5.0", "5e0", ".5"}) CHECK_FALSE(quantity(text).is_integer);
}

TEST_CASE("a unit follows with or without spaces") {
    for (const std::string text : {"2ms", "2 ms", "2   ms"}) {
        CHECK(quantity(text).number == 2);
        CHECK(quantity(text).has_unit);
        CHECK(quantity(text).unit.text == "ms");
    }
    CHECK(quantity("5mm/s").unit.text == "mm/s");
    CHECK(quantity("5e4 mm/s^3").number == 5e4);
    CHECK(quantity("5e4mm/s^3").unit.text == "mm/s^3");
    CHECK(quantity("5.mm").number == 5);
    CHECK(quantity("5 1/s").unit.text == "1/s");
    CHECK(quantity("20%").has_unit);
    CHECK(quantity("20 %").unit.dimension_name() == "number");
    CHECK_FALSE(quantity("20").has_unit);
    CHECK(quantity("20").unit.text.empty());
    CHECK_FALSE(quantity("20 ").has_unit);
    CHECK(value_in("2 cm", "mm") == 20);
    CHECK(value_in("20 %", "") == 0.2);
    CHECK(value_in("20", "") == 20);
}

TEST_CASE("what does not begin with a number") {
    for (const std::string text :
         {"",       " ",    " 5",  "fast", ".",        "+",     "-",    "+-5", "--5",   "-.",
          "e3",     ".e3",  "_1",  "010",  "00",       "-010",  "+00",  "0_1", "01.5",  "nan",
          "NaN",    "-nan", "inf", "-inf", "infinity", "#",     "#5",   "16#", "16#G",  "16#_1",
          "-16#10", "2#2",  "3#1", "10#5", "0#1",      "1_6#1", "2#12", "mm",  "$speed"}) {
        INFO("'" << text << "'");
        CHECK(fails_as(text, QuantityError::not_a_number));
    }
    CHECK(fails_as(std::string_view("\0"
                                    "5",
                                    2),
                   QuantityError::not_a_number));
}

TEST_CASE("a number with something that is no unit") {
    for (const std::string text : {"5 x",   "5mmm",  "0x10",  "5 mm s", "1.2.3", "5..2",  "5e",
                                   "5e+",   "1_",    "1__0",  "5 ,",    "5,5",   "5 1",   ".5#1",
                                   "5 mm ", "5\tmm", "5 mm/", "1e3e3",  "5 nan", "3'000", "5 #"}) {
        INFO(text);
        CHECK(fails_as(text, QuantityError::unknown_unit));
    }
    CHECK(fails_as(std::string_view("5\0", 2), QuantityError::unknown_unit));
    CHECK(fails_as("5 " + std::string(100'000, 'm'), QuantityError::unknown_unit));
}

TEST_CASE("a number beyond a double's range") {
    for (const std::string text : {"1e309", "-1e309 mm", "1e99999999999", "1e-400", "1e-400 mm",
                                   "16#1_0000_0000_0000_0000"}) {
        INFO(text);
        CHECK(fails_as(text, QuantityError::out_of_range));
    }
    CHECK(fails_as(std::string(100'000, '9'), QuantityError::out_of_range));
}

TEST_CASE("times are whole nanoseconds, exactly") {
    CHECK(nanoseconds("1.25 ms") == 1'250'000);
    CHECK(nanoseconds("0.1 s") == 100'000'000);
    CHECK(nanoseconds("2ms") == 2'000'000);
    CHECK(nanoseconds("-3 us") == -3000);
    CHECK(nanoseconds("0 s") == 0);
    CHECK(nanoseconds("0.0 s") == 0);
    CHECK(nanoseconds("-0.0 s") == 0);
    CHECK(nanoseconds("0e300 s") == 0);
    CHECK(nanoseconds("7 ns") == 7);
    CHECK(nanoseconds("0.001 us") == 1);
    CHECK(nanoseconds("1e-9 s") == 1);
    CHECK(nanoseconds("1.5 h") == 5'400'000'000'000);
    CHECK(nanoseconds("0.1 min") == 6'000'000'000);
    CHECK(nanoseconds("9000000.1 s") == 9'000'000'100'000'000);
    CHECK(nanoseconds("123456.789012345 s") == 123'456'789'012'345);
    CHECK(nanoseconds("0.30000000000000004 s") == std::nullopt);
    CHECK(nanoseconds("0.1000000000000000000000001 s") == 100'000'000);
    CHECK(nanoseconds("2 1/kHz") == 2'000'000);
    CHECK(nanoseconds("5 ms^2/s") == 5000);
}

TEST_CASE("times that are none") {
    CHECK(nanoseconds("1") == std::nullopt);
    CHECK(nanoseconds("1 mm") == std::nullopt);
    CHECK(nanoseconds("1 Hz") == std::nullopt);
    CHECK(nanoseconds("1 s^2") == std::nullopt);
    CHECK(nanoseconds("0.5 ns") == std::nullopt);
    CHECK(nanoseconds("1e-10 s") == std::nullopt);
    CHECK(nanoseconds("5e-324 s") == std::nullopt);
    CHECK(nanoseconds("1 ns/s*ns") == std::nullopt);
    CHECK(nanoseconds("1 deg*s/rad") == std::nullopt);
    Quantity none = quantity("1 s");
    none.is_integer = false;
    for (const double value : {infinity, -infinity, std::nan("")}) {
        none.number = value;
        CHECK(to_nanoseconds(none) == std::nullopt);
    }
}

TEST_CASE("times end at 292 years") {
    CHECK(nanoseconds("9200000000 s") == 9'200'000'000'000'000'000);
    CHECK(nanoseconds("-9200000000 s") == -9'200'000'000'000'000'000);
    CHECK(nanoseconds("9200000000000000000 ns") == 9'200'000'000'000'000'000);
    CHECK(nanoseconds("9200000000000000001 ns") == std::nullopt);
    CHECK(nanoseconds("-9200000000000000001 ns") == std::nullopt);
    CHECK(nanoseconds("9200000001 s") == std::nullopt);
    CHECK(nanoseconds("9223372036854775807 h") == std::nullopt);
    CHECK(nanoseconds("-9223372036854775808 h") == std::nullopt);
    CHECK(nanoseconds("1e300 s") == std::nullopt);
    CHECK(nanoseconds("-1e300 ns") == std::nullopt);
}

TEST_CASE("every decimal time of nine places is exact") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 100'000; ++i) {
        const auto value = static_cast<std::int64_t>(random() % 1'000'000'000'000'000);
        const std::string text = std::to_string(value / 1'000'000'000) + "." +
                                 std::to_string(1'000'000'000 + value % 1'000'000'000).substr(1);
        REQUIRE(nanoseconds(text + " s") == value);
        REQUIRE(nanoseconds("-" + text + "s") == -value);
    }
}

TEST_CASE("numbers are written shortest and read back the same") {
    CHECK(format_number(0.1) == "0.1");
    CHECK(format_number(1) == "1");
    CHECK(format_number(-0.0) == "-0");
    CHECK(format_number(1e22) == "1e+22");
    CHECK(format_number(5e-324) == "5e-324");
    CHECK(format_number(-1.7976931348623157e308) == "-1.7976931348623157e+308");
    std::mt19937_64 random(3);
    for (int i = 0; i < 100'000; ++i) {
        const std::uint64_t bits = random();
        double value = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isfinite(value)) continue;
        REQUIRE(quantity(format_number(value)).number == value);
    }
}

TEST_CASE("the locale changes nothing") {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "C.UTF-8"}) {
        if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
    CHECK(quantity("1.5 mm").number == 1.5);
    CHECK(fails_as("1,5 mm", QuantityError::unknown_unit));
    CHECK(format_number(1.5) == "1.5");
    CHECK(in(1.005, "m", "mm") == 1005);
    std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("times are written in seconds, exactly") {
    CHECK(format_time(0) == "0 s");
    CHECK(format_time(12'345'000'000) == "12.345 s");
    CHECK(format_time(1) == "0.000000001 s");
    CHECK(format_time(10'000'000'000) == "10 s");
    CHECK(format_time(100'000'000) == "0.1 s");
    CHECK(format_time(9'007'199'254'740'993) == "9007199.254740993 s");
    CHECK(format_time(9'200'000'000'000'000'001) == "9200000000.000000001 s");
}
