#include <algorithm>

#include "runtime/debug/session.hpp"
#include "runtime/model/state.hpp"

namespace lineshaft::debug {

void Session::note_beginning() {
    fresh_ = machine_.memory;
    fresh_forces_ = machine_.forces;
    StateWriter out;
    executive_->save(out);
    history_.keep(-1, {out.bytes()});
    kept_ = Clock::now();
}

/// As the run began.
void Session::reset() {
    std::ranges::copy(fresh_, machine_.memory.begin());
    machine_.forces = fresh_forces_;
}

/// What is kept takes a fiftieth of the time.
void Session::keep() {
    constexpr auto least = std::chrono::milliseconds(2);
    const auto now = Clock::now();
    if (now - kept_ < std::max<Clock::duration>(least, 50 * keep_cost_)) return;
    StateWriter out;
    executive_->save(out);
    history_.keep(executive_->time(), {out.bytes()});
    kept_ = Clock::now();
    keep_cost_ = kept_ - now;
}

/// From the last checkpoint before it up to where nothing of `time` [ns] has run.
void Session::start_at(Executive& executive, std::int64_t time) {
    executive_ = &executive;
    StateReader in(history_.before(time).second->state);
    executive.recall(in);
    executive.begin();
    if (made_) made_->generated.code.probe = nullptr;
    instant_ = -1;
    while (executive.time() < time - 1)
        if (!run_freely(time - 1, true)) break;
}

std::optional<Position> Session::search(std::int64_t from, const Position& end, const Plan& plan) {
    reset();
    Executive executive(machine_);
    start_at(executive, from);
    begin(executive);
    search_ = Search{end, plan};
    attach();
    executive.run_until(end.scan == 0 ? end.time - 1 : end.time);
    executive.remove(*this);
    const std::optional<Position> found = search_->found;
    search_.reset();
    return found;
}

/// In windows that grow: most steps are short.
std::optional<Position> Session::last_before(const Position& end, const Plan& plan) {
    constexpr std::int64_t growth = 4;
    std::int64_t span = machine_.duration;
    for (const Task& task : machine_.tasks)
        if (task.every > 0) span = std::min(span, task.every);
    Position until = end;
    for (std::int64_t from = end.time; from >= 0;
         span = span > never / growth ? never : span * growth) {
        if (const auto found = search(from, until, plan)) return found;
        if (from == 0) break;
        until = {from, 0, 0};
        from = std::max<std::int64_t>(0, from - span);
    }
    return {};
}

bool Session::matches(const Search& search, int task, std::uint32_t depth,
                      std::size_t statement) const {
    const Plan& plan = search.plan;
    if (plan.command.way == Way::back_go) {
        Stop stop;
        return has_code(task) && hits(statement, stop);
    }
    if (plan.command.task >= 0 && task != plan.command.task) return false;
    const bool is_same_scan = here_.time == plan.from.time && here_.scan == plan.from.scan;
    return depth <= (is_same_scan ? plan.depth : 0);
}

/// Where the jump leads to.
Position Session::target() {
    const Plan plan = *std::exchange(jump_, {});
    if (plan.command.way == Way::back_go && breakpoints_.empty()) return {};
    return last_before(plan.from, plan).value_or(Position{});
}

/// On from a place in the past.
void Session::wander() {
    plan_.reset();
    between_.reset();
    const Position to = target();
    reset();
    Executive executive(machine_);
    executive.report_to(*this);
    if (to.time < 0) {
        start_at(executive, 0);
        between_ = Stop{"entry", "the beginning of the run"};
    } else if (to.scan == Position::behind) {
        start_at(executive, to.time + 1);
        between_ = Stop{"step"};
        instant_ = to.time;
    } else {
        start_at(executive, to.time);
        goal_ = to;
    }
    play(executive);
}

/// The files of the run, as if nobody had looked at it.
RunReport Session::repeat(RunOptions how) {
    reset();
    how.drive = [this](Executive& executive, const auto&) {
        const bool goes_on = executive.run_until(has_ended_ ? end_of_run() : end_);
        if (!has_ended_ && goes_on) executive.interrupt();
        return true;
    };
    return lineshaft::run(loaded_, how);
}

}  // namespace lineshaft::debug
