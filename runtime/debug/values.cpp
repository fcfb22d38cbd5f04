#include "runtime/debug/values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/debug/packed_values.hpp"
#include "runtime/debug/properties.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::debug {

namespace {

using st::Section;
using Kind = st::Type::Kind;

std::string with_unit(std::string value, const std::string& unit) {
    return unit.empty() ? value : value + " " + unit;
}

/// What is known already, under a name.
Shown group(std::string name, List inside) {
    return {.name = std::move(name),
            .value = "",
            .inside = [inside = std::move(inside)](auto, auto) { return inside; }};
}

Shown show_variable(const st::Variable& variable, std::byte* base, const Frame& frame) {
    const std::string name(variable.text);
    if (variable.space == st::Space::constant && variable.type && variable.type->is_scalar()) {
        const std::uint64_t bits = variable.type->is_real()
                                       ? std::bit_cast<std::uint64_t>(variable.value.real)
                                       : static_cast<std::uint64_t>(variable.value.integer);
        return {.name = name,
                .value = with_unit(st::value_text(*variable.type, bits), variable.unit),
                .type = variable.type->name};
    }
    const Seat seat = seat_of(variable, base, frame);
    if (!seat.at) return {.name = name, .value = "not in the machine's memory"};
    Shown shown = show(name, seat, variable.unit);
    if (variable.constant) shown.seat = nullptr;
    return shown;
}

/// An ARRAY[*] is passed on as where it is.
Section section_of(const st::Variable& variable) {
    const bool is_given = variable.section == Section::input && variable.type->is_open_array();
    return is_given ? Section::in_out : variable.section;
}

/// The groups of a block's or a routine's variables that have any.
List groups_of(const st::Routine& routine, std::byte* base, const Frame& frame) {
    static const std::pair<const char*, std::vector<Section>> groups[] = {
        {"Inputs", {Section::input}},      {"Outputs", {Section::output, Section::result}},
        {"In and out", {Section::in_out}}, {"Locals", {Section::local, Section::kept}},
        {"Temporaries", {Section::temp}},  {"Globals", {Section::external, Section::global}}};
    List shown;
    for (const auto& [name, sections] : groups) {
        List of_group;
        for (const st::Variable* variable : st::all_variables(routine))
            if (variable->type && !variable->text.empty() && !variable->bound_of &&
                std::ranges::find(sections, section_of(*variable)) != sections.end())
                of_group.push_back(show_variable(*variable, base, frame));
        if (!of_group.empty()) shown.push_back(group(name, std::move(of_group)));
    }
    const auto is_monitored = [](const auto& getter) { return getter.second->pou->is_monitored; };
    if (std::ranges::any_of(routine.getters, is_monitored))
        shown.push_back(
            {.name = "Properties", .value = "", .inside = [&routine, base, &frame](auto, auto) {
                 return properties_of({routine.type, base, &frame});
             }});
    return shown;
}

List elements_of(const Seat& seat, std::size_t first, std::size_t count) {
    const st::Type& array = *seat.type;
    const auto size = array.count();
    const std::size_t end =
        first + std::min(count == 0 ? size : count, size - std::min(first, size));
    List elements;
    for (std::size_t i = first; i < end; ++i)
        elements.push_back(show(fmt::format("[{}]", array.lower + static_cast<std::int64_t>(i)),
                                seat.part(array.element, 8 * i * st::element_slots(array))));
    return elements;
}

/// What a reference is to, if there is a value of its type.
List referred(const Seat& seat) {
    const Seat target = target_of(seat);
    return target.at ? List{show("^", target)} : List{};
}

std::string field_text(const Field& field, const std::byte* block) {
    return describe(load(field.type, block + field.offset), field.type, field.names,
                    field.unit.find('{') == std::string_view::npos ? field.unit : "");
}

List fields_inside(const BlockType& kind, const std::byte* block, const Frame& frame);

/// An AXIS_REF or another block of the program, with what is in that.
void show_referred(Shown& shown, const Referred& to, const Frame& frame) {
    shown.value = to.at ? to.block->name : "none";
    if (!to.at) return;
    shown.inside = [to, &frame](auto, auto) {
        return fields_inside(*to.block->type, to.at, frame);
    };
}

List fields_inside(const BlockType& kind, const std::byte* block, const Frame& frame) {
    List fields;
    for (const Field& field : kind.fields) {
        const std::byte* const at = block + field.offset;
        Shown& shown = fields.emplace_back(Shown{.name = std::string(field.name),
                                                 .value = field_text(field, block),
                                                 .type = std::string(name_of(field.direction)),
                                                 .at = at,
                                                 .bytes = size_of(field.type)});
        if (field.direction != Direction::in_out) continue;
        shown.type = field.refers;
        show_referred(shown, block_of(at, frame), frame);
    }
    return fields;
}

void show_parts(Shown& shown, const Seat& seat) {
    switch (seat.type->kind) {
        case Kind::array:
            shown.elements = seat.type->count();
            shown.inside = [seat](std::size_t first, std::size_t count) {
                return elements_of(seat, first, count);
            };
            break;
        case Kind::structure:
        case Kind::union_:
            shown.inside = [seat](auto, auto) {
                List members;
                for (const st::Variable* member : seat.type->members)
                    members.push_back(
                        show(std::string(member->text), member_at(seat, *member), member->unit));
                return members;
            };
            break;
        case Kind::block:
            shown.inside = [seat](auto, auto) {
                return groups_of(*seat.type->routine, seat.at, *seat.frame);
            };
            break;
        case Kind::standard:
            shown.inside = [seat](auto, auto) {
                return fields_inside(*seat.type->standard, seat.at, *seat.frame);
            };
            break;
        case Kind::handle:
            show_referred(shown, block_of(seat.at, *seat.frame), *seat.frame);
            break;
        case Kind::reference:
            if (read<std::uint64_t>(seat.at) != 0)
                shown.inside = [seat](auto, auto) { return referred(seat); };
            break;
        default:
            break;
    }
}

std::string text_of(const Seat& seat) {
    switch (seat.type->kind) {
        case Kind::array:
        case Kind::structure:
        case Kind::union_:
        case Kind::block:
        case Kind::standard:
            return st::describe(*seat.type);
        case Kind::reference:
        case Kind::interface:
            return read<std::uint64_t>(seat.at) == 0 ? "NULL" : st::describe(*seat.type);
        case Kind::handle:
            return {};  // see show_referred
        case Kind::text: {
            const auto length =
                std::min<std::uint64_t>(read<std::uint64_t>(seat.at),
                                        seat.type->is_open ? 1 << 16 : seat.type->text_bytes());
            return text_shown(*seat.type, {reinterpret_cast<const char*>(seat.at + 8),
                                           static_cast<std::size_t>(length)});
        }
        default:
            return st::value_text(*seat.type, read<std::uint64_t>(seat.at));
    }
}

/// The array that an ARRAY[*] has been given, with its bounds.
Seat given_array(const Seat& reference, const std::vector<std::int64_t>& bounds) {
    Seat array = target_of(reference);
    if (!array.at) return {};
    auto types = std::make_shared<std::vector<st::Type>>(bounds.size() / 2);
    const st::Type* element = reference.type->element;
    for (std::size_t i = types->size(); i-- > 0; element = &(*types)[i]) {
        st::Type& made = (*types)[i];
        made.kind = Kind::array;
        made.lower = bounds[2 * i], made.upper = bounds[2 * i + 1];
        made.element = element;
        made.has_inner = i + 1 < types->size();
        made.slots = static_cast<std::uint32_t>(made.count() * st::element_slots(made));
    }
    array.type = element;
    array.made = {types, element};
    return array;
}

/// What an ARRAY[*] of a routine or block has been given.
Seat as_given(const st::Variable& array, const Seat& reference, std::byte* base) {
    const Frame& frame = *reference.frame;
    std::vector<std::int64_t> bounds;
    for (const st::Routine& routine : frame.made->checked.routines)
        if (routine.pou == array.of)
            for (const st::Variable& part : routine.variables)
                if (part.bound_of == &array)
                    bounds.push_back(
                        read<std::int64_t>(frame.seen(base + 8 * std::size_t{part.slot})));
    return given_array(reference, bounds);
}

}  // namespace

