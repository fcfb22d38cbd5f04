#include "runtime/st/library/kind.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "runtime/model/kept_state.hpp"
#include "runtime/st/library/failed_assertion.hpp"
#include "runtime/st/library/retained.hpp"
#include "runtime/st/library/shortened.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

bool is_in_range(const KindContext::Check& check, std::byte* instance) {
    std::byte* place = instance + 8 * std::size_t{check.slot};
    if (check.type->is_real()) {
        const double narrow = double{static_cast<float>(read<double>(place))};
        std::memcpy(place, &narrow, sizeof narrow);
        return true;
    }
    const Wide value = whole_in(*check.type, read<std::uint64_t>(place));
    return value >= smallest(*check.type) && value <= largest(*check.type);
}

/// Before the first instruction.
bool refuse(const KindContext& kind, std::byte* instance, Fault fault) {
    const std::uint64_t header[] = {1, static_cast<std::uint64_t>(fault), kind.routine->entry, 0,
                                    0};
    std::memcpy(instance, header, sizeof header);
    return true;
}

[[gnu::noinline]] bool run_test(const KindContext& kind, std::byte* instance,
                                const Context& context) {
    kind.failure = kind.run_test(instance, context);
    if (kind.failure.empty()) return false;
    const std::uint64_t header[] = {1, static_cast<std::uint64_t>(Fault::assertion)};
    std::memcpy(instance, header, sizeof header);
    return true;
}

/// Whether what the instance was given is nothing that it may be scanned with.
[[gnu::noinline]] bool is_refused(const KindContext& kind, std::byte* instance) {
    for (const std::uint32_t slot : kind.references)
        if (read<std::uint64_t>(instance + 8 * std::size_t{slot}) == 0)
            return refuse(kind, instance, Fault::no_reference);
    for (const KindContext::Check& check : kind.checks)
        if (!is_in_range(check, instance)) return refuse(kind, instance, Fault::out_of_range);
    return false;
}

bool scan_one(const KindContext& kind, std::byte* instance, const Scan& now,
              const Context& context) {
    if (!kind.is_plain) {
        if (kind.run_test) return run_test(kind, instance, context);
        if (is_refused(kind, instance)) return true;
    }
    return execute(instance, kind.start, now, context);
}

[[gnu::noinline]] bool scan_all(const KindContext& kind, std::byte* first, std::size_t count,
                                const Scan& now, const Context& context) {
    if (!kind.routine) return false;
    bool error = false;
    for (; count > 0; --count, first += kind.size) error |= scan_one(kind, first, now, context);
    return error;
}

bool scan_blocks(std::byte* first, std::size_t count, const Scan& now, const Context& context) {
    const auto& kind = *static_cast<const KindContext*>(context.kind);
    if (count == 1 && kind.is_plain) [[likely]]
        return execute(first, kind.start, now, context);
    return scan_all(kind, first, count, now, context);
}

std::string why(const std::byte* block, const Context& context, const NameOf&) {
    const auto& kind = *static_cast<const KindContext*>(context.kind);
    if (!kind.failure.empty()) return kind.failure;
    const FaultPlace found = fault_of(*kind.code, block);
    if (found.fault == Fault::none) return {};  // the error is forced
    std::string text =
        fmt::format("at {}:{}:{}", found.mark.file->path, found.mark.line, found.mark.column);
    for (std::size_t i = 0; i < found.calls.size(); ++i)
        text += (i == 0 ? " in " : ", called by ") + found.calls[i];
    if (found.fault == Fault::assertion) text += ": " + text_of_failure(*kind.made, block, context);
    if (found.fault == Fault::outside_of_variable)
        text += fmt::format(", which left the variable '{}'", found.left);
    if (found.fault == Fault::call_has_ended)
        text += fmt::format(", where the call that had '{}' has ended", found.left);
    return text;
}

void shift(std::byte* block, std::int64_t by, const void* context) {
    for (const auto& part : static_cast<const KindContext*>(context)->with_moments)
        part.kind->shift(block + part.offset, by, part.kind->context);
}

