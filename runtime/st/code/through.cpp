#include "runtime/st/code/bytes.hpp"
#include "runtime/st/code/code.hpp"
#include "runtime/st/code/meaning.hpp"

namespace lineshaft::st::meaning {

/// The slot of a value of that shape there, if there is one; else null: it is to be had by bytes.
static std::byte* slots_at(const Code& code, const Bytes& at, std::uint64_t bit,
                           std::uint32_t shape) {
    const auto slot = slot_of(code, at.shape, 8 * at.first + static_cast<std::int64_t>(bit), shape);
    return slot ? at.slots + 8 * *slot : nullptr;
}

Fault load_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                   std::uint32_t shape, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = frames.find(reference, next, at); wrong != Fault::none) return wrong;
    if (const std::byte* slots = slots_at(frames.code, at, bit, shape)) {
        frames.reached = word(slots, 0);
        return Fault::none;
    }
    return frames.told(load_value(frames.code, at, bit, shape, frames.reached), reference);
}

Fault store_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                    std::uint32_t shape, std::uint64_t value, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = frames.find(reference, next, at); wrong != Fault::none) return wrong;
    if (std::byte* slots = slots_at(frames.code, at, bit, shape)) {
        set_word(slots, 0, value);
        return Fault::none;
    }
    return frames.told(store_value(frames.code, at, bit, shape, value), reference);
}

Fault load_text_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                        std::uint32_t shape, std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = frames.find(reference, next, at); wrong != Fault::none) return wrong;
    at.first += static_cast<std::int64_t>(bit / 8);
    return frames.told(load_text(frames.code, at, shape, frames.place(slots)), reference);
}

Fault store_text_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                         std::uint32_t shape, std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = frames.find(reference, next, at); wrong != Fault::none) return wrong;
    if (is_too_long(frames.place(slots), frames.code.shapes[shape].type->room()))
        frames.note_cut(next);
    at.first += static_cast<std::int64_t>(bit / 8);
    return frames.told(store_text(frames.code, at, shape, frames.place(slots)), reference);
}

Fault copy_from_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                        std::uint32_t shape, std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = frames.find(reference, next, at); wrong != Fault::none) return wrong;
    if (const std::byte* from = slots_at(frames.code, at, bit, shape)) {
        copy_slots(frames.place(slots), from, frames.code.shapes[shape].slots);
        return Fault::none;
    }
    at.first += static_cast<std::int64_t>(bit / 8);
    const Bytes to{shape, frames.place(slots), 0};
    return frames.told(copy_bytes(frames.code, to, at, frames.code.shapes[shape].bits / 8),
                       reference);
}

Fault copy_to_through(Frames& frames, const std::byte* reference, std::uint64_t bit,
                      std::uint32_t shape, std::uint64_t slots, std::uint64_t next) {
    Bytes at;
    if (const Fault wrong = frames.find(reference, next, at); wrong != Fault::none) return wrong;
    if (std::byte* to = slots_at(frames.code, at, bit, shape)) {
        copy_slots(to, frames.place(slots), frames.code.shapes[shape].slots);
        return Fault::none;
    }
    at.first += static_cast<std::int64_t>(bit / 8);
    const Bytes from{shape, frames.place(slots), 0};
    return frames.told(copy_bytes(frames.code, at, from, frames.code.shapes[shape].bits / 8),
                       reference);
}

Fault copy_memory(Frames& frames, const std::byte* to, const std::byte* from, std::int64_t count,
                  std::uint64_t next) {
    if (count <= 0) return Fault::none;
    Bytes target, source;
    if (const Fault wrong = frames.find(to, next, target); wrong != Fault::none) return wrong;
    if (const Fault wrong = frames.find(from, next, source); wrong != Fault::none) return wrong;
    const auto bytes = static_cast<std::uint64_t>(count);
    const Fault wrong = copy_bytes(frames.code, target, source, bytes);
    return frames.told(wrong, is_inside(frames.code, target, bytes) ? from : to);
}

Fault fill_memory(Frames& frames, const std::byte* to, std::uint64_t value, std::int64_t count,
                  std::uint64_t next) {
    if (count <= 0) return Fault::none;
    Bytes target;
    if (const Fault wrong = frames.find(to, next, target); wrong != Fault::none) return wrong;
    return frames.told(fill_bytes(frames.code, target, static_cast<std::byte>(value),
                                  static_cast<std::uint64_t>(count)),
                       to);
}

Fault compare_memory(Frames& frames, const std::byte* a, const std::byte* b, std::int64_t count,
                     std::uint64_t next) {
    frames.reached = 0;
    if (count <= 0) return Fault::none;
    Bytes left, right;
    if (const Fault wrong = frames.find(a, next, left); wrong != Fault::none) return wrong;
    if (const Fault wrong = frames.find(b, next, right); wrong != Fault::none) return wrong;
    std::int64_t order = 0;
    const auto bytes = static_cast<std::uint64_t>(count);
    const Fault wrong = compare_bytes(frames.code, left, right, bytes, order);
    frames.reached = static_cast<std::uint64_t>(order);
    return frames.told(wrong, is_inside(frames.code, left, bytes) ? b : a);
}

}  // namespace lineshaft::st::meaning
