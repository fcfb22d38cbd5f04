#include "runtime/source/formula.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

/// Recursive descent. After the first error everything returns at once.
class Evaluator {
  public:
    Evaluator(std::string_view text, const Lookup& lookup, std::string_view operation)
        : text_(text), lookup_(lookup), operation_(operation) {}

    FormulaResult result() {
        result_.value = sum();
        skip_blanks();
        if (at_ < text_.size())
            fail(fmt::format("'{}' is not expected here", text_.substr(at_, 1)));
        return result_;
    }

  private:
    static constexpr int deepest = 100;

    double sum() {
        double value = product();
        while (true) {
            if (take('+'))
                value += product();
            else if (take('-'))
                value -= product();
            else
                return value;
        }
    }

    double product() {
        double value = factor();
        while (true) {
            if (take('*'))
                value *= factor();
            else if (take('/'))
                value /= factor();
            else
                return value;
        }
    }

    double factor() {
        if (++depth_ > deepest) fail("the formula is nested too deep");
        const double value = failed() ? 0 : unary();
        --depth_;
        return value;
    }

    double unary() {
        if (take('-')) return -factor();
        if (take('(')) {
            const double value = sum();
            if (!take(')')) fail("')' is missing");
            return value;
        }
        skip_blanks();
        if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
        if (at_ < text_.size() && is_letter(text_[at_])) return name();
        fail("a number, a name or '(' is expected here");
        return 0;
    }

    double number() {
        double value = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc()) fail("this is not a number");
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }

    double name() {
        const std::size_t start = at_;
        while (at_ < text_.size() &&
               (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.'))
            ++at_;
        const std::string_view word = text_.substr(start, at_ - start);
        if (take('(')) return call(word, start);
        const auto value = lookup_(word);
        if (!value) {
            at_ = start;
            if (!failed()) result_.name = word;
            fail(fmt::format("the name '{}' is not known", word));
        }
        return value.value_or(0);
    }

    double call(std::string_view function, std::size_t start) {
        std::vector<double> arguments{sum()};
        while (take(',')) arguments.push_back(sum());
        if (!take(')')) fail("')' is missing");
        if (failed()) return 0;
        if (function == "abs" && arguments.size() == 1) return std::abs(arguments[0]);
        if (function == "sqrt" && arguments.size() == 1) return std::sqrt(arguments[0]);
        if (function == operation_ && arguments.size() == 1) return arguments[0];
        if (function == "min") return *std::ranges::min_element(arguments);
        if (function == "max") return *std::ranges::max_element(arguments);
        if (function == "mean")
            return std::accumulate(arguments.begin(), arguments.end(), 0.0) /
                   static_cast<double>(arguments.size());
        at_ = start;
        fail(fmt::format(
            "there is no function '{}' of {}; known: abs(x), sqrt(x), {}min, max and mean",
            function,
            arguments.size() == 1 ? "one value" : fmt::format("{} values", arguments.size()),
            operation_.empty() ? "" : fmt::format("{}(x), ", operation_)));
        return 0;
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

FormulaResult evaluate(std::string_view formula, const Lookup& lookup, std::string_view operation) {
    return Evaluator(formula, lookup, operation).result();
}

}  // namespace lineshaft
