#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

Slot emit_normalise(Emission& e) {
    const Slot min = e.value(0), in = e.value(1), max = e.value(2);
    e.land();  // MIN is read twice
    const Op sub = e.of_real(Op::sub_real, Op::sub_lreal);
    const Slot above = e.emit(sub, in, min), range = e.emit(sub, max, min);
    return e.result(e.of_real(Op::div_real, Op::div_lreal), above, range);
}

Slot emit_scale(Emission& e) {
    const Slot min = e.value(0), in = e.value(1), max = e.value(2);
    e.land();  // MIN is read twice
    const Slot range = e.emit(e.of_real(Op::sub_real, Op::sub_lreal), max, min);
    const Slot above = e.emit(e.of_real(Op::mul_real, Op::mul_lreal), in, range);
    return e.result(e.of_real(Op::add_real, Op::add_lreal), above, min);
}

// clang-format off
/// What comes from outside, and what it is to be.
constexpr StandardFunction measured[] = {
    {"NORM_X(MIN, VALUE, MAX: ANY_REAL): ANY_REAL", "where VALUE is from MIN to MAX: (VALUE - MIN) / (MAX - MIN)",
     Typing::reals, emit_normalise, Op::move, Eno::scaled},
    {"SCALE_X(MIN, VALUE, MAX: ANY_NUM): ANY_NUM", "VALUE * (MAX - MIN) + MIN, rounded where that is an integer",
     Typing::scaled, emit_scale, Op::move, Eno::scaled},
    {"IS_VALID(IN: ANY_REAL): BOOL", "IN is a number, and not infinite", Typing::real,
     [](Emission& e) { return e.result(Op::is_finite, e.value(0)); }},
    {"IS_VALID_BCD(IN: ANY_BIT): BOOL", "each four bits of IN are a decimal digit", Typing::bits,
     [](Emission& e) { return e.result(Op::is_bcd, e.value(0)); }},
};
// clang-format on

}  // namespace

constinit const Subject measured_functions{"measured", measured};

}  // namespace lineshaft::st
