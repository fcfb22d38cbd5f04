#include "runtime/debug/session.hpp"

#include <algorithm>

namespace lineshaft::debug {

namespace {

const st::Library::Made* find_made(const Machine& machine) {
    for (const BlockType* type : machine.types)
        if (const st::Library::Made* made = type ? st::made_of(*type) : nullptr) return made;
    return nullptr;
}

}  // namespace

class Session::Looking final : public st::Probe {
  public:
    Looking(const st::Code& code, Session& session) : Probe(code), session_(session) {}
    bool steps(const st::CodeRoutine& routine, const Scan& now) override {
        return session_.steps(routine, now);
    }
    void at(const st::Halt& halt) override { session_.look(halt); }

  private:
    Session& session_;
};

Session::Session(Loaded& loaded, Front& front)
    : loaded_(loaded),
      machine_(loaded.linked.machine),
      front_(front),
      made_(find_made(machine_)),
      breakpoints_(made_),
      signals_(loaded),
      data_(machine_),
      has_code_(machine_.tasks.size()) {
    if (made_) looking_ = std::make_unique<Looking>(made_->generated.code, *this);
    for (std::size_t i = 0; i < machine_.blocks.size(); ++i)
        if (st::made_of(*machine_.blocks[i].type) && !machine_.blocks[i].type->single)
            has_code_[static_cast<std::size_t>(loaded.linked.net.instances[i].task)] = true;
}

Session::~Session() {
    if (made_) made_->generated.code.probe = nullptr;
}

bool Session::has_code(int task) const {
    return task < 0 ? std::ranges::count(has_code_, true) > 0
                    : has_code_[static_cast<std::size_t>(task)];
}

std::int64_t Session::end_of_run() const {
    return std::min(machine_.end, machine_.duration);
}

RunReport Session::run(RunOptions how) {
    const RunOptions again = how;
    how.events = this;
    how.drive = [this](Executive& executive, const auto&) {
        executive_ = &executive;
        note_beginning();
        signals_.begin(0);
        data_.begin();
        if (stop_on_entry && has_code(-1))
            plan_ = Plan{{Way::into, -1}, here_};
        else if (stop_on_entry)
            between_ = Stop{"entry"};
        return play(executive);
    };
    RunReport report = lineshaft::run(loaded_, how);
    if (!jump_) return report;
    while (jump_) wander();
    return repeat(again);
}

/// Forwards, until the run or the session ends. False: it is to go on in the past.
bool Session::play(Executive& executive) {
    begin(executive);
    bool goes_on = true;
    while (!jump_ && !ending_) {
        if (between_) {
            here_ = {instant_};
            if (between_->reason == "exception") find_failed(between_->task);
            stand(*std::exchange(between_, {}), nullptr);
            failed_.reset();
            post_due();
        } else if (!goes_on || executive.time() >= end_of_run()) {
            here_ = {executive.time()};
            if (stop_at_end) stand({"exit", "the end of the run"}, nullptr);
            if (!jump_) break;
        } else {
            attach();
            goes_on = run_freely(end_of_run(), false);
        }
    }
    executive.remove(*this);
    if (made_) made_->generated.code.probe = nullptr;
    if (ending_ && goes_on && executive.time() < end_of_run()) executive.interrupt();
    end_ = executive.time();
    has_ended_ = !jump_ && !ending_;
    executive_ = nullptr;
    return !jump_;
}

void Session::begin(Executive& executive) {
    executive_ = &executive;
    quiet_ = false;
    attach();
}

/// A piece of the way, as long as a look at the front may wait. False at the end of the run.
bool Session::run_freely(std::int64_t limit, bool is_quiet) {
    constexpr auto wanted = std::chrono::milliseconds(2);
    const auto begun = Clock::now();
    post_due();
    if (next_change_ < changes_.size()) limit = std::min(limit, changes_[next_change_].at - 1);
    const bool goes_on = executive_->run_until(std::min(limit, later(executive_->time(), chunk_)));
    const auto took = Clock::now() - begun;
    chunk_ = std::clamp<std::int64_t>(took > wanted ? chunk_ / 2 : chunk_ * 2, 1000, never / 4);
    if (!jump_ && !ending_ && !search_) keep();
    if (!is_quiet) front_.look();
    return goes_on;
}

/// Who runs without a stop in it runs as without a debugger.
void Session::attach() {
    const bool is_wanted = plan_ || goal_ || search_ || !breakpoints_.empty() || !data_.empty();
    if (made_) made_->generated.code.probe = is_wanted ? looking_.get() : nullptr;
    executive_->remove(*this);
    if (is_wanted || pausing_ || !signals_.empty()) executive_->add(*this);
}

bool Session::steps(const st::CodeRoutine& routine, const Scan& now) {
    if (now.time != instant_) scans_ = 0;
    instant_ = now.time;
    ++scans_;
    statements_ = 0;
    if (quiet_ && !recounts_) return false;
    if (goal_ || plan_) return true;
    if (search_ && search_->plan.command.way != Way::back_go) return true;
    return (!recounts_ && !data_.empty()) || breakpoints_.are_reached_by(routine);
}

void Session::look(const st::Halt& halt) {
    constexpr std::uint32_t often = 1024;
    const Position now{instant_, scans_, ++statements_};
    if (quiet_ && !recounts_) return;
    here_ = now;
    Stop stop{.reason = {}, .task = halt.context.task};
    if (search_) {
        watch(now, true);
        if (now < search_->end && matches(*search_, halt)) search_->found = now;
        return;
    }
    if (recounts_ || (goal_ && now < *goal_)) {
        hits(halt, stop, false);
        return;
    }
    if (std::exchange(goal_, {}) ||
        (plan_ && is_reached(*plan_, stop.task, halt.depth, halt.now.index)))
        stop.reason = plan_ && plan_->from.time < 0 && stop_on_entry ? "entry" : "step";
    if (++polls_ % often == 0) front_.look();
    if (ending_) return obey(&halt);
    hits(halt, stop, true);
    if (std::exchange(pausing_, false) && stop.reason.empty()) stop.reason = "pause";
    if (!stop.reason.empty()) stand(stop, &halt);
}

bool Session::is_reached(const Plan& plan, int task, std::uint32_t depth, std::int64_t scan) const {
    const Way way = plan.command.way;
    const int wanted = plan.command.task;
    if (wanted >= 0 && task != wanted) return false;
    const bool is_same_scan = here_.time == plan.from.time && here_.scan == plan.from.scan;
    switch (way) {
        case Way::into:
            return true;
        case Way::next:
            return !is_same_scan || depth <= plan.depth;
        case Way::out:
            return !is_same_scan || depth < plan.depth;
        case Way::next_scan:
            return scan != plan.scan;
        default:
            return false;
    }
}

std::vector<Breakpoint> Session::set_breakpoints(const std::string& path,
                                                 const std::vector<Wanted>& wanted) {
    std::vector<Breakpoint> made = breakpoints_.set(path, wanted);
    for (const Breakpoint& breakpoint : made) set_at_[breakpoint.id] = here_;
    return made;
}

/// Tells which breakpoints it is that the statement stops at, or the one before it has changed.
bool Session::hits(const st::Halt& halt, Stop& stop, bool tells) {
    stop.breakpoints = data_.changed();
    if (!stop.breakpoints.empty()) stop.reason = "data breakpoint";
    const auto& here = breakpoints_.at(halt.statement);
    if (here.empty()) return !stop.breakpoints.empty();
    const Frame frame = innermost(halt, *made_, machine_);
    for (const Breakpoint* breakpoint : here) {
        if (breakpoint->condition) {
            const Evaluated value = breakpoint->condition->value(frame);
            if (!value.truth.value_or(true)) continue;
            if (!value.truth) stop.text = breakpoint->wanted.condition + ": " + value.error;
        }
        const bool counts = here_ > set_at_[breakpoint->id];
        const std::int64_t count = counts ? ++hits_[breakpoint->id] : 0;
        if (breakpoint->hits && !(counts && breakpoint->hits->holds(count))) continue;
        if (breakpoint->log.empty()) {
            stop.breakpoints.push_back(breakpoint->id);
            stop.reason = "breakpoint";
        } else if (tells) {
            front_.log(breakpoint->logged(frame));
        }
    }
    return !stop.breakpoints.empty();
}

/// A search for what changed some bytes ends: it was what came before this.
void Session::watch(const Position& now, bool is_statement) {
    Search& search = *search_;
    if (search.plan.command.way != Way::writer) return;
    const char* const at = reinterpret_cast<const char*>(search.plan.command.at);
    const std::string_view bytes(at, search.plan.command.bytes);
    const bool is_next = search.last.time == now.time && search.last.scan == now.scan;
    if (bytes != search.bytes) {
        search.bytes = bytes;
        // What came in before the first statement of a scan is another block's, or a wire's.
        const Position writer = is_next || !is_statement ? search.last : Position{now.time};
        const Position found = writer.time == now.time ? writer : Position{now.time};
        if (found < search.end && now <= search.end) search.found = found;
    }
    if (is_statement) search.last = now;
}

/// A task without Structured Text is stepped scan by scan.
void Session::scanned(int task, const Scan&) {
    if (!quiet_ && !goal_ && !has_code(task)) plain_scan_ = task;
}

std::optional<Stop> Session::stop_between(std::int64_t time) {
    std::string risen = signals_.empty() ? "" : signals_.risen(time);
    std::vector<int> changed = data_.changed();
    if (!risen.empty()) return Stop{"function breakpoint", std::move(risen)};
    if (changed.empty()) return {};
    return Stop{.reason = "data breakpoint", .breakpoints = std::move(changed)};
}

void Session::settled(std::int64_t time, std::int64_t) {
    instant_ = time;
    const int task = std::exchange(plain_scan_, -1);
    const Position now{time};
    if (quiet_ || goal_ || recounts_) return;
    std::optional<Stop> why = stop_between(time);
    if (search_) {
        const Way way = search_->plan.command.way;
        watch(now, false);
        if (now < search_->end && ((way == Way::back && search_->plan.command.task == task) ||
                                   (way == Way::back_go && why))) {
            search_->found = now;
            search_->why = std::move(why);
        }
        return;
    }
    if (between_) return;
    if (why)
        between_ = std::move(why);
    else if (plan_ && task >= 0 && plan_->command.task == task)
        between_ = Stop{.reason = "step", .task = task};
    else if (std::exchange(pausing_, false))
        between_ = Stop{"pause"};
    if (between_) executive_->hold();
}

void Session::happened(const RunEvent& event) {
    if (quiet_ || search_ || goal_ || recounts_) return;
    front_.happened(event);
    if (!stop_on_error || event.kind != EventKind::block_error) return;
    instant_ = event.time;
    between_ = Stop{"exception", event.text, std::max(event.task, 0)};
    executive_->hold();
}

/// The first block of the task that a fault in its Structured Text ended.
void Session::find_failed(int task) {
    for (std::size_t i = 0; i < machine_.blocks.size() && !failed_; ++i) {
        const BlockPlace& block = machine_.blocks[i];
        const bool is_text = made_ && st::made_of(*block.type) == made_ && !block.type->single;
        if (is_text && loaded_.linked.net.instances[i].task == task &&
            read<std::uint64_t>(block.live + 8 * std::size_t{st::error_slot}) != 0)
            failed_.emplace(machine_, *made_, block, task);
    }
}

void Session::stand(Stop stop, const st::Halt* halt) {
    plan_.reset();
    halt_ = failed_ ? &failed_->halt() : halt;
    command_ = {};
    front_.stopped(stop);
    halt_ = nullptr;
    obey(halt);
}

/// Within a scan all that comes in the instant still runs, and is not told, when it is left.
void Session::obey(const st::Halt* halt) {
    const Plan plan{command_, here_, halt ? halt->depth : 0, halt ? halt->now.index : -1};
    const Way way = command_.way;
    if (ending_ || way == Way::end || way == Way::none) {
        ending_ = quiet_ = true;
    } else if (way == Way::back || way == Way::back_go || way == Way::to || way == Way::writer) {
        jump_ = plan;
        quiet_ = true;
    } else if (way != Way::go) {
        plan_ = plan;
    }
    plain_scan_ = -1;
    executive_->hold();
}

}  // namespace lineshaft::debug
