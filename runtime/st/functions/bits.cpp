#include "runtime/st/functions/standard.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

/// CODESYS: SHL and SHR by as many as a processor takes, which has registers of 32 or 64 bits.
Slot places(Emission& e) {
    const Slot n = e.value(1);
    const Op op = e.call.standard->op;
    const bool is_shift = op == Op::shl_8 || op == Op::shr_8;
    if (!is_shift || !e.call.place.dialect().reckons_in_registers) return n;
    return e.emit(Op::and_bits, n, e.constant(e.type().bits == 64 ? 63 : 31));
}

/// What a signed integer becomes is that of its bits; only SHR keeps its sign.
Slot emit_shift(Emission& e) {
    const Op first = e.call.standard->op;
    const Type& type = e.type();
    int width = 0;
    while ((8 << width) < type.bits) ++width;
    const Op op = after(first, 4 * width);
    const Slot a = e.value(0), n = places(e);
    if (!type.is_signed) return e.result(op, a, n);
    if (first == Op::shr_8) return e.result(Op::shr_signed, a, n);
    const Slot pattern = e.emit(of_type(Op::wrap_sint, bits_type(type.bits)), a);
    return e.result(of_type(Op::wrap_sint, type), e.emit(op, pattern, n));
}

/// The bytes of the value in reverse order, where the controller does not have them as `is_big`
/// says.
template <bool is_big>
Slot emit_bytes(Emission& e) {
    const Type& type = e.type();
    const Slot given = e.value(0);
    const auto bits = static_cast<Slot>(type.is_time() ? 64 : type.bits);
    if (e.call.place.dialect().packs_as_s7 == is_big || bits == 8) return e.result(Op::move, given);
    if (e.is_narrow())
        return e.result(Op::real_of_bits,
                        e.emit(Op::swap_bytes, e.emit(Op::real_bits, given), bits));
    if (!type.is_signed || type.is_time()) return e.result(Op::swap_bytes, given, bits);
    return e.result(of_type(Op::wrap_sint, type), e.emit(Op::swap_bytes, given, bits));
}

consteval StandardFunction bytes(std::string_view signature, std::string_view doc, Emit emit) {
    return {signature, doc, Typing::own, emit};
}

Slot emit_decode(Emission& e) {
    const Slot last = e.constant(static_cast<std::uint64_t>(e.type().bits - 1));
    const Slot place = e.emit(Op::and_bits, e.value(0), last);
    return e.result(Op::shl_64, e.constant(1), place);
}

/// Nothing, where there is no such bit.
Slot the_bit(Emission& e) {
    return e.emit(Op::shl_64, e.constant(1), e.value(1));
}

Slot emit_set_bit(Emission& e) {
    const Slot in = e.value(0), all = e.emit(Op::or_bits, in, the_bit(e));
    return e.result(of_type(Op::wrap_sint, e.type()), all);
}

Slot emit_clear_bit(Emission& e) {
    const Slot in = e.value(0), others = e.emit(Op::not_bits, the_bit(e), 64);
    return e.result(of_type(Op::wrap_sint, e.type()), e.emit(Op::and_bits, in, others));
}

Slot emit_test_bit(Emission& e) {
    const Slot in = e.value(0), found = e.emit(Op::and_bits, in, the_bit(e));
    return e.result(Op::ne_word, found, e.constant(0));
}

consteval StandardFunction shift(std::string_view signature, std::string_view doc, Op op) {
    return {signature, doc, Typing::places, emit_shift, op};
}

// clang-format off
constexpr StandardFunction bit_strings[] = {
    shift("SHL(IN: ANY_WHOLE; N: ANY_INT): ANY_WHOLE", "the bits N places to the left, filled with 0", Op::shl_8),
    shift("SHR(IN: ANY_WHOLE; N: ANY_INT): ANY_WHOLE",
          "the bits N places to the right, filled with 0, of a signed integer with its sign", Op::shr_8),
    shift("ROL(IN: ANY_WHOLE; N: ANY_INT): ANY_WHOLE", "the bits N places to the left, in a circle", Op::rol_8),
    shift("ROR(IN: ANY_WHOLE; N: ANY_INT): ANY_WHOLE", "the bits N places to the right, in a circle", Op::ror_8),
    {"SWAP(IN: ANY_BIT): ANY_BIT", "the bytes in reverse order", Typing::bits,
     [](Emission& e) { return e.result(Op::swap_bytes, e.value(0), static_cast<Slot>(e.type().bits)); }},
    bytes("TO_BIG_ENDIAN(IN: ANY_ORDERED): ANY_ORDERED", "IN with its highest byte first", emit_bytes<true>),
    bytes("TO_LITTLE_ENDIAN(IN: ANY_ORDERED): ANY_ORDERED", "IN with its lowest byte first", emit_bytes<false>),
    bytes("FROM_BIG_ENDIAN(IN: ANY_ORDERED): ANY_ORDERED", "what TO_BIG_ENDIAN was made of", emit_bytes<true>),
    bytes("FROM_LITTLE_ENDIAN(IN: ANY_ORDERED): ANY_ORDERED", "what TO_LITTLE_ENDIAN was made of", emit_bytes<false>),
    {"DECO(IN: ANY_INT): ANY_BIT", "the bit of number IN, from 0 on, and no other", Typing::bit_number, emit_decode},
    {"ENCO(IN: ANY_BIT): INT", "the number of the lowest bit that is set, from 0 on; of 0 it is 0",
     Typing::bits, [](Emission& e) { return e.result(Op::lowest_bit, e.value(0)); }},
    {"BIT_SET(IN: ANY_WHOLE; POS: ANY_INT): ANY_WHOLE", "IN with bit POS set, from 0 on", Typing::places, emit_set_bit},
    {"BIT_CLR(IN: ANY_WHOLE; POS: ANY_INT): ANY_WHOLE", "IN with bit POS cleared, from 0 on", Typing::places, emit_clear_bit},
    {"BIT_TST(IN: ANY_WHOLE; POS: ANY_INT): BOOL", "bit POS of IN, from 0 on", Typing::places, emit_test_bit},
    {"SCATTER(IN: ANY_BIT; OUT: ARRAY)", "writes each bit of IN to an element of OUT, an array of BOOL",
     Rewriting::scatter},
    {"SCATTER_BLK(IN: ANY_BIT; COUNT_IN: ANY_INT; OUT: BOOL)",
     "writes the bits of COUNT_IN elements from IN on to elements of an array of BOOL from OUT on, which begin where such a bit string may",
     Rewriting::scatter_block, Eno::bits},
    {"GATHER_BLK(IN: BOOL; COUNT_OUT: ANY_INT; OUT: ANY_BIT)",
     "writes elements of an array of BOOL from IN on, which begin where such a bit string may, to the bits of COUNT_OUT elements from OUT on",
     Rewriting::gather_block, Eno::bits},
    {"GATHER(IN: ARRAY; OUT: ANY_BIT)", "writes each element of IN, an array of BOOL, to a bit of OUT",
     Rewriting::gather},
};
// clang-format on

}  // namespace

constinit const Subject bit_functions{"bits", bit_strings};

}  // namespace lineshaft::st
