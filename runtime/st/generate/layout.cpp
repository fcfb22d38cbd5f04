#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "runtime/st/generate/generator_class.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

constexpr std::uint64_t most_slots = 1U << 26;

std::uint64_t bits_of(const Type& type, const Constant& value) {
    if (type.is_real()) return std::bit_cast<std::uint64_t>(value.real);
    return static_cast<std::uint64_t>(value.integer);
}

}  // namespace

/// Of a block only after it is laid out, with all its methods.
std::uint32_t Generator::slots_of(const Type& type) {
    if (type.kind == Kind::block) return type.routine->frame;
    if (type.slots != 0) return type.slots;
    std::uint64_t slots = 0;
    if (type.kind == Kind::text) slots = 1 + (type.length + 7U) / 8;
    if (type.kind == Kind::array)
        slots = static_cast<std::uint64_t>(type.upper - type.lower + 1) * slots_of(*type.element);
    if (type.kind == Kind::structure)
        for (Variable* member : type.members) {
            member->slot = static_cast<std::uint32_t>(slots);
            slots += slots_of(*member->type);
        }
    if (slots > most_slots) check_size(slots, place_, type.name);
    const_cast<Type&>(type).slots = static_cast<std::uint32_t>(std::min(slots, most_slots));
    return type.slots;
}

void Generator::check_size(std::uint64_t slots, Place place, std::string_view name) {
    if (slots <= most_slots) return;
    if (!place.file) return;
    out_.add("L0912", place.mark(), fmt::format("'{}' takes more than 512 MB", name),
             "make its arrays smaller");
}

void Generator::place_variables(Routine& routine, std::uint32_t& at, auto condition) {
    for (Variable& variable : routine.variables) {
        const bool elsewhere = variable.space == Space::none || variable.space == Space::global;
        if (elsewhere || !condition(variable)) continue;
        place_ = variable.name.place;
        variable.slot = at;
        const std::uint64_t own = slots_of(*variable.type);  // also lays out what is referred to
        const std::uint64_t slots = variable.space != Space::reference ? own
                                    : variable.type->is_open           ? 2
                                                                       : 1;
        check_size(at + slots, variable.name.place, variable.text);
        if (at + slots > most_slots) return;
        at += static_cast<std::uint32_t>(slots);
    }
}

/// Variables that live for one call only come last, to be initialised in one go.
void Generator::lay_out(Routine& block) {
    if (block.variables_end != 0) return;
    std::uint32_t at = globals_slot + code_.globals + 2 * block.depth;
    place_variables(block, at, [](const Variable& v) { return v.section != Section::temp; });
    block.temps_begin = at;
    place_variables(block, at, [](const Variable& v) { return v.section == Section::temp; });
    block.variables_end = block.frame = at;
    Image& image = images_[block.type];
    image.assign(at, 0);
    for (const Variable& variable : block.variables) fill(image, variable.slot, variable);
}

void Generator::lay_out_function(Routine& routine) {
    std::uint32_t at = 0;
    const auto is_given = [](const Variable& v) {
        return v.section == Section::input || v.section == Section::in_out;
    };
    place_variables(routine, at, is_given);
    routine.temps_begin = at;
    place_variables(routine, at, [&](const Variable& v) { return !is_given(v); });
    routine.variables_end = at;
    Image& image = function_images_[&routine];
    image.assign(at, 0);
    for (const Variable& variable : routine.variables) fill(image, variable.slot, variable);
}

/// A method's frame is a part of its block's.
void Generator::lay_out_method(Routine& method) {
    Routine& block = *method.owner;
    lay_out(block);
    std::uint32_t at = block.frame;
    const auto is_given = [](const Variable& v) {
        return v.section == Section::input || v.section == Section::in_out;
    };
    place_variables(method, at, is_given);
    method.temps_begin = at;
    place_variables(method, at, [&](const Variable& v) { return !is_given(v); });
    method.variables_end = at;
    Image& image = images_[block.type];
    image.resize(at, 0);
    for (const Variable& variable : method.variables) fill(image, variable.slot, variable);
}

