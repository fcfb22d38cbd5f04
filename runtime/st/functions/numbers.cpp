#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

Slot emit_real(Emission& e) {
    const Slot a = e.value(0);
    return e.rounded(e.call.standard->op, a, e.count() > 1 ? e.value(1) : 0);
}

Slot emit_square(Emission& e) {
    const Slot a = e.value(0);
    return e.result(e.of_real(Op::mul_real, Op::mul_lreal), a, a);
}

Slot emit_fraction(Emission& e) {
    const Slot a = e.value(0);
    return e.result(Op::sub_lreal, a, e.emit(Op::truncate, a));
}

/// MatIEC's is a cast in C, which an x86-64 does by 32 or, for an UDINT and more, by 64 bits.
Slot cast(Emission& e, Slot whole) {
    const bool is_long = e.type().bits == 64 || (e.type().bits == 32 && !e.type().is_signed);
    return e.result(of_type(Op::wrap_sint, e.type()),
                    e.emit(is_long ? Op::left_in_64 : Op::truncated_in_32, whole));
}

Slot emit_whole(Emission& e) {
    const Slot whole = e.emit(e.call.standard->op, e.value(0));
    const Place& place = e.call.place;
    const Dialect& dialect = place.dialect();
    if (dialect.functions_are_in_c && e.call.standard->op == Op::truncate) return cast(e, whole);
    if (dialect.beyond_type == BeyondType::fault || place.source->is_prelude())
        return e.result(of_type(Op::round_sint, e.type()), whole);
    if (dialect.beyond_type == BeyondType::lowest_bits)
        return e.result(of_type(Op::wrap_sint, e.type()), e.emit(Op::lowest_bits, whole));
    if (e.call.standard->op == Op::truncate)
        return e.result(of_type(Op::wrap_sint, e.type()), e.emit(Op::truncated_in_32, whole));
    return e.result(of_type(Op::round_sint, e.type()), whole);
}

Slot emit_absolute(Emission& e) {
    if (e.type().is_real()) return e.result(Op::abs_lreal, e.value(0));
    if (!e.type().is_signed) return e.value(0);
    return e.fitted(e.emit(Op::abs_signed, e.value(0)));
}

Op greatest(Emission& e) {
    return e.of_number(Op::max_lreal, Op::max_unsigned, Op::max_signed);
}

Op least(Emission& e) {
    return e.of_number(Op::min_lreal, Op::min_unsigned, Op::min_signed);
}

/// Where one of two is no number, the first is kept, in CODESYS the second.
bool keeps_second(const Emission& e) {
    return e.call.place.dialect().extremes_keep_second;
}

Slot emit_extremum(Emission& e) {
    const Op op = e.call.standard->op == Op::max_signed ? greatest(e) : least(e);
    Slot so_far = e.value(0);
    for (std::size_t i = 1; i + 1 < e.count(); ++i) {
        const Slot next = e.value(i);
        so_far = keeps_second(e) ? e.emit(op, next, so_far) : e.emit(op, so_far, next);
    }
    const Slot last = e.value(e.count() - 1);
    return keeps_second(e) ? e.result(op, last, so_far) : e.result(op, so_far, last);
}

Slot emit_limit(Emission& e) {
    const Slot mn = e.value(0), in = e.value(1), mx = e.value(2);
    const CrossedLimits crossed = e.call.place.dialect().crossed_limits;
    const Op if_less =
        e.of_number(Op::move_if_lt_float, Op::move_if_lt_unsigned, Op::move_if_lt_signed);
    if (crossed == CrossedLimits::upper_or_lower) {
        const Slot limited = e.emit(Op::move, mn);
        e.put(if_less, mn, in, limited, e.emit(least(e), in, mx));
        e.land();
        return limited;
    }
    if (keeps_second(e)) return e.result(least(e), mx, e.emit(greatest(e), in, mn));
    if (crossed == CrossedLimits::upper) return e.result(least(e), e.emit(greatest(e), in, mn), mx);
    const Slot limited = e.emit(least(e), e.emit(greatest(e), in, mn), mx);
    e.put(if_less, mx, mn, limited, in);
    e.land();
    return limited;
}

Slot emit_select(Emission& e) {
    const Slot second = e.value(0), first = e.several(1);
    return e.result(Op::select, second, first);
}

Slot emit_multiplex(Emission& e) {
    const Slot k = e.value(0), first = e.several(1);
    const std::uint64_t count = e.count() - 1;
    const Slot place =
        e.call.has_else ? e.emit(Op::min_unsigned, k, e.constant(count - 1)) : e.index(k, count);
    return e.result(Op::load_at, first, place);
}

