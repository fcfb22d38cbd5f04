#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/st/generate/layout.hpp"
#include "runtime/st/generate/places.hpp"

namespace lineshaft::st {

namespace {

std::uint64_t bits_of(const Type& type, const Constant& value) {
    if (type.is_real()) return std::bit_cast<std::uint64_t>(value.real);
    return static_cast<std::uint64_t>(value.integer);
}

void fill_elements(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type,
                   const Expression& list) {
    const bool nested = list.is_nested();
    const Type& element = nested ? *type.element : type.innermost();
    const std::uint32_t slots = slots_of(w, element), end = at + slots_of(w, type);
    const auto put_one = [&](const Expression& value) {
        if (at < end) fill(w, image, at, element, value);
        at += slots;
    };
    for (const Argument& argument : list.arguments) {
        if (argument.value->kind != Expression::Kind::repeated) {
            put_one(*argument.value);
            continue;
        }
        const auto times = argument.value->operands[0]->constant.integer;
        for (Wide i = 0; i < times && at < end; ++i) {
            if (argument.value->arguments.empty()) at += slots;
            for (const Argument& repeated : argument.value->arguments) put_one(*repeated.value);
        }
    }
}

/// The block begins at `at`.
void put(Writing::Image& image, std::uint32_t at, const Variable& member, const Constant& value) {
    if (member.is_byte)
        reinterpret_cast<char*>(&image[at])[member.byte] = static_cast<char>(value.integer);
    else
        image[at + member.slot] = bits_of(*member.type, value);
}

/// What is 0 says nothing of the bytes that other members share.
void fill_member_of_union(Writing& w, Writing::Image& image, std::uint32_t at,
                          const Variable& member, const Expression* value) {
    const Type& type = *member.type;
    Writing::Image slots(slots_of(w, type), 0);
    fill_default(w, slots, 0, type);
    if (value) fill(w, slots, 0, type, *value);
    if (value || std::ranges::any_of(slots, [](std::uint64_t slot) { return slot != 0; }))
        fill_packed(reinterpret_cast<std::byte*>(&image[at]), place_in_union(member), type,
                    member.name.place.dialect(), slots.data());
}

}  // namespace

void fill(Writing& w, Writing::Image& image, std::uint32_t at, const Variable& variable) {
    if (variable.space == Space::reference || variable.space == Space::constant ||
        variable.space == Space::image || variable.space == Space::overlay ||
        (variable.space == Space::global && variable.of))
        return;
    fill_default(w, image, at, *variable.type);
    if (variable.initial) fill(w, image, at, *variable.type, *variable.initial);
}

void fill_default(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type) {
    switch (type.kind) {
        case Kind::array:
            for (std::uint32_t i = 0; i < slots_of(w, type); i += slots_of(w, *type.element))
                fill_default(w, image, at + i, *type.element);
            break;
        case Kind::structure:
            for (const Variable* member : type.members) fill(w, image, at + member->slot, *member);
            break;
        case Kind::union_:
            for (const Variable* member : type.members)
                fill_member_of_union(w, image, at, *member, member->initial);
            break;
        case Kind::block:
            std::ranges::copy(w.images[&type], image.begin() + at);
            break;
        case Kind::standard:
            type.standard->construct(reinterpret_cast<std::byte*>(&image[at]));
            for (const auto& [name, value] : type.presets)
                for (const Variable* member : type.members)
                    if (member->text == name) put(image, at, *member, value);
            break;
        default:
            if (type.is_scalar()) image[at] = bits_of(type, type.initial);
    }
    if (type.initial_value) fill(w, image, at, type, *type.initial_value);
}

void fill(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type,
          const Expression& value) {
    if (value.kind == Expression::Kind::constant && type.kind == Kind::text) {
        const std::string& whole = value.constant.text;
        const std::string text = whole.substr(0, kept_bytes(whole, type.room()));
        image[at] = text.size();
        std::memcpy(&image[at] + 1, text.data(), text.size());
    } else if (value.kind == Expression::Kind::constant) {
        image[at] = bits_of(type, value.constant);
    } else if (value.kind == Expression::Kind::list && type.kind == Kind::array) {
        fill_elements(w, image, at, type, value);
    } else if (value.kind == Expression::Kind::list) {
        for (const Argument& argument : value.arguments) {
            const Variable* member = argument.variable;
            if (!member || !member->type) continue;
            if (type.kind == Kind::union_)
                fill_member_of_union(w, image, at, *member, argument.value);
            else if (member->is_byte && argument.value->kind == Expression::Kind::constant)
                reinterpret_cast<char*>(&image[at])[member->byte] =
                    static_cast<char>(argument.value->constant.integer);
            else
                fill(w, image, at + member->slot, *member->type, *argument.value);
        }
    }
}

void fill_assigned(Writing& w, Writing::Image& image, const Block& assignments) {
    for (const Statement* s : assignments) {
        const Location to = locate(w, *s->target);
        if (to.byte)
            reinterpret_cast<char*>(&image[to.slot])[*to.byte] =
                static_cast<char>(s->value->constant.integer);
        else
            fill(w, image, to.slot, *s->target->type, *s->value);
    }
}

void finish_images(Writing& w) {
    std::unordered_map<const Writing::Image*, std::uint32_t> starts;
    for (const Writing::ImageUse& use : w.image_uses) {
        const Writing::Image& image =
            use.type ? w.images[use.type] : w.function_images[use.function];
        const auto end = static_cast<std::uint32_t>(w.code.images.size());
        const auto [start, added] = starts.emplace(&image, end);
        if (added) w.code.images.insert(w.code.images.end(), image.begin(), image.end());
        w.code.instructions[use.instruction].b += start->second;
    }
    w.code.images.push_back(0);  // an empty image begins in it, too
}

}  // namespace lineshaft::st
