#include <algorithm>

#include <fmt/format.h>

#include "runtime/program/program_reader.hpp"

namespace lineshaft {

namespace {

constexpr const char* expectation_help =
    "write it as {at: end, axis.position: 20 mm, within: 1e-9 mm}";

/// The bounds that only `value` is within.
std::string as_bounds(const Node& value) {
    if (value.text == "false") return "write at_most: false";
    if (value.text == "true") return "write at_least: true";
    return fmt::format("write at_least: {0}, at_most: {0}", value.text);
}

}  // namespace

void ProgramReader::run(const Node& node) {
    RunPlan& run = program_.run;
    run.mark = node.mark;
    if (!read_.expect_map(node, "'run'")) return;
    read_.only_keys(node, "'run'", {"for", "until", "seed", "on_error"});
    if (const Node* n = node.find("for")) {
        const auto duration = read_.time(*n);
        if (duration == 0) read_.fail("L0308", *n, "a run must be longer than 0 s");
        run.duration = duration.value_or(0);
    }
    if (const Node* n = node.find("until"); n && read_.expect_scalar(*n, "'until'")) run.until = *n;
    if (!node.find("for"))
        read_.fail("L0202", node, "'run' has no 'for'",
                   "say how long to run, such as for: 2 s; with 'until' it is the limit");
    if (const Node* n = node.find("seed")) {
        const std::int64_t seed = read_.integer(*n).value_or(1);
        if (seed < 0) read_.fail("L0305", *n, fmt::format("'{}' is below 0", n->text));
        run.seed = static_cast<std::uint64_t>(seed);
    }
    const Node* on_error = node.find("on_error");
    if (!on_error || !read_.expect_scalar(*on_error, "'on_error'")) return;
    run.continue_on_error = on_error->text == "continue";
    if (!run.continue_on_error && on_error->text != "stop")
        read_.fail("L0306", *on_error, fmt::format("'{}' is no way to go on", on_error->text),
                   "known: stop, continue");
}

void ProgramReader::expectations(const Node& node) {
    if (!read_.expect_sequence(node, "'expect'")) return;
    for (const Node& item : node.items)
        if (read_.expect_map(item, "an expectation")) expectation(item);
}

void ProgramReader::expectation(const Node& item) {
    ExpectPlan plan;
    plan.mark = item.mark;
    const Node* always = item.find("always");
    const Node* when = item.find("at");
    if (always && when)
        return read_.fail("L0213", item, "an expectation says 'at' or 'always', not both",
                          "write two expectations");
    if (!always && !when)
        return read_.fail("L0202", item, "an expectation says neither 'at' nor 'always'",
                          expectation_help);
    bounds(item, plan);
    plan.always = always != nullptr;
    if (always && read_.expect_scalar(*always, "a signal")) plan.signal = *always;
    if (when) at(*when, plan);
    for (const auto& [key, value] : item.entries) {
        if (key.text == "at" || key.text == "always" || key.text == "within" ||
            key.text == "at_least" || key.text == "at_most")
            continue;
        if (always && key.text == "equals")
            return read_.fail("L0213", key, "'always' takes bounds, not 'equals'",
                              as_bounds(value));
        if (always || !plan.signal.text.empty()) {
            read_.fail("L0201", key,
                       fmt::format("an expectation has one signal, '{}' is a second", key.text));
            continue;
        }
        plan.signal = key;
        if (!value.is_map()) {
            plan.equals = value;
            continue;
        }
        read_.only_keys(value, "an expectation's bounds", {"at_least", "at_most"});
        bounds(value, plan);
    }
    if (plan.signal.text.empty())
        return read_.fail("L0202", item, "an expectation names no signal", expectation_help);
    if (!plan.equals && !plan.at_least && !plan.at_most)
        return read_.fail("L0202", item, "an expectation has no value and no bound",
                          "write SIGNAL: VALUE, at_least or at_most");
    if (plan.within && !plan.equals)
        return read_.fail("L0202", *plan.within, "'within' is for a value, and there is none",
                          "write SIGNAL: VALUE beside it");
    if (plan.equals && (plan.at_least || plan.at_most))
        return read_.fail("L0213", item, "an expectation has a value or bounds, not both",
                          "write two expectations");
    program_.expectations.push_back(std::move(plan));
}

void ProgramReader::bounds(const Node& map, ExpectPlan& plan) {
    if (const Node* n = map.find("within")) plan.within = *n;
    if (const Node* n = map.find("at_least")) plan.at_least = *n;
    if (const Node* n = map.find("at_most")) plan.at_most = *n;
}

void ProgramReader::at(const Node& node, ExpectPlan& plan) {
    if (node.is_scalar() && node.text == "end") return;
    plan.at = read_.time(node);
}

}  // namespace lineshaft
