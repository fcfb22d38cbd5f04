#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/st/code/op_class.hpp"

/// The instructions, one line each: name, class, operands, meaning.
///
///     Instruction | op 16 | - | a 32 | b 32 | d 32 | c 64 |   a is written, the others are read
///
/// An operand is a slot of the frame (w written, r read), a number (n), an instruction of the same
/// routine, by its address (j), a routine (f), an index table (x), the first of several slots (s),
/// of two (d) or of the three of a reference (t), or unused (-). In meanings `I(b)` is slot b as
/// std::int64_t, `U(b)` as std::uint64_t, `R(b)` as double; `put` writes; ELEMENT(b, c) finds the
/// `element` of an array; GO(to) jumps to c, AGAIN(to) too and takes fuel; CALL and LEAVE begin and
/// end a call; FAIL ends the scan with a fault.
///
/// In packed memory the lower half of c is where a value begins [bits], on from what slot d has,
/// and the upper one, UPPER(to), its PackedFormat; of what a reference is to (`..._through`) the
/// number of the value's shape.
///
/// Fused instructions do what two or more of the others do. Code that is counted has none.
// clang-format off
#define LINESHAFT_ST_REACHED(fault)                                                                  \
    const Fault wrong = fault;                                                                       \
    if (wrong == Fault::no_reference) FAIL(no_reference);                                            \
    if (wrong == Fault::outside_of_variable) FAIL(outside_of_variable);                              \
    if (wrong == Fault::call_has_ended) FAIL(call_has_ended);                                        \
    if (wrong == Fault::out_of_range) FAIL(out_of_range)

#define LINESHAFT_ST_SAVED(fault)                                                                    \
    const Fault wrong = fault;                                                                       \
    if (wrong == Fault::calls_too_deep) FAIL(calls_too_deep);                                        \
    if (wrong == Fault::runs_already) FAIL(runs_already)

