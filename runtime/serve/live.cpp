#include "runtime/serve/live.hpp"

#include <algorithm>
#include <numeric>

namespace lineshaft {

namespace {

constexpr std::int64_t ms = 1'000'000;

/// How long the mail waits at most, on the clock, while nothing is due or too much [ns].
constexpr std::int64_t patience = 2 * ms;

}  // namespace

std::int64_t Pace::overruns() const {
    return std::accumulate(tasks.begin(), tasks.end(), std::int64_t{0},
                           [](std::int64_t sum, const TaskPace& t) { return sum + t.overruns; });
}

nlohmann::ordered_json to_json(const Pace& pace) {
    const auto us = [](std::int64_t time) { return static_cast<double>(time) / 1e3; };
    auto tasks = nlohmann::ordered_json::array();
    for (const TaskPace& task : pace.tasks) {
        auto histogram = nlohmann::ordered_json::array();
        for (const auto& [below, count] : task.lateness.histogram())
            histogram.push_back({{"below_us", us(below)}, {"scans", count}});
        tasks.push_back({{"name", task.name},
                         {"scans", task.scans},
                         {"paced_scans", task.lateness.count()},
                         {"overruns", task.overruns},
                         {"lateness_us",
                          {{"p50", us(task.lateness.quantile(0.5))},
                           {"p99", us(task.lateness.quantile(0.99))},
                           {"p99.9", us(task.lateness.quantile(0.999))},
                           {"greatest", us(task.lateness.greatest())}}},
                         {"histogram", histogram}});
    }
    return {{"tasks", tasks},
            {"overruns", pace.overruns()},
            {"skipped_s", static_cast<double>(pace.skipped) / 1e9}};
}

Live::Live(Loaded& loaded, Executive& executive, const LiveOptions& options,
           RecordingWriter* recording, World& world)
    : machine_(loaded.linked.machine),
      executive_(executive),
      options_(options),
      world_(world),
      mailbox_(world),
      pacer_(options.speed),
      recording_(recording) {
    for (const Task& task : machine_.tasks) {
        pace_.tasks.push_back({.name = task.name, .every = task.every, .lateness = {}});
        if (task.every > 0 && (shortest_ == 0 || task.every < shortest_)) shortest_ = task.every;
    }
    executive.add(*this);
}

void Live::drive() {
    Pacer::take_sleep_at_its_word();
    pacer_.anchor(time(), world_.now());
    while (goes_on_ && time() < options_.end && !*options_.interrupt) turn();
    mailbox_.close();
}

void Live::turn() {
    const std::int64_t limit = std::min({options_.end, goal_, machine_.duration});
    const std::int64_t next = std::min(executive_.next_time(), limit);
    if (paused_)
        rest();
    else if (pacer_.is_paced())
        run_paced(next);
    else
        run_freely(next, limit);
    if (time() < goal_) return;
    goal_ = never;
    paused_ = true;
}

void Live::rest() {
    if (mailbox_.waits())
        mailbox_.deliver();
    else
        world_.sleep_until(world_.now() + patience);
}

void Live::run_paced(std::int64_t next) {
    const std::int64_t now = world_.now(), due = pacer_.due(next);
    if (now < due) {
        if (mailbox_.waits()) {
            advance(std::clamp(pacer_.time_at(now), time(), next - 1));
            deliver();
        } else {
            world_.sleep_until(std::min(due, now + patience));
        }
        return;
    }
    late_ = now - due;
    if (options_.late == WhenLate::skip && shortest_ > 0 &&
        late_ >= pacer_.due(shortest_) - pacer_.due(0)) {
        pacer_.put_off(late_);
        pace_.skipped += late_;
    }
    advance(next);
    if (now - delivered_ > patience) deliver();
}

void Live::run_freely(std::int64_t next, std::int64_t limit) {
    if (next == machine_.duration) return rest();
    const std::int64_t begun = world_.now();
    advance(std::min(limit, std::max(next, later(time(), chunk_))));
    const std::int64_t took = std::max<std::int64_t>(world_.now() - begun, 1);
    chunk_ = std::clamp<std::int64_t>(took > ms ? chunk_ / 2 : chunk_ * 2, 1000, never / 4);
    deliver();
}

void Live::deliver() {
    delivered_ = world_.now();
    if (mailbox_.waits()) mailbox_.deliver();
}

void Live::advance(std::int64_t time) {
    goes_on_ = executive_.run_until(time);
    sample();
}

void Live::sample() {
    if (streams_.empty()) return;
    for (const auto& stream : streams_) stream->sample(time());
    std::erase_if(streams_, [](const auto& stream) { return stream->is_closed(); });
}

void Live::scanned(int task, const Scan& scan) {
    TaskPace& pace = pace_.tasks[static_cast<std::size_t>(task)];
    ++pace.scans;
    if (step_task_ < 0 || step_task_ == task) --steps_;
    if (!pacer_.is_paced() || paused_) return;
    pace.lateness.add(late_);
    if (scan.interval > 0 && late_ >= pacer_.due(scan.interval) - pacer_.due(0)) ++pace.overruns;
}

Applied Live::apply(const std::vector<Change>& changes) {
    std::vector<Change> taken = changes;
    executive_.make_room(taken.size());
    Applied applied{.at = executive_.time() + 1};
    if (recording_) applied.mark = recording_->append(recorded(applied.at, changes));
    for (Change& change : taken) {
        if (change.kind == Change::Kind::set)
            executive_.post(std::move(change.stimulus));
        else if (change.kind == Change::Kind::force)
            executive_.force(std::move(change.force));
        else
            executive_.lift_force(change.live);
    }
    return applied;
}

std::string Live::keep(const Applied& applied) {
    return recording_ ? recording_->keep(applied.mark) : "";
}

void Live::pause() {
    paused_ = true;
}

void Live::resume() {
    paused_ = false;
    pacer_.anchor(time(), world_.now());
}

std::int64_t Live::step(int task, std::int64_t scans) {
    pause();
    step_task_ = task;
    steps_ = scans;
    const std::int64_t limit = std::min(options_.end, machine_.duration);
    for (const std::int64_t begun = world_.now();
         steps_ > 0 && goes_on_ && time() < limit && world_.now() - begun < patience;)
        advance(std::min(executive_.next_time(), limit));
    return time() < limit ? std::max<std::int64_t>(steps_, 0) : 0;
}

bool Live::run_until(std::int64_t time) {
    if (time < this->time()) return false;
    resume();
    goal_ = time;
    return true;
}

void Live::set_speed(double speed) {
    pacer_.set_speed(speed);
    pacer_.anchor(time(), world_.now());
}

LiveState Live::state() const {
    LiveState state{.time = time(),
                    .speed = pacer_.speed(),
                    .paused = paused_,
                    .forced = {},
                    .pace = pace_,
                    .recording = recording_ ? recording_->path() : "",
                    .recording_error = recording_error()};
    for (const Force& force : machine_.forces)
        if (force.from <= time() + 1 && time() + 1 < force.until)
            state.forced.push_back({force.name, force.value_text});
    return state;
}

}  // namespace lineshaft