std::string text_shown(const st::Type& type, std::string_view text) {
    if (!type.is_wide) return st::text_literal(text);
    std::string marked;
    for (const char c : text) {
        if (c == '$' || c == '"') marked += '$';
        marked += c;
    }
    return '"' + st::printable(marked) + '"';
}

Shown show(std::string name, const Seat& seat, const std::string& unit) {
    if (!seat.type) return {.name = std::move(name), .value = "of no type"};
    const bool is_block = seat.type->kind == Kind::block;
    Shown shown{
        .name = std::move(name),
        .value = with_unit(text_of(seat), unit),
        .type = st::describe(*seat.type),
        .at = seat.copy ? nullptr : seat.at,
        .bytes = 8 * std::size_t{is_block ? seat.type->routine->variables_end : seat.type->slots},
        .seat = std::make_shared<const Seat>(seat)};
    show_parts(shown, seat);
    return shown;
}

Seat member_at(const Seat& whole, const st::Variable& member) {
    if (whole.type->kind == Kind::union_) return member_of_union(whole, member);
    if (whole.type->kind == Kind::block) return seat_of(member, whole.at, *whole.frame);
    return whole.part(member.type, 8 * std::size_t{member.slot});
}

Seat target_of(const Seat& reference, std::int64_t bytes) {
    const st::Type* to = reference.type->element;
    const auto address = read<std::uint64_t>(reference.at);
    const auto [piece, byte] = st::ByteOfPiece::of(read<std::uint64_t>(reference.at + 8));
    const st::Code& code = reference.frame->made->generated.code;
    if (!to || address == 0 || piece == 0 || piece > code.pieces.size()) return {};
    const std::int64_t first = bytes + byte;
    const Frame& frame = *reference.frame;
    const auto place_of = [&](std::uint64_t slot) {
        return frame.seen(st::place_of(slot, frame.root, *frame.context));
    };
    for (std::uint32_t shape = 0; shape < code.shapes.size(); ++shape) {
        if (code.shapes[shape].byte || !st::same_type(*code.shapes[shape].type, *to)) continue;
        if (const auto slot = st::slot_of(code, code.pieces[piece - 1].shape, 8 * first, shape))
            return {to, place_of(address + *slot), &frame};
    }
    return seat_in_bytes({code.pieces[piece - 1].shape, place_of(address), first}, *to, frame);
}

