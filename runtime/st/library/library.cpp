#include "runtime/st/library/library.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "runtime/model/kept_state.hpp"
#include "runtime/st/library/compiled.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

/// What the blocks of a kind share.
struct KindContext {
    const Code* code = nullptr;
    const CodeRoutine* routine = nullptr;  ///< null: a data block
    const std::uint64_t* image = nullptr;
    std::size_t size = 0;
    Options options;
    std::string name, doc;
    std::vector<Field> fields;
    std::vector<std::string_view> texts;
    std::vector<std::string_view> retained;  ///< names of those in VAR RETAIN
    struct Check {
        std::uint32_t slot;
        const Type* type;
    };
    struct Part {
        std::size_t offset;
        const BlockType* kind;
    };
    std::vector<Part> with_moments;         ///< instances of the catalogue that remember when
    const Type* type = nullptr;             ///< of the instances
    std::vector<Check> checks;              ///< inputs narrower than what a wire brings
    std::vector<std::uint32_t> references;  ///< slots of VAR_IN_OUT, which a call fills
};

namespace {

using Kind = Type::Kind;

bool is_in_range(const KindContext::Check& check, std::byte* instance) {
    std::byte* place = instance + 8 * std::size_t{check.slot};
    if (check.type->is_real()) {
        double value = 0;
        std::memcpy(&value, place, sizeof value);
        const double narrow = double{static_cast<float>(value)};
        std::memcpy(place, &narrow, sizeof narrow);
        return true;
    }
    std::int64_t value = 0;
    std::memcpy(&value, place, sizeof value);
    return value >= smallest(*check.type) && value <= largest(*check.type);
}

/// Before the first instruction.
bool refuse(const KindContext& kind, std::byte* instance, Fault fault) {
    const std::uint64_t header[] = {1, static_cast<std::uint64_t>(fault), kind.routine->entry, 0,
                                    0};
    std::memcpy(instance, header, sizeof header);
    return true;
}

bool scan_one(const KindContext& kind, std::byte* instance, const Scan& now,
              const Context& context) {
    for (const std::uint32_t slot : kind.references) {
        std::uint64_t address = 0;
        std::memcpy(&address, instance + 8 * std::size_t{slot}, sizeof address);
        if (address == 0) return refuse(kind, instance, Fault::no_reference);
    }
    for (const KindContext::Check& check : kind.checks)
        if (!is_in_range(check, instance)) return refuse(kind, instance, Fault::out_of_range);
    Scan moment = now;
    const auto& times = kind.options.times;
    return execute(*kind.code, *kind.routine, instance, moment, context, kind.options.fuel,
                   times ? times->data() : nullptr) != Fault::none;
}

bool scan_blocks(std::byte* first, std::size_t count, const Scan& now, const Context& context) {
    const auto& kind = *static_cast<const KindContext*>(context.kind);
    if (!kind.routine) return false;
    bool error = false;
    for (; count > 0; --count, first += kind.size) error |= scan_one(kind, first, now, context);
    return error;
}

std::string why(const std::byte* block, const Context& context, const NameOf&) {
    const FaultPlace found = fault_of(*static_cast<const KindContext*>(context.kind)->code, block);
    std::string text =
        fmt::format("at {}:{}:{}", found.mark.file->path, found.mark.line, found.mark.column);
    for (std::size_t i = 0; i < found.calls.size(); ++i)
        text += (i == 0 ? " in " : ", called by ") + found.calls[i];
    return text;
}

void shift(std::byte* block, std::int64_t by, const void* context) {
    for (const auto& part : static_cast<const KindContext*>(context)->with_moments)
        part.kind->shift(block + part.offset, by, part.kind->context);
}

/// Each value that outlives a scan, and where: `value(type, slot)`; `reference(slots, slot)` of a
/// VAR_IN_OUT.
template <class Value, class Reference>
void visit(const Type& type, std::size_t slot, const Value& value, const Reference& reference) {
    if (type.kind == Kind::array) {
        const Type& element = *type.element;
        const std::size_t step =
            element.kind == Kind::block ? element.routine->frame : element.slots;
        for (std::int64_t i = type.lower; i <= type.upper; ++i, slot += step)
            visit(element, slot, value, reference);
    } else if (type.kind == Kind::structure) {
        for (const Variable* member : type.members)
            visit(*member->type, slot + member->slot, value, reference);
    } else if (type.kind == Kind::block) {
        for (const Variable& member : type.routine->variables) {
            if (!member.type || member.section == Section::temp) continue;
            if (member.space == Space::reference)
                reference(member.type->is_open ? 2 : 1, slot + member.slot);
            else if (member.space == Space::frame && !member.constant)
                visit(*member.type, slot + member.slot, value, reference);
        }
    } else {
        value(type, slot);
    }
}

std::size_t slots_of(const Type& type) {
    return type.kind == Kind::text ? 1 + (type.length + 7U) / 8 : type.slots;
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
    visit(
        *kind.type, 0, [&](const Type& type, std::size_t slot) { copy(slot, slots_of(type)); },
        [](std::size_t, std::size_t) {});
}

bool is_handle(const Type& type, std::int64_t number, const Context& context) {
    if (number < 0) return number == -1;
    return number < context.blocks && context.types[number] == type.standard;
}

bool is_value(const Type& type, const std::byte* place, const KeptState& machine) {
    const auto number = read<std::int64_t>(place);
    switch (type.kind) {
        case Kind::boolean:
            return number == 0 || number == 1;
        case Kind::enumeration:
            return number >= 0 && number < std::ssize(type.values);
        case Kind::integer:
        case Kind::bits:
            if (type.bits == 64 && !type.is_subrange) return true;
            return number >= smallest(type) && number <= largest(type);
        case Kind::real: {
            const auto value = read<double>(place);
            return type.bits == 64 || !std::isfinite(value) ||
                   std::abs(value) <= double{std::numeric_limits<float>::max()};
        }
        case Kind::handle:
            return is_handle(type, number, machine.context);
        case Kind::text:
            return number >= 0 && number <= std::int64_t{type.length};
        case Kind::standard:
            return lineshaft::is_valid(*type.standard, place, machine);
        default:
            return true;
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
    visit(
        *kind.type, 0,
        [&](const Type& type, std::size_t slot) {
            good = good && (is_value(type, block + 8 * slot, machine) || is_checked(kind, slot));
        },
        [](std::size_t, std::size_t) {});
    return good;
}

template <class Do>
void visit_standard(const Type& type, const Do& act) {
    visit(
        type, 0,
        [&](const Type& inner, std::size_t slot) {
            if (inner.kind == Kind::standard) act(*inner.standard, 8 * slot);
        },
        [](std::size_t, std::size_t) {});
}

void add_links(std::vector<std::size_t>& places, const BlockType& block) {
    const auto& kind = *static_cast<const KindContext*>(block.context);
    visit_standard(*kind.type, [&](const BlockType& inner, std::size_t offset) {
        const std::size_t before = places.size();
        if (inner.add_links) inner.add_links(places, inner);
        for (std::size_t i = before; i < places.size(); ++i) places[i] += offset;
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

struct Library::Made : Compiled {
    std::deque<KindContext> kinds;
    std::deque<std::string> names;                     ///< of fields
    std::deque<std::vector<std::string_view>> values;  ///< of enumerations
};

namespace {

/// What comments say, in one line.
std::string text_of_comments(std::string_view written) {
    constexpr std::string_view marks = "(*/) \t\r\n";
    std::string text;
    for (std::size_t begin = 0; begin < written.size();) {
        const std::size_t end = std::min(written.find('\n', begin), written.size());
        std::string_view line = written.substr(begin, end - begin);
        begin = end + 1;
        line.remove_prefix(std::min(line.find_first_not_of(marks), line.size()));
        const bool is_closed =
            line.ends_with("*)") || line.ends_with("*/") || line.ends_with("*/)");
        const std::size_t last = line.find_last_not_of(is_closed ? marks : " \t\r");
        line = line.substr(0, last == std::string_view::npos ? 0 : last + 1);
        if (!text.empty() && !line.empty()) text += ' ';
        text += line;
    }
    return text;
}

/// Writes down the fields of one kind.
class FieldWriter {
  public:
    FieldWriter(Library::Made& made, KindContext& kind) : made_(made), kind_(kind) {}

    /// `objects` are the globals of the program that it names.
    void write_header(const Routine& routine, const std::set<int>& objects) {
        const bool own = routine.names.contains("error") || routine.names.contains("error_id");
        Field error;
        error.name = own ? "fault" : "error";
        error.doc = "the last scan ended with a fault";
        error.direction = Direction::output;
        error.type = lineshaft::Type::boolean;
        error.offset = 8 * error_slot;
        kind_.fields.push_back(error);
        Field id = error;
        id.name = own ? "fault_id" : "error_id";
        id.doc = "the fault of the last scan";
        id.type = lineshaft::Type::enumeration;
        id.offset = 8 * error_id_slot;
        id.names = fault_names;
        kind_.fields.push_back(id);
        for (std::uint32_t i = 0; i < made_.checked.globals.size(); ++i) {
            const Global& global = made_.checked.globals[i];
            if (global.object && !objects.contains(static_cast<int>(i))) continue;
            Field reference;
            reference.name = made_.names.emplace_back(fmt::format("\"{}\"", global.name));
            reference.global = global.name;
            reference.refers = global.object ? global.type->standard->name : global.name;
            reference.doc = "the program's, by its name";
            reference.direction = Direction::in_out;
            reference.type = lineshaft::Type::integer;
            reference.offset = 8 * std::size_t{globals_slot + i};
            kind_.fields.push_back(reference);
        }
    }

    void write(const Variable& variable, std::uint32_t at, const std::string& path,
               Direction direction) {
        if (variable.space != Space::frame || kind_.fields.size() >= Library::most_parts) return;
        const std::size_t offset =
            8 * std::size_t{at} +
            (variable.is_byte ? variable.byte : 8 * std::size_t{variable.slot});
        write(*variable.type, offset, path + std::string(variable.text), direction, variable);
    }

    /// VAR_IN_OUT: so that a program that has the block itself is told.
    void write_reference(const Variable& variable) {
        if (!variable.type) return;
        Field reference;
        reference.name = variable.text;
        reference.refers = made_.names.emplace_back("VAR_IN_OUT " + describe(*variable.type));
        reference.doc = made_.names.emplace_back(fmt::format(
            "a variable ({}) of the block that calls this one; declare an instance in a "
            "PROGRAM, call it there, and use that as a block",
            describe(*variable.type)));
        reference.direction = Direction::in_out;
        reference.type = lineshaft::Type::integer;
        reference.offset = 8 * std::size_t{variable.slot};
        reference.required = true;
        kind_.fields.push_back(reference);
    }

    /// Of a data block, whose variables are all its own.
    void write_member(const Variable& member) {
        write(*member.type, 8 * std::size_t{member.slot}, std::string(member.text),
              Direction::local, member);
    }

    static Direction direction_of(const Variable& variable) {
        if (variable.section == Section::input)
            return variable.constant ? Direction::parameter : Direction::input;
        if (variable.section == Section::in_out) return Direction::in_out;
        return variable.section == Section::output ? Direction::output : Direction::local;
    }

  private:
    void write(const Type& type, std::size_t offset, const std::string& name, Direction direction,
               const Variable& variable) {
        if (kind_.fields.size() >= Library::most_parts) return;
        const auto slot = static_cast<std::uint32_t>(offset / 8);
        switch (type.kind) {
            case Kind::array:
                write_elements(type, offset, name + "[", direction, variable);
                return;
            case Kind::structure:
                for (const Variable* member : type.members)
                    write(*member, slot, name + ".", direction);
                return;
            case Kind::standard:
                for (const Variable* member : type.members)
                    write(*member, slot, name + ".", inner(direction));
                return;
            case Kind::block:
                for (const Variable& member : type.routine->variables)
                    if (member.section != Section::temp)
                        write(member, slot, name + ".", inner(direction));
                return;
            case Kind::text:
                if (kind_.texts.size() < Library::most_parts)
                    kind_.texts.push_back(made_.names.emplace_back(name));
                return;
            case Kind::handle:
                write_handle(type, offset, name, direction);
                return;
            default:
                write_scalar(type, offset, name, direction, variable);
        }
    }

    /// One that a block keeps for itself is no field.
    void write_handle(const Type& type, std::size_t offset, const std::string& name,
                      Direction direction) {
        if (direction != Direction::in_out && direction != Direction::input) return;
        Field field;
        field.name = made_.names.emplace_back(name);
        field.refers = type.standard->name;
        field.doc = type.standard->doc;
        field.direction = Direction::in_out;
        field.type = lineshaft::Type::integer;
        field.offset = offset;
        field.required = true;
        kind_.fields.push_back(field);
    }

    /// `before` is `table[`, or of the next dimension `table[2,`.
    void write_elements(const Type& array, std::size_t offset, const std::string& before,
                        Direction direction, const Variable& variable) {
        for (std::int64_t i = array.lower; i <= array.upper;
             ++i, offset += 8 * element_slots(array)) {
            if (kind_.fields.size() >= Library::most_parts) return;
            const std::string name = before + std::to_string(i);
            if (array.has_inner)
                write_elements(*array.element, offset, name + ",", direction, variable);
            else
                write(*array.element, offset, name + "]", direction, variable);
        }
    }

    static std::size_t element_slots(const Type& array) {
        return array.element->kind == Kind::block ? array.element->routine->frame
                                                  : array.element->slots;
    }

    /// Parts of an instance are not wired one by one.
    static Direction inner(Direction direction) {
        return direction == Direction::output ? direction : Direction::local;
    }

    void write_scalar(const Type& type, std::size_t offset, const std::string& name,
                      Direction direction, const Variable& variable) {
        Field field;
        field.name = made_.names.emplace_back(name);
        field.unit = type.is_time() ? std::string_view("ns") : std::string_view(variable.unit);
        if (!variable.doc.empty())
            field.doc = made_.names.emplace_back(text_of_comments(variable.doc));
        field.direction = direction;
        field.offset = offset;
        field.type = type.kind == Kind::boolean       ? lineshaft::Type::boolean
                     : type.is_real()                 ? lineshaft::Type::real
                     : type.kind == Kind::enumeration ? lineshaft::Type::enumeration
                                                      : lineshaft::Type::integer;
        if (type.kind == Kind::enumeration)
            field.names = made_.values.emplace_back(type.values.begin(), type.values.end());
        const bool limited = (type.kind == Kind::integer || type.kind == Kind::bits) &&
                             (type.bits < 64 || type.is_subrange);
        if (limited) {
            field.minimum = static_cast<double>(smallest(type));
            field.maximum = static_cast<double>(largest(type));
        } else if (type.is_real() && type.bits == 32) {
            field.maximum = std::numeric_limits<float>::max();
            field.minimum = -field.maximum;
        } else if ((type.kind == Kind::integer || type.kind == Kind::bits) && smallest(type) == 0) {
            field.minimum = 0;
        }
        const bool wired = direction == Direction::input;
        if (wired && (limited || (type.is_real() && type.bits == 32)))
            kind_.checks.push_back({static_cast<std::uint32_t>(offset / 8), &type});
        kind_.fields.push_back(field);
    }

    Library::Made& made_;
    KindContext& kind_;
};

/// The instances of the catalogue in a value at `slot`.
void find_moments(const Type& type, std::size_t slot, KindContext& kind) {
    switch (type.kind) {
        case Kind::standard:
            if (type.standard->shift) kind.with_moments.push_back({8 * slot, type.standard});
            return;
        case Kind::array: {
            const Type& element = *type.element;
            const bool is_block = element.kind == Kind::block;
            const std::size_t step = is_block ? element.routine->frame : element.slots;
            for (std::int64_t i = type.lower; i <= type.upper && !element.is_scalar(); ++i)
                find_moments(element, slot + step * static_cast<std::size_t>(i - type.lower), kind);
            return;
        }
        case Kind::structure:
            for (const Variable* member : type.members)
                find_moments(*member->type, slot + member->slot, kind);
            return;
        case Kind::block:
            for (const Variable& member : type.routine->variables)
                if (member.space == Space::frame && member.section != Section::temp)
                    find_moments(*member.type, slot + member.slot, kind);
            return;
        default:
            return;
    }
}

KindContext& add_kind(Library::Made& made, std::string name, const Type& type,
                      const Options& options) {
    KindContext& kind = made.kinds.emplace_back();
    kind.code = &made.generated.code;
    kind.options = options;
    kind.name = std::move(name);
    const auto& image = made.generated.images.at(&type);
    kind.image = image.data();
    kind.size = 8 * image.size();
    kind.type = &type;
    find_moments(type, 0, kind);
    return kind;
}

/// The fields from `first` on are of a variable in VAR RETAIN, if it is one. Inputs come anew.
void keep(KindContext& kind, std::size_t first, bool retain) {
    for (; retain && first < kind.fields.size(); ++first)
        if (kind.fields[first].direction >= Direction::output)
            kind.retained.push_back(kind.fields[first].name);
}

/// Of all that `routine` runs, the blocks of the program that are named.
void find_objects(const Routine& routine, std::set<const Routine*>& seen, std::set<int>& objects) {
    if (!seen.insert(&routine).second) return;
    objects.insert(routine.objects.begin(), routine.objects.end());
    for (const Routine* called : routine.calls) find_objects(*called, seen, objects);
}

void add_routine(Library::Made& made, const Routine& routine, const CodeRoutine& code,
                 const Options& options) {
    KindContext& kind = add_kind(made, routine.name, *routine.type, options);
    kind.routine = &code;
    kind.doc = fmt::format("{} of {}",
                           routine.pou->kind == PouKind::program ? "PROGRAM" : "FUNCTION_BLOCK",
                           routine.pou->name.place.source->file->path);
    if (!routine.pou->doc.empty()) kind.doc += ": " + text_of_comments(routine.pou->doc);
    FieldWriter fields(made, kind);
    std::set<const Routine*> seen;
    std::set<int> objects;
    find_objects(routine, seen, objects);
    fields.write_header(routine, objects);
    for (const Variable& variable : routine.variables) {
        const std::size_t before = kind.fields.size();
        fields.write(variable, 0, {}, FieldWriter::direction_of(variable));
        keep(kind, before, variable.retain);
        if (variable.space != Space::reference) continue;
        kind.references.push_back(variable.slot);
        fields.write_reference(variable);
    }
}

void add_global(Library::Made& made, const Global& global, const Options& options) {
    KindContext& kind = add_kind(made, global.name, *global.type, options);
    kind.doc = global.pou ? "DATA_BLOCK" : "VAR_GLOBAL";
    FieldWriter fields(made, kind);
    if (global.type->kind == Kind::block) {
        for (const Variable& variable : global.type->routine->variables)
            if (variable.section != Section::temp) fields.write(variable, 0, {}, Direction::local);
    }
    for (const Variable* member : global.type->members) {
        const std::size_t before = kind.fields.size();
        fields.write_member(*member);
        keep(kind, before, member->retain);
    }
}

BlockType block_type(const KindContext& kind, const std::shared_ptr<const Library::Made>& made) {
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

}  // namespace

std::optional<Library> compile(const std::vector<std::shared_ptr<const SourceFile>>& sources,
                               const Catalog& standard, Diagnostics& out, const Options& options) {
    const auto made = std::make_shared<Library::Made>();
    made->sources = sources;
    const CodeOptions code_options{.overflow_faults = options.overflow_faults,
                                   .counted = options.times.has_value()};
    if (!compile(*made, standard, out, code_options)) return {};
    std::unordered_map<const Routine*, const CodeRoutine*> codes;
    const CodeRoutine* code = made->generated.code.routines.data();
    for (const Routine* routine : made->checked.order) codes.emplace(routine, code++);
    for (const Routine& routine : made->checked.routines)
        if (routine.has_instances() && !routine.owner && !routine.pou->place.source->is_prelude())
            add_routine(*made, routine, *codes.at(&routine), options);
    for (const Global& global : made->checked.globals)
        if (!global.object) add_global(*made, global, options);
    Library library;
    library.made_ = made;
    for (const KindContext& kind : made->kinds) library.kinds_.push_back(block_type(kind, made));
    return library;
}

FaultPlace Library::fault(const BlockType& kind, const std::byte* instance) const {
    if (!static_cast<const KindContext*>(kind.context)->routine) return {};
    return fault_of(made_->generated.code, instance);
}

std::span<const std::uint64_t, op_classes> Library::counts(const std::byte* instance) const {
    return std::span<const std::uint64_t, op_classes>(
        std::launder(reinterpret_cast<const std::uint64_t*>(instance)) + counts_slot, op_classes);
}

std::string_view find_text(const BlockType& kind, std::string_view name) {
    if (kind.scan_blocks != scan_blocks) return {};
    const auto& texts = static_cast<const KindContext*>(kind.context)->texts;
    const auto it = std::ranges::find_if(
        texts, [&](std::string_view text) { return same_letters(text, name); });
    return it == texts.end() ? std::string_view() : *it;
}

std::span<const std::string_view> retained(const BlockType& kind) {
    if (kind.scan_blocks != scan_blocks) return {};
    return static_cast<const KindContext*>(kind.context)->retained;
}

std::optional<Mark> cut_text(const BlockType& kind, const std::byte* instance) {
    if (kind.scan_blocks != scan_blocks || kind.single) return {};
    return cut_of(*static_cast<const KindContext*>(kind.context)->code, instance);
}

std::string Library::listing() const {
    return st::listing(made_->generated.code);
}

}  // namespace lineshaft::st