void Generator::fill(Image& image, std::uint32_t at, const Variable& variable) {
    if (variable.space == Space::reference || variable.space == Space::none ||
        (variable.space == Space::global && variable.of))
        return;
    fill_default(image, at, *variable.type);
    if (variable.initial) fill(image, at, *variable.type, *variable.initial);
}

void Generator::fill_default(Image& image, std::uint32_t at, const Type& type) {
    switch (type.kind) {
        case Kind::array:
            for (std::uint32_t i = 0; i < slots_of(type); i += slots_of(*type.element))
                fill_default(image, at + i, *type.element);
            break;
        case Kind::structure:
            for (const Variable* member : type.members) fill(image, at + member->slot, *member);
            break;
        case Kind::block:
            std::ranges::copy(images_[&type], image.begin() + at);
            break;
        case Kind::standard:
            type.standard->construct(reinterpret_cast<std::byte*>(&image[at]));
            for (const auto& [name, value] : type.presets)
                for (const Variable* member : type.members)
                    if (member->text == name)
                        image[at + member->slot] = bits_of(*member->type, value);
            break;
        default:
            if (type.is_scalar()) image[at] = bits_of(type, type.initial);
    }
    if (type.initial_value) fill(image, at, type, *type.initial_value);
}

void Generator::fill(Image& image, std::uint32_t at, const Type& type, const Expression& value) {
    if (value.kind == Expression::Kind::constant && type.kind == Kind::text) {
        const std::string text = value.constant.text.substr(0, type.length);
        image[at] = text.size();
        std::memcpy(&image[at] + 1, text.data(), text.size());
    } else if (value.kind == Expression::Kind::constant) {
        image[at] = bits_of(type, value.constant);
    } else if (value.kind == Expression::Kind::list && type.kind == Kind::array) {
        fill_elements(image, at, type, value);
    } else if (value.kind == Expression::Kind::list) {
        for (const Argument& argument : value.arguments) {
            const Variable* member = argument.variable;
            if (!member || !member->type) continue;
            if (member->is_byte)
                reinterpret_cast<char*>(&image[at])[member->byte] =
                    static_cast<char>(argument.value->constant.integer);
            else
                fill(image, at + member->slot, *member->type, *argument.value);
        }
    }
}

void Generator::fill_elements(Image& image, std::uint32_t at, const Type& type,
                              const Expression& list) {
    const bool nested = list.is_nested();
    const Type& element = nested ? *type.element : type.innermost();
    const std::uint32_t slots = slots_of(element), end = at + slots_of(type);
    const auto put_one = [&](const Expression& value) {
        if (at < end) fill(image, at, element, value);
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

/// What stands behind BEGIN are initial values.
void Generator::fill_data_block(Image& image, const Global& global) {
    if (!global.pou) return;
    for (const Statement* s : global.pou->body) {
        const Location to = locate(*s->target);
        if (to.byte)
            reinterpret_cast<char*>(&image[to.slot])[*to.byte] =
                static_cast<char>(s->value->constant.integer);
        else
            fill(image, to.slot, *s->target->type, *s->value);
    }
}

void Generator::finish_images() {
    std::unordered_map<const Type*, std::uint32_t> starts;
    std::unordered_map<const Routine*, std::uint32_t> function_starts;
    const auto append = [&](const Image& image) {
        const auto start = static_cast<std::uint32_t>(code_.images.size());
        code_.images.insert(code_.images.end(), image.begin(), image.end());
        return start;
    };
    for (const ImageUse& use : image_uses_) {
        std::uint32_t& b = code_.instructions[use.instruction].b;
        if (use.type) {
            if (!starts.contains(use.type)) starts[use.type] = append(images_[use.type]);
            b += starts[use.type];
        } else {
            if (!function_starts.contains(use.function))
                function_starts[use.function] = append(function_images_[use.function]);
            b += function_starts[use.function];
        }
    }
    code_.images.push_back(0);  // an empty image begins in it, too
}

}  // namespace lineshaft::st
