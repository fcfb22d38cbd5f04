#include "runtime/source/formula.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

std::optional<Amount> names(std::string_view name) {
    if (name == "a") return 2;
    if (name == "b_2") return 5;
    if (name == "early.fit.mean_deviation") return 0.01;
    return {};
}

double value(std::string_view formula) {
    const FormulaResult result = evaluate(formula, names);
    INFO(formula << ": " << result.error);
    REQUIRE(result.error.empty());
    return result.amount.value;
}

void check_error(std::string_view formula, std::string_view error, std::size_t position) {
    const FormulaResult result = evaluate(formula, names);
    INFO(formula);
    CHECK(result.error == error);
    CHECK(result.position == position);
}

}  // namespace

TEST_CASE("products bind before sums, and both from left to right") {
    CHECK(value("1 + 2 * 3") == 7);
    CHECK(value("2 * 3 + 1") == 7);
    CHECK(value("10 - 4 - 3") == 3);
    CHECK(value("24 / 4 / 3") == 2);
    CHECK(value("24 / 4 * 3") == 18);
    CHECK(value("(1 + 2) * 3") == 9);
    CHECK(value("1 - 2 / 4") == 0.5);
}

TEST_CASE("a minus may stand before any factor") {
    CHECK(value("-3 + 1") == -2);
    CHECK(value("-(1 + 2) * -2") == 6);
    CHECK(value("--4") == 4);
    CHECK(value("2 - -3") == 5);
    CHECK(value("-2 * 3") == -6);
}

TEST_CASE("numbers are decimal, with or without point and exponent") {
    CHECK(value("0.25") == 0.25);
    CHECK(value(".5") == 0.5);
    CHECK(value("2.") == 2);
    CHECK(value("1e-3") == 1e-3);
    CHECK(value("1.5E2") == 150);
    CHECK(value("  7\n") == 7);
}

TEST_CASE("names have letters, digits, underscores and points") {
    CHECK(value("1 - a / b_2") == 0.6);
    CHECK(value("early.fit.mean_deviation * 100") == 1);
}

TEST_CASE("functions take their arguments' values") {
    CHECK(value("abs(-3)") == 3);
    CHECK(value("sqrt(16)") == 4);
    CHECK(value("min(3, 1, 2)") == 1);
    CHECK(value("max(3, 1 + 7, 2)") == 8);
    CHECK(value("mean(1, 2, 6)") == 3);
    CHECK(value("max(1)") == 1);
    CHECK(value("abs (min(-a, 4))") == 2);
}

TEST_CASE("a division by zero and a root of a negative number have no finite value") {
    CHECK(std::isinf(value("1 / 0")));
    CHECK(std::isnan(value("0 / 0")));
    CHECK(std::isnan(value("sqrt(-1)")));
}

TEST_CASE("a mistake is named where it stands") {
    check_error("1 + x", "the name 'x' is not known", 4);
    check_error("", "a number, a name or '(' is expected here", 0);
    check_error("1 +", "a number, a name or '(' is expected here", 3);
    check_error("(1 + 2", "')' is missing", 6);
    check_error("1 2", "'2' is not expected here", 2);
    check_error("2a", "'a' is not expected here", 1);
    check_error("1 + * 2", "a number, a name or '(' is expected here", 4);
    check_error("1)", "')' is not expected here", 1);
    const std::string known =
        "; known: abs(x), sqrt(x), exp(x), ln(x), sin(x), cos(x), tan(x), asin(x), acos(x), "
        "atan(x), atan2(y, x), min, max and mean";
    check_error("root(2)", "there is no function 'root' of one value" + known, 0);
    check_error("2 * abs(1, 2)", "there is no function 'abs' of 2 values" + known, 4);
    check_error("min()", "a number, a name or '(' is expected here", 4);
    check_error("1e999", "this is not a number", 0);
    check_error(".", "this is not a number", 0);
    check_error("1 % 2", "'2' is not expected here", 4);
}

