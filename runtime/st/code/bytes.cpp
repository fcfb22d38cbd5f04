#include "runtime/st/code/bytes.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "runtime/st/code/code.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

namespace {

using Coding = PackedFormat::Coding;

constexpr std::uint64_t longest_run = 256;

std::uint64_t slot_value(const std::byte* slots, std::uint64_t slot = 0) {
    return read<std::uint64_t>(slots + 8 * slot);
}

void set_slot(std::byte* slots, std::uint64_t value) {
    std::memcpy(slots, &value, sizeof value);
}

std::uint64_t scalar_value(const Shape& shape, const std::byte* slots) {
    return shape.byte ? std::to_integer<std::uint64_t>(slots[*shape.byte]) : slot_value(slots);
}

void set_scalar(const Shape& shape, std::byte* slots, std::uint64_t value) {
    if (shape.byte)
        slots[*shape.byte] = static_cast<std::byte>(value);
    else
        set_slot(slots, value);
}

/// A scalar, a text, a UNION, or what is not seen by bytes: `whole`.
struct Leaf {
    std::uint32_t number = 0;  ///< of its shape
    std::uint64_t bit = 0;     ///< of the variable
    std::byte* slots = nullptr;
};

/// What has that bit; empty: nothing, it is between values.
std::optional<Leaf> leaf_at(const Code& code, const Bytes& of, std::uint64_t bit) {
    Leaf at{of.shape, 0, of.slots};
    for (;;) {
        const Shape& here = code.shapes[at.number];
        if (bit - at.bit >= here.bits) return {};
        if (here.kind == Shape::Kind::array) {
            const std::uint64_t place = (bit - at.bit) / here.stride;
            if (place >= here.count) return {};
            at = {here.element, at.bit + place * here.stride,
                  at.slots + 8 * place * code.shapes[here.element].slots};
        } else if (here.kind == Shape::Kind::structure) {
            const ShapeMember* member = member_at(code, here, bit - at.bit);
            if (!member) return {};
            at = {member->shape, at.bit + member->bit, at.slots + 8 * member->slot};
        } else {
            return at;
        }
    }
}

bool is_bit(const Shape& shape) {
    return shape.kind == Shape::Kind::scalar && shape.format.coding == Coding::bit;
}

bool is_value(const Type& type, std::uint64_t number) {
    if (type.kind == Type::Kind::enumeration)
        return type.is_unchecked || type.name_of(static_cast<std::int64_t>(number));
    const Wide whole = whole_in(type, number);
    const bool fits = whole >= smallest(type) && whole <= largest(type);
    return !type.in_a_run().is_subrange || fits;
}

using Scalar = std::array<std::byte, 8>;

Scalar bytes_of_scalar(const Shape& shape, std::uint64_t value) {
    Scalar bytes{};
    store_packed(bytes.data(), 0, shape.format, value);
    return bytes;
}

std::byte byte_at(const std::u16string& units, std::uint64_t at) {
    return reinterpret_cast<const std::byte*>(units.data())[at];
}

std::byte byte_of_text(const Shape& shape, const std::byte* slots, std::uint64_t at) {
    if (shape.type->is_wide) return byte_at(memory_of_units(slots, shape.type->length), at);
    const std::uint64_t length = slot_value(slots), room = shape.type->length;
    if (shape.is_s7 && at < 2) return static_cast<std::byte>(at == 0 ? room : length);
    if (shape.is_s7) at -= 2;
    return (at == length && at < room) || at > room ? std::byte{0} : slots[8 + at];
}

/// Where another text begins at `first`, too: the first 0 ends it.
void set_units(const Shape& shape, std::byte* slots, std::uint64_t first, std::uint64_t count,
               const std::byte* from) {
    std::u16string memory = memory_of_units(slots, shape.type->length);
    std::memcpy(reinterpret_cast<std::byte*>(memory.data()) + first, from, count);
    memory.back() = 0;
    set_memory_of_units(slots, memory);
}

/// A text ends with its first 0, or with its room, behind which there is a byte more; on an S7
/// where it says.
void set_text(const Shape& shape, std::byte* slots, std::uint64_t first, std::uint64_t count,
              const std::byte* from) {
    if (shape.type->is_wide) return set_units(shape, slots, first, count, from);
    const std::uint64_t length = slot_value(slots), room = shape.type->length;
    if (length < room && !shape.is_s7) slots[8 + length] = std::byte{0};
    for (std::uint64_t at = first; at < first + count; ++at, ++from) {
        const std::uint64_t place = shape.is_s7 ? at - 2 : at;
        if (shape.is_s7 && at == 1)
            set_slot(slots, std::min(std::to_integer<std::uint64_t>(*from), room));
        if (place <= room) slots[8 + place] = *from;
    }
    if (shape.is_s7) return;
    const std::byte* end = std::find(slots + 8, slots + 8 + room, std::byte{0});
    set_slot(slots, static_cast<std::uint64_t>(end - slots) - 8);
}

bool is_null(const Shape& shape, const std::byte* slots) {
    const bool may_be = shape.type->is_reference() || shape.type->kind == Type::Kind::interface;
    return may_be && std::all_of(slots, slots + 8 * shape.slots,
                                 [](std::byte byte) { return byte == std::byte{0}; });
}

/// `count` bytes from `first` on of one leaf, which is none of single bits.
Fault read_leaf(const Code& code, const Leaf& leaf, std::uint64_t first, std::uint64_t count,
                std::byte* to) {
    const Shape& shape = code.shapes[leaf.number];
    switch (shape.kind) {
        case Shape::Kind::scalar:
            std::memcpy(to, bytes_of_scalar(shape, scalar_value(shape, leaf.slots)).data() + first,
                        count);
            return Fault::none;
        case Shape::Kind::text:
            for (std::uint64_t i = 0; i < count; ++i)
                to[i] = byte_of_text(shape, leaf.slots, first + i);
            return Fault::none;
        case Shape::Kind::raw:
            std::memcpy(to, leaf.slots + first, count);
            return Fault::none;
        default:
            std::memset(to, 0, count);
            return is_null(shape, leaf.slots) ? Fault::none : Fault::outside_of_variable;
    }
}

Fault write_leaf(const Code& code, const Leaf& leaf, std::uint64_t first, std::uint64_t count,
                 const std::byte* from) {
    const Shape& shape = code.shapes[leaf.number];
    if (shape.kind == Shape::Kind::scalar) {
        Scalar bytes = bytes_of_scalar(shape, scalar_value(shape, leaf.slots));
        std::memcpy(bytes.data() + first, from, count);
        const std::uint64_t value = load_packed(bytes.data(), 0, shape.format);
        if (!is_value(*shape.type, value)) return Fault::out_of_range;
        set_scalar(shape, leaf.slots, value);
    } else if (shape.kind == Shape::Kind::text) {
        set_text(shape, leaf.slots, first, count, from);
    } else if (shape.kind == Shape::Kind::raw) {
        std::memcpy(leaf.slots + first, from, count);
    } else {
        const bool is_zero =
            std::all_of(from, from + count, [](std::byte byte) { return byte == std::byte{0}; });
        const bool is_reference =
            shape.type->is_reference() || shape.type->kind == Type::Kind::interface;
        const bool is_all = is_reference && 8 * count == shape.bits;
        if (!is_zero || (!is_all && !is_null(shape, leaf.slots))) return Fault::outside_of_variable;
        std::memset(leaf.slots, 0, 8 * shape.slots);
    }
    return Fault::none;
}

/// Bytes of one leaf, or a byte of several that are bits, or of none.
struct Run {
    std::optional<Leaf> leaf;
    std::uint64_t first = 0, end = 0;  ///< bytes of the variable
};

Run run_at(const Code& code, const Bytes& of, std::uint64_t byte) {
    const auto leaf = leaf_at(code, of, 8 * byte);
    if (!leaf) return {{}, byte, byte + 1};
    const Shape& shape = code.shapes[leaf->number];
    if (is_bit(shape)) return {leaf, byte, byte + 1};
    return {leaf, leaf->bit / 8, (leaf->bit + shape.bits) / 8};
}

template <class Do>
void visit_bits(const Code& code, const Bytes& of, std::uint64_t byte, const Do& act) {
    for (std::uint64_t i = 0; i < 8; ++i) {
        const auto leaf = leaf_at(code, of, 8 * byte + i);
        if (leaf && is_bit(code.shapes[leaf->number])) act(*leaf, i);
    }
}

Fault read_run(const Code& code, const Bytes& from, const Run& run, std::uint64_t first,
               std::uint64_t count, std::byte* to) {
    if (run.leaf && !is_bit(code.shapes[run.leaf->number]))
        return read_leaf(code, *run.leaf, first - run.first, count, to);
    *to = std::byte{0};
    visit_bits(code, from, first, [&](const Leaf& leaf, std::uint64_t i) {
        *to |= static_cast<std::byte>((slot_value(leaf.slots) & 1) << i);
    });
    return Fault::none;
}

Fault write_run(const Code& code, const Bytes& to, const Run& run, std::uint64_t first,
                std::uint64_t count, const std::byte* from) {
    if (run.leaf && !is_bit(code.shapes[run.leaf->number]))
        return write_leaf(code, *run.leaf, first - run.first, count, from);
    visit_bits(code, to, first, [&](const Leaf& leaf, std::uint64_t i) {
        set_slot(leaf.slots, std::to_integer<std::uint64_t>(*from) >> i & 1);
    });
    return Fault::none;
}

/// Calls `as_one(run, first, count)` of each run of `of`, from the last one on if it is to be so;
/// where that is false `act`, of `longest_run` bytes at most.
template <class AsOne, class Do>
Fault visit_runs(const Code& code, const Bytes& of, std::uint64_t count, bool backwards,
                 const AsOne& as_one, const Do& act) {
    if (!is_inside(code, of, count)) return Fault::outside_of_variable;
    std::uint64_t first = static_cast<std::uint64_t>(of.first), end = first + count;
    while (first < end) {
        const Run run = run_at(code, of, backwards ? end - 1 : first);
        std::uint64_t from = std::max(run.first, first), to = std::min(run.end, end);
        if (as_one(run, from, to - from)) {
            (backwards ? end : first) = backwards ? from : to;
            continue;
        }
        if (backwards)
            from = std::max(from, to - std::min(to, longest_run));
        else
            to = std::min(to, from + longest_run);
        if (const Fault wrong = act(run, from, to - from); wrong != Fault::none) return wrong;
        (backwards ? end : first) = backwards ? from : to;
    }
    return Fault::none;
}

bool is_nothing(const Run&, std::uint64_t, std::uint64_t) {
    return false;
}

/// Where all of the run is a value that begins in the other variable, too, as the same shape: its
/// slots there. Of values that are seen by no bytes this is all there is.
const std::byte* same_value(const Code& code, const Run& run, std::uint64_t first,
                            std::uint64_t count, const Bytes& other, std::uint64_t byte) {
    if (!run.leaf || run.first != first || run.end - run.first != count) return nullptr;
    const auto found = leaf_at(code, other, 8 * byte);
    if (!found || found->bit != 8 * byte || found->number != run.leaf->number) return nullptr;
    const Shape& shape = code.shapes[found->number];
    if (is_bit(shape) || shape.byte) return nullptr;
    return found->slots;
}

bool make_zero(const Code& code, std::uint32_t number, std::byte* slots);

/// All elements or members of what has such, variables of a block.
bool make_parts_zero(const Code& code, const Shape& shape, std::byte* slots) {
    bool is_made = true;
    for (std::uint32_t i = 0; i < shape.count && is_made; ++i) {
        if (shape.kind == Shape::Kind::array) {
            is_made = make_zero(code, shape.element, slots);
            slots += 8 * code.shapes[shape.element].slots;
        } else {
            const ShapeMember& member = code.members[shape.first + i];
            is_made = make_zero(code, member.shape, slots + 8 * member.slot);
        }
    }
    return is_made;
}

/// As it begins, but for its inputs, which are 0.
bool make_standard_zero(const Type& type, std::byte* slots) {
    if (type.is_object()) return false;
    type.standard->construct(slots);
    for (const Variable* member : type.members) {
        if (member->section != Section::input || !member->type->is_scalar()) continue;
        if (member->is_byte)
            slots[member->byte] = std::byte{0};
        else if (member->type->kind != Type::Kind::handle)
            set_slot(slots + 8 * member->slot, 0);
    }
    return true;
}

/// A value of that shape, of which all bytes become 0; false: 0 is no value of its type.
bool make_zero(const Code& code, std::uint32_t number, std::byte* slots) {
    const Shape& shape = code.shapes[number];
    const Type& type = *shape.type;
    if (type.kind == Type::Kind::array || type.kind == Type::Kind::structure ||
        type.kind == Type::Kind::block)
        return make_parts_zero(code, shape, slots);
    if (type.kind == Type::Kind::standard) return make_standard_zero(type, slots);
    std::uint64_t first = 0;
    if (type.kind == Type::Kind::handle) first = ~first;
    if (shape.kind == Shape::Kind::scalar && !is_value(type, 0)) return false;
    std::memset(slots, 0, 8 * shape.slots);
    set_slot(slots, first);
    return true;
}

Bytes behind(Bytes of, std::uint64_t bits) {
    of.first += static_cast<std::int64_t>(bits / 8);
    return of;
}

}  // namespace

