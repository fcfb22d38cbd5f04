#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

Slot emit_copy(Emission& e) {
    const Slot to = e.reference(0), from = e.reference(1), count = e.value(2);
    e.put(Op::copy_memory, to, from, count);
    return e.result(of_type(Op::wrap_sint, e.type()), count);
}

Slot emit_fill(Emission& e) {
    const Slot to = e.reference(0), value = e.value(1), count = e.value(2);
    e.put(Op::fill_memory, to, value, count);
    return e.result(of_type(Op::wrap_sint, e.type()), count);
}

/// B&R's give the address behind.
Slot emit_copy_of_br(Emission& e) {
    const Slot to = e.reference(0), from = e.reference(1), count = e.value(2);
    e.put(Op::copy_memory, to, from, count);
    return e.moved(to, count);
}

Slot emit_fill_of_br(Emission& e) {
    const Slot to = e.reference(0), value = e.value(1), count = e.value(2);
    e.put(Op::fill_memory, to, value, count);
    return e.moved(to, count);
}

Slot emit_compare(Emission& e) {
    const Slot made = e.constant(0), a = e.reference(0), b = e.reference(1), count = e.value(2);
    const Slot order = e.emit(Op::move, made);
    e.put(Op::compare_memory, order, a, b, count);
    return order;
}

// clang-format off
constexpr const char *copies = "copies n bytes, as if all were read before the first is written; its value is n",
                     *fills = "sets n bytes to one value; its value is n",
                     *copies_of_br = "copies n bytes, as if all were read before the first is written; its value is the address behind the last",
                     *fills_of_br = "sets n bytes to one value; its value is the address behind the last",
                     *compares = "compares n bytes: -1, 0 or 1 as the first of two that differ is less, none, greater";

// Beckhoff's and those of B&R.
constexpr StandardFunction memory[] = {
    {"MEMCPY(destAddr, srcAddr: POINTER; n: ANY_WHOLE): ANY_INT", copies, Typing::memory, emit_copy},
    {"MEMMOVE(destAddr, srcAddr: POINTER; n: ANY_WHOLE): ANY_INT", copies, Typing::memory, emit_copy},
    {"MEMSET(destAddr: POINTER; fillByte, n: ANY_WHOLE): ANY_INT", fills, Typing::memory, emit_fill},
    {"MEMCMP(pBuf1, pBuf2: POINTER; n: ANY_WHOLE): DINT", compares, Typing::memory, emit_compare},
    {"brsmemcpy(pDest, pSrc: POINTER; length: ANY_WHOLE): POINTER", copies_of_br, Typing::memory, emit_copy_of_br},
    {"brsmemmove(pDest, pSrc: POINTER; length: ANY_WHOLE): POINTER", copies_of_br, Typing::memory, emit_copy_of_br},
    {"brsmemset(pDest: POINTER; value, length: ANY_WHOLE): POINTER", fills_of_br, Typing::memory, emit_fill_of_br},
    {"brsmemcmp(pMem1, pMem2: POINTER; length: ANY_WHOLE): DINT", compares, Typing::memory, emit_compare},
};
// clang-format on

}  // namespace

constinit const Subject memory_functions{"memory", memory};

}  // namespace lineshaft::st
