#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

Slot emit_reset(Emission& e) {
    e.reset_timer(0);
    return 0;
}

// clang-format off
constexpr StandardFunction timers[] = {
    {"RESET_TIMER(TIMER: TIMER)", "lets the timer begin anew; its PT stays", Rewriting::reset_timer, Eno::always, emit_reset},
    {"PRESET_TIMER(PT: TIME; TIMER: TIMER)", "gives the timer another PT", Rewriting::preset_timer},
};
// clang-format on

}  // namespace

constinit const Subject timer_functions{"timers", timers};

}  // namespace lineshaft::st
