#pragma once

#include "runtime/projects/drawings/s7_running.hpp"

namespace lineshaft::projects::s7 {

// Boxes: what each does, and the power behind it.

Value move(Running& r);
Value text_move(Running& r);
Value arithmetic(Running& r);
Value negation(Running& r);
Value inversion(Running& r);
Value power_of(Running& r);
Value increment(Running& r);
Value decrement(Running& r);
Value conversion(Running& r);
Value limit(Running& r);
Value scale(Running& r);
Value normalize(Running& r);
Value plain_function(Running& r);
Value typed_function(Running& r);
Value multiplexer(Running& r);
Value formula(Running& r);
Value bits_set(Running& r);
Value bits_reset(Running& r);
Value timer(Running& r);
Value up_counter(Running& r);
Value down_counter(Running& r);
Value up_down_counter(Running& r);
Value called(Running& r);
Value other_function(Running& r);
Value text_conversion(Running& r);

// s5_boxes.cpp: timers and counters of the controller itself.

Value s5_timer(Running& r);
Value s5_counter(Running& r);
Value s5_timer_coil(Running& r);
Value s5_counter_coil(Running& r);

}  // namespace lineshaft::projects::s7
