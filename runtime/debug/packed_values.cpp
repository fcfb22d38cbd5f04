#include "runtime/debug/packed_values.hpp"

#include <cstring>

#include "runtime/st/types/packed.hpp"

namespace lineshaft::debug {

namespace {

using Kind = st::Type::Kind;

/// Bytes of packed memory, in which a value begins at `bit`.
template <class Byte>
struct Packed {
    Byte* bytes;
    std::uint64_t bit;
    const st::Dialect& dialect;

    Packed behind(std::uint64_t bits) const { return {bytes, bit + bits, dialect}; }
};
using From = Packed<const std::byte>;
using To = Packed<std::byte>;

void move_text(std::byte* slots, const st::Type& type, const From& from) {
    st::load_packed_text(slots, from.bytes, from.bit, st::packed_text(type, from.dialect));
}

void move_text(std::byte* slots, const st::Type& type, const To& to) {
    st::store_packed_text(to.bytes, to.bit, st::packed_text(type, to.dialect), slots);
}

void move_bytes(std::byte* slots, std::size_t count, const From& from) {
    std::memcpy(slots, from.bytes + from.bit / 8, count);
}

void move_bytes(std::byte* slots, std::size_t count, const To& to) {
    std::memcpy(to.bytes + to.bit / 8, slots, count);
}

void move_scalar(std::byte* slot, st::PackedFormat format, const From& from) {
    const std::uint64_t value = st::load_packed(from.bytes, from.bit, format);
    std::memcpy(slot, &value, sizeof value);
}

void move_scalar(std::byte* slot, st::PackedFormat format, const To& to) {
    st::store_packed(to.bytes, to.bit, format, read<std::uint64_t>(slot));
}

/// From packed memory to slots, or back.
template <class Byte>
void move_value(std::byte* slots, const st::Type& type, const Packed<Byte>& packed) {
    if (type.kind == Kind::text) return move_text(slots, type, packed);
    if (type.kind == Kind::union_)
        return move_bytes(slots, st::packed_bits(type, packed.dialect) / 8, packed);
    if (type.kind == Kind::structure)
        for (const st::Variable* member : type.members)
            move_value(slots + 8 * std::size_t{member->slot}, *member->type,
                       packed.behind(st::packed_offset(type, *member, packed.dialect)));
    if (type.kind == Kind::array)
        for (std::size_t i = 0; i < type.count(); ++i)
            move_value(slots + 8 * i * st::element_slots(type), *type.element,
                       packed.behind(i * st::packed_stride(type, packed.dialect)));
    if (const auto format = st::packed_format(type, packed.dialect); format && type.is_scalar())
        move_scalar(slots, *format, packed);
}

using Slots = std::vector<std::uint64_t>;

Seat seat_on(std::shared_ptr<Slots> slots, const st::Type& type, const Frame* frame) {
    auto* const at = reinterpret_cast<std::byte*>(slots->data());
    return {&type, at, frame, std::move(slots)};
}

Seat copied(const st::Type& type, const From& from, const Frame* frame) {
    const auto slots = std::make_shared<Slots>(type.slots + 1);
    move_value(reinterpret_cast<std::byte*>(slots->data()), type, from);
    return seat_on(slots, type, frame);
}

const st::Dialect& dialect_of(const Frame& frame) {
    return frame.routine->pou->name.place.dialect();
}

}  // namespace

Seat member_of_union(const Seat& whole, const st::Variable& member) {
    const st::Dialect& dialect = member.name.place.dialect();
    const std::uint64_t bit = st::packed_offset(*whole.type, member, dialect);
    Seat seat = copied(*member.type, {whole.at, bit, dialect}, whole.frame);
    if (!whole.copy) seat.packed = {whole.at, bit, member.type, &dialect};
    return seat;
}

Seat seat_in_image(const ImageAddress& address, const st::Type& type, const Frame& frame) {
    const st::Image& image = frame.made->checked.image;
    const std::uint64_t bit = image.bit_of(address);
    if (image.global < 0 || bit + address.bits > 8 * std::uint64_t{image.bytes}) return {};
    const std::byte* bytes = global_at(image.global, frame);
    if (address.bits != 1) return copied(type, {bytes, bit, dialect_of(frame)}, &frame);
    constexpr st::PackedFormat of_bit{st::PackedFormat::Coding::bit, 1, false, 0};
    return seat_on(std::make_shared<Slots>(1, st::load_packed(bytes, bit, of_bit)), type, &frame);
}

Seat seat_in_bytes(const st::Bytes& from, const st::Type& type, const Frame& frame) {
    std::vector<std::byte> bytes((st::packed_bits(type, dialect_of(frame)) + 7) / 8);
    const st::Code& code = frame.made->generated.code;
    if (bytes.empty() || st::read_bytes(code, from, bytes.size(), bytes.data()) != st::Fault::none)
        return {};
    return copied(type, {bytes.data(), 0, dialect_of(frame)}, &frame);
}

std::function<void()> writing(const Seat& seat, std::vector<std::byte> value) {
    const auto put = [value = std::move(value)](std::byte* to) { std::ranges::copy(value, to); };
    if (!seat.copy) return [put, at = seat.at] { put(at); };
    return [put, to = seat.packed, behind = seat.behind] {
        std::vector<std::uint64_t> slots(to.type->slots + 1);
        auto* const first = reinterpret_cast<std::byte*>(slots.data());
        move_value(first, *to.type, From{to.bytes, to.bit, *to.dialect});
        put(first + behind);
        move_value(first, *to.type, To{to.bytes, to.bit, *to.dialect});
    };
}

}  // namespace lineshaft::debug
