#include "blocks/logic/timer.hpp"

#include <algorithm>

#include "blocks/inputs.hpp"

namespace lineshaft {

template <TimerKind kind>
std::span<const Field> Timer<kind>::fields() {
    using T = Timer;
    static const Field table[] = {
        input("in", &T::in, "", "starts the timer").must_be_set(),
        input("pt", &T::pt, "ns", "preset time, such as 500 ms").must_be_set(),
        output("q", &T::q, "", "the signal delayed, or the pulse"),
        output("et", &T::et, "ns", "elapsed time, up to pt"),
        local("keeps_pt", &T::keeps_pt, "", "a new pt counts from the next start on"),
        local("answers_later", &T::answers_later, "",
              "the call that starts it does not ask for pt"),
        local("preset", &T::preset, "ns", "pt at the last start"),
    };
    return table;
}

template <TimerKind kind>
void Timer<kind>::begin(const Scan& now) {
    running = true;
    start = now.time;
    preset = pt;
}

template <TimerKind kind>
bool Timer<kind>::elapsed(const Scan& now) {
    const std::int64_t time = now.time - start;
    et = std::min(time, std::max<std::int64_t>(limit(), 0));
    return time >= limit();
}

template <>
void Ton::scan(const Scan& now) {
    if (!in) {
        running = q = false;
        et = 0;
        return;
    }
    if (!running) {
        begin(now);
        if (answers_later) return;
    }
    if (!q) q = elapsed(now);
}

template <>
void Tof::scan(const Scan& now) {
    if (in) {
        q = true;
        running = false;
        et = 0;
        return;
    }
    if (!q) return;
    if (!running) {
        begin(now);
        if (answers_later) return;
    }
    q = !elapsed(now);
}

template <>
void Tp::scan(const Scan& now) {
    const bool edge = rising_edge(in, last_in);
    const bool starts = !q && edge;
    if (starts) begin(now);
    if (starts && answers_later)
        q = true;
    else if (starts || q)
        q = !elapsed(now);
    if (!q && !in) et = 0;
}

template struct Timer<TimerKind::ton>;
template struct Timer<TimerKind::tof>;
template struct Timer<TimerKind::tp>;

}  // namespace lineshaft
