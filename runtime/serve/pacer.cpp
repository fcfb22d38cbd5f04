#include "runtime/serve/pacer.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

namespace lineshaft {

namespace {

constexpr std::int64_t second = 1'000'000'000;
constexpr double century = 3.2e18;

std::int64_t nearest_nanosecond(double nanoseconds) {
    return std::llround(std::clamp(nanoseconds, -century, century));
}

}  // namespace

void Pacer::anchor(std::int64_t time, std::int64_t wall) {
    time_ = time;
    wall_ = wall;
}

std::int64_t Pacer::due(std::int64_t time) const {
    return wall_ + nearest_nanosecond(static_cast<double>(time - time_) / speed_);
}

std::int64_t Pacer::time_at(std::int64_t wall) const {
    return time_ + nearest_nanosecond(static_cast<double>(wall - wall_) * speed_);
}

std::int64_t Pacer::now() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * second + now.tv_nsec;
}

void Pacer::sleep_until(std::int64_t wall) {
    const timespec until{.tv_sec = wall / second, .tv_nsec = wall % second};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

void Pacer::take_sleep_at_its_word() {
    ::prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0);
}

std::string Pacer::be_realtime(int priority) {
    const sched_param wanted{.sched_priority = priority};
    if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) != 0)
        return fmt::format("cannot run at real-time priority {}: {}", priority,
                           std::strerror(errno));
    // What comes later is mostly stacks of clients' threads, 8 MiB each, of which they use little.
    if (::mlockall(MCL_CURRENT) != 0 || ::mlockall(MCL_FUTURE | MCL_ONFAULT) != 0)
        return fmt::format("cannot lock the memory: {}", std::strerror(errno));
    return {};
}

}  // namespace lineshaft
