#include "blocks/other_valid.hpp"

namespace lineshaft {

namespace {

constexpr std::int64_t far = std::int64_t{1} << 61;

bool is_valid(const PulseSegment& segment) {
    const auto within = [](std::int64_t value) { return value > -far && value < far; };
    return within(segment.start_rate) && within(segment.end_rate) && within(segment.count);
}

bool is_valid(const Pto::Train& train, const Pto& output) {
    const std::int64_t most = std::max<std::int64_t>(output.profile.size, 1);
    return are_booleans(train.from_profile, train.multi_segment, train.reverse) &&
           is_valid(train.segment) && train.segments >= 1 && train.segments <= most &&
           (!train.from_profile || output.profile.size > 0);
}

bool are_counts(std::initializer_list<std::int64_t> numbers) {
    return std::ranges::all_of(numbers, is_count);
}

}  // namespace

bool is_valid(const Ctu& counter, const KeptState&) {
    return are_booleans(counter.last_cu, counter.stops_at_preset);
}

bool is_valid(const Ctd& counter, const KeptState&) {
    return are_booleans(counter.last_cd, counter.stops_at_preset);
}

bool is_valid(const Ctud& counter, const KeptState&) {
    return are_booleans(counter.last_cu, counter.last_cd, counter.stops_at_preset);
}

bool is_valid(const FilterPt1& filter, const KeptState& machine) {
    return are_booleans(filter.started) && machine.is_moment(filter.last_time);
}

bool is_valid(const CircleFit& fit, const KeptState&) {
    return are_booleans(fit.taking) && is_count(fit.samples);
}

bool is_valid(const PathMove& move, const KeptState& machine) {
    return are_booleans(move.last_execute, move.told, move.started) &&
           machine.is_moment(move.start_time) &&
           is_one_of(move.plan.kind, MoveKind::peak_falling_neither) &&
           are_booleans(move.plan.reaches_Ve);
}

bool is_valid(const ContourError& error, const KeptState&) {
    return error.path.is_possible();
}

bool is_valid(const ContourComparison& comparison, const KeptState&) {
    const ContourComparison& c = comparison;
    return are_booleans(c.last_enable) && c.path.is_possible() &&
           are_counts({c.samples, c.real_time_error.count, c.linear_error.count,
                       c.spline_error.count, c.following_error.count, c.to_linear.count,
                       c.to_spline.count, c.points_back.count});
}

/// A train under way has given its edges up to the last advance, which was in the last instant: so
/// there are not more at once than time brings.
bool is_valid(const Pto& output, const KeptState& machine) {
    const Pto& p = output;
    if (!are_booleans(p.last_execute, p.last_stop, p.told) ||
        !is_one_of(p.command, Pto::Command::halt) ||
        !is_one_of(p.command_refused, Pto::Refusal::not_pto) || !is_valid(p.last_single) ||
        p.profile.size < 0 || p.profile.size > std::ssize(p.profile.rows))
        return false;
    if (!are_counts({p.trains, p.pulses, p.lost, p.refused, p.warnings, far + p.position}))
        return false;
    if (p.command == Pto::Command::load && p.command_refused == Pto::Refusal::none &&
        !is_valid(p.commanded, p))
        return false;
    if (p.queued && !is_valid(p.waiting, p)) return false;
    if (!p.busy) return machine.is_moment(p.advanced);
    return is_valid(p.active, p) && p.active_segment >= 1 &&
           p.active_segment <= p.active.segments && p.advanced == machine.now &&
           p.train.is_possible(p.advanced);
}

}  // namespace lineshaft
