#include "runtime/st/code/shapes.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "runtime/st/code/code.hpp"

namespace lineshaft::st {

namespace {

/// The last member that begins there or before.
const ShapeMember* last_member(const Code& code, const Shape& of, std::uint64_t ShapeMember::*begin,
                               std::uint64_t at) {
    const auto members = std::span(code.members).subspan(of.first, of.count);
    const auto behind = std::ranges::upper_bound(members, at, {}, begin);
    return behind == members.begin() ? nullptr : &*std::prev(behind);
}

}  // namespace

bool derives(const Code& code, std::uint32_t shape, std::uint32_t from) {
    while (shape != from && code.shapes[shape].base != 0) shape = code.shapes[shape].base - 1;
    return shape == from;
}

const ShapeMember* member_at(const Code& code, const Shape& structure, std::uint64_t bit) {
    return last_member(code, structure, &ShapeMember::bit, bit);
}

std::optional<std::uint64_t> slot_of(const Code& code, std::uint32_t shape, std::int64_t bit,
                                     std::uint32_t wanted) {
    if (bit < 0) return {};
    auto at = static_cast<std::uint64_t>(bit);
    std::uint64_t slot = 0;
    for (;;) {
        const Shape& here = code.shapes[shape];
        if (at >= here.bits && at != 0) return {};
        if (derives(code, shape, wanted)) return at == 0 ? std::optional(slot) : std::nullopt;
        if (here.kind == Shape::Kind::array) {
            if (here.stride == 0) return {};
            slot += at / here.stride * code.shapes[here.element].slots;
            at %= here.stride;
            shape = here.element;
        } else if (here.kind == Shape::Kind::structure) {
            const ShapeMember* member = member_at(code, here, at);
            if (!member) return {};
            slot += member->slot;
            at -= member->bit;
            shape = member->shape;
        } else {
            return {};
        }
    }
}

std::uint64_t byte_of(const Code& code, std::uint32_t shape, std::uint64_t slot) {
    std::uint64_t byte = 0;
    while (slot > 0) {
        const Shape& here = code.shapes[shape];
        if (here.kind == Shape::Kind::array) {
            const Shape& element = code.shapes[here.element];
            byte += slot / element.slots * (here.stride / 8);
            slot %= element.slots;
            shape = here.element;
        } else if (here.kind == Shape::Kind::structure) {
            const ShapeMember* member = last_member(code, here, &ShapeMember::slot, slot);
            if (!member) return byte;
            byte += member->bit / 8;
            slot -= member->slot;
            shape = member->shape;
        } else {
            return byte;
        }
    }
    return byte;
}

}  // namespace lineshaft::st