Referred block_of(const std::byte* handle, const Frame& frame) {
    const auto number = read<std::int64_t>(handle);
    if (number < 0 || number >= frame.context->blocks) return {};
    const std::byte* at = frame.context->instances[number];
    const auto& blocks = frame.machine->blocks;
    const auto it = std::ranges::find_if(
        blocks, [&](const BlockPlace& b) { return b.live == at || b.published == at; });
    if (it == blocks.end()) return {};
    return {&*it, at};
}

std::byte* global_at(int global, const Frame& frame) {
    const std::byte* slot = frame.root + 8 * (st::globals_slot + static_cast<std::size_t>(global));
    return frame.context->instances[read<std::uint64_t>(slot)];
}

Seat seat_of(const st::Variable& variable, std::byte* base, const Frame& frame) {
    const std::size_t offset = 8 * std::size_t{variable.slot};
    switch (variable.space) {
        case st::Space::frame: {
            const Seat seat{variable.type, frame.seen(base + offset), &frame};
            const bool is_open = variable.type && variable.type->is_open_array();
            return is_open ? as_given(variable, seat, base) : seat;
        }
        case st::Space::reference: {
            const auto address = read<std::uint64_t>(frame.seen(base + offset));
            if (address == 0) return {};
            return {variable.type, frame.seen(st::place_of(address, frame.root, *frame.context)),
                    &frame};
        }
        case st::Space::global:
            return {variable.type, global_at(variable.global, frame) + offset, &frame};
        case st::Space::image:
            return seat_in_image(variable.address, *variable.type, frame);
        default:
            return {};
    }
}

List parts_of(const Shown& whole, std::size_t first, std::size_t count) {
    List parts = whole.inside(first, count);
    for (Shown& part : parts) {
        const bool is_joined =
            whole.expression.empty() || part.name.front() == '[' || part.name == "^";
        part.expression = whole.expression;
        if (!part.is_group()) part.expression += (is_joined ? "" : ".") + part.name;
    }
    return parts;
}

std::string signal_of(const Linked& linked, const Shown& shown) {
    if (!shown.signal.empty() || !shown.at || shown.inside) return shown.signal;
    for (std::size_t i = 0; i < linked.machine.blocks.size(); ++i) {
        const BlockPlace& block = linked.machine.blocks[i];
        const auto offset = static_cast<std::size_t>(shown.at - block.live);
        if (shown.at < block.live || offset >= block.type->size) continue;
        const auto& fields = block.type->fields;
        for (std::size_t field = 0; field < fields.size(); ++field)
            if (fields[field].offset == offset && fields[field].direction != Direction::in_out)
                return linked.net.signal({static_cast<int>(i), static_cast<int>(field)}).name;
    }
    return {};
}