bool is_inside(const Code& code, const Bytes& bytes, std::uint64_t count) {
    const std::uint64_t size = code.shapes[bytes.shape].bits / 8;
    return bytes.first >= 0 && count <= size &&
           static_cast<std::uint64_t>(bytes.first) <= size - count;
}

Fault read_bytes(const Code& code, const Bytes& from, std::uint64_t count, std::byte* to) {
    const auto first = static_cast<std::uint64_t>(from.first);
    return visit_runs(code, from, count, false, is_nothing,
                      [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
                          return read_run(code, from, run, at, bytes, to + (at - first));
                      });
}

static Fault write_bytes(const Code& code, const Bytes& to, std::uint64_t count,
                         const std::byte* from) {
    const auto first = static_cast<std::uint64_t>(to.first);
    return visit_runs(code, to, count, false, is_nothing,
                      [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
                          return write_run(code, to, run, at, bytes, from + (at - first));
                      });
}

Fault copy_bytes(const Code& code, const Bytes& to, const Bytes& from, std::uint64_t count) {
    if (!is_inside(code, from, count)) return Fault::outside_of_variable;
    const bool backwards = to.slots == from.slots && to.first > from.first;
    const auto distance = static_cast<std::uint64_t>(from.first - to.first);
    const auto copy = [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
        const std::byte* value = same_value(code, run, at, bytes, from, at + distance);
        if (value) std::memmove(run.leaf->slots, value, 8 * code.shapes[run.leaf->number].slots);
        return value != nullptr;
    };
    return visit_runs(code, to, count, backwards, copy,
                      [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
                          std::byte kept[longest_run];
                          Bytes source = from;
                          source.first = static_cast<std::int64_t>(at + distance);
                          const Fault wrong = read_bytes(code, source, bytes, kept);
                          return wrong == Fault::none ? write_run(code, to, run, at, bytes, kept)
                                                      : wrong;
                      });
}

