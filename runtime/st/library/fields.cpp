#include "runtime/st/library/fields.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "runtime/st/library/shortened.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/types/parameters.hpp"

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;

/// Writes down the fields of one kind.
class FieldWriter {
  public:
    FieldWriter(Library::Made& made, KindContext& kind) : made_(made), kind_(kind) {}

    /// `objects` are the blocks of the program that it names.
    void write_header(const Routine& routine, const std::set<int>& objects) {
        const bool own = routine.names.contains("error") || routine.names.contains("error_id");
        add(own ? "fault" : "error", Direction::output, lineshaft::Type::boolean, 8 * error_slot)
            .doc = "the last scan ended with a fault";
        Field& id = add(own ? "fault_id" : "error_id", Direction::output,
                        lineshaft::Type::enumeration, 8 * error_id_slot);
        id.doc = "the fault of the last scan";
        id.names = std::span<const std::string_view>(fault_names);
        for (std::uint32_t i = 0; i < made_.checked.globals.size(); ++i) {
            const Global& global = made_.checked.globals[i];
            if (global.object && !objects.contains(static_cast<int>(i))) continue;
            Field& reference = add(fmt::format("\"{}\"", global.name), Direction::in_out,
                                   lineshaft::Type::integer, 8 * std::size_t{globals_slot + i});
            reference.global = global.name;
            reference.refers = global.object ? global.type->standard->name : global.name;
            reference.doc = "the program's, by its name";
        }
    }

    void write(const Variable& variable, std::uint32_t at, const std::string& path,
               Direction direction) {
        const bool has_no_name =
            variable.section == Section::temp && variable.text.starts_with('%');
        if (variable.space != Space::frame || has_no_name) return;
        const std::size_t offset =
            8 * std::size_t{at} +
            (variable.is_byte ? variable.byte : 8 * std::size_t{variable.slot});
        const bool was_own = std::exchange(is_own_, is_own_ && variable.section != Section::temp);
        const std::string name = path + std::string(variable.text);
        if (place_ != Place::element) begin_ = name;
        write(*variable.type, offset, name, direction, variable);
        is_own_ = was_own;
    }

    /// VAR_IN_OUT: so that a program that has the block itself is told.
    void write_reference(const Variable& variable) {
        if (!variable.type) return;
        Field& reference = add(std::string(variable.text), Direction::in_out,
                               lineshaft::Type::integer, 8 * std::size_t{variable.slot});
        reference.refers = made_.names.emplace_back("VAR_IN_OUT " + describe(*variable.type));
        reference.doc = made_.names.emplace_back(fmt::format(
            "a variable ({}) of the block that calls this one; declare an instance in a "
            "PROGRAM, call it there, and use that as a block",
            describe(*variable.type)));
        reference.required = true;
    }

    /// It is one of a data block, whose variables are all its own. What a library keeps many of
    /// is nobody else's.
    void write_member(const Variable& member) {
        const bool are_librarys =
            member.name.place.source && member.name.place.source->is_library() &&
            member.type->kind == Kind::array && member.type->element->kind == Kind::structure;
        if (are_librarys && !has_handle(*member.type)) return;
        begin_ = member.text;
        write(*member.type, 8 * std::size_t{member.slot}, std::string(member.text),
              pin_of(member, Direction::local), member);
    }

    /// `AT %I*` and `AT %Q*` are wired from outside wherever they stand.
    static Direction pin_of(const Variable& variable, Direction other) {
        return variable.pin == Section::input    ? Direction::input
               : variable.pin == Section::output ? Direction::output
                                                 : other;
    }

    static Direction direction_of(const Variable& variable) {
        if (variable.pin == Section::input) return Direction::input;
        if (variable.pin == Section::output) return Direction::output;
        if (variable.section == Section::input)
            return variable.constant ? Direction::parameter : Direction::input;
        if (is_kept_in_out(variable)) return Direction::input;
        if (variable.section == Section::in_out) return Direction::in_out;
        return variable.section == Section::output ? Direction::output : Direction::local;
    }

