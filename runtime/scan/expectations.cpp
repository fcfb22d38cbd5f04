#include "runtime/scan/expectations.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

/// value + sign * slack; of a whole number exact, and at most as far as whole numbers go.
Value moved(const Signal& signal, const Value& value, const Value& slack, int sign) {
    constexpr double most = 0x1p63;
    const auto number = whole(value);
    const double size = as_real(slack);
    if (!number || size >= most) return as_real(value) + sign * size;
    const Wide way = whole(slack).value_or(static_cast<std::int64_t>(size));
    if (const auto sum = whole_value(*number + sign * way, signal.type)) return *sum;
    using Limits = std::numeric_limits<std::int64_t>;
    if (signal.type == Type::unsigned_integer)
        return sign > 0 ? std::numeric_limits<std::uint64_t>::max() : std::uint64_t{0};
    return sign > 0 ? Limits::max() : Limits::min();
}

/// Whole where the signal and the text are.
std::optional<Value> read_tolerance(const Connecting& to, const Signal& signal, const Node& node,
                                    const Value& around) {
    if (signal.type == Type::boolean || signal.type == Type::enumeration) {
        to.read.fail(code::entries_do_not_go_together, node,
                     fmt::format("'within' is for numbers, '{}' is {}", signal.name,
                                 kind(signal.type, signal.names)));
        return {};
    }
    const bool time = signal.is_time() && !is_share(node);
    const auto given = parse_quantity(node.text);
    const auto* quantity = std::get_if<Quantity>(&given);
    const bool whole = is_integer(signal.type) && signal.unit.empty() && quantity &&
                       quantity->is_integer && !quantity->has_unit;
    std::optional<Value> value;
    if (whole || time)
        value = whole ? to.read.integer(node) : to.read.time(node);
    else
        value = to.read.real_or_share(node, to.net.unit(signal.unit), as_real(around));
    if (!value || compare(*value, 0.0) >= 0) return value;
    to.read.fail(code::number_out_of_range, node, fmt::format("'{}' is below 0", node.text));
    return {};
}

using When = ExpectPlan::When;

/// `always`, `from 1 s to 2 s`: what stands before the signal.
std::string when_text(const ExpectPlan& plan) {
    switch (plan.when) {
        case When::at_end:
            return "at the end";
        case When::at:
            return "at " + format_time(plan.from);
        case When::excluded:
            return "never";
        case When::counted:
            return "rising";
        case When::answered:
            return fmt::format("within {} of {}", format_time(plan.until), plan.cause.text);
        case When::always:
            break;
    }
    if (plan.until == never) return "always";
    return fmt::format("from {} to {}", format_time(plan.from), format_time(plan.until));
}

void read_value(const Connecting& to, const ExpectPlan& plan, const Signal& target,
                Expectation& e) {
    e.low = e.high = read_bound(to, target, *plan.equals).value_or(0.0);
    const auto slack = plan.within ? read_tolerance(to, target, *plan.within, e.low) : std::nullopt;
    if (slack) {
        e.high = moved(target, e.low, *slack, 1);
        e.low = moved(target, e.low, *slack, -1);
    }
    e.wanted = plan.equals->text;
    if (plan.within) e.wanted += " within " + plan.within->text;
}

void read_bounds(const Connecting& to, const ExpectPlan& plan, const Signal& target,
                 Expectation& e) {
    const auto side = [&](const std::optional<Node>& node, const char* word, Value& limit) {
        if (!node) return;
        limit = read_bound(to, target, *node).value_or(0.0);
        e.wanted += fmt::format("{}{} {}", e.wanted.empty() ? "" : ", ", word, node->text);
    };
    if (plan.equals) read_value(to, plan, target, e);
    side(plan.at_least, "at least", e.low);
    side(plan.at_most, "at most", e.high);
    if (plan.at_least && plan.at_most && compare(e.low, e.high) > 0)
        to.read.fail(code::entries_do_not_go_together, *plan.at_least,
                     "'at_least' is above 'at_most': this never holds");
}

/// False, and reported, where what is to be true or to rise is no boolean.
bool is_boolean(const Connecting& to, const Signal& signal, const Node& place) {
    if (signal.type == Type::boolean) return true;
    to.read.fail(
        code::wire_between_types, place,
        fmt::format("a boolean is expected here, '{}' is {}", signal.name, name_of(signal.type)));
    return false;
}

/// How often a signal rises is a whole number, whatever the signal is.
const Signal& a_count() {
    static const Signal count{.name = "count", .type = Type::integer, .unit = {}, .names = {}};
    return count;
}

Expectation expectation(const Connecting& to, const ExpectPlan& plan, const Signal& target) {
    Expectation e{.text = {},
                  .signal = target,
                  .when = plan.when,
                  .from = plan.from,
                  .until = plan.until,
                  .wanted = {}};
    const bool has_bounds = plan.equals || plan.at_least || plan.at_most;
    const bool counts = plan.when == When::counted;
    if (counts || !has_bounds) is_boolean(to, target, plan.signal);
    if (has_bounds) read_bounds(to, plan, counts ? a_count() : target, e);
    if (!has_bounds) e.low = e.high = std::int64_t{1};
    e.text = fmt::format("{}: {}", when_text(plan), target.name);
    if (has_bounds) e.text += fmt::format(" {}{}", plan.equals ? "= " : "", e.wanted);
    if (plan.when == When::answered) e.wanted = format_time(plan.until);
    if (plan.when == When::always && !has_bounds) e.wanted = "true";
    if (plan.when == When::excluded)
        e.wanted = fmt::format("never {}", has_bounds ? e.wanted : "true");
    if (!plan.because.empty()) e.text += ", because " + plan.because;
    return e;
}

}  // namespace

std::optional<Value> read_bound(const Connecting& to, const Signal& signal, const Node& node) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (signal.type == Type::real && node.is_scalar()) {
        if (node.text == "INF") return infinite;
        if (node.text == "-INF") return -infinite;
        if (node.text == "NaN") {
            to.read.fail(code::not_a_number, node, "no comparison with NaN is ever fulfilled",
                         "let the program tell: is_nan := x <> x");
            return {};
        }
    }
    Field field;
    field.name = signal.name;
    field.type = signal.type;
    field.names = signal.names;
    return read_literal(to.read, node, field, to.net.unit(signal.unit));
}

std::vector<Expectation> connect_expectations(const Connecting& to) {
    std::vector<Expectation> expectations;
    for (const ExpectPlan& plan : to.program.expectations) {
        const auto target = to.net.find(to.read, plan.signal, plan.signal.text);
        const auto cause = plan.when == When::answered
                               ? to.net.find(to.read, plan.cause, plan.cause.text)
                               : std::nullopt;
        if (!target) continue;
        Expectation e = expectation(to, plan, to.machine.placed(*target));
        if (plan.when == When::answered && !cause) continue;
        if (cause && is_boolean(to, *cause, plan.cause)) e.cause = to.machine.placed(*cause);
        expectations.push_back(std::move(e));
    }
    return expectations;
}

}  // namespace lineshaft
