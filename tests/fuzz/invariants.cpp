#include "tests/fuzz/invariants.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "runtime/run/link.hpp"
#include "runtime/scan/executive.hpp"

namespace lineshaft::test {

namespace {

constexpr double rounding = 1e-9;

class Pulses : public PulseSink {
  public:
    void edges(std::span<const std::int64_t> times, bool) override { count += std::ssize(times); }
    std::int64_t count = 0;
};

/// Looks at every signal after each scan of its task.
class Watch : public Observer {
  public:
    Watch(const Machine& machine, const std::vector<Bound>& bounds)
        : machine_(machine), bounds_(bounds) {
        for (const Bound& bound : bounds) bounded_.push_back(machine.find(bound.signal));
        last_.resize(bounds.size());
    }

    void scanned(int task, const Scan& scan) override {
        for (const Signal& signal : machine_.signals)
            if (signal.task == task) look(signal, scan);
        for (std::size_t i = 0; i < bounds_.size(); ++i)
            if (bounded_[i]->task == task) hold(i, scan);
    }
    void settled(std::int64_t, std::int64_t) override {}

    std::string wrong;
    std::uint64_t hash = 0xcbf29ce484222325;

  private:
    struct Sample {
        std::int64_t time = 0;  ///< [ns]
        double value = 0;
    };

    void look(const Signal& signal, const Scan& scan) {
        const double value = as_real(signal.value());
        if (signal.type == Type::real && !std::isfinite(value))
            fail(fmt::format("{} is {} in scan {}", signal.name, value, scan.index));
        hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3;
    }

    void hold(std::size_t i, const Scan& scan) {
        const Bound& bound = bounds_[i];
        const Sample now{scan.time, as_real(bounded_[i]->value())};
        const Sample before = std::exchange(last_[i], now);
        if (bound.of_change && now.time == before.time) return;
        const double held = bound.of_change ? (now.value - before.value) * 1e9 /
                                                  static_cast<double>(now.time - before.time)
                                            : now.value;
        if (std::abs(held) > bound.most * (1 + 1e-6) + rounding)
            fail(fmt::format("{}{} is {} in scan {}, at most {} is allowed", bound.signal,
                             bound.of_change ? "'s change" : "", held, scan.index, bound.most));
    }

    void fail(std::string what) {
        if (wrong.empty()) wrong = std::move(what);
    }

    const Machine& machine_;
    const std::vector<Bound>& bounds_;
    std::vector<const Signal*> bounded_;
    std::vector<Sample> last_;
};

std::string wrong_counts(const Machine& machine, const RunResult& result) {
    const bool may_wait =
        std::ranges::any_of(machine.tasks, [](const Task& t) { return t.cost > 0; });
    if (result.outcome != Outcome::completed || may_wait) return {};
    for (std::size_t i = 0; i < machine.tasks.size(); ++i) {
        const Task& task = machine.tasks[i];
        if (task.on_event || task.jitter > 0) continue;
        const std::int64_t due = machine.duration / task.every + 1;
        if (result.scans[i] != due)
            return fmt::format("{} scans of '{}' instead of {}", result.scans[i], task.name, due);
    }
    return {};
}

/// What is wrong with one run, and the hash of its values.
std::pair<std::string, std::uint64_t> run_once(const RandomProgram& program,
                                               const Catalog& catalog) {
    Diagnostics out;
    const auto file = std::make_shared<const SourceFile>(SourceFile{"random.yaml", program.text});
    Linked linked = link(read_program(file, {}, out), catalog, out);
    if (!out.empty()) return {out.render(), 0};
    Machine& machine = linked.machine;
    std::vector<Pulses> pulses(machine.devices.size());
    for (std::size_t i = 0; i < pulses.size(); ++i) machine.devices[i].sink = &pulses[i];
    Watch watch(machine, program.bounds);
    const RunResult result = Executive(machine).run({&watch});
    if (!watch.wrong.empty()) return {watch.wrong, 0};
    if (std::string wrong = wrong_counts(machine, result); !wrong.empty()) return {wrong, 0};
    for (std::size_t i = 0; i < pulses.size(); ++i) {
        const Signal* counted = machine.find(machine.devices[i].name + ".pulses");
        if (counted && pulses[i].count != std::get<std::int64_t>(counted->value()))
            return {fmt::format("{} pulses seen, {} counted by '{}'", pulses[i].count,
                                as_real(counted->value()), machine.devices[i].name),
                    0};
    }
    return {{}, watch.hash};
}

}  // namespace

std::string broken_invariant(const RandomProgram& program, const Catalog& catalog) {
    const auto [wrong, hash] = run_once(program, catalog);
    if (!wrong.empty()) return wrong;
    return run_once(program, catalog).second == hash ? "" : "a second run has other values";
}

}  // namespace lineshaft::test