  private:
    /// What is written: a variable of the kind, a part of one, or what stands in an array.
    enum class Place { own, part, element };

    /// How many there are in those places.
    struct Count {
        std::size_t parts = 0, elements = 0;

        void add(Place place) {
            parts += place == Place::part;
            elements += place == Place::element;
        }
    };

    Field& add(std::string name, Direction direction, lineshaft::Type type, std::size_t offset) {
        fields_.add(place_);
        Field& field = kind_.fields.emplace_back();
        field.name = made_.names.emplace_back(std::move(name));
        field.direction = direction;
        field.type = type;
        field.offset = offset;
        return field;
    }

    void write(const Type& type, std::size_t offset, const std::string& name, Direction direction,
               const Variable& variable) {
        if (is_left_out(type)) return note_cut();
        const auto slot = static_cast<std::uint32_t>(offset / 8);
        const Place before = std::exchange(place_, place_of_parts(type));
        switch (type.kind) {
            case Kind::array:
                write_elements(type, offset, name + "[", direction, variable);
                break;
            case Kind::structure:
                for (const Variable* member : type.members)
                    write(*member, slot, name + ".", pin_of(*member, direction));
                break;
            case Kind::standard:
                for (const Variable* member : type.members)
                    write_part(*member, slot, name + ".", direction, false);
                break;
            case Kind::block:
                for (const Variable* member : all_variables(*type.routine))
                    if (member->section != Section::temp)
                        write_part(*member, slot, name + "." + of_base(*type.routine, *member),
                                   direction, is_own(member->section));
                break;
            case Kind::interface:
            case Kind::reference:
            case Kind::union_:
                break;
            case Kind::text:
                texts_.add(place_);
                kind_.texts.push_back({made_.names.emplace_back(name), offset});
                break;
            case Kind::handle:
                write_handle(type, offset, name, direction, variable);
                break;
            default:
                write_scalar(type, offset, name, direction, variable);
        }
        place_ = before;
    }

    Place place_of_parts(const Type& type) const {
        if (type.kind == Kind::array) return Place::element;
        const bool has_parts =
            type.kind == Kind::structure || type.kind == Kind::block || type.kind == Kind::standard;
        return has_parts ? std::max(place_, Place::part) : place_;
    }

    static bool is_own(Section section) {
        return section == Section::local || section == Section::output;
    }

    /// Parts of an instance are not wired one by one, but for `AT %I*` and `AT %Q*`. `is_local`: it
    /// is the instance's own.
    void write_part(const Variable& member, std::uint32_t slot, const std::string& path,
                    Direction direction, bool is_local) {
        const bool was_own = std::exchange(is_own_, is_own_ && is_local);
        const bool is_output = direction == Direction::output;
        write(member, slot, path, pin_of(member, is_output ? direction : Direction::local));
        is_own_ = was_own;
    }

    /// Behind `most_elements` only those elements that are given a block of the program are fields,
    /// as many again.
    bool is_left_out(const Type& type) const {
        const Count& count = type.kind == Kind::text ? texts_ : fields_;
        if (place_ == Place::own) return false;
        if (place_ == Place::part) return count.parts >= most_parts;
        return count.elements >= most_elements &&
               (count.elements >= 2 * most_elements || !has_handle(type));
    }

    void note_cut() {
        if (kind_.shortened.empty() || kind_.shortened.back() != begin_)
            kind_.shortened.push_back(made_.names.emplace_back(begin_));
    }

    /// `VAR axis : AXIS_REF` may be given one of the program's, as TwinCAT links it to one of its
    /// numerical control. What a caller gives to a part is no field.
    void write_handle(const Type& type, std::size_t offset, const std::string& name,
                      Direction direction, const Variable& variable) {
        const bool is_given = direction == Direction::in_out || direction == Direction::input;
        if (!is_given && !is_own_) return;
        Field& field = add(name, Direction::in_out, lineshaft::Type::integer, offset);
        field.refers = type.standard->name;
        if (variable.named >= 0)
            field.global = made_.checked.globals[static_cast<std::size_t>(variable.named)].name;
        field.doc = type.standard->doc;
        field.required = is_given;
    }