#define LINESHAFT_ST_OPCODES(OP)                                                                     \
    OP(move, move, "wr--", put(a, U(b)))                                                             \
    OP(copy, move, "ssn-", copy_slots(at(a), at(b), c))                                              \
    OP(set_address, move, "ws--", put(a, frames.address_of(b)))                                      \
    OP(set_global, move, "wn--", put(a, frames.global(b)))                                           \
    OP(set_global_number, move, "wn--", put(a, frames.global_number(b)))                             \
    OP(address_of_number, move, "wr--", put(a, Address::in(U(b)).word()))                                     \
    OP(lasting, move, "wr--", put(a, frames.lasting(U(b))))                                          \
    OP(number_call, move, "w---", put(a, frames.number_of_call(fuel)))                                \
    OP(bytes_of_slots, integer, "wrn-", put(a, byte_of(code, c, U(b))))                              \
    OP(move_reference, move, "ttr-", if (!move_reference(at(a), at(b), I(c))) FAIL(out_of_range))    \
    OP(compare_references, integer, "wtt-", put(a, compare_references(at(b), at(c))))                \
    OP(reference_distance, integer, "wtt-", if (const auto n = reference_distance(at(b), at(c))) put(a, *n); else FAIL(out_of_range)) \
    OP(number_of_reference, integer, "wtrr", if (!frames.number(at(b), U(c), U(d))) FAIL(out_of_range); put(a, frames.reached)) \
    OP(reference_of_number, integer, "trrr", frames.find_number(at(a), U(b), U(c), U(d))) \
    OP(reach, move, "wtn-", LINESHAFT_ST_REACHED(frames.reach(at(b), c, BEHIND)); put(a, frames.reached)) \
    OP(load_through, move, "wtnr", LINESHAFT_ST_REACHED(load_through(frames, at(b), c + U(d), UPPER(to), BEHIND)); put(a, frames.reached)) \
    OP(store_through, move, "rtnr", LINESHAFT_ST_REACHED(store_through(frames, at(b), c + U(d), UPPER(to), U(a), BEHIND))) \
    OP(load_text_through, text, "rtnr", LINESHAFT_ST_REACHED(load_text_through(frames, at(b), c + U(d), UPPER(to), U(a), BEHIND))) \
    OP(store_text_through, text, "rtnr", LINESHAFT_ST_REACHED(store_text_through(frames, at(b), c + U(d), UPPER(to), U(a), BEHIND))) \
    OP(copy_from_through, move, "rtnr", LINESHAFT_ST_REACHED(copy_from_through(frames, at(b), c + U(d), UPPER(to), U(a), BEHIND))) \
    OP(copy_to_through, move, "rtnr", LINESHAFT_ST_REACHED(copy_to_through(frames, at(b), c + U(d), UPPER(to), U(a), BEHIND))) \
    OP(copy_memory, move, "ttr-", if ((fuel -= effort(I(c))) < 0) FAIL(no_end); LINESHAFT_ST_REACHED(copy_memory(frames, at(a), at(b), I(c), BEHIND))) \
    OP(fill_memory, move, "trr-", if ((fuel -= effort(I(c))) < 0) FAIL(no_end); LINESHAFT_ST_REACHED(fill_memory(frames, at(a), U(b), I(c), BEHIND))) \
    OP(compare_memory, integer, "wttr", if ((fuel -= effort(I(d))) < 0) FAIL(no_end); LINESHAFT_ST_REACHED(compare_memory(frames, at(b), at(c), I(d), BEHIND)); put(a, frames.reached)) \
    OP(offset, move, "wrn-", put(a, U(b) + c))                                                       \
    OP(offset_by, move, "wrr-", put(a, U(b) + U(c)))                                                 \
    OP(load, move, "wrn-", put(a, word(target(U(b)), c)))                                            \
    OP(store, move, "rrn-", set_word(target(U(b)), c, U(a)))                                         \
    OP(load_byte, move, "wrn-", put(a, byte(target(U(b)), c)))                                       \
    OP(store_byte, move, "rrn-", set_byte(target(U(b)), c, U(a)))                                    \
    OP(get_byte, move, "wsn-", put(a, byte(at(b), c)))                                               \
    OP(set_byte, move, "rsn-", set_byte(at(b), c, U(a)))                                             \
    OP(load_at, move, "wsr-", put(a, word(at(b), U(c))))                                             \
    OP(store_at, move, "rsr-", set_word(at(b), U(c), U(a)))                                          \
    OP(copy_from, move, "srn-", copy_slots(at(a), target(U(b)), c))                                  \
    OP(copy_between, move, "rrn-", copy_slots(target(U(a)), target(U(b)), c))                        \
    OP(copy_to, move, "rsn-", copy_slots(target(U(a)), at(b), c))                                    \
    OP(load_packed, move, "wrnr", put(a, load_packed(target(U(b)), c + U(d), PackedFormat::of_number(UPPER(to))))) \
    OP(store_packed, move, "rrnr", store_packed(target(U(b)), c + U(d), PackedFormat::of_number(UPPER(to)), U(a))) \
    OP(load_packed_text, text, "rrnr", load_packed_text(target(U(a)), target(U(b)), c + U(d), PackedText::of_number(UPPER(to)))) \
    OP(store_packed_text, text, "rrnr", if (is_too_long(target(U(a)), PackedText::of_number(UPPER(to)).room())) frames.note_cut(BEHIND); store_packed_text(target(U(b)), c + U(d), PackedText::of_number(UPPER(to)), target(U(a)))) \
    OP(initialise, move, "snn-", copy_slots(at(a), IMAGE(b), c))            \
    OP(index, integer, "wrx-", ELEMENT(b, c); put(a, element))                                       \
    OP(index_more, integer, "wrx-", ELEMENT(b, c); put(a, U(a) + element))                           \
    OP(load_element, integer, "wsrx", ELEMENT(c, d); put(a, word(at(b), element)))                   \
    OP(store_element, integer, "rsrx", ELEMENT(c, d); set_word(at(b), element, U(a)))                \
    OP(within, integer, "-rx-", if (!within(U(b), c)) FAIL(out_of_range))                            \
    OP(between, integer, "-rrr", if (I(b) < I(c) || I(b) > I(d)) FAIL(array_bounds))                 \
    OP(bound, integer, "-r--", if (U(b) == 0) FAIL(no_reference))                                     \
    OP(jump, jump, "--j-", GO(to))                                                                   \
    OP(jump_if, jump, "-rj-", if (U(b) != 0) GO(to))                                                 \
    OP(jump_unless, jump, "-rj-", if (U(b) == 0) GO(to))                                             \
    OP(move_twice, move, "wrwr", put(a, U(b)); put(c, U(d)))                                         \
    OP(move_and_jump, jump, "wrj-", put(a, U(b)); GO(to))                                            \
    OP(choose, jump, "-rx-", if (within(U(b), c)) CHOOSE(b, c, to))                            \
    OP(repeat, jump, "--j-", AGAIN(to))                                                              \
    OP(repeat_if, jump, "-rj-", if (U(b) != 0) AGAIN(to))                                            \
    OP(repeat_next, jump, "wdj-", if (next<std::int64_t>(at(a), at(b))) AGAIN(to))                   \
    OP(skip_loop, jump, "rdj-", if (!is_within<std::int64_t>(at(a), at(b))) GO(to))                  \
    OP(repeat_next_unsigned, jump, "wdj-", if (next<std::uint64_t>(at(a), at(b))) AGAIN(to))         \
    OP(skip_loop_unsigned, jump, "rdj-", if (!is_within<std::uint64_t>(at(a), at(b))) GO(to))        \
    OP(call, call, "sf--", CALL(frames.address_of(a), b))                                            \
    OP(call_at, call, "rf--", CALL(U(a), b))                                                         \
    OP(find_routine, call, "wrn-", if (U(b) == 0) FAIL(no_reference); if (!frames.find(at(a), U(b), c)) FAIL(calls_too_deep)) \
    OP(attempt, move, "wrn-", put(a, U(b) != 0 && frames.has(U(b), c) ? U(b) : 0))        \
    OP(call_found, call, "rr--", const std::uint64_t found = U(b); CALL(U(a), found))                \
    OP(push_frame, call, "wf--", if (!frames.push(at(a), b)) FAIL(calls_too_deep))                    \
    OP(save_frame, call, "-fr-", LINESHAFT_ST_SAVED(frames.save(b, U(c))))                            \
    OP(save_found, call, "-rr-", LINESHAFT_ST_SAVED(frames.save(U(b), U(c))))                         \
    OP(lent, call, "wr--", put(a, frames.lent(U(b))))                                                 \
    OP(swap_frame, call, "w---", const std::uint64_t results = frames.swap(); put(a, results))        \
    OP(pop_frame, call, "----", frames.pop())                                                         \
    OP(exception, move, "w---", put(a, frames.exception()))                                           \
    OP(call_block, call, "sn--", code.call_block(at(a), b, frames.now, frames.context))                                        \
    OP(call_block_at, call, "rn--", code.call_block(target(U(a)), b, frames.now, frames.context))                              \
    OP(advance_time, call, "-rr-", if (!frames.advance(I(b), I(c))) FAIL(out_of_range); fuel = frames.fuel) \
    OP(message, none, "r---", (void)a)                                                                \
    OP(cover, none, "n---", code.hits[a].fetch_add(1, std::memory_order_relaxed))                     \
    OP(stop, jump, "rrr-", if (frames.ends_at(BEHIND)) FAIL(assertion))                                      \
    OP(leave, jump, "----", LEAVE)                                                                   \
    OP(and_bits, boolean, "wrr-", put(a, U(b) & U(c)))                                               \
    OP(or_bits, boolean, "wrr-", put(a, U(b) | U(c)))                                                \
    OP(xor_bits, boolean, "wrr-", put(a, U(b) ^ U(c)))                                               \
    OP(not_bool, boolean, "wr--", put(a, U(b) ^ 1))                                                  \
    OP(not_bits, boolean, "wrn-", put(a, ~U(b) & mask(c)))                                           \
    OP(swap_bytes, boolean, "wrn-", put(a, __builtin_bswap64(U(b)) >> (64 - c)))                      \
    OP(lowest_bit, boolean, "wr--", put(a, U(b) == 0 ? 0 : static_cast<std::uint64_t>(std::countr_zero(U(b))))) \
    OP(get_bits, boolean, "wrn-", put(a, U(b) >> (c & 63) & mask(c >> 6)))                           \
    OP(set_bits, boolean, "wrn-", put(a, (U(a) & ~(mask(c >> 6) << (c & 63))) | (U(b) & mask(c >> 6)) << (c & 63))) \
    OP(shr_signed, boolean, "wrr-", put(a, I(b) >> std::min<std::uint64_t>(U(c), 63)))               \
    LINESHAFT_ST_SHIFTS(OP, 8) LINESHAFT_ST_SHIFTS(OP, 16)                                           \
    LINESHAFT_ST_SHIFTS(OP, 32) LINESHAFT_ST_SHIFTS(OP, 64)                                          \
    LINESHAFT_ST_INTEGER(OP, sint, std::int8_t) LINESHAFT_ST_INTEGER(OP, int, std::int16_t)          \
    LINESHAFT_ST_INTEGER(OP, dint, std::int32_t) LINESHAFT_ST_INTEGER(OP, lint, std::int64_t)        \
    LINESHAFT_ST_INTEGER(OP, usint, std::uint8_t) LINESHAFT_ST_INTEGER(OP, uint, std::uint16_t)      \
    LINESHAFT_ST_INTEGER(OP, udint, std::uint32_t) LINESHAFT_ST_INTEGER(OP, ulint, std::uint64_t)    \
    LINESHAFT_ST_ORDER(OP, signed, integer, I) LINESHAFT_ST_ORDER(OP, unsigned, integer, U)          \
    LINESHAFT_ST_ORDER(OP, float, real, R)                                                           \
    LINESHAFT_ST_EQUAL(OP, word, integer, U) LINESHAFT_ST_EQUAL(OP, float, real, R)                  \
    OP(add_lreal, real, "wrr-", put(a, sum(R(b), R(c))))                                             \
    OP(sub_lreal, real, "wrr-", put(a, R(b) - R(c)))                                                 \
    OP(mul_lreal, real, "wrr-", put(a, product(R(b), R(c))))                                         \
    OP(div_lreal, real, "wrr-", put(a, R(b) / R(c)))                                                 \
    OP(add_real, real, "wrr-", put(a, narrow(sum(R(b), R(c)))))                                      \
    OP(sub_real, real, "wrr-", put(a, narrow(R(b) - R(c))))                                          \
    OP(mul_real, real, "wrr-", put(a, narrow(product(R(b), R(c)))))                                  \
    OP(div_real, real, "wrr-", put(a, narrow(R(b) / R(c))))                                          \
    OP(neg_lreal, real, "wr--", put(a, -R(b)))                                                       \
    OP(abs_lreal, real, "wr--", put(a, std::fabs(R(b))))                                             \
    OP(abs_signed, integer, "wr--", put(a, I(b) < 0 ? 0 - U(b) : U(b)))                              \
    OP(min_lreal, real, "wrr-", put(a, R(c) < R(b) ? R(c) : R(b)))                                   \
    OP(max_lreal, real, "wrr-", put(a, R(b) < R(c) ? R(c) : R(b)))                                   \
    OP(min_signed, integer, "wrr-", put(a, I(c) < I(b) ? I(c) : I(b)))                               \
    OP(max_signed, integer, "wrr-", put(a, I(b) < I(c) ? I(c) : I(b)))                               \
    OP(min_unsigned, integer, "wrr-", put(a, U(c) < U(b) ? U(c) : U(b)))                             \
    OP(max_unsigned, integer, "wrr-", put(a, U(b) < U(c) ? U(c) : U(b)))                             \
    OP(sqrt, real, "wr--", put(a, std::sqrt(R(b))))                                                  \
    OP(ln, real, "wr--", put(a, Sleef_cinz_logd1_u10purec(R(b))))                                    \
    OP(log10, real, "wr--", put(a, Sleef_cinz_log10d1_u10purec(R(b))))                               \
    OP(exp, real, "wr--", put(a, Sleef_cinz_expd1_u10purec(R(b))))                                   \
    OP(sin, real, "wr--", put(a, Sleef_cinz_sind1_u10purec(R(b))))                                   \
    OP(cos, real, "wr--", put(a, Sleef_cinz_cosd1_u10purec(R(b))))                                   \
    OP(tan, real, "wr--", put(a, Sleef_cinz_tand1_u10purec(R(b))))                                   \
    OP(asin, real, "wr--", put(a, Sleef_cinz_asind1_u10purec(R(b))))                                 \
    OP(acos, real, "wr--", put(a, Sleef_cinz_acosd1_u10purec(R(b))))                                 \
    OP(atan, real, "wr--", put(a, Sleef_cinz_atand1_u10purec(R(b))))                                 \
    OP(atan2, real, "wrr-", put(a, Sleef_cinz_atan2d1_u10purec(R(b), R(c))))                         \
    OP(atanh, real, "wr--", put(a, Sleef_cinz_atanhd1_u10purec(R(b))))                               \
    OP(tanh, real, "wr--", put(a, Sleef_cinz_tanhd1_u10purec(R(b))))                                 \
    OP(power, real, "wrr-", put(a, Sleef_cinz_powd1_u10purec(R(b), R(c))))                           \
    OP(floor, real, "wr--", put(a, std::floor(R(b))))                                                \
    OP(ceil, real, "wr--", put(a, std::ceil(R(b))))                                                  \
    OP(truncate, real, "wr--", put(a, std::trunc(R(b))))                                             \
    OP(round_away, real, "wr--", put(a, std::round(R(b))))                                           \
    OP(round, real, "wr--", put(a, std::nearbyint(R(b))))                                            \
    OP(lowest_bits, real, "wr--", put(a, lowest_bits(R(b))))                                         \
    OP(left_in_64, real, "wr--", put(a, left_in_64(R(b))))                                           \
    OP(left_in_32, real, "wr--", put(a, left_in_32(R(b))))                                           \
    OP(truncated_in_32, real, "wr--", put(a, truncated_in_32(R(b))))                                 \
    OP(narrow, real, "wr--", put(a, narrow(R(b))))                                                   \
    OP(real_from_signed, real, "wr--", put(a, double{static_cast<float>(I(b))}))                     \
    OP(real_from_unsigned, real, "wr--", put(a, double{static_cast<float>(U(b))}))                   \
    OP(lreal_from_signed, real, "wr--", put(a, static_cast<double>(I(b))))                           \
    OP(lreal_from_unsigned, real, "wr--", put(a, static_cast<double>(U(b))))                         \
    OP(real_bits, real, "wr--", put(a, std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(R(b)))})) \
    OP(real_of_bits, real, "wr--", put(a, double{std::bit_cast<float>(static_cast<std::uint32_t>(U(b)))})) \
    OP(is_finite, real, "wr--", put(a, std::uint64_t{std::isfinite(R(b))}))                          \
    OP(text_copy, text, "rrr-", if (!copy_text(target(U(a)), target(U(b)), TextRoom::of_number(U(c)))) frames.note_cut(BEHIND)) \
    OP(text_append, text, "rrdn", if (!append_text(target(U(a)), target(U(b)), I(c), I(c + 1), TextRoom::of_number(d))) frames.note_cut(BEHIND)) \
    OP(text_recode, text, "rrn-", recode_text(target(U(a)), target(U(b)), TextRoom::of_number(c)))   \
    OP(text_length, text, "wrn-", put(a, length_of_text(target(U(b)), c != 0)))                      \
    OP(text_compare, text, "wrr-", put(a, compare_texts(target(U(b)), target(U(c)))))                \
    OP(text_character, text, "wrrn", if (const auto n = character_of(target(U(b)), I(c), TextRoom::of_number(d))) put(a, *n); else FAIL(array_bounds)) \
    OP(text_byte, text, "wrrr", if (const auto n = byte_of_text(target(U(b)), I(c), TextRoom::of_number(U(d)))) put(a, *n); else FAIL(array_bounds)) \
    OP(set_text_byte, text, "rrrr", if (!set_byte_of_text(target(U(b)), I(c), U(a), TextRoom::of_number(U(d)))) FAIL(array_bounds)) \
    OP(set_character, text, "rrrr", if (!set_character(target(U(b)), I(c), U(a), TextRoom::of_number(U(d)))) FAIL(array_bounds)) \
    OP(text_find, text, "wrrn", put(a, find_text(target(U(b)), target(U(c)), d != 0)))               \
    OP(matiec_text_find, text, "wrr-", put(a, matiec_find_text(target(U(b)), target(U(c)))))         \
    OP(text_of_signed, text, "rrn-", write_number(target(U(a)), I(b), c != 0))                       \
    OP(text_of_unsigned, text, "rrn-", write_number(target(U(a)), U(b), c != 0))                     \
    OP(text_of_real, text, "rrn-", write_real(target(U(a)), R(b), real_form(c)))                     \
    OP(text_of_float, text, "rrn-", write_real(target(U(a)), static_cast<float>(R(b)), real_form(c))) \
    OP(integer_of_text, text, "wrn-", put(a, number_of_text<std::uint64_t>(target(U(b)), c != 0)))    \
    OP(real_of_text, text, "wrn-", put(a, number_of_text<double>(target(U(b)), c != 0)))             \
    OP(s7_integer_of_text, text, "wrnn", put(a, s7_integer_of_text(target(U(b)), c, d != 0)))         \
    OP(s7_real_of_text, text, "wr--", put(a, s7_real_of_text(target(U(b)))))                         \
    OP(matiec_integer_of_text, text, "wrn-", put(a, matiec_integer_of_text(target(U(b)), c != 0)))   \
    OP(matiec_real_of_text, text, "wr--", put(a, matiec_real_of_text(target(U(b)))))                 \
    OP(text_of_truth, text, "rr--", write_truth(target(U(a)), U(b) != 0))                          \
    OP(text_of_time, text, "rrn-", write_time(target(U(a)), c, I(b)))                               \
    OP(text_of_bits, text, "rr--", write_bits(target(U(a)), U(b)))                                   \
    OP(text_of_ten_digits, text, "rr--", write_ten_digits(target(U(a)), R(b)))                       \
    OP(text_of_parts, text, "rr--", write_time_in_parts(target(U(a)), I(b)))                         \
    OP(truth_of_text, text, "wrn-", put(a, truth_of_text(target(U(b)), c != 0)))                     \
    OP(time_of_text, text, "wrn-", put(a, time_of_text(c, target(U(b)))))                            \
    LINESHAFT_ST_EXACT(OP, signed, std::int64_t) LINESHAFT_ST_EXACT(OP, unsigned, std::uint64_t)      \
    OP(from_bcd, integer, "wr--", if (const auto n = from_bcd(U(b))) put(a, *n); else FAIL(out_of_range)) \
    OP(to_bcd, integer, "wrn-", if (const auto n = to_bcd(U(b), c)) put(a, *n); else FAIL(out_of_range)) \
    OP(is_bcd, integer, "wr--", put(a, std::uint64_t{from_bcd(U(b)).has_value()}))                    \
    OP(time_now, move, "w---", put(a, frames.now.time))                                               \
    OP(interval_now, move, "w---", put(a, frames.now.interval))                                       \
    OP(scans_now, move, "w---", put(a, frames.now.index))                                             \
    OP(task_now, move, "w---", put(a, std::int64_t{std::max(frames.context.task, 0)} + 1))            \
    OP(select, move, "wrd-", put(a, word(at(c), U(b) & 1)))                                          \
    OP(look_up, move, "wrx-", if (!within(U(b), c)) FAIL(out_of_range); put(a, number_of(U(b), c)))  \
    LINESHAFT_ST_PAIRS(OP, lreal, real, R, exact) LINESHAFT_ST_PAIRS(OP, real, real, R, narrow)      \
    LINESHAFT_ST_PAIRS(OP, int, integer, U, wrap<std::int16_t>)                                      \
    LINESHAFT_ST_PAIRS(OP, dint, integer, U, wrap<std::int32_t>)                                     \
    LINESHAFT_ST_PAIRS(OP, lint, integer, U, wrap<std::int64_t>)                                     \
    LINESHAFT_ST_COUNT(OP, int, std::int16_t) LINESHAFT_ST_COUNT(OP, dint, std::int32_t)             \
    LINESHAFT_ST_COUNT(OP, lint, std::int64_t)