/// A part of an instance that outlives a scan.
bool stays(const Variable& part) {
    return part.section != Section::temp && part.space == Space::frame && !part.constant;
}

/// Each value that outlives a scan, and where: `value(type, slot)`.
template <class Value>
void visit(const Type& type, std::size_t slot, const Value& value) {
    if (type.kind == Kind::array) {
        for (std::int64_t i = type.lower; i <= type.upper; ++i, slot += element_slots(type))
            visit(*type.element, slot, value);
    } else if (type.kind == Kind::structure) {
        for (const Variable* member : type.members)
            visit(*member->type, slot + member->slot, value);
    } else if (type.kind == Kind::block) {
        const auto visit_kept = [&](const Variable& member) {
            if (member.type && stays(member)) visit(*member.type, slot + member.slot, value);
        };
        for (const Variable* member : all_variables(*type.routine)) visit_kept(*member);
        for (const Routine* block = type.routine; block; block = block->base)
            for (const Routine* method : block->own_methods)
                for (const Variable& member : method->variables)
                    if (member.section == Section::kept) visit_kept(member);
    } else {
        value(type, slot);
    }
}

/// What a scan leaves to the next one, and the next call gives anew: temporaries, frames of
/// functions and the addresses of VAR_IN_OUT, stays as in a new block.
void take(std::byte* block, const std::byte* kept, const void* context) {
    const auto& kind = *static_cast<const KindContext*>(context);
    const auto copy = [&](std::size_t slot, std::size_t slots) {
        std::memcpy(block + 8 * slot, kept + 8 * slot, 8 * slots);
    };
    if (kind.routine)
        for (const std::size_t slot : {error_slot, error_id_slot, cut_slot}) copy(slot, 1);
    visit(*kind.type, 0, [&](const Type& type, std::size_t slot) { copy(slot, slots_of(type)); });
}

std::size_t slots_in_memory(const Type& type) {
    if (type.kind == Kind::block) return type.routine->frame;
    if (type.kind != Kind::array) return slots_of(type);
    return type.count() * element_slots(type);
}

/// Something that `fits` begins at that slot of a value: itself, or a part of it; of a block one of
/// those that `may_be`.
bool is_at(const Type& type, std::size_t slot, const auto& fits, const auto& may_be) {
    if (slot == 0 && fits(type)) return true;
    if (slot >= slots_in_memory(type)) return false;
    if (type.kind == Kind::array)
        return is_at(*type.element, slot % element_slots(type), fits, may_be);
    const bool is_block = type.kind == Kind::block;
    const auto parts = is_block ? all_variables(*type.routine) : type.members;
    return std::ranges::any_of(parts, [&](const Variable* part) {
        return part->type && slot >= part->slot && (!is_block || may_be(*part)) &&
               is_at(*part->type, slot - part->slot, fits, may_be);
    });
}

/// NULL, or to a variable that is there. One of a call is used only while that goes on, and is then
/// known by its frame.
bool is_reference(const std::byte* place, const KeptState& machine) {
    const auto& own = *static_cast<const KindContext*>(machine.context.kind);
    const Address address = Address::of(read<std::uint64_t>(place));
    const std::uint32_t piece = ByteOfPiece::of(read<std::uint64_t>(place + 8)).piece;
    if (piece == 0) return true;
    if (!own.code || piece > own.code->pieces.size() || !address.is_of_program() ||
        address.instance() >= machine.context.blocks)
        return false;
    const Piece& to = own.code->pieces[piece - 1];
    if (to.ends) return true;
    const BlockType& type = *machine.context.types[address.instance()];
    if (type.scan_blocks != scan_blocks) return false;
    const auto& kind = *static_cast<const KindContext*>(type.context);
    const Type& wanted = *own.code->shapes[to.shape].type;
    const auto fits = [&](const Type& there) {
        const bool is_derived = there.kind == Kind::block && wanted.kind == Kind::block &&
                                is_a(*there.routine, *wanted.routine);
        return is_derived || same_type(there, wanted);
    };
    return kind.code == own.code && is_at(*kind.type, address.slot, fits, stays);
}

