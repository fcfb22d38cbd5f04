#include "runtime/scan/expectations.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"

namespace lineshaft {

namespace {

std::optional<double> read_tolerance(const Connecting& to, const Signal& signal, const Node& node,
                                     double around) {
    static const Unit one;
    if (signal.type == Type::boolean || signal.type == Type::enumeration) {
        to.read.fail("L0213", node,
                     fmt::format("'within' is for numbers, '{}' is {}", signal.name,
                                 kind(signal.type, signal.names)));
        return {};
    }
    const bool share = node.is_scalar() && node.text.ends_with('%');
    const auto value = to.read.real(node, share ? one : to.net.unit(signal.unit));
    if (!value) return {};
    if (*value >= 0) return share ? *value * std::abs(around) : *value;
    to.read.fail("L0305", node, fmt::format("'{}' is below 0", node.text));
    return {};
}

Expectation expectation(const Connecting& to, const ExpectPlan& plan, const Signal& target) {
    Expectation e{.text = {}, .signal = target, .always = plan.always, .at = plan.at, .wanted = {}};
    e.low = -std::numeric_limits<double>::infinity();
    e.high = -e.low;
    if (plan.equals) {
        const double value = read_bound(to, target, *plan.equals).value_or(0);
        const double slack =
            plan.within ? read_tolerance(to, target, *plan.within, value).value_or(0) : 0;
        e.low = value - slack;
        e.high = value + slack;
        e.wanted = plan.equals->text;
        if (plan.within) e.wanted += " within " + plan.within->text;
    }
    const auto side = [&](const std::optional<Node>& node, const char* word, double& limit) {
        if (!node) return;
        limit = read_bound(to, target, *node).value_or(0);
        e.wanted += fmt::format("{}{} {}", e.wanted.empty() ? "" : ", ", word, node->text);
    };
    side(plan.at_least, "at least", e.low);
    side(plan.at_most, "at most", e.high);
    if (plan.at_least && plan.at_most && e.low > e.high)
        to.read.fail("L0213", *plan.at_least, "'at_least' is above 'at_most': this never holds");
    const std::string when = plan.always ? "always"
                             : plan.at   ? "at " + format_time(*plan.at)
                                         : "at the end";
    e.text = fmt::format("{}: {} {}{}", when, target.name, plan.equals ? "= " : "", e.wanted);
    return e;
}

}  // namespace

std::optional<double> read_bound(const Connecting& to, const Signal& signal, const Node& node) {
    Field field;
    field.name = signal.name;
    field.type = signal.type;
    field.names = signal.names;
    const auto value = read_literal(to.read, node, field, to.net.unit(signal.unit));
    return value ? std::optional(as_real(*value)) : std::nullopt;
}

std::vector<Expectation> connect_expectations(const Connecting& to) {
    std::vector<Expectation> expectations;
    for (const ExpectPlan& plan : to.program.expectations)
        if (const auto target = to.net.find(to.read, plan.signal, plan.signal.text))
            expectations.push_back(expectation(to, plan, to.machine.placed(*target)));
    return expectations;
}

}  // namespace lineshaft
