#include <algorithm>

#include <fmt/format.h>

#include "runtime/scan/executive.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

constexpr std::int64_t most_starts_at_once = 1000;

/// A loop of own code was ended after as many passes as a scan may have.
bool is_endless(const ErrorFlag& flag) {
    return flag.error_id && flag.names.of(*flag.error_id) == "no_end";
}

}  // namespace

bool Executive::repeats_without_end(int index) {
    const Task& task = this->task(index);
    State& state = this->state(index);
    state.repeats = state.scan.time == now_ ? state.repeats + 1 : 0;
    if (state.repeats < most_starts_at_once) return false;
    stop(Outcome::overrun,
         fmt::format("event task '{}' overran: it has scanned {} times at {} and does not end",
                     task.name, state.repeats, format_time(now_)),
         index);
    return true;
}

void Executive::check_deadlines() {
    for (std::size_t i = 0; i < running_.size() && !stopped_; ++i) {
        const int index = running_[i];
        State& state = this->state(index);
        if (state.deadline > now_) continue;
        const std::int64_t limit = task(index).maximum_cycle_time;
        state.deadline = later(state.deadline, limit);
        time_error(index, fmt::format("scan {}, begun at {}, has not ended at {}; its maximum "
                                      "cycle time is {}",
                                      state.scan.index, format_time(state.scan.time),
                                      format_time(now_), format_time(limit)));
    }
}

void Executive::due_again(int index) {
    const State& state = this->state(index);
    const char* again = task(index).on_event ? "its event comes again" : "it is due again";
    time_error(index, state.pending
                          ? fmt::format("{} at {}, before scan {}, due at {}, could begin", again,
                                        format_time(now_), state.index, format_time(state.released))
                          : fmt::format("{} at {}, before scan {}, begun at {}, has ended", again,
                                        format_time(now_), state.scan.index,
                                        format_time(state.scan.time)));
}

void Executive::time_error(int index, std::string what) {
    const Task& task = this->task(index);
    std::string message =
        fmt::format("task '{}' overran: {}{}", task.name, what, running_block(index));
    tell(EventKind::overrun, index, message);
    ++result_.time_errors;
    ++errors_in_cycle_;
    const auto because = [&](const char* why) {
        stop(Outcome::overrun, message + "; STOP: " + why, index);
    };
    if (task.motion) return because("a motion task must not overrun");
    if (task.on_overrun < 0) return because("no task has it under 'on_overrun'");
    if (errors_in_cycle_ > 1) return because("it is the second time error in one cycle");
    make_pending(task.on_overrun);
    state(task.on_overrun).released = now_;
}

/// `; block 'drive' (servo_drive) was running`: a scan's time is spread over its blocks in the
/// proportions of their costs, the task's own cost evenly.
std::string Executive::running_block(int index) const {
    if (!state(index).active) {
        if (running_.empty()) return {};
        const int other = running_.back();
        return fmt::format("; task '{}' was running{}", task(other).name, running_block(other));
    }
    const Task& task = this->task(index);
    const State& state = this->state(index);
    const auto blocks = static_cast<std::int64_t>(task.infos.size());
    if (blocks == 0) return {};
    std::int64_t own = task.cost;
    for (const BlockInfo& info : task.infos) own -= info.cost;
    const double even = task.cost > 0 ? static_cast<double>(own) / static_cast<double>(blocks) : 1;
    const double whole =
        task.cost > 0 ? static_cast<double>(task.cost) : static_cast<double>(blocks);
    const double reached = static_cast<double>(state.cost - state.remaining) * whole;
    double end = 0;
    for (const BlockInfo& info : task.infos) {
        end += even + static_cast<double>(info.cost);
        if (reached < end * static_cast<double>(state.cost))
            return fmt::format("; block {} was running", info.block);
    }
    return fmt::format("; block {} was running", task.infos.back().block);
}

std::string Executive::why(const ErrorFlag& flag, int index) {
    if (!flag.type || !flag.type->why) return {};
    Context context = machine_.context_of(*flag.type, index);
    context.published = result_.scans.data();
    const std::string text = flag.type->why(flag.memory, context, [this](std::int64_t instance) {
        return machine_.blocks[static_cast<std::size_t>(instance)].name;
    });
    return text.empty() ? text : ": " + text;
}

void Executive::report_errors(int index) {
    std::uint8_t* level = error_levels_.data() + state(index).first_error;
    state(index).may_err = false;
    for (const ErrorFlag& flag : task(index).errors) {
        const bool before = *level != 0;
        *level++ = *flag.error;
        state(index).may_err |= *flag.error;
        if (!*flag.error || (before && !is_endless(flag))) continue;
        std::string text;
        if (flag.error_id) {
            text = fmt::format(" {}", *flag.error_id);
            const std::string_view name = flag.names.of(*flag.error_id);
            if (!name.empty()) text += fmt::format(" ({})", name);
        }
        const Scan& scan = state(index).scan;
        const std::string place = why(flag, index);
        if (is_endless(flag)) {
            time_error(index, fmt::format("scan {}, begun at {}, does not end in block {}{}",
                                          scan.index, format_time(scan.time), flag.block, place));
            if (stopped_) return;
            continue;
        }
        text = fmt::format("block {} reports error{} in scan {} of task '{}' at {}", flag.block,
                           text, scan.index, task(index).name, format_time(scan.time));
        text += place;
        tell(EventKind::block_error, index, text);
        if (!machine_.continue_on_error) return stop(Outcome::block_error, text, index);
    }
}

void Executive::report_warnings(const DeviceCall& device, int index) {
    const WarningCount& warnings = device.warnings;
    if (!warnings.count) return;
    Warned& warned = warned_[static_cast<std::size_t>(&device - machine_.devices.data())];
    const std::int64_t more = *warnings.count - warned.count;
    if (more == 0) return;
    if (warned.count == 0) {
        warned.first = now_;
        warned.id = *warnings.id;
    }
    warned.count = *warnings.count;
    if (!events_) return;
    tell(EventKind::block_warning, index,
         fmt::format("block {} warns of {}{}", warnings.block, warnings.names.of(*warnings.id),
                     more > 1 ? fmt::format(", the last of {} warnings", more) : ""));
}

std::vector<std::string> Executive::warnings() const {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < warned_.size(); ++i) {
        const Warned& warned = warned_[i];
        const WarningCount& warnings = machine_.devices[i].warnings;
        if (warned.count == 0) continue;
        texts.push_back(
            fmt::format("block {} warned {}, first of {} at {}", warnings.block,
                        warned.count == 1 ? "once" : fmt::format("{} times", warned.count),
                        warnings.names.of(warned.id), format_time(warned.first)));
    }
    return texts;
}

void Executive::tell(EventKind kind, int index, const std::string& text) {
    if (!events_) return;
    events_->happened({.time = now_,
                       .scan = index < 0 ? -1 : state(index).scan.index,
                       .task = index,
                       .kind = kind,
                       .text = text});
}

void Executive::stop(Outcome outcome, std::string message, int index) {
    tell(EventKind::stop, index, message);
    stopped_ = true;
    result_.outcome = outcome;
    result_.message = std::move(message);
    result_.time = now_;
}

}  // namespace lineshaft
