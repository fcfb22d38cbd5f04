#include "runtime/debug/properties.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

namespace lineshaft::debug {

namespace {

/// Passes of loops and calls in a GET.
constexpr std::int64_t most_passes = 1'000'000;

/// All that blocks of a machine are given, once more.
struct Copied {
    BlockMemory memory;
    std::vector<std::byte*> instances, seen;
    Context context;
    std::ptrdiff_t room;  ///< where what is not the machine's begins

    Copied(const Frame& frame, std::size_t bytes_of_room) : context(*frame.context) {
        const BlockMemory& all = frame.machine->memory;
        room = static_cast<std::ptrdiff_t>((all.size() + 15) / 16 * 16);
        memory.resize(static_cast<std::size_t>(room) + bytes_of_room);
        std::ranges::copy(all, memory.begin());
        for (int i = 0; i < context.blocks; ++i) {
            instances.push_back(place_of(context.instances[i], frame));
            seen.push_back(place_of(context.seen[i], frame));
        }
        context.instances = instances.data();
        context.seen = seen.data();
        context.memory = memory.data();
    }
    Copied(const Copied&) = delete;
    Copied& operator=(const Copied&) = delete;

    std::byte* place_of(const std::byte* at, const Frame& frame) {
        return memory.data() + (at - frame.machine->memory.data());
    }
};

/// As it means the same to all blocks; empty: it is in none.
std::optional<std::uint64_t> address_of(const std::byte* at, const Context& context) {
    for (int i = 0; i < context.blocks; ++i) {
        const auto bytes = static_cast<std::uint64_t>(at - context.instances[i]);
        if (bytes < context.types[i]->size)
            return st::Address::in(static_cast<std::uint64_t>(i), bytes / 8).word();
    }
    return {};
}

const st::Type* block_at(const st::Type& type, std::size_t slot, const st::Routine& wanted);

const st::Type* block_in(const st::Variable& part, std::size_t slot, const st::Routine& wanted) {
    if (!part.type || part.space != st::Space::frame || slot < part.slot) return nullptr;
    return block_at(*part.type, slot - part.slot, wanted);
}

/// The outermost block that begins at a slot of a value and is the wanted one, or derives from it;
/// null: none.
const st::Type* block_at(const st::Type& type, std::size_t slot, const st::Routine& wanted) {
    if (type.kind == st::Type::Kind::array) {
        const std::size_t each = st::element_slots(type);
        return slot < each * type.count() ? block_at(*type.element, slot % each, wanted) : nullptr;
    }
    if (type.kind == st::Type::Kind::block && slot == 0 && st::is_a(*type.routine, wanted))
        return &type;
    const st::Type* found = nullptr;
    const auto look = [&](const st::Variable& part) {
        if (!found) found = block_in(part, slot, wanted);
    };
    if (type.kind == st::Type::Kind::structure)
        for (const st::Variable* member : type.members) look(*member);
    if (type.kind != st::Type::Kind::block || slot >= type.routine->frame) return found;
    for (const st::Variable* variable : st::all_variables(*type.routine)) look(*variable);
    for (const st::Routine* block = type.routine; block; block = block->base)
        for (const st::Routine* method : block->own_methods)
            for (const st::Variable& variable : method->variables) look(variable);
    return found;
}

const st::CodeRoutine* code_of(const st::Library::Made& made, const st::Routine& routine) {
    const auto& order = made.checked.order;
    const auto it = std::ranges::find(order, &routine);
    const auto number = static_cast<std::size_t>(it - order.begin());
    return it == order.end() ? nullptr : &made.generated.code.routines[number];
}

std::string why_not(const st::Code& code, const std::byte* root, st::Fault fault) {
    const auto word = [&](std::uint32_t slot) { return read<std::uint64_t>(root + 8 * slot); };
    const st::EndOfScan end = st::EndOfScan::of(word(st::place_slot), word(st::depth_slot));
    const Mark at = code.places[end.instruction].mark();
    return fmt::format("the fault {}, at {}:{}", st::fault_names[static_cast<std::size_t>(fault)],
                       at.file->path, at.line);
}

}  // namespace

Seat instance_at(const Seat& seat) {
    const Frame& frame = *seat.frame;
    const bool is_interface = seat.type->kind == st::Type::Kind::interface;
    const auto address = is_interface ? std::optional(read<std::uint64_t>(seat.at))
                                      : address_of(seat.at, *frame.context);
    if (is_interface && *address == 0) return {};
    if (!address) return seat;
    const st::Address place = st::Address::of(*address);
    if (!place.is_of_program()) return seat;
    const st::KindContext* kind = st::context_of(*frame.context->types[place.instance()]);
    const st::Type* type = kind ? block_at(*kind->type, place.slot, *seat.type->routine) : nullptr;
    return {type ? type : seat.type, st::place_of(*address, frame.root, *frame.context), &frame};
}

Got get(const Seat& instance, const st::Routine& getter) {
    const Frame& frame = *instance.frame;
    const auto address = address_of(instance.at, *frame.context);
    const st::CodeRoutine* code = code_of(*frame.made, getter);
    if (!address || !code || !getter.result) return {.error = getter.name + " is not called here"};
    const auto copied = std::make_shared<Copied>(frame, st::bytes_beside(*code));
    std::byte* const root = copied->place_of(frame.root, frame);
    const st::Code& all = frame.made->generated.code;
    const st::Fault fault =
        st::execute_beside(all, *code, root, *address, *frame.now, copied->context, most_passes,
                           copied->memory.data() + copied->room);
    if (fault != st::Fault::none)
        return {.error =
                    fmt::format("GET of {} ends with {}", getter.name, why_not(all, root, fault))};
    std::byte* const result =
        copied->place_of(instance.at, frame) + 8 * std::size_t{getter.result->slot};
    return {.seat = {getter.result->type, result, &frame, copied}};
}

List properties_of(const Seat& instance) {
    std::vector<const st::Routine*> blocks;
    for (const st::Routine* block = instance.type->routine; block; block = block->base)
        blocks.insert(blocks.begin(), block);
    List shown;
    for (const st::Routine* block : blocks)
        for (const st::Routine* method : block->own_methods) {
            const std::string name(method->pou->name.text);
            const bool is_shown = method->pou->is_monitored &&
                                  st::find_in(instance.type->routine->getters, name) == method;
            if (!is_shown) continue;
            const Seat there = instance_at(instance);
            const Got got = get(there, *st::find_in(there.type->routine->getters, name));
            shown.push_back(got.error.empty() ? show(name, got.seat, method->result->unit)
                                              : Shown{.name = name, .value = got.error});
        }
    return shown;
}

}  // namespace lineshaft::debug
