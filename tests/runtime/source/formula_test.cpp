#include "runtime/source/formula.hpp"

#include <cmath>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

std::optional<double> names(std::string_view name) {
    if (name == "a") return 2;
    if (name == "b_2") return 5;
    if (name == "early.fit.mean_deviation") return 0.01;
    return {};
}

double value(std::string_view formula) {
    const FormulaResult result = evaluate(formula, names);
    INFO(formula << ": " << result.error);
    REQUIRE(result.error.empty());
    return result.value;
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
    const std::string known = "; known: abs(x), sqrt(x), min, max and mean";
    check_error("root(2)", "there is no function 'root' of one value" + known, 0);
    check_error("2 * abs(1, 2)", "there is no function 'abs' of 2 values" + known, 4);
    check_error("min()", "a number, a name or '(' is expected here", 4);
    check_error("1e999", "this is not a number", 0);
    check_error(".", "this is not a number", 0);
    check_error("1 % 2", "'%' is not expected here", 2);
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