    /// `before` is `table[`, or of the next dimension `table[2,`.
    void write_elements(const Type& array, std::size_t offset, const std::string& before,
                        Direction direction, const Variable& variable) {
        for (std::int64_t i = array.lower; i <= array.upper;
             ++i, offset += 8 * element_slots(array)) {
            if (is_left_out(*array.element)) return note_cut();
            const std::string name = before + std::to_string(i);
            if (array.has_inner)
                write_elements(*array.element, offset, name + ",", direction, variable);
            else
                write(*array.element, offset, name + "]", direction, variable);
        }
    }

    void write_scalar(const Type& type, std::size_t offset, const std::string& name,
                      Direction direction, const Variable& variable) {
        const auto value = type.kind == Kind::boolean       ? lineshaft::Type::boolean
                           : type.is_real()                 ? lineshaft::Type::real
                           : type.kind == Kind::enumeration ? lineshaft::Type::enumeration
                           : type.is_unsigned_64()          ? lineshaft::Type::unsigned_integer
                                                            : lineshaft::Type::integer;
        Field& field = add(name, direction, value, offset);
        field.takes_not_finite = type.is_real();
        field.unit = type.is_time() ? std::string_view("ns") : std::string_view(variable.unit);
        if (!variable.doc.empty())
            field.doc = made_.names.emplace_back(text_of_comments(variable.doc));
        if (type.kind == Kind::enumeration) field.names = names_of(type);
        const Type& range = type.in_a_run();
        const bool limited = (type.kind == Kind::integer || type.kind == Kind::bits) &&
                             (type.bits < 64 || range.is_subrange);
        if (limited) {
            field.minimum = static_cast<double>(smallest(range));
            field.maximum = static_cast<double>(largest(range));
        } else if (type.is_real() && type.bits == 32) {
            field.maximum = std::numeric_limits<float>::max();
            field.minimum = -field.maximum;
        } else if ((type.kind == Kind::integer || type.kind == Kind::bits) &&
                   smallest(range) == 0) {
            field.minimum = 0;
        }
        const bool wired = direction == Direction::input;
        if (wired && (limited || (type.is_real() && type.bits == 32)))
            kind_.checks.push_back({static_cast<std::uint32_t>(offset / 8), &type});
    }

    /// A catalogue's are names alone.
    ValueNames names_of(const Type& type) const {
        const auto& names = made_.values.emplace_back(type.values.begin(), type.values.end());
        if (!type.has_numbers) return std::span(names);
        using Limits = std::numeric_limits<std::int64_t>;
        const Type& base = type.base->plain();
        const bool has_sign = largest(base) <= Limits::max();
        ValueNames made(type.name, names, type.numbers);
        if (!has_sign) made = made.without_sign();
        if (!type.is_unchecked) return made;
        return made.with_others(
            has_sign ? static_cast<std::int64_t>(smallest(base)) : Limits::min(),
            has_sign ? static_cast<std::int64_t>(largest(base)) : Limits::max());
    }

    Library::Made& made_;
    KindContext& kind_;
    bool is_own_ = true;  ///< what is written is the kind's own, and given by nobody
    Place place_ = Place::own;
    std::string begin_;  ///< the path of the variable that is written, or of the array that has it
    Count fields_, texts_;
};

/// Adds the blocks of the program that are named in all that `routine` runs.
void find_objects(const Routine& routine, std::set<const Routine*>& seen, std::set<int>& objects) {
    if (!seen.insert(&routine).second) return;
    objects.insert(routine.objects.begin(), routine.objects.end());
    for (const Called& called : routine.calls) find_objects(*called.routine, seen, objects);
}

}  // namespace

std::string of_base(const Routine& block, const Variable& variable) {
    const auto it = block.names.find(variable.text);
    const bool is_hidden = it != block.names.end() && it->second != &variable && variable.of;
    return is_hidden ? fmt::format("{}.", variable.of->name.text) : std::string();
}

