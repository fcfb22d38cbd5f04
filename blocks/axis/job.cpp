#include "blocks/axis/job.hpp"

#include <fmt/format.h>

namespace lineshaft {

std::string text_of(MotionError error, const Shortage& shortage, std::string_view unit) {
    if (error != MotionError::sync_limits || !(shortage.needed > shortage.allowed))
        return std::string(text_of(error));
    if (shortage.limit == CurveFault::none)
        return fmt::format(
            "the coupling takes {:.5g} times the velocity, acceleration and jerk that are "
            "the limit",
            shortage.needed);
    const auto quantity =
        static_cast<std::size_t>(shortage.limit) - static_cast<std::size_t>(CurveFault::velocity);
    constexpr std::string_view names[] = {"a velocity", "an acceleration", "a jerk"};
    constexpr std::string_view per[] = {"/s", "/s^2", "/s^3"};
    return fmt::format("the coupling takes {} of {:.5g} {}{}, and {:.5g} {}{} is the limit",
                       names[quantity], shortage.needed, unit, per[quantity], shortage.allowed,
                       unit, per[quantity]);
}

std::string text_of_profile(const Shortage& shortage, std::string_view unit) {
    if (shortage.needed == shortage.allowed || shortage.limit > CurveFault::acceleration)
        return std::string(text_of(MotionError::out_of_range));
    const auto quantity = static_cast<std::size_t>(shortage.limit);
    constexpr std::string_view names[] = {"at the position", "with the velocity",
                                          "with the acceleration"};
    constexpr std::string_view per[] = {"", "/s", "/s^2"};
    return fmt::format("the profile begins or ends {} {:.5g} {}{}, where {:.5g} {}{} is due",
                       names[quantity], shortage.allowed, unit, per[quantity], shortage.needed,
                       unit, per[quantity]);
}

void JobState::tell(Progress how, MotionError why, std::int64_t by_task, std::int64_t in_scan) {
    if (told_by != by_task || told_in != in_scan) before = progress;
    progress = how;
    if (how == Progress::reached) has_reached = 1;
    error = why;
    told_by = by_task;
    told_in = in_scan;
}

void link(const Context& context, JobState& job, JobList& list, JobPlace in) {
    const std::int64_t place = context.place_of(job);
    job.in = in;
    job.previous = list.last;
    job.next = nowhere;
    (list.first == nowhere ? list.first : context.at<JobState>(list.last).next) = place;
    list.last = place;
}

void unlink(const Context& context, JobState& job, JobList& list) {
    const std::int64_t place = context.place_of(job);
    std::int64_t at = list.first;
    while (at != place && at != nowhere) at = context.at<JobState>(at).next;
    if (at == nowhere) return;
    (job.previous == nowhere ? list.first : context.at<JobState>(job.previous).next) = job.next;
    (job.next == nowhere ? list.last : context.at<JobState>(job.next).previous) = job.previous;
    job.in = JobPlace::no_list;
    job.previous = job.next = nowhere;
}

JobList take_due(const Context& context, JobList& inbox) {
    JobList due;
    std::int64_t next = nowhere;
    for (std::int64_t place = inbox.first; place != nowhere; place = next) {
        JobState& job = context.at<JobState>(place);
        next = job.next;
        if (!context.is_published(job.task, job.scan)) continue;
        unlink(context, job, inbox);
        std::int64_t* link = &due.first;
        while (*link != nowhere && context.at<JobState>(*link).task <= job.task)
            link = &context.at<JobState>(*link).next;
        job.next = *link;
        *link = place;
    }
    return due;
}

}  // namespace lineshaft
