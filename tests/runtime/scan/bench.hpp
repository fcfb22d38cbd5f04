#pragma once

#include <algorithm>
#include <cstring>
#include <functional>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "runtime/scan/executive.hpp"

/// A machine put together by hand, and what it did.
namespace lineshaft::test {

inline constexpr std::int64_t ms = 1'000'000;

template <class Block>
void add_call(Task& task, Block& block, ScanBlocks scan) {
    Call& call = task.calls.emplace_back();
    call.scan = scan;
    call.first = reinterpret_cast<std::byte*>(&block);
    call.count = 1;
    call.size = sizeof(Block);
}

/// A scan as it was called.
struct Event {
    std::string task;
    std::int64_t time = 0;  ///< [ms]
    std::int64_t index = 0;
    std::int64_t input = 0;  ///< what was read at its start

    bool operator==(const Event&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const Event& e) {
    return out << e.task << " scan " << e.index << " at " << e.time << " ms reads " << e.input;
}

/// The only block of each task: its output counts its scans.
struct Probe {
    std::int64_t input = 0;
    std::int64_t output = 0;
    bool flag = false;    ///< true from scan `flag_at` on
    bool wanted = false;  ///< boolean input
    std::int64_t reason = 0;
    std::int64_t flag_at = -1;
    std::vector<Event>* log = nullptr;
    const char* task = "";

    void scan(const Scan& now) {
        output = now.index + 1;
        if (flag_at >= 0) flag = now.index >= flag_at;
        if (log) log->push_back({task, now.time / ms, now.index, input});
    }
};

struct TaskSpec {
    std::string name;
    std::int64_t every = 1;  ///< [ms], as all of these
    std::int64_t priority = 1;
    std::int64_t offset = 0;
    std::int64_t cost = 0;
    std::int64_t jitter = 0;
    std::int64_t cost_jitter = 0;
    bool on_event = false;
};

class Bench {
  public:
    explicit Bench(std::vector<TaskSpec> specs) : specs_(std::move(specs)) {
        std::ranges::stable_sort(specs_, std::ranges::greater{}, &TaskSpec::priority);
        machine.memory.resize(2 * sizeof(Probe) * specs_.size());
        machine.duration = 10 * ms;
        for (std::size_t i = 0; i < specs_.size(); ++i) add(i);
    }
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    Machine machine;
    std::vector<Event> log;

    int index(const std::string& task) const {
        return static_cast<int>(std::ranges::find(specs_, task, &TaskSpec::name) - specs_.begin());
    }
    Task& task(const std::string& name) {
        return machine.tasks[static_cast<std::size_t>(index(name))];
    }
    Probe& live(const std::string& name) { return *reinterpret_cast<Probe*>(task(name).live); }
    const Probe& published(const std::string& name) {
        return *reinterpret_cast<Probe*>(task(name).published);
    }
    Signal output(const std::string& name) {
        return {.name = name + ".output",
                .type = Type::integer,
                .unit = {},
                .names = {},
                .slot = reinterpret_cast<const std::byte*>(&published(name).output),
                .task = index(name)};
    }
    Signal flag(const std::string& name) {
        Signal signal = output(name);
        signal.name = name + ".flag";
        signal.type = Type::boolean;
        signal.slot = reinterpret_cast<const std::byte*>(&published(name).flag);
        return signal;
    }
    /// The task's input reads another one's published output.
    void wire(const std::string& from, const std::string& to) {
        Task& target = task(to);
        target.wires.copies.push_back(
            {.source = reinterpret_cast<const std::byte*>(&published(from).output),
             .target = reinterpret_cast<std::byte*>(&live(to).input)});
        Call& call = target.calls.front();
        call.feed = Feed::many;
        call.first_copy = target.wires.copies.data();
        ++call.words;
    }
    /// The task is released by the rising edges of another one's published flag.
    void trigger(const std::string& from, const std::string& to) {
        machine.triggers.push_back({&published(from).flag, index(to)});
    }
    /// The task is released by the rising edges of a boolean that `set_event` sets.
    void trigger_from_outside(const std::string& to) {
        machine.triggers.push_back({&live(to).wanted, index(to)});
    }
    void set_event(const std::string& task, std::int64_t at, bool value) {
        machine.stimuli.push_back(
            {at * ms, reinterpret_cast<std::byte*>(&live(task).wanted), Type::boolean, value});
    }
    void report_errors(const std::string& name) {
        task(name).errors.push_back(
            {&live(name).flag, &live(name).reason, {}, "'" + name + "_block' (probe)"});
    }
    RunResult run(std::vector<Observer*> observers = {},
                  const std::atomic<bool>* interrupt = nullptr) {
        return Executive(machine).run(observers, interrupt);
    }
    std::vector<std::int64_t> times(const std::string& name) const {
        std::vector<std::int64_t> result;
        for (const Event& e : log)
            if (e.task == name) result.push_back(e.time);
        return result;
    }

  private:
    void add(std::size_t i) {
        const TaskSpec& spec = specs_[i];
        Task task;
        task.name = spec.name;
        task.on_event = spec.on_event;
        task.every = spec.every * ms;
        task.offset = spec.offset * ms;
        task.priority = spec.priority;
        task.jitter = spec.jitter * ms;
        task.cost = spec.cost * ms;
        task.cost_jitter = spec.cost_jitter * ms;
        task.size = sizeof(Probe);
        task.live = machine.memory.data() + 2 * i * sizeof(Probe);
        task.published = spec.cost > 0 ? task.live + sizeof(Probe) : task.live;
        Probe* probe = new (task.live) Probe;
        probe->log = &log;
        probe->task = spec.name.c_str();
        if (task.published != task.live) new (task.published) Probe(*probe);
        add_call(task, *probe, [](std::byte* first, std::size_t, const Scan& now, const Context&) {
            auto* block = reinterpret_cast<Probe*>(first);
            block->scan(now);
            return block->flag;
        });
        machine.tasks.push_back(std::move(task));
    }

    std::vector<TaskSpec> specs_;
};

/// When an output changed, and to what.
class Watch : public Observer {
  public:
    struct Change {
        std::int64_t time = 0;  ///< [ms]
        std::int64_t value = 0;
        bool operator==(const Change&) const = default;
    };

    explicit Watch(Signal signal) : signal_(std::move(signal)) {}

    void scanned(int, const Scan&) override {}
    void settled(std::int64_t time, std::int64_t next) override {
        REQUIRE(next > time);
        const auto value = static_cast<std::int64_t>(as_real(signal_.value()));
        if (changes.empty() ? value != 0 : changes.back().value != value)
            changes.push_back({time / ms, value});
    }

    std::vector<Change> changes;

  private:
    Signal signal_;
};

inline std::ostream& operator<<(std::ostream& out, const Watch::Change& c) {
    return out << c.value << " at " << c.time << " ms";
}

}  // namespace lineshaft::test