List scopes_of(const Frame& frame) {
    List scopes = groups_of(*frame.routine, frame.base, frame);
    if (const st::Routine* owner = frame.routine->owner)
        scopes.push_back(
            {.name = "THIS", .value = owner->name, .inside = [owner, &frame](auto, auto) {
                 return groups_of(*owner, frame.base, frame);
             }});
    return scopes;
}

namespace {

/// `, from slave.velocity` of an input that a wire feeds.
std::string origin_of(const Linked& linked, Port port) {
    for (const Wire& wire : linked.net.wires_to(port.instance))
        if (wire.to.field == port.field)
            return fmt::format(", from {}{}", wire.negated ? "NOT " : "",
                               linked.net.signal(wire.from).name);
    return "";
}

Shown show_field(const Linked& linked, Port port, const std::byte* block) {
    const Field& field = linked.net.field(port);
    const Signal signal = linked.net.signal(port);
    std::string type(name_of(field.type));
    if (field.direction == Direction::input) type += origin_of(linked, port);
    if (field.direction == Direction::in_out) {
        const auto other = read<std::int64_t>(block + field.offset);
        const bool is_there = other >= 0 && other < std::ssize(linked.net.instances);
        return {.name = std::string(field.name),
                .value = is_there ? linked.net.instance(static_cast<int>(other)).name : "none",
                .type = std::string(field.refers)};
    }
    return {.name = std::string(field.name),
            .value = signal.describe(load(field.type, block + field.offset)),
            .type = std::move(type),
            .signal = signal.name,
            .at = block + field.offset,
            .bytes = size_of(field.type)};
}

/// Its fields by direction, with where its inputs come from.
Shown show_block(const Linked& linked, int number) {
    const BlockPlace& block = linked.machine.blocks[static_cast<std::size_t>(number)];
    const auto inside = [&linked, number, &block](auto, auto) {
        constexpr std::pair<Direction, const char*> groups[] = {
            {Direction::input, "Inputs"},         {Direction::output, "Outputs"},
            {Direction::in_out, "References"},    {Direction::local, "Locals"},
            {Direction::parameter, "Parameters"},
        };
        List shown;
        for (const auto& [direction, name] : groups) {
            List fields;
            for (std::size_t i = 0; i < block.type->fields.size(); ++i)
                if (block.type->fields[i].direction == direction)
                    fields.push_back(show_field(linked, {number, static_cast<int>(i)}, block.live));
            if (!fields.empty()) shown.push_back(group(name, std::move(fields)));
        }
        return shown;
    };
    return {.name = block.name, .value = std::string(block.type->name), .inside = inside};
}

}  // namespace

Shown show_blocks(const Linked& linked, int task) {
    List blocks;
    for (std::size_t i = 0; i < linked.machine.blocks.size(); ++i)
        if (linked.net.instances[i].task == task)
            blocks.push_back(show_block(linked, static_cast<int>(i)));
    return group("Blocks", std::move(blocks));
}

Shown show_signal(const Machine& machine, const Signal& signal) {
    const std::byte* at = signal.slot;
    if (signal.port.instance >= 0) {
        const BlockPlace& block = machine.blocks[static_cast<std::size_t>(signal.port.instance)];
        at = block.live + block.type->fields[static_cast<std::size_t>(signal.port.field)].offset;
    }
    return {.name = signal.name,
            .value = signal.describe(signal.value()),
            .type = std::string(name_of(signal.type)),
            .signal = signal.name,
            .at = at,
            .bytes = size_of(signal.type)};
}

Shown show_inputs(const Linked& linked) {
    List inputs;
    for (const Signal& signal : linked.machine.signals)
        if (signal.port.instance < 0) inputs.push_back(show_signal(linked.machine, signal));
    return group("Inputs of the program", std::move(inputs));
}

Shown show_forces(const Linked& linked, std::int64_t now) {
    List forces;
    for (const Force& force : linked.machine.forces)
        if (force.from <= now && now < force.until)
            forces.push_back({.name = force.name, .value = force.value_text});
    return group("Forced", std::move(forces));
}

}  // namespace lineshaft::debug