bool is_handle(const Type& type, std::int64_t number, const Context& context) {
    if (number < 0) return number == -1;
    return number < context.blocks && context.types[number] == type.standard;
}

/// 0, or the address of an instance of the program that implements the interface.
bool is_instance(const Type& interface, std::uint64_t word, const Context& context) {
    if (word == 0) return true;
    const Address address = Address::of(word);
    if (!address.is_of_program() || address.instance() >= context.blocks) return false;
    const BlockType& kind = *context.types[address.instance()];
    if (kind.scan_blocks != scan_blocks) return false;
    const Type& type = *static_cast<const KindContext*>(kind.context)->type;
    const auto implements = [&](const Type& there) {
        return there.kind == Kind::block && is_a(*there.routine, *interface.routine);
    };
    const auto may_be = [](const Variable& part) {
        return part.space != Space::reference && part.space != Space::constant;
    };
    return is_at(type, address.slot, implements, may_be);
}

bool is_value(const Type& type, const std::byte* place, const KeptState& machine) {
    switch (type.kind) {
        case Kind::handle:
            return is_handle(type, read<std::int64_t>(place), machine.context);
        case Kind::interface:
            return is_instance(type, read<std::uint64_t>(place), machine.context);
        case Kind::reference:
            return is_reference(place, machine);
        case Kind::standard:
            return lineshaft::is_valid(*type.standard, place, machine);
        default:
            return is_value(type, place);
    }
}

/// Before each scan: a wire may have brought any number.
bool is_checked(const KindContext& kind, std::size_t slot) {
    return std::ranges::any_of(kind.checks, [&](const auto& check) { return check.slot == slot; });
}

bool is_valid(const std::byte* block, const KeptState& machine) {
    const auto& kind = *static_cast<const KindContext*>(machine.context.kind);
    bool good = true;
    if (kind.routine)
        good = read<std::uint64_t>(block + 8 * cut_slot) <= kind.code->places.size() &&
               read<std::uint64_t>(block + 8 * error_slot) <= 1;
    visit(*kind.type, 0, [&](const Type& type, std::size_t slot) {
        good = good && (is_value(type, block + 8 * slot, machine) || is_checked(kind, slot));
    });
    return good;
}

template <class Do>
void visit_standard(const Type& type, const Do& act) {
    visit(type, 0, [&](const Type& inner, std::size_t slot) {
        if (inner.kind == Kind::standard) act(*inner.standard, 8 * slot);
    });
}

void add_links(std::vector<LinkedPart>& parts, const BlockType& block) {
    const auto& kind = *static_cast<const KindContext*>(block.context);
    visit_standard(*kind.type, [&](const BlockType& inner, std::size_t offset) {
        const std::size_t before = parts.size();
        if (inner.add_links) inner.add_links(parts, inner);
        for (std::size_t i = before; i < parts.size(); ++i) parts[i].place += offset;
    });
}

void mend_links(std::byte* block, const KeptState& machine) {
    const auto& kind = *static_cast<const KindContext*>(machine.context.kind);
    visit_standard(*kind.type, [&](const BlockType& inner, std::size_t offset) {
        if (inner.mend_links) inner.mend_links(block + offset, machine);
    });
}

void make(std::byte* place, const void* context) {
    const auto& kind = *static_cast<const KindContext*>(context);
    if (kind.size > 0) std::memcpy(place, kind.image, kind.size);  // globals may be constants only
}

}  // namespace

bool is_value(const Type& type, const std::byte* place) {
    const auto number = read<std::int64_t>(place);
    switch (type.kind) {
        case Kind::boolean:
            return number == 0 || number == 1;
        case Kind::enumeration:
            return type.is_unchecked ? is_value(*type.base, place)
                                     : type.name_of(number) != nullptr;
        case Kind::integer:
        case Kind::bits:
            if (type.bits == 64 && !type.in_a_run().is_subrange) return true;
            return whole_in(type, read<std::uint64_t>(place)) >= smallest(type.in_a_run()) &&
                   whole_in(type, read<std::uint64_t>(place)) <= largest(type.in_a_run());
        case Kind::real: {
            const auto value = read<double>(place);
            return type.bits == 64 || !std::isfinite(value) ||
                   std::abs(value) <= double{std::numeric_limits<float>::max()};
        }
        case Kind::text:
            return number >= 0 && number <= std::int64_t{type.text_bytes()};
        default:
            return true;
    }
}