Fault fill_bytes(const Code& code, const Bytes& to, std::byte value, std::uint64_t count) {
    std::byte filled[longest_run];
    std::ranges::fill(filled, value);
    const auto make_whole_zero = [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
        const bool is_all = run.leaf && run.first == at && run.end - run.first == bytes;
        return value == std::byte{0} && is_all &&
               code.shapes[run.leaf->number].kind == Shape::Kind::whole &&
               make_zero(code, run.leaf->number, run.leaf->slots);
    };
    return visit_runs(code, to, count, false, make_whole_zero,
                      [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
                          return write_run(code, to, run, at, bytes, filled);
                      });
}

Fault compare_bytes(const Code& code, const Bytes& a, const Bytes& b, std::uint64_t count,
                    std::int64_t& order) {
    order = 0;
    const auto first = static_cast<std::uint64_t>(a.first);
    const auto compare = [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
        if (!run.leaf || code.shapes[run.leaf->number].kind != Shape::Kind::whole) return false;
        const std::uint64_t byte = static_cast<std::uint64_t>(b.first) + (at - first);
        const std::byte* value =
            is_inside(code, b, count) ? same_value(code, run, at, bytes, b, byte) : nullptr;
        if (!value) return false;
        const std::uint64_t size = 8 * code.shapes[run.leaf->number].slots;
        const int found = std::memcmp(run.leaf->slots, value, size);
        if (order == 0) order = found < 0 ? -1 : found > 0;
        return true;
    };
    return visit_runs(
        code, a, count, false, compare, [&](const Run& run, std::uint64_t at, std::uint64_t bytes) {
            std::byte left[longest_run], right[longest_run];
            Fault wrong = read_run(code, a, run, at, bytes, left);
            if (wrong == Fault::none)
                wrong = read_bytes(code, behind(b, 8 * (at - first)), bytes, right);
            const int found = wrong == Fault::none ? std::memcmp(left, right, bytes) : 0;
            if (order == 0) order = found < 0 ? -1 : found > 0;
            return wrong;
        });
}

