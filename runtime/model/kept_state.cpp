#include "runtime/model/kept_state.hpp"

namespace lineshaft {

namespace {

/// Whether `number` refers to no block, or to one of the kind that the field takes.
bool is_reference(const Field& field, std::int64_t number, const KeptState& machine) {
    if (number < 0) return number == -1;
    return number < machine.context.blocks &&
           same_letters(machine.context.types[number]->name, field.refers);
}

bool is_valid(const Field& field, const std::byte* place, const KeptState& machine) {
    if (field.type == Type::boolean) return read<unsigned char>(place) <= 1;
    if (field.direction == Direction::in_out)
        return field.refers.starts_with("VAR_IN_OUT ") ||
               is_reference(field, read<std::int64_t>(place), machine);
    return field.type != Type::enumeration || field.names.takes(read<std::int64_t>(place));
}

bool fields_are_valid(const BlockType& type, const std::byte* block, const KeptState& machine) {
    return std::ranges::all_of(type.fields, [&](const Field& field) {
        return is_valid(field, block + field.offset, machine);
    });
}

}  // namespace

bool is_valid(const BlockType& type, const std::byte* block, const KeptState& machine) {
    if (!fields_are_valid(type, block, machine)) return false;
    KeptState own = machine;
    own.context.kind = type.context;
    return !type.valid || type.valid(block, own);
}

}  // namespace lineshaft
