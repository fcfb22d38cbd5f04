#include "runtime/st/library/failed_assertion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "runtime/st/code/code.hpp"
#include "runtime/st/library/compiled.hpp"
#include "runtime/st/library/suites_state.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

namespace {

/// The statement in one line; what stands in quotes as it is.
std::string written(const Assertion& failed, Place at) {
    constexpr std::size_t longest = 100;
    std::string text;
    char quote = 0;
    bool is_escaped = false;
    for (const char c : at.text()) {
        const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        if (c == '\n' || (c == quote && !is_escaped))
            quote = 0;
        else if (quote == 0 && (c == '\'' || c == '"'))
            quote = c;
        is_escaped = quote != 0 && c == '$' && !is_escaped;
        if (!blank || quote != 0)
            text += c;
        else if (!text.empty() && text.back() != ' ')
            text += ' ';
    }
    const bool is_call = text.ends_with(')');
    if (text.size() > longest && is_call) text = text.substr(0, text.find('('));
    return failed.part.empty() ? text : fmt::format("{} at {}", text, failed.part);
}

/// It is named where it is one of TcUnit: a program that calls RUN may have many.
std::string name_of_test(const Compiled& made, const std::byte* root, const Context& context) {
    if (made.checked.globals.empty()) return {};
    const auto number = read<std::uint64_t>(root + 8 * std::size_t{globals_slot});
    const SuitesState state(made, context.instances[number]);
    if (!state.is_there() || state.get("test") == 0) return {};
    return fmt::format(", in the test '{}'", state.test(state.get("test")).name);
}

/// What it compared, in the frame that it stands in.
class Failed {
  public:
    Failed(const Assertion& assertion, const Instruction& stop, const std::byte* root,
           const Context& context, std::uint64_t frame)
        : assertion_(assertion), stop_(stop), root_(root), context_(context), frame_(frame) {}

    std::string what() const;
    /// What the user wrote; empty: nothing.
    std::string message() const {
        const Instruction& behind = *(&stop_ + 1);
        return assertion_.has_message ? printable(text_at(word(behind.a))) : std::string();
    }

  private:
    const std::byte* place(std::uint64_t address) const {
        return place_of(address, root_, context_);
    }
    std::string_view text_at(std::uint64_t address) const {
        const std::byte* first = place(address);
        return {reinterpret_cast<const char*>(first + 8),
                static_cast<std::size_t>(read<std::uint64_t>(first))};
    }
    std::uint64_t word(std::uint64_t slot) const {
        return read<std::uint64_t>(place(frame_ + slot));
    }
    std::string value(const Type& type, std::uint32_t slot) const {
        if (type.kind == Type::Kind::text) return text_literal(text_at(word(slot)));
        return value_text(type, word(slot));
    }
    std::string distance() const;

    const Assertion& assertion_;
    const Instruction& stop_;
    const std::byte* root_;
    const Context& context_;
    std::uint64_t frame_;
};

std::string Failed::what() const {
    const auto found = [&] { return value(*assertion_.found, stop_.a); };
    const auto wanted = [&] { return value(*assertion_.wanted, stop_.b); };
    switch (assertion_.call) {
        case TestCall::assert_true:
            return fmt::format("expected TRUE, found {}", found());
        case TestCall::assert_false:
            return fmt::format("expected FALSE, found {}", found());
        case TestCall::assert_neq:
            return fmt::format("expected another value than {}", found());
        case TestCall::assert_gt:
            return fmt::format("expected more than {}, found {}", wanted(), found());
        case TestCall::assert_lt:
            return fmt::format("expected less than {}, found {}", wanted(), found());
        case TestCall::assert_ge:
            return fmt::format("expected at least {}, found {}", wanted(), found());
        case TestCall::assert_le:
            return fmt::format("expected at most {}, found {}", wanted(), found());
        case TestCall::assert_near:
            return distance();
        case TestCall::mock_verify_called:
            return "expected a call, found none";
        case TestCall::mock_verify_call_count:
            return fmt::format("expected {} call{}, found {}", word(stop_.b),
                               word(stop_.b) == 1 ? "" : "s", word(stop_.a));
        case TestCall::none:
        case TestCall::assert_eq:
        case TestCall::advance_time:
        case TestCall::mock:
        case TestCall::mock_function:
            break;
    }
    if (wanted() == found() && assertion_.found->is_date()) {
        const auto more = static_cast<std::int64_t>(word(stop_.a) - word(stop_.b));
        return fmt::format("expected {}, found {} and {} {}", wanted(), found(),
                           time_literal(more < 0 ? -more : more), more < 0 ? "less" : "more");
    }
    const auto exact = [&](std::uint32_t slot) { return std::bit_cast<double>(word(slot)); };
    const bool hides_digits =
        wanted() == found() && assertion_.found->is_real() && std::isfinite(exact(stop_.a));
    if (!hides_digits) return fmt::format("expected {}, found {}", wanted(), found());
    return fmt::format("expected {}, found {}", exact(stop_.b), exact(stop_.a));
}

std::string Failed::distance() const {
    const Type& type = *assertion_.found;
    const auto shown = [&](std::uint64_t slot) {
        const double real = std::bit_cast<double>(word(slot));
        if (type.is_real()) return value_text(type, word(slot));
        if (type.kind == Type::Kind::time) return time_literal(static_cast<std::int64_t>(real));
        return fmt::format("{}", real);
    };
    return fmt::format("expected {} within {}, found {}", shown(stop_.b), shown(stop_.c),
                       shown(stop_.a));
}

}  // namespace

std::string text_of_failure(const Compiled& made, const std::byte* root, const Context& context) {
    const auto slot = [&](std::uint32_t number) {
        return read<std::uint64_t>(root + 8 * std::size_t{number});
    };
    const TestResult failed =
        failed_assertion(made, root, context, EndOfScan::of(slot(place_slot), slot(depth_slot)));
    return failed.failure + name_of_test(made, root, context);
}

TestResult failed_assertion(const Compiled& made, const std::byte* root, const Context& context,
                            const EndOfScan& end) {
    const Assertion& assertion =
        *std::ranges::find(made.generated.assertions, end.instruction, &Assertion::instruction);
    const Place at = place_of_user(made.generated.code, root, end, assertion.place);
    const Failed failed(assertion, made.generated.code.instructions[end.instruction], root, context,
                        end.frame);
    TestResult result;
    result.mark = at.mark();
    result.failure = fmt::format("{}: {}", written(assertion, at), failed.what());
    if (const std::string message = failed.message(); !message.empty())
        result.failure += "; " + message;
    return result;
}

}  // namespace lineshaft::st
