#include "runtime/source/formula.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <sleef.h>

#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {

namespace {

struct Function {
    std::string_view name;
    double (*of)(double);
    enum class Takes : std::uint8_t { angle, plain } takes = Takes::plain;
};

constexpr Function functions[] = {
    {"sin", [](double x) -> double { return Sleef_cinz_sind1_u10purec(x); },
     Function::Takes::angle},
    {"cos", [](double x) -> double { return Sleef_cinz_cosd1_u10purec(x); },
     Function::Takes::angle},
    {"tan", [](double x) -> double { return Sleef_cinz_tand1_u10purec(x); },
     Function::Takes::angle},
    {"asin", [](double x) -> double { return Sleef_cinz_asind1_u10purec(x); }},
    {"acos", [](double x) -> double { return Sleef_cinz_acosd1_u10purec(x); }},
    {"atan", [](double x) -> double { return Sleef_cinz_atand1_u10purec(x); }},
    {"exp", [](double x) -> double { return Sleef_cinz_expd1_u10purec(x); }},
    {"ln", [](double x) -> double { return Sleef_cinz_logd1_u10purec(x); }}};

/// Functions whose arguments and value have one unit: `abs`, `min`; see Evaluator::call.
constexpr std::string_view of_units[] = {"abs", "sqrt", "min", "max", "mean", "atan2"};

bool is_function(std::string_view name) {
    return std::ranges::find(of_units, name) != std::end(of_units) ||
           std::ranges::find(functions, name, &Function::name) != std::end(functions);
}

/// `m*rad/s^2`: of base units.
Unit base_unit(const std::array<int, Unit::dimensions>& exponents) {
    constexpr std::string_view names[] = {"m", "rad", "s", "pulse"};
    std::string above, below;
    for (std::size_t i = 0; i < exponents.size(); ++i) {
        const int power = std::abs(exponents[i]);
        if (power == 0) continue;
        const std::string factor =
            power == 1 ? std::string(names[i]) : fmt::format("{}^{}", names[i], power);
        if (exponents[i] < 0)
            below += "/" + factor;
        else
            above += (above.empty() ? "" : "*") + factor;
    }
    if (above.empty() && !below.empty()) above = "1";
    return {.exponents = exponents, .text = above + below};
}

bool is_plain(const Amount& a) {
    return a.unit.text.empty();
}

Amount in_base_units(const Amount& a) {
    return is_plain(a) ? a
                       : Amount(a.value * a.unit.numerator / a.unit.denominator,
                                base_unit(a.unit.exponents));
}

std::string described(const Amount& a) {
    return is_plain(a) ? "a plain number" : a.unit.text;
}

/// Recursive descent. After the first error everything returns at once.
class Evaluator {
  public:
    Evaluator(std::string_view text, const Lookup& lookup, std::string_view operation)
        : text_(text), lookup_(lookup), operation_(operation) {}

    FormulaResult result() {
        result_.amount = sum();
        skip_blanks();
        if (at_ < text_.size())
            fail(fmt::format("'{}' is not expected here",
                             text_.substr(at_, first_character(text_.substr(at_)).bytes)));
        return result_;
    }

  private:
    static constexpr int deepest = 100;

    Amount sum() {
        Amount value = product();
        while (true) {
            const std::size_t sign = at_;
            const bool adds = take('+');
            if (!adds && !take('-')) return value;
            const Amount other = like(value, product(), sign);
            value.value += adds ? other.value : -other.value;
        }
    }

    /// `other` in the unit of `first`.
    Amount like(const Amount& first, Amount other, std::size_t at) {
        if (failed()) return other;
        if (first.unit.same_dimension(other.unit))
            return {convert(other.value, other.unit, first.unit), first.unit};
        at_ = at;
        fail(fmt::format("{} and {} do not go together", described(first), described(other)));
        return other;
    }

    Amount product() {
        Amount value = factor();
        while (true) {
            if (take('*'))
                value = multiplied(value, factor(), 1);
            else if (take('/'))
                value = multiplied(value, factor(), -1);
            else
                return value;
        }
    }

