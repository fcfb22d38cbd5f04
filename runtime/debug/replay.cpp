#include <algorithm>
#include <ctime>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "runtime/debug/session.hpp"
#include "runtime/model/state.hpp"
#include "runtime/program/meaning.hpp"
#include "runtime/source/text_hash.hpp"

namespace lineshaft::debug {

namespace {

constexpr std::int64_t ms = 1'000'000;

/// What this thread has taken of a processor [ns].
std::int64_t cpu_time() {
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return now.tv_sec * 1000 * ms + now.tv_nsec;
}

}  // namespace

void Session::note_beginning() {
    fresh_ = machine_.memory;
    fresh_forces_ = machine_.forces;
    StateWriter out;
    executive_->save(out);
    history_.keep(-1, {out.bytes()});
    kept_ = cpu_time();
}

/// As the run began.
void Session::reset() {
    std::ranges::copy(fresh_, machine_.memory.begin());
    machine_.forces = fresh_forces_;
    constexpr std::int64_t before_all = std::numeric_limits<std::int64_t>::min();
    for (Replay& replay : machine_.replays) replay.skip_to(before_all);
}

/// What is kept takes a hundredth of the processor's time, whatever else runs there; `at_once`:
/// now.
void Session::keep(bool at_once) {
    constexpr std::int64_t least = 2 * ms;
    const std::int64_t now = cpu_time();
    if (!at_once && now - kept_ < std::max(least, 100 * keep_cost_)) return;
    StateWriter out;
    executive_->save(out);
    history_.keep(executive_->time(), {out.bytes(), next_change_, hits_});
    kept_ = cpu_time();
    keep_cost_ = kept_ - now;
}

/// From the last checkpoint before it up to where nothing of `time` [ns] has run.
void Session::start_at(Executive& executive, std::int64_t time) {
    executive_ = &executive;
    const History::Checkpoint& from = *history_.before(time).second;
    StateReader in(from.state);
    executive.recall(in);
    next_change_ = from.changes;
    hits_ = from.hits;
    executive.begin();
    instant_ = -1;
    recounts_ = made_ && breakpoints_.are_counted();
    if (made_) made_->generated.code.probe = recounts_ ? looking_.get() : nullptr;
    const std::int64_t begun = cpu_time();
    while (executive.time() < time - 1)
        if (!run_freely(time - 1, true)) break;
    recounts_ = false;
    if (cpu_time() - begun > ms) keep(true);  // who looked here looks again
    signals_.begin(time);
    data_.begin();
}

std::optional<Position> Session::search(std::int64_t from, const Position& end, const Plan& plan) {
    reset();
    Executive executive(machine_);
    start_at(executive, from);
    begin(executive);
    const Command& command = plan.command;
    search_ = Search{end, plan, {}, {reinterpret_cast<const char*>(command.at), command.bytes}};
    attach();
    const std::int64_t limit = end.scan == 0 ? end.time - 1 : end.time;
    while (executive.time() < limit)
        if (!run_freely(limit, true)) break;
    executive.remove(*this);
    const std::optional<Position> found = search_->found;
    landing_ = search_->why;
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

bool Session::matches(const Search& search, const st::Halt& halt) {
    const Plan& plan = search.plan;
    if (plan.command.way == Way::writer) return false;
    if (plan.command.way == Way::back_go) {
        Stop stop;
        return hits(halt, stop, false);
    }
    if (plan.command.task >= 0 && halt.context.task != plan.command.task) return false;
    const bool is_same_scan = here_.time == plan.from.time && here_.scan == plan.from.scan;
    return halt.depth <= (is_same_scan ? plan.depth : 0);
}

/// Where the jump leads to.
Position Session::target() {
    const Plan plan = *std::exchange(jump_, {});
    landing_.reset();
    const Way way = plan.command.way;
    if (way == Way::to) return plan.command.to;
    if (way == Way::back_go && breakpoints_.empty() && signals_.empty() && data_.empty()) return {};
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
        between_ = std::exchange(landing_, {}).value_or(Stop{"step"});
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
        executive_ = &executive;
        next_change_ = 0;
        quiet_ = true;
        const std::int64_t end = has_ended_ ? end_of_run() : end_;
        bool goes_on = true;
        while (goes_on && executive.time() < end) goes_on = run_freely(end, true);
        if (!has_ended_ && goes_on) executive.interrupt();
        executive_ = nullptr;
        return true;
    };
    return lineshaft::run(loaded_, how);
}

std::string Session::change(const std::string& signal, const std::string& value, Diagnostics& out) {
    Desk desk(loaded_);
    const auto kind = desk.is_settable(signal) ? Change::Kind::set : Change::Kind::force;
    auto made = desk.changes(kind, {{signal, value}}, out);
    if (!out.empty() || made.empty()) return {};
    std::string text = made.front().text;
    want({.change = std::move(made.front())});
    return text;
}

void Session::change(const std::string& variable, std::function<void()> write) {
    want({.change = {.kind = Change::Kind::set, .name = variable, .text = {}},
          .write = std::move(write)});
}

void Session::want(HandChange wanted) {
    wanted_changes_.push_back(std::move(wanted));
    if (!halt_) post_due();
}

/// What was wanted since, and what the past has at this time.
void Session::post_due() {
    for (HandChange& wanted : wanted_changes_) {
        wanted.at = executive_->time() + 1;
        const auto task = static_cast<std::size_t>(std::max(wanted.change.force.task, 0));
        if (wanted.change.kind == Change::Kind::force)
            wanted.until = later(wanted.at, std::max<std::int64_t>(machine_.tasks[task].every, 1));
        changes_.resize(next_change_);
        history_.forget_after(executive_->time());
        changes_.push_back(std::move(wanted));
        apply(changes_[next_change_++]);
        front_.log(changes_.back().write ? "not recorded: " + changes_.back().change.name + "\n"
                                         : "recorded: " + text_of(changes_.back()));
    }
    wanted_changes_.clear();
    while (next_change_ < changes_.size() && changes_[next_change_].at <= executive_->time() + 1)
        apply(changes_[next_change_++]);
}

void Session::apply(const HandChange& made) {
    if (made.write) return made.write();
    if (made.change.kind == Change::Kind::set) {
        executive_->post(made.change.stimulus);
        return;
    }
    Force force = made.change.force;
    force.until = made.until;
    executive_->force(std::move(force));
}

std::string Session::text_of(const HandChange& made) {
    if (made.write) return {};
    std::string text = recorded(made.at, {&made.change, 1});
    if (made.until == never) return text;
    Change end{.kind = Change::Kind::lift_force, .name = made.change.name, .text = {}};
    return text + recorded(made.until, {&end, 1});
}

std::string Session::recording() const {
    std::string text;
    for (const HandChange& made : changes_) text += text_of(made);
    if (text.empty()) return text;
    text += fmt::format("- {{at: {} ns, end: true}}\n", end_);
    return fmt::format("lineshaft_recording: 1\nprogram: '{}'\nmeaning: '{}'\nentries:\n{}",
                       std::filesystem::path(loaded_.program.file->path).filename().string(),
                       meaning_of(loaded_.program).in_force, text);
}

std::string Session::fingerprint() const {
    StateWriter out;
    executive_->save(out);
    return text_hash(out.bytes());
}

}  // namespace lineshaft::debug
