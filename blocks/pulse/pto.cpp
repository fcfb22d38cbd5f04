#include "blocks/pulse/pto.hpp"

#include <algorithm>

namespace lineshaft {

namespace {

constexpr std::int64_t most_single = 65'535, most_multi = 100'000;  // [Hz]
constexpr std::int64_t most_pulses = 2'147'483'647;
constexpr double shortest_segment = 500e-6;  // [s]
constexpr std::size_t edges_at_once = 1024;

constexpr std::string_view rate_update_names[] = {"continuous", "per_pulse"};
constexpr std::string_view warning_names[] = {"none",    "overflow",          "no_segments",
                                              "not_pto", "rate_out_of_range", "count_out_of_range"};
constexpr std::span refusal_names = std::span(warning_names).first(4);

bool bit(std::int64_t byte, int number) {
    return (byte >> number & 1) != 0;
}

}  // namespace

std::span<const Field> Pto::fields() {
    using P = Pto;
    static const Field list[] = {
        parameter("rate_update", &P::rate_update, "", "when a new rate takes effect")
            .one_of(rate_update_names),
        parameter("underflow_ends", &P::underflow_ends, "",
                  "a segment shorter than 500 us ends the train"),
        input("enable", &P::enable, "", "false: executing ends the output"),
        input("multi_segment", &P::multi_segment, "", "true: by the profile table"),
        input("update_rate", &P::update_rate, "", "false: a single segment keeps the last rate"),
        input("update_count", &P::update_count, "", "false: it keeps the last count"),
        input("control", &P::control, "", "SMB67 in place of these four, if 0 or more")
            .at_most(255),
        input("start_rate", &P::start_rate, "Hz",
              "rate of a single segment, up to 65535 Hz, or at the start of the one segment")
            .at_least(1)
            .at_most(most_multi),
        input("end_rate", &P::end_rate, "Hz", "multi-segment: rate at the end of the one segment")
            .at_least(1)
            .at_most(most_multi),
        input("count", &P::count, "", "pulses").at_least(1).at_most(most_pulses),
        input("segments", &P::segments, "", "of the profile to run; below 0: all").at_most(255),
        input("reverse", &P::reverse, "", "direction of the next train"),
        input("interrupt", &P::interrupt, "", "the end of a train sets `done` (ATCH)"),
        input("execute", &P::execute, "", "rising edge: the PLS instruction"),
        input("job", &P::job, "", "each change: the PLS instruction"),
        input("stop", &P::stop, "", "rising edge: ends the output at once"),
        output("busy", &P::busy, "", "a train is under way"),
        output("queued", &P::queued, "", "another one waits"),
        output("done", &P::done, "",
               "a train has ended; for one whole scan of this block at least"),
        output("active_segment", &P::active_segment, "", "from 1, as SMB166; 0: idle"),
        output("trains", &P::trains, "", "trains that have ended, stopped ones too"),
        output("pulses", &P::pulses, "", "rising edges so far"),
        output("position", &P::position, "", "forward less reverse pulses so far"),
        output("lost", &P::lost, "", "pulses loaded and not made, because the output was ended"),
        output("rate", &P::rate, "Hz", "now; 0: idle"),
        output("end_time", &P::end_time, "s", "virtual time at which the last train has ended"),
        output("reversed", &P::reversed, "", "direction output"),
        output("clamped", &P::clamped, "", "a rate or count was out of range"),
        output("overflow", &P::overflow, "", "a train came while another one waited (SM66.6)"),
        output("underflow", &P::underflow, "", "a segment was shorter than 500 us (SM66.6)"),
        output("stopped", &P::stopped, "", "the output was ended by the program"),
        output("refused", &P::refused, "", "instructions that were ignored"),
        output("refusal", &P::refusal, "", "why the last of them was").one_of(refusal_names),
        output("warnings", &P::warnings, "", "what was clamped or refused so far"),
        output("warning_id", &P::warning_id, "", "why the last of it was").one_of(warning_names),
    };
    return list;
}

std::span<const TableField> Pto::tables() {
    static const Field columns[] = {
        column("start_rate", "Hz", "rate at the segment's start").at_least(1).at_most(most_multi),
        column("end_rate", "Hz", "rate at its end").at_least(1).at_most(most_multi),
        column("count", "", "pulses").at_least(1).at_most(most_pulses)};
    static const TableField list[] = {
        table("profile", &Pto::profile, columns, "the profile table, a row a segment")};
    return list;
}

std::optional<Misfit> Pto::misfit(const IsConstant& is_constant) const {
    if (!is_constant("control")) return {};
    const bool by_byte = control >= 0;
    if (by_byte && !bit(control, 6))
        return Misfit{"control", "bit 6 chooses pulse train output; without it all is refused"};
    if (!by_byte && !is_constant("multi_segment")) return {};
    const bool multi = by_byte ? bit(control, 5) : multi_segment;
    if (!multi && profile.size > 0)
        return Misfit{"profile", "a profile is for multi-segment output: multi_segment: true"};
    if (!multi && is_constant("start_rate") && start_rate > most_single)
        return Misfit{"start_rate", "a single segment has at most 65535 Hz"};
    const std::int64_t most = std::max<std::int64_t>(profile.size, 1);
    if (multi && is_constant("segments") && (segments == 0 || segments > most))
        return Misfit{"segments", "name as many as the profile has, or -1 for all"};
    return {};
}

void Pto::scan(const Scan&) {
    done = done && !told;
    told = done;
    const bool executed = rising_edge(execute, last_execute);
    const bool ordered = job != last_job;
    last_job = job;
    command = Command::none;
    if (executed || ordered) take_instruction();
    if (rising_edge(stop, last_stop)) command = Command::halt;
}

void Pto::take_instruction() {
    const bool by_byte = control >= 0;
    const bool multi = by_byte ? bit(control, 5) : multi_segment;
    commanded = {.segment = {}, .multi_segment = multi, .reverse = reverse};
    command = (by_byte ? bit(control, 7) : enable) ? Command::load : Command::halt;
    command_refused = by_byte && !bit(control, 6) ? Refusal::not_pto : Refusal::none;
    if (!multi) {
        if (by_byte ? bit(control, 0) : update_rate) last_single.start_rate = start_rate;
        if (by_byte ? bit(control, 2) : update_count) last_single.count = count;
        last_single.end_rate = last_single.start_rate;
        commanded.segment = last_single;
        return;
    }
    commanded.segment = {start_rate, end_rate, count};
    commanded.from_profile = profile.size > 0;
    const std::int64_t most = std::max<std::int64_t>(profile.size, 1);
    commanded.segments = segments < 0 ? most : segments;
    if (commanded.segments < 1 || commanded.segments > most) command_refused = Refusal::no_segments;
}

void Pto::publish(std::int64_t time) {
    if (command == Command::load) load(time);
    if (command == Command::halt) halt({time, 0});
    command = Command::none;
}

void Pto::load(std::int64_t time) {
    if (command_refused == Refusal::none && queued) command_refused = Refusal::overflow;
    if (command_refused != Refusal::none) {
        refusal = command_refused;
        overflow = overflow || refusal == Refusal::overflow;
        ++refused;
        warn(static_cast<Warning>(refusal));
    } else if (busy) {
        waiting = commanded;
        queued = true;
    } else {
        begin_train(commanded, {time, 0});
    }
}

void Pto::warn(Warning why) {
    ++warnings;
    warning_id = why;
}

void Pto::halt(PulseTime time) {
    if (busy) {
        lost += train.segment().count - train.emitted();
        stopped = true;
        end_train(time);
    }
    if (queued) lose_from(waiting, 0);
    queued = false;
}

void Pto::begin_train(const Train& next, PulseTime start) {
    active = next;
    active_segment = 0;
    busy = true;
    stopped = false;
    reversed = next.reverse;
    begin_segment(start);
}

void Pto::begin_segment(PulseTime start) {
    const PulseSegment wanted = segment_of(active, active_segment);
    const PulseSegment segment = clamp(wanted, active.multi_segment);
    if (segment.start_rate != wanted.start_rate || segment.end_rate != wanted.end_rate)
        warn(Warning::rate_out_of_range);
    if (segment.count != wanted.count) warn(Warning::count_out_of_range);
    train.begin(segment, rate_update, start);
    ++active_segment;
}

PulseSegment Pto::segment_of(const Train& of, std::int64_t index) const {
    return of.from_profile ? profile.rows[static_cast<std::size_t>(index)] : of.segment;
}

void Pto::lose_from(const Train& of, std::int64_t first_segment) {
    for (std::int64_t i = first_segment; i < of.segments; ++i)
        lost += clamp(segment_of(of, i), of.multi_segment).count;
}

PulseSegment Pto::clamp(const PulseSegment& wanted, bool multi) {
    const std::int64_t most = multi ? most_multi : most_single;
    const PulseSegment segment{std::clamp<std::int64_t>(wanted.start_rate, 1, most),
                               std::clamp<std::int64_t>(wanted.end_rate, 1, most),
                               std::clamp<std::int64_t>(wanted.count, 1, most_pulses)};
    clamped = clamped || segment != wanted;
    return segment;
}

bool Pto::is_too_short() const {
    const PulseSegment& s = train.segment();
    const auto rates = static_cast<double>(s.start_rate + s.end_rate);
    return 2 * static_cast<double>(s.count) < shortest_segment * rates;
}

bool Pto::in_last_segment() const {
    return active_segment >= active.segments || (underflow_ends && is_too_short());
}

/// At the end of this segment `done` must rise, and is still true.
bool Pto::renews_done() const {
    return done && interrupt && in_last_segment();
}

std::int64_t Pto::next_event_time() const {
    if (!busy) return never;
    const std::int64_t end = train.end_not_before();
    return renews_done() ? std::max(end - 1, advanced + 1) : end;
}

void Pto::advance(std::int64_t time, PulseSink* sink) {
    advanced = time;
    while (busy) {
        emit(time, sink);
        rate = train.rate(time);
        if (renews_done() && train.ends(time + 1)) done = false;
        if (!train.ends(time)) return;
        end_segment();
    }
}

void Pto::emit(std::int64_t time, PulseSink* sink) {
    const std::int64_t before = train.emitted();
    if (sink) {
        std::array<std::int64_t, edges_at_once> edges;
        for (std::size_t taken = edges.size(); taken == edges.size();) {
            taken = train.take(time, edges);
            sink->edges(std::span(edges).first(taken), reversed);
        }
    } else {
        train.skip(time);
    }
    const std::int64_t made = train.emitted() - before;
    pulses += made;
    position += reversed ? -made : made;
}

void Pto::end_segment() {
    underflow = underflow || is_too_short();
    if (!in_last_segment()) return begin_segment(train.end());
    end_train(train.end());
    if (!queued) return;
    queued = false;
    begin_train(waiting, train.end());
}

void Pto::end_train(PulseTime end) {
    lose_from(active, active_segment);
    ++trains;
    end_time = seconds(end.rounded());
    done = done || interrupt;
    told = told && !interrupt;
    busy = false;
    active_segment = 0;
    rate = 0;
}

}  // namespace lineshaft
