#include "runtime/debug/packed_values.hpp"

#include <cstring>

#include "runtime/st/types/packed.hpp"

namespace lineshaft::debug {

namespace {

using Kind = st::Type::Kind;

/// Bytes of packed memory, in which a value begins at `bit`.
struct Packed {
    const std::byte* bytes;
    std::uint64_t bit;
    const st::Dialect& dialect;

    Packed behind(std::uint64_t bits) const { return {bytes, bit + bits, dialect}; }
};

void unpack(std::byte* slots, const st::Type& type, const Packed& from);

void unpack_parts(std::byte* slots, const st::Type& type, const Packed& from) {
    for (const st::Variable* member : type.members)
        unpack(slots + 8 * std::size_t{member->slot}, *member->type,
               from.behind(st::packed_offset(type, *member, from.dialect)));
}

void unpack_elements(std::byte* slots, const st::Type& array, const Packed& from) {
    for (std::size_t i = 0; i < array.count(); ++i)
        unpack(slots + 8 * i * st::element_slots(array), *array.element,
               from.behind(i * st::packed_stride(array, from.dialect)));
}

void unpack(std::byte* slots, const st::Type& type, const Packed& from) {
    if (type.kind == Kind::text)
        return st::load_packed_text(slots, from.bytes, from.bit,
                                    st::packed_text(type, from.dialect));
    if (type.kind == Kind::structure) return unpack_parts(slots, type, from);
    if (type.kind == Kind::array) return unpack_elements(slots, type, from);
    if (type.kind == Kind::union_)
        return void(
            std::memcpy(slots, from.bytes + from.bit / 8, st::packed_bits(type, from.dialect) / 8));
    const auto format = st::packed_format(type, from.dialect);
    if (!format) return;
    const std::uint64_t value = st::load_packed(from.bytes, from.bit, *format);
    std::memcpy(slots, &value, sizeof value);
}

using Slots = std::vector<std::uint64_t>;

Seat seat_on(std::shared_ptr<Slots> slots, const st::Type& type, const Frame* frame) {
    auto* const at = reinterpret_cast<std::byte*>(slots->data());
    return {&type, at, frame, std::move(slots)};
}

Seat copied(const st::Type& type, const Packed& from, const Frame* frame) {
    const auto slots = std::make_shared<Slots>(type.slots + 1);
    unpack(reinterpret_cast<std::byte*>(slots->data()), type, from);
    return seat_on(slots, type, frame);
}

}  // namespace

Seat member_of_union(const Seat& whole, const st::Variable& member) {
    const st::Dialect& dialect = member.name.place.dialect();
    const std::uint64_t bit = st::packed_offset(*whole.type, member, dialect);
    return copied(*member.type, {whole.at, bit, dialect}, whole.frame);
}

Seat seat_in_image(const st::Variable& variable, const Frame& frame) {
    if (frame.image->global < 0) return {};
    const std::byte* bytes = global_at(frame.image->global, frame);
    const std::uint64_t bit = frame.image->bit_of(variable.address);
    if (variable.address.bits != 1)
        return copied(*variable.type, {bytes, bit, variable.name.place.dialect()}, &frame);
    constexpr st::PackedFormat of_bit{st::PackedFormat::Coding::bit, 1, false, 0};
    return seat_on(std::make_shared<Slots>(1, st::load_packed(bytes, bit, of_bit)), *variable.type,
                   &frame);
}

}  // namespace lineshaft::debug