consteval StandardFunction real(std::string_view signature, std::string_view doc, Op op,
                                Eno eno = Eno::always) {
    return {signature, doc, Typing::real, emit_real, op, eno};
}

consteval StandardFunction whole(std::string_view signature, std::string_view doc, Op op) {
    return {signature, doc, Typing::real, emit_whole, op, Eno::converted};
}

// clang-format off
constexpr StandardFunction numbers[] = {
    {"ABS(IN: ANY_MAGNITUDE): ANY_MAGNITUDE", "the number without its sign", Typing::own, emit_absolute, Op::move, Eno::valid},
    real("SQRT(IN: ANY_REAL): ANY_REAL", "the square root; of what is below 0 not a number", Op::sqrt, Eno::valid),
    real("LN(IN: ANY_REAL): ANY_REAL", "the logarithm to the base e", Op::ln, Eno::valid),
    real("LOG(IN: ANY_REAL): ANY_REAL", "the logarithm to the base 10", Op::log10),
    real("EXP(IN: ANY_REAL): ANY_REAL", "e to the power IN", Op::exp, Eno::valid),
    real("SIN(IN: ANY_REAL): ANY_REAL", "the sine of an angle [rad]", Op::sin, Eno::valid),
    real("COS(IN: ANY_REAL): ANY_REAL", "the cosine of an angle [rad]", Op::cos, Eno::valid),
    real("TAN(IN: ANY_REAL): ANY_REAL", "the tangent of an angle [rad]", Op::tan, Eno::valid),
    real("ASIN(IN: ANY_REAL): ANY_REAL", "the angle whose sine is IN, -pi/2 to pi/2 [rad]", Op::asin, Eno::valid),
    real("ACOS(IN: ANY_REAL): ANY_REAL", "the angle whose cosine is IN, 0 to pi [rad]", Op::acos, Eno::valid),
    real("ATAN(IN: ANY_REAL): ANY_REAL", "the angle whose tangent is IN, -pi/2 to pi/2 [rad]", Op::atan, Eno::valid),
    {"ATAN2(Y, X: ANY_REAL): ANY_REAL", "the angle of the point (X, Y), -pi to pi [rad]",
     Typing::reals, emit_real, Op::atan2},
    real("ATANH(IN: ANY_REAL): ANY_REAL", "the number whose hyperbolic tangent is IN, -1 to 1", Op::atanh),
    real("TANH(IN: ANY_REAL): ANY_REAL", "the hyperbolic tangent of IN, -1 to 1", Op::tanh),
    {"SQR(IN: ANY_REAL): ANY_REAL", "IN * IN", Typing::real, emit_square, Op::move, Eno::valid},
    {"FRAC(IN: ANY_REAL): ANY_REAL", "what is behind the point: IN - TRUNC(IN)", Typing::real, emit_fraction, Op::move, Eno::valid},
    {"EXPT(IN1, IN2: ANY_REAL): ANY_REAL", "IN1 to the power IN2", Word::power, Eno::valid},
    whole("TRUNC(IN: ANY_REAL): ANY_INT", "the whole number towards 0", Op::truncate),
    whole("ROUND(IN: ANY_REAL): ANY_INT", "the nearest whole number; of two the even one", Op::round),
    whole("FLOOR(IN: ANY_REAL): ANY_INT", "the greatest whole number that is not above IN", Op::floor),
    whole("CEIL(IN: ANY_REAL): ANY_INT", "the least whole number that is not below IN", Op::ceil),
    {"MIN(IN1, IN2, ...: ANY_ELEMENTARY): ANY_ELEMENTARY", "the least of its arguments",
     Typing::common, emit_extremum, Op::min_signed, Eno::valid},
    {"MAX(IN1, IN2, ...: ANY_ELEMENTARY): ANY_ELEMENTARY", "the greatest of its arguments",
     Typing::common, emit_extremum, Op::max_signed, Eno::valid},
    {"LIMIT(MN, IN, MX: ANY_ELEMENTARY): ANY_ELEMENTARY", "IN, but at least MN and at most MX; where MN is above MX in SCL IN, in MatIEC MX if IN is above MN, else MN",
     Typing::common, emit_limit, Op::move, Eno::limit},
    {"SEL(G: BOOL; IN0, IN1: ANY): ANY", "IN1 if G, else IN0", Typing::chosen, emit_select},
    {"MUX(K: ANY_INT; IN0, ...: ANY): ANY",
     "the argument of number K, from 0 on; of another number that of INELSE, else a fault, in CODESYS "
     "the last, in MatIEC what the type begins with",
     Typing::chosen, emit_multiplex, Op::move, Eno::chosen},
};
// clang-format on

}  // namespace

constinit const Subject number_functions{"numbers", numbers};

}  // namespace lineshaft::st