Fault load_value(const Code& code, const Bytes& from, std::uint64_t bit, std::uint32_t number,
                 std::uint64_t& value) {
    const Shape& shape = code.shapes[number];
    Scalar bytes{};
    const Fault wrong = read_bytes(code, behind(from, bit), shape.format.bytes, bytes.data());
    if (wrong != Fault::none) return wrong;
    const std::uint64_t found = load_packed(bytes.data(), bit % 8, shape.format);
    const bool is_its = is_value(*shape.type, found);
    value = is_its ? found : 0;
    return is_its ? Fault::none : Fault::out_of_range;
}

Fault store_value(const Code& code, const Bytes& to, std::uint64_t bit, std::uint32_t number,
                  std::uint64_t value) {
    const Shape& shape = code.shapes[number];
    const Bytes at = behind(to, bit);
    Scalar bytes{};
    const Fault wrong = is_bit(shape) ? read_bytes(code, at, 1, bytes.data()) : Fault::none;
    if (wrong != Fault::none) return wrong;
    store_packed(bytes.data(), bit % 8, shape.format, value);
    return write_bytes(code, at, shape.format.bytes, bytes.data());
}

/// The characters of a WSTRING take two bytes each.
static Fault load_units(const Code& code, const Bytes& from, std::uint64_t room, std::byte* text) {
    std::u16string units(room + 1, u'\0');
    for (std::uint64_t at = 0; at < room; ++at) {
        std::byte two[2];
        const Fault wrong = read_bytes(code, behind(from, 16 * at), 2, two);
        if (wrong != Fault::none) return wrong;
        std::memcpy(&units[at], two, 2);
        if (units[at] == 0) break;
    }
    set_memory_of_units(text, units);
    return Fault::none;
}