std::size_t slots_of(const Type& type) {
    return type.kind == Kind::text ? type.text_slots() : type.slots;
}

std::size_t element_slots(const Type& array) {
    const Type& element = *array.element;
    return element.kind == Kind::block ? element.routine->frame : element.slots;
}

KindContext& add_kind(Library::Made& made, std::string name, const Type& type,
                      const Options& options) {
    KindContext& kind = made.kinds.emplace_back();
    kind.made = &made;
    kind.code = &made.generated.code;
    kind.options = options;
    kind.name = std::move(name);
    const auto& image = made.generated.images.at(&type);
    kind.image = image.data();
    kind.size = 8 * image.size();
    kind.type = &type;
    visit_standard(type, [&](const BlockType& inner, std::size_t offset) {
        if (inner.shift) kind.with_moments.push_back({offset, &inner});
    });
    return kind;
}

BlockType block_type(KindContext& kind, const std::shared_ptr<const Library::Made>& made) {
    kind.is_plain =
        kind.routine && !kind.run_test && kind.references.empty() && kind.checks.empty();
    if (kind.routine) kind.start = {*kind.code, *kind.routine, kind.options.fuel};
    BlockType type;
    type.name = kind.name;
    type.doc = kind.doc;
    type.fields = kind.fields;
    type.size = kind.size;
    type.alignment = alignof(std::uint64_t);
    type.make = make;
    type.scan_blocks = scan_blocks;
    type.shift = shift;
    type.valid = is_valid;
    type.take = take;
    type.add_links = add_links;
    type.mend_links = mend_links;
    type.why = why;
    type.single = !kind.routine;
    if (kind.routine && kind.options.times) type.time_taken = 8 * std::size_t{time_slot};
    type.context = &kind;
    type.owner = made;
    return type;
}

const Library::Made* made_of(const BlockType& kind) {
    if (kind.scan_blocks != scan_blocks) return nullptr;
    return static_cast<const Library::Made*>(kind.owner.get());
}

std::span<const TextVariable> text_variables(const BlockType& kind) {
    if (kind.scan_blocks != scan_blocks) return {};
    return static_cast<const KindContext*>(kind.context)->texts;
}

std::string_view text_of(const TextVariable& variable, const std::byte* block) {
    const std::byte* place = block + variable.offset;
    return {reinterpret_cast<const char*>(place) + 8, read<std::uint64_t>(place)};
}

std::string_view find_text(const BlockType& kind, std::string_view name) {
    const auto texts = text_variables(kind);
    const auto it = std::ranges::find_if(
        texts, [&](const TextVariable& text) { return same_letters(text.name, name); });
    return it == texts.end() ? std::string_view() : it->name;
}

std::span<const std::string_view> shortened_variables(const BlockType& kind) {
    const KindContext* context = context_of(kind);
    return context ? context->shortened : std::span<const std::string_view>();
}

std::string_view find_shortened(const BlockType& kind, std::string_view field) {
    for (const std::string_view path : shortened_variables(kind))
        if (same_letters(field.substr(0, path.size()), path) &&
            (field.size() == path.size() || field[path.size()] == '[' || field[path.size()] == '.'))
            return path;
    return {};
}

const KindContext* context_of(const BlockType& kind) {
    if (kind.scan_blocks != scan_blocks) return nullptr;
    return static_cast<const KindContext*>(kind.context);
}

std::optional<Mark> cut_text(const BlockType& kind, const std::byte* instance) {
    if (kind.scan_blocks != scan_blocks || kind.single) return {};
    return cut_of(*static_cast<const KindContext*>(kind.context)->code, instance);
}

}  // namespace lineshaft::st