    static Amount multiplied(const Amount& a, const Amount& b, int power) {
        const auto joined = [&](double x, double y) { return power > 0 ? x * y : x / y; };
        if (is_plain(b)) return {joined(a.value, b.value), a.unit};
        if (is_plain(a) && power > 0) return {a.value * b.value, b.unit};
        const bool cancels = power < 0 && a.unit.text == b.unit.text;
        if (cancels) return a.value / b.value;
        const Amount x = in_base_units(a), y = in_base_units(b);
        auto exponents = a.unit.exponents;
        for (std::size_t i = 0; i < exponents.size(); ++i)
            exponents[i] += power * b.unit.exponents[i];
        return {joined(x.value, y.value), base_unit(exponents)};
    }

    Amount factor() {
        if (++depth_ > deepest) fail("the formula is nested too deep");
        const Amount value = failed() ? Amount() : unary();
        --depth_;
        return value;
    }

    Amount unary() {
        if (take('-')) {
            Amount value = factor();
            value.value = -value.value;
            return value;
        }
        if (take('(')) {
            const Amount value = sum();
            if (!take(')')) fail("')' is missing");
            return value;
        }
        skip_blanks();
        if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
        if (at_ < text_.size() && (is_letter(text_[at_]) || text_[at_] == '$')) return name();
        fail("a number, a name or '(' is expected here");
        return {};
    }

    Amount number() {
        double value = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc()) fail("this is not a number");
        at_ = static_cast<std::size_t>(end - text_.data());
        return {value, unit()};
    }

    /// The longest one that stands here.
    Unit unit() {
        const std::size_t begin = std::min(text_.find_first_not_of(' ', at_), text_.size());
        constexpr std::string_view signs = "%*/^";
        std::size_t end = begin;
        while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) ||
                                      signs.find(text_[end]) != std::string_view::npos))
            ++end;
        const bool inverse = begin > at_ && text_.substr(begin).starts_with("1/");
        const bool begins =
            begin < end && (is_letter(text_[begin]) || text_[begin] == '%' || inverse);
        for (; begins && end > begin; --end) {
            const bool is_whole = end == text_.size() || !is_letter(text_[end]);
            const auto found =
                is_whole ? Unit::parse(text_.substr(begin, end - begin)) : std::nullopt;
            if (!found) continue;
            at_ = end;
            return *found;
        }
        return {};
    }

    Amount name() {
        const std::size_t start = at_;
        if (text_[at_] == '$') ++at_;
        while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) ||
                                      text_[at_] == '.' || !is_ascii(text_[at_])))
            ++at_;
        const std::string_view word = text_.substr(start, at_ - start);
        if (take('(')) return call(word, start);
        if (failed()) return {};
        if (auto value = lookup_(word)) return *value;
        if (word == "pi") return std::numbers::pi;
        at_ = start;
        result_.name = word;
        fail(fmt::format("the name '{}' is not known", word));
        return {};
    }

    Amount call(std::string_view function, std::size_t start) {
        std::vector<Amount> arguments{sum()};
        while (take(',')) {
            const std::size_t comma = at_;
            arguments.push_back(like(arguments.front(), sum(), comma));
        }
        if (!take(')')) fail("')' is missing");
        if (failed()) return {};
        const auto known = std::ranges::find(functions, function, &Function::name);
        if (known != std::end(functions) && arguments.size() == 1)
            return value_of(*known, arguments[0], start);
        Amount value = arguments[0];
        if (function == operation_ && arguments.size() == 1) return value;
        if (function == "min" || function == "max" || function == "mean") {
            for (const Amount& a : std::span(arguments).subspan(1))
                value.value = function == "min"   ? std::min(value.value, a.value)
                              : function == "max" ? std::max(value.value, a.value)
                                                  : value.value + a.value;
            if (function == "mean") value.value /= static_cast<double>(arguments.size());
            return value;
        }
        if (function == "abs" && arguments.size() == 1) {
            value.value = std::abs(value.value);
            return value;
        }
        if (function == "sqrt" && arguments.size() == 1) return root(value, start);
        if (function == "atan2" && arguments.size() == 2)
            return Sleef_cinz_atan2d1_u10purec(value.value, arguments[1].value);
        at_ = start;
        fail(fmt::format(
            "there is no function '{}' of {}; known: abs(x), sqrt(x), exp(x), ln(x), sin(x), "
            "cos(x), tan(x), asin(x), acos(x), atan(x), atan2(y, x), {}min, max and mean",
            function,
            arguments.size() == 1 ? "one value" : fmt::format("{} values", arguments.size()),
            operation_.empty() ? "" : fmt::format("{}(x), ", operation_)));
        return {};
    }

    Amount value_of(const Function& function, const Amount& a, std::size_t start) {
        static const Unit radian = *Unit::parse("rad");
        if (a.unit.same_dimension({})) return function.of(convert(a.value, a.unit, {}));
        if (function.takes == Function::Takes::angle && a.unit.same_dimension(radian))
            return function.of(convert(a.value, a.unit, radian));
        at_ = start;
        fail(fmt::format("{} takes {}, not {}", function.name,
                         function.takes == Function::Takes::angle ? "an angle or a plain number"
                                                                  : "a plain number",
                         described(a)));
        return {};
    }

    Amount root(const Amount& a, std::size_t start) {
        const Amount base = in_base_units(a);
        auto exponents = a.unit.exponents;
        for (int& exponent : exponents) {
            if (exponent % 2 != 0) {
                at_ = start;
                fail(fmt::format("there is no square root of {}", described(a)));
                return {};
            }
            exponent /= 2;
        }
        return {std::sqrt(base.value), base_unit(exponents)};
    }

    void skip_blanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    }

    bool take(char c) {
        skip_blanks();
        if (failed() || at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    bool failed() const { return !result_.error.empty(); }

    void fail(std::string message) {
        if (failed()) return;
        result_.error = std::move(message);
        result_.position = at_;
    }

    std::string_view text_;
    const Lookup& lookup_;
    std::string_view operation_;
    std::size_t at_ = 0;
    int depth_ = 0;
    FormulaResult result_;
};

}  // namespace