TEST_CASE("only the first mistake is told") {
    check_error("x + y", "the name 'x' is not known", 0);
    check_error("(x", "the name 'x' is not known", 1);
    check_error("min(x, (", "the name 'x' is not known", 4);
}

TEST_CASE("a formula may be 100 levels deep, no more") {
    const auto nested = [](std::size_t depth) {
        return std::string(depth, '(') + "1" + std::string(depth, ')');
    };
    CHECK(value(nested(90)) == 1);
    CHECK(evaluate(nested(101), names).error == "the formula is nested too deep");
    CHECK(evaluate(nested(1'000'000), names).error == "the formula is nested too deep");
    const std::string minuses(1'000'000, '-');
    CHECK(evaluate(minuses, names).error == "the formula is nested too deep");
}

namespace {

std::optional<Amount> parameters(std::string_view name) {
    if (name == "$speed") return Amount(10, *Unit::parse("mm/s"));
    if (name == "$radius") return Amount(20, *Unit::parse("mm"));
    if (name == "$share") return Amount(20, *Unit::parse("%"));
    if (name == "$n") return 3;
    return {};
}

std::string text(std::string_view formula) {
    const FormulaResult result = evaluate(formula, parameters);
    INFO(formula << ": " << result.error);
    CHECK(result.error.empty());
    return result.amount.text();
}

}  // namespace

TEST_CASE("a formula reckons with units, and its result is a quantity again") {
    CHECK(text("$speed * 2") == "20 mm/s");
    CHECK(text("$radius / 2 + 1 mm") == "11 mm");
    CHECK(text("1 cm + $radius") == "3 cm");
    CHECK(text("$radius / $speed") == "2 s");
    CHECK(text("$speed * 500 ms") == "0.005 m");
    CHECK(text("$radius / 5 mm") == "4");
    CHECK(text("1 / 20 ms") == "50 1/s");
    CHECK(text("$share * 50 mm") == "0.01 m");
    CHECK(text("2 * $share") == "40 %");
    CHECK(text("sqrt($radius * $radius)") == "0.02 m");
    CHECK(text("max($radius, 3 cm)") == "30 mm");
    CHECK(text("cos(60 deg) * 2") == "1");
    CHECK(text("$n * 0.1 s") == "0.3 s");
    CHECK(text("sin(0) - 0") == "0");
    CHECK(text("-$n*2") == "-6");
    CHECK(text("2 * 5 1/s^2") == "10 1/s^2");
    CHECK(text("10 mm/2") == "5 mm");
    CHECK(text("1e4 mm/s^2/2") == "5000 mm/s^2");
}

TEST_CASE("what does not go together in a formula is told where it stands") {
    const auto error = [](std::string_view formula) { return evaluate(formula, parameters).error; };
    CHECK(error("$speed + 1 mm") == "mm/s and mm do not go together");
    CHECK(error("$radius + 1") == "mm and a plain number do not go together");
    CHECK(error("min($radius, $speed)") == "mm and mm/s do not go together");
    CHECK(error("cos($radius)") == "cos takes an angle or a plain number, not mm");
    CHECK(error("exp(1 rad)") == "exp takes a plain number, not rad");
    CHECK(error("sqrt($radius)") == "there is no square root of mm");
    CHECK(error("$n * sped") == "the name 'sped' is not known");
    CHECK(evaluate("1 + $radius", parameters).position == 2);
}

TEST_CASE("what is a formula is neither a name, a quantity nor a wire") {
    for (const char* formula : {"$speed * 2", "2*$speed", "cos(0.02)", "-($n)", "1 mm / 3",
                                "(1 + 2) * 3", "max($a, 1)", "$a-$b", "- $n"})
        CHECK(is_formula(formula));
    for (const char* other : {"$speed", "b.q", "NOT b.q", "previous(b.q)", "every(servo)",
                              "every()", "10 mm/s", "-5", "1e-3", "16#FF", "a-b.csv", "2026-11-23",
                              "shaft.position > 5 mm", "2 * b.q", "", "-", "("})
        CHECK_FALSE(is_formula(other));
}