/// `@PATH := '\/Axes'`, which CoDeSys 2.3 writes before a block for itself.
static bool is_property_of_export(std::string_view line) {
    return line.starts_with('@') && line.find(":=") != line.npos;
}

std::string text_of_comments(std::string_view written) {
    constexpr std::string_view marks = "(*/) \t\r\n", blanks = " \t\r";
    std::string text;
    for (std::size_t begin = 0; begin < written.size();) {
        const std::size_t end = std::min(written.find('\n', begin), written.size());
        std::string_view line = written.substr(begin, end - begin);
        begin = end + 1;
        line.remove_prefix(std::min(line.find_first_not_of(marks), line.size()));
        if (is_property_of_export(line)) continue;
        line = line.substr(0, line.find_last_not_of(blanks) + 1);
        const bool is_closed =
            line.ends_with("*)") || line.ends_with("*/") || line.ends_with("*/)");
        const std::size_t last = line.find_last_not_of(is_closed ? marks : blanks);
        line = line.substr(0, last == std::string_view::npos ? 0 : last + 1);
        if (!text.empty() && !line.empty()) text += ' ';
        text += line;
    }
    return text;
}

void write_fields(Library::Made& made, KindContext& kind, const Routine& routine) {
    FieldWriter fields(made, kind);
    std::set<const Routine*> seen;
    std::set<int> objects;
    find_objects(routine, seen, objects);
    fields.write_header(routine, objects);
    for (const Variable* declared : all_variables(routine)) {
        const Variable& variable = *declared;
        fields.write(variable, 0, of_base(routine, variable), FieldWriter::direction_of(variable));
        if (variable.space != Space::reference) continue;
        kind.references.push_back(variable.slot);
        fields.write_reference(variable);
    }
}

void write_test_fields(Library::Made& made, KindContext& kind, const Routine& fixture) {
    std::set<int> objects;
    for (std::size_t i = 0; i < made.checked.globals.size(); ++i)
        objects.insert(static_cast<int>(i));
    FieldWriter(made, kind).write_header(fixture, objects);
}

void add_data_blocks(Library::Made& made, const Options& options) {
    for (const Global& global : made.checked.globals) {
        const auto is_its = [&](const KindContext& kind) { return kind.type == global.type; };
        const bool is_there = is_program(global) && std::ranges::any_of(made.kinds, is_its);
        if (global.object || is_there || global.name == image_name) continue;
        KindContext& kind = add_kind(made, global.name, *global.type, options);
        if (global.pou) kind.retention = global.pou->retention;
        kind.doc = global.pou ? "DATA_BLOCK" : global.is_statics ? "VAR_STAT" : "VAR_GLOBAL";
        write_fields(made, kind, global);
    }
}

std::vector<KeptReference> kept_references(Library::Made& made, const Routine& program,
                                           const Catalog& standard) {
    std::vector<KeptReference> kept;
    const auto note = [&](const KindContext& kind, int global) {
        for (const Field& field : kind.fields)
            if (!field.refers.empty() && field.global.empty() && !field.required)
                kept.push_back({global, field.offset, standard.find(field.refers)});
    };
    KindContext& own = add_kind(made, program.name, *program.type, {});
    write_fields(made, own, program);
    note(own, -1);
    for (std::size_t i = 0; i < made.checked.globals.size(); ++i) {
        const Global& global = made.checked.globals[i];
        const bool is_own = is_program(global) && global.type == program.type;
        if (global.object || is_own || global.name == image_name) continue;
        KindContext& kind = add_kind(made, global.name, *global.type, {});
        write_fields(made, kind, global);
        note(kind, static_cast<int>(i));
    }
    return kept;
}

void write_fields(Library::Made& made, KindContext& kind, const Global& global) {
    FieldWriter fields(made, kind);
    if (global.type->kind == Type::Kind::block) {
        for (const Variable* variable : all_variables(*global.type->routine))
            if (variable->section != Section::temp)
                fields.write(*variable, 0, {}, Direction::local);
    }
    for (const Variable* member : global.type->members)
        if (member != made.checked.numbers && !member->text.empty()) fields.write_member(*member);
}

}  // namespace lineshaft::st