std::string Amount::text() const {
    constexpr double most = 9e15;  // below it each whole number is one of double's
    const bool finite = std::isfinite(value);
    double kept = value;
    const std::string digits = fmt::format("{:.15g}", value);
    if (finite) std::from_chars(digits.data(), digits.data() + digits.size(), kept);
    const bool whole = kept == std::trunc(kept) && std::abs(kept) < most;
    const std::string number = whole ? fmt::format("{:.0f}", kept + 0.0) : format_number(kept);
    return unit.text.empty() ? number : number + " " + unit.text;
}

FormulaResult evaluate(std::string_view formula, const Lookup& lookup, std::string_view operation) {
    return Evaluator(formula, lookup, operation).result();
}

bool is_formula(std::string_view text) {
    const bool refers = text.find('$') != std::string_view::npos;
    if (text.size() < 2 || (text.find_first_of("+-*/(", 1) == std::string_view::npos && !refers))
        return false;
    if (is_letter(text[0]) || text[0] == '$') {
        const std::size_t end = text.find_first_of("+-*/( ");
        if (text[0] == '$') return end != std::string_view::npos;
        if (end == std::string_view::npos || text[end] != '(') return false;
        const std::string_view name = text.substr(0, end);
        return is_function(name) || (refers && name != "previous" && name != "every");
    }
    const bool begins = is_digit(text[0]) || text[0] == '.' || text[0] == '-' || text[0] == '(';
    if (!begins) return false;
    if (refers) return true;
    const auto has = [&](std::string_view part) { return text.find(part) != text.npos; };
    if (text.find_first_of("*/(") == text.npos && !has(" + ") && !has(" - ")) return false;
    if (std::holds_alternative<Quantity>(parse_quantity(text))) return false;
    return evaluate(text, [](std::string_view) { return std::optional<Amount>(); }).error.empty();
}

}  // namespace lineshaft