/// Arithmetic in a width: what is beyond it wraps. Division truncates towards zero.
#define LINESHAFT_ST_INTEGER(OP, type, T)                                                            \
    OP(add_##type, integer, "wrr-", put(a, wrap<T>(U(b) + U(c))))                                    \
    OP(sub_##type, integer, "wrr-", put(a, wrap<T>(U(b) - U(c))))                                    \
    OP(mul_##type, integer, "wrr-", put(a, wrap<T>(U(b) * U(c))))                                    \
    OP(div_##type, integer, "wrr-", if (U(c) == 0) FAIL(division_by_zero); put(a, quotient<T>(U(b), U(c)))) \
    OP(mod_##type, integer, "wrr-", if (U(c) == 0) FAIL(division_by_zero); put(a, remainder<T>(U(b), U(c)))) \
    OP(neg_##type, integer, "wr--", put(a, wrap<T>(0 - U(b))))                                       \
    OP(wrap_##type, integer, "wr--", put(a, wrap<T>(U(b))))                                          \
    OP(round_##type, real, "wr--", if (!fits<T>(std::nearbyint(R(b)))) FAIL(out_of_range); put(a, whole<T>(std::nearbyint(R(b)))))

/// Arithmetic of 64 bits: what is beyond them is a fault.
#define LINESHAFT_ST_EXACT(OP, type, T)                                                              \
    OP(add_exact_##type, integer, "wrr-", T sum; if (__builtin_add_overflow(T(U(b)), T(U(c)), &sum)) FAIL(out_of_range); put(a, sum)) \
    OP(sub_exact_##type, integer, "wrr-", T sum; if (__builtin_sub_overflow(T(U(b)), T(U(c)), &sum)) FAIL(out_of_range); put(a, sum)) \
    OP(mul_exact_##type, integer, "wrr-", T sum; if (__builtin_mul_overflow(T(U(b)), T(U(c)), &sum)) FAIL(out_of_range); put(a, sum))

#define LINESHAFT_ST_SHIFTS(OP, bits)                                                                \
    OP(shl_##bits, boolean, "wrr-", put(a, shift_left<bits>(U(b), U(c))))                            \
    OP(shr_##bits, boolean, "wrr-", put(a, shift_right<bits>(U(b), U(c))))                           \
    OP(rol_##bits, boolean, "wrr-", put(a, rotate_left<bits>(U(b), U(c))))                           \
    OP(ror_##bits, boolean, "wrr-", put(a, rotate_right<bits>(U(b), U(c))))

/// Comparisons, jumps where they do not hold, loops and moves where they do.
#define LINESHAFT_ST_ORDER(OP, type, class, V)                                                       \
    OP(lt_##type, class, "wrr-", put(a, std::uint64_t{V(b) < V(c)}))                                 \
    OP(le_##type, class, "wrr-", put(a, std::uint64_t{V(b) <= V(c)}))                                \
    OP(jump_unless_lt_##type, class, "rrj-", if (!(V(a) < V(b))) GO(to))                             \
    OP(jump_unless_le_##type, class, "rrj-", if (!(V(a) <= V(b))) GO(to))                            \
    OP(move_if_lt_##type, class, "rrwr", if (V(a) < V(b)) put(c, U(d)))                              \
    OP(move_if_le_##type, class, "rrwr", if (V(a) <= V(b)) put(c, U(d)))                             \
    OP(repeat_if_lt_##type, class, "rrj-", if (V(a) < V(b)) AGAIN(to))                               \
    OP(repeat_if_le_##type, class, "rrj-", if (V(a) <= V(b)) AGAIN(to))

#define LINESHAFT_ST_EQUAL(OP, type, class, V)                                                       \
    OP(eq_##type, class, "wrr-", put(a, std::uint64_t{V(b) == V(c)}))                                \
    OP(ne_##type, class, "wrr-", put(a, std::uint64_t{V(b) != V(c)}))                                \
    OP(jump_unless_eq_##type, class, "rrj-", if (!(V(a) == V(b))) GO(to))                            \
    OP(jump_unless_ne_##type, class, "rrj-", if (!(V(a) != V(b))) GO(to))                            \
    OP(move_if_eq_##type, class, "rrwr", if (V(a) == V(b)) put(c, U(d)))                             \
    OP(move_if_ne_##type, class, "rrwr", if (V(a) != V(b)) put(c, U(d)))                             \
    OP(repeat_if_eq_##type, class, "rrj-", if (V(a) == V(b)) AGAIN(to))                              \
    OP(repeat_if_ne_##type, class, "rrj-", if (V(a) != V(b)) AGAIN(to))

/// Two operations, each rounded or wrapped (`to`): `add_mul` is `(b + c) * d`, `add_from` is
/// `d - (b + c)`.
#define LINESHAFT_ST_PAIRS(OP, type, class, V, to)                                                   \
    LINESHAFT_ST_PAIR(OP, add, type, class, V, to, sum(V(b), V(c)))                                  \
    LINESHAFT_ST_PAIR(OP, sub, type, class, V, to, V(b) - V(c))                                      \
    LINESHAFT_ST_PAIR(OP, mul, type, class, V, to, product(V(b), V(c)))

#define LINESHAFT_ST_PAIR(OP, first, type, class, V, to, value)                                      \
    OP(first##_add_##type, class, "wrrr", put(a, to(sum(to(value), V(d)))))                          \
    OP(first##_sub_##type, class, "wrrr", put(a, to(to(value) - V(d))))                              \
    OP(first##_mul_##type, class, "wrrr", put(a, to(product(to(value), V(d)))))                      \
    OP(first##_from_##type, class, "wrrr", put(a, to(V(d) - to(value))))

/// The end of a WHILE that counts.
#define LINESHAFT_ST_COUNT(OP, type, T)                                                              \
    OP(count_lt_##type, integer, "wrjr", put(a, wrap<T>(U(a) + U(b))); if (I(a) < I(d)) AGAIN(to))   \
    OP(count_le_##type, integer, "wrjr", put(a, wrap<T>(U(a) + U(b))); if (I(a) <= I(d)) AGAIN(to))
// clang-format on

namespace lineshaft::st {

enum class Op : std::uint16_t {
#define OP(name, class, operands, ...) name,
    LINESHAFT_ST_OPCODES(OP)
#undef OP
};

struct OpInfo {
    std::string_view name;
    OpClass cost;
    std::string_view operands;
};

inline constexpr OpInfo op_infos[] = {
#define OP(name, class, operands, ...) {#name, OpClass::class, operands},
    LINESHAFT_ST_OPCODES(OP)
#undef OP
};

constexpr const OpInfo& info(Op op) {
    return op_infos[static_cast<std::size_t>(op)];
}

}  // namespace lineshaft::st