static Fault store_units(const Code& code, const Bytes& to, TextRoom room, const std::byte* text) {
    const std::string_view whole(reinterpret_cast<const char*>(text + 8), slot_value(text));
    const std::u16string units = units_of(whole.substr(0, kept_bytes(whole, room)));
    return write_bytes(code, to, 2 * (units.size() + 1),
                       reinterpret_cast<const std::byte*>(units.c_str()));
}

Fault load_text(const Code& code, const Bytes& from, std::uint32_t number, std::byte* text) {
    const Shape& shape = code.shapes[number];
    if (shape.type->is_wide) return load_units(code, from, shape.type->length, text);
    const std::uint64_t room = shape.type->length;
    std::uint64_t length = room;
    Bytes at = from;
    if (shape.is_s7) {
        std::byte header[2];
        if (const Fault wrong = read_bytes(code, at, 2, header); wrong != Fault::none) return wrong;
        length = std::min(std::to_integer<std::uint64_t>(header[1]), room);
        at = behind(at, 16);
    }
    std::uint64_t taken = 0;
    for (; taken < length; ++taken) {
        std::byte& next = text[8 + taken];
        const Fault wrong = read_bytes(code, behind(at, 8 * taken), 1, &next);
        if (wrong != Fault::none) return wrong;
        if (!shape.is_s7 && next == std::byte{0}) break;
    }
    set_slot(text, taken);
    return Fault::none;
}

Fault store_text(const Code& code, const Bytes& to, std::uint32_t number, const std::byte* text) {
    const Shape& shape = code.shapes[number];
    if (shape.type->is_wide) return store_units(code, to, shape.type->room(), text);
    const std::uint64_t room = shape.type->length, length = std::min(slot_value(text), room);
    const std::byte end{0},
        header[2] = {static_cast<std::byte>(room), static_cast<std::byte>(length)};
    if (!shape.is_s7) {
        const Fault wrong = write_bytes(code, to, length, text + 8);
        return wrong == Fault::none ? write_bytes(code, behind(to, 8 * length), 1, &end) : wrong;
    }
    const Fault wrong = write_bytes(code, to, 2, header);
    return wrong == Fault::none ? write_bytes(code, behind(to, 16), length, text + 8) : wrong;
}

}  // namespace lineshaft::st
