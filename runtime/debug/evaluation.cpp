#include "runtime/debug/evaluation.hpp"

#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "runtime/debug/packed_values.hpp"
#include "runtime/debug/properties.hpp"
#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/code/meaning.hpp"
#include "runtime/st/library/compiled.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/st/types/value_text.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::debug {

struct Expression::Parsed {
    st::Tree tree;
    const st::Expression* root = nullptr;
};

namespace {

using E = st::Expression::Kind;
using st::Wide;
using st::Word;

struct Failed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What an expression means: a value of a type, with its place in memory if it has one; or a name
/// that no variable has.
struct Operand {
    std::string name = {};
    Seat seat = {};
    st::Constant value = {};
    std::string unit = {};

    bool is_value() const { return name.empty() && is_value_type(*seat.type); }
    static bool is_value_type(const st::Type& type) {
        return type.is_scalar() || type.kind == st::Type::Kind::text;
    }
};

Operand load(const Seat& seat, const std::string& unit) {
    Operand found{.seat = seat, .unit = unit};
    const st::Type& type = *seat.type;
    if (type.kind == st::Type::Kind::text)
        found.value.text.assign(reinterpret_cast<const char*>(seat.at + 8),
                                static_cast<std::size_t>(read<std::uint64_t>(seat.at)));
    else if (type.is_real())
        found.value.real = read<double>(seat.at);
    else if (type.is_scalar())
        found.value.integer = whole_in(type, read<std::uint64_t>(seat.at));
    return found;
}

/// Variables are found in memory; what is made of their values is what the checker makes of
/// constants, with the machine that scans.
class Reckoning {
  public:
    Reckoning(st::Tree& tree, const Frame& frame)
        : frame_(frame), checked_(frame.made->checked), c_{tree, nothing_, st::evaluate, wrong_} {
        for (const st::Type& type : checked_.types) {
            if (!type.has_values() || type.name.empty()) continue;
            c_.users.types.emplace(type.name, st::NamedType{&declared_, &type});
            for (std::size_t i = 0; i < type.values.size(); ++i) {
                const auto [it, is_new] =
                    c_.users.values.emplace(type.values[i], st::NamedValue{&type, i});
                it->second.ambiguous = !is_new;
            }
        }
    }

    Operand value(const st::Expression& e) {
        if (is_place(e))
            if (Operand found = place(e); found.name.empty()) return found;
        st::Expression* made = reckoned(e, nullptr);
        return {.seat = {made->type, nullptr, &frame_}, .value = made->constant};
    }

    /// What an assignment to a variable of that type gives it.
    st::Constant value_for(const st::Expression& e, const st::Type& type) {
        st::Expression* made = with_values(e);
        if (!st::check(c_, made, &type) || !st::coerce(c_, made, type) || !st::evaluate(c_, made))
            throw Failed(wrong_.empty() ? unknown(e) : wrong_.list().front().message);
        return made->constant;
    }

  private:
    static bool is_place(const st::Expression& e) {
        return e.kind == E::name || e.kind == E::member || e.kind == E::index ||
               e.kind == E::deref || e.kind == E::bit;
    }

    /// The value as a constant; `expected` tells which enumeration a name is of.
    st::Expression* reckoned(const st::Expression& e, const st::Type* expected) {
        st::Expression* made = with_values(e);
        if (!st::check(c_, made, expected) || !st::evaluate(c_, made))
            throw Failed(wrong_.empty() || is_place(e) ? unknown(e)
                                                       : wrong_.list().front().message);
        return made;
    }

    /// The expression with constants in place of variables.
    st::Expression* with_values(const st::Expression& e) {
        if (is_place(e)) {
            const Operand found = place(e);
            if (!found.name.empty()) return st::make_copy(c_, e);
            if (!found.is_value()) throw Failed(fmt::format("'{}' is no value", e.place.text()));
            return st::make_constant(c_, e, *found.seat.type, found.value);
        }
        st::Expression* made = st::make_copy(c_, e);
        if (e.kind == E::typed) return made;
        if (e.kind == E::call) {
            const std::string_view name = e.operands[0]->token.text;
            const auto is_called = [&](const st::Routine& r) {
                return st::same_name(r.name, name);
            };
            if (e.operands[0]->kind != E::name || std::ranges::any_of(checked_.routines, is_called))
                throw Failed(fmt::format("'{}' is not for a debugger, which changes nothing",
                                         e.place.text()));
            if (const auto size = size_of(e)) return size;
            for (st::Argument& argument : made->arguments)
                argument.value = with_values(*argument.value);
            return made;
        }
        const bool ends_early = e.op == Word::and_then_ || e.op == Word::or_else_;
        if (e.kind == E::binary && ends_early) {
            made->operands[0] = reckoned(*e.operands[0], &st::bool_type);
            if ((made->operands[0]->constant.integer != 0) == (e.op == Word::or_else_))
                return made->operands[0];
        } else if (e.operands[0]) {
            made->operands[0] = with_values(*e.operands[0]);
        }
        if (e.operands[1]) made->operands[1] = with_values(*e.operands[1]);
        return made;
    }

    /// `SIZEOF(x)` of a variable; null: it is something else.
    st::Expression* size_of(const st::Expression& call) {
        const bool is_size = st::same_name(call.operands[0]->token.text, "sizeof") &&
                             call.arguments.size() == 1 && is_place(*call.arguments[0].value);
        const Operand of = is_size ? place(*call.arguments[0].value) : Operand{.name = "-"};
        if (!of.name.empty()) return nullptr;
        const Wide bytes = st::bytes_of(*of.seat.type);
        return st::make_constant(c_, call, st::any_integer_type, {.integer = bytes});
    }

    Operand place(const st::Expression& e) {
        switch (e.kind) {
            case E::name:
                return named(e);
            case E::member:
                return member(e);
            case E::index:
                return element(e);
            case E::deref:
                return followed(e, place(*e.operands[0]));
            case E::bit:
                return bit(e);
            default:
                throw Failed(unknown(e));
        }
    }

    /// In the routine, or in the block that it is a method of; beside all.
    Operand named(const st::Expression& e) const {
        const std::string_view name = e.token.text;
        const st::Routine* block = nullptr;
        for (const st::Routine* routine = frame_.routine; routine; routine = routine->owner) {
            block = routine;
            const st::Variable* found = st::find_in(routine->names, name);
            if (!found && st::find_in(routine->getters, name))
                return property({routine->type, frame_.base, &frame_}, e);
            if (!found) continue;
            if (found->space == st::Space::constant)
                return {.seat = {found->type, nullptr, &frame_},
                        .value = found->value,
                        .unit = found->unit};
            return at(seat_of(*found, frame_.base, frame_), e, found->unit);
        }
        if (name.starts_with('%')) return addressed(e);
        if (st::same_name(name, "this") && block && block->type)
            return load({block->type, frame_.base, &frame_}, "");
        if (is_super(e) && block && block->base)
            return load({block->base->type, frame_.base, &frame_}, "");
        if (const st::Variable* global = global_of("", name))
            return at(seat_of(*global, frame_.base, frame_), e, global->unit);
        for (std::size_t i = 0; i < checked_.globals.size(); ++i)
            if (const st::Global& data = checked_.globals[i];
                data.pou && st::same_name(data.name, name))
                return load({data.type, global_at(static_cast<int>(i), frame_), &frame_}, "");
        return {.name = std::string(name)};
    }

    /// `SUPER` or `SUPER^`
    static bool is_super(const st::Expression& e) {
        return e.kind == E::deref ? is_super(*e.operands[0])
                                  : e.kind == E::name && st::same_name(e.token.text, "super");
    }

    /// What GET gives; the instance says which one, but not behind SUPER.
    Operand property(const Seat& of, const st::Expression& e) const {
        const bool is_of_base = e.kind == E::member && is_super(*e.operands[0]);
        const Seat there = is_of_base ? of : instance_at(of);
        if (!there.at) throw Failed(fmt::format("'{}' is to nothing", e.operands[0]->place.text()));
        const st::Routine* getter = st::find_in(there.type->routine->getters, e.token.text);
        if (!getter) throw Failed(unknown(e));
        const Got got = get(there, *getter);
        if (!got.error.empty()) throw Failed(got.error);
        return at(got.seat, e, getter->result->unit);
    }

    /// `%MW10`, as the scan has it now.
    Operand addressed(const st::Expression& e) const {
        const auto address = read_address(e.token.text, checked_.image.count);
        if (!address) throw Failed(unknown(e));
        const st::Type& type = address->bits == 1 ? st::bool_type : st::bits_type(address->bits);
        return at(seat_in_image(*address, type, frame_), e, "");
    }

    /// Names and numbers are those of the enumeration.
    static bool is_called(const st::Type& type, const ValueNames& names) {
        if (!std::ranges::equal(type.values, names)) return false;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (type.numbers[i] != names.number(i)) return false;
        return true;
    }

    /// A signal of another block of the program.
    std::optional<Operand> signal(std::string_view name) const {
        const Signal* signal = frame_.machine->find(name);
        if (!signal) return {};
        return operand(signal->value(), *signal, is_single(signal->port));
    }

    /// The value of a signal, or of a block's field.
    template <class Named>
    Operand operand(const Value& value, const Named& named, bool is_narrow) const {
        using Is = lineshaft::Type;
        Operand found{.unit = std::string(named.unit)};
        const st::Type* type = named.is_time() ? &st::time_type : &st::lint_type;
        if (named.type == Is::real) {
            type = is_narrow ? &st::real_type : &st::lreal_type;
            found.value.real = std::get<double>(value);
        } else if (named.type == Is::boolean) {
            type = &st::bool_type;
            found.value.integer = std::get<bool>(value);
        } else {
            if (named.type == Is::unsigned_integer) type = &st::ulint_type;
            found.value.integer = *whole(value);
        }
        if (named.type == Is::enumeration)
            for (const st::Type& each : checked_.types)
                if (is_called(each, named.names)) type = &each;
        found.seat = {type, nullptr, &frame_};
        return found;
    }

    /// `axis.position` of an AXIS_REF.
    Operand field(const Operand& handle, const st::Expression& e) const {
        const Referred to = block_of(handle.seat.at, *handle.seat.frame);
        if (!to.at) throw Failed(fmt::format("'{}' is to nothing", e.operands[0]->place.text()));
        const auto& fields = to.block->type->fields;
        const Field* found = st::find_called(fields, e.token.text, &Field::name);
        if (!found)
            found = st::find_called(fields, st::standard_part_name(e.token.text), &Field::name);
        if (!found) throw Failed(unknown(e));
        return operand(lineshaft::load(found->type, to.at + found->offset), *found, false);
    }

    bool is_single(Port port) const {
        return port.instance >= 0 && frame_.machine->blocks[static_cast<std::size_t>(port.instance)]
                                             .type->fields[static_cast<std::size_t>(port.field)]
                                             .maximum == double{std::numeric_limits<float>::max()};
    }

    /// A variable of VAR_GLOBAL: `x`, and with the name of its list, whether programs have to
    /// write that or not.
    const st::Variable* global_of(std::string_view list, std::string_view name) const {
        const std::string full =
            list.empty() ? std::string(name) : fmt::format("{}.{}", list, name);
        for (const st::Global& global : checked_.globals)
            for (const st::Variable* variable : global.type->members) {
                const st::Source* source = variable->name.place.source;
                if (variable->space != st::Space::global || !source) continue;
                const bool is_of_list = st::same_name(variable->text, name) &&
                                        st::same_name(st::name_of_list(*source), list);
                if (st::same_name(variable->text, full) || is_of_list) return variable;
            }
        for (const st::Variable* variable : checked_.image.variables)
            if (variable->section == st::Section::global && st::same_name(variable->text, full))
                return variable;
        return nullptr;
    }

    /// What is there; of a REFERENCE TO what it is to.
    Operand at(const Seat& seat, const st::Expression& e, const std::string& unit) const {
        if (!seat.at) throw Failed(fmt::format("'{}' is not in the memory now", e.place.text()));
        const Operand found = load(seat, unit);
        return seat.type->is_alias() ? followed(e, found) : found;
    }

    Operand followed(const st::Expression& e, const Operand& reference) const {
        const st::Type* type = reference.seat.type;
        const bool is_array = reference.seat.made && type->kind == st::Type::Kind::array;
        if (is_array || (type && type->kind == st::Type::Kind::block)) return reference;  // THIS^
        if (!type || !type->is_reference())
            throw Failed(fmt::format("'{}' is no pointer", e.operands[0]->place.text()));
        return pointed_to(e, reference, 0);
    }

    /// What is so many bytes behind what it is to.
    static Operand pointed_to(const st::Expression& e, const Operand& reference, Wide bytes) {
        const Seat target = target_of(reference.seat, static_cast<std::int64_t>(bytes));
        if (!target.at) throw Failed(fmt::format("'{}' is to nothing", e.place.text()));
        return load(target, "");
    }

    /// `s[3]`, by the language of the source.
    Operand character(const st::Expression& e, const Operand& text, Wide index) const {
        const st::Type& type = *text.seat.type;
        const st::Dialect& dialect = e.place.dialect();
        const auto place = static_cast<std::int64_t>(index);
        st::TextRoom room = type.room();
        if (type.is_open) room = {static_cast<std::uint32_t>(text.value.text.size()), false};
        if (dialect.characters_may_be_missing) room = room.that_may_miss();
        const auto found = dialect.texts_are_bytes
                               ? st::meaning::byte_of_text(text.seat.at, place, room)
                               : st::meaning::character_of(text.seat.at, place, room);
        if (!found) throw Failed(fmt::format("'{}' has no such character", e.place.text()));
        const st::Type& of = dialect.texts_are_bytes ? st::bits_type(type.is_wide ? 16 : 8)
                             : type.is_wide          ? st::wide_char_type
                                                     : st::char_type;
        return {.seat = {&of, nullptr, &frame_}, .value = {.integer = Wide{*found}}};
    }

    Operand bit(const st::Expression& e) {
        const Operand whole = place(*e.operands[0]);
        std::string_view written = e.token.text;
        written.remove_prefix(std::min(written.find_first_of("0123456789"), written.size()));
        const auto number = st::read_integer(written);
        if (!whole.is_value() || !number || *number > 63) throw Failed(unknown(e));
        return {.seat = {&st::bool_type, nullptr, &frame_},
                .value = {.integer = whole.value.integer >> static_cast<int>(*number) & 1}};
    }

    /// The name of a list of globals is none that a variable has, and so is that of a type, which a
    /// variable may be called, too.
    Operand member(const st::Expression& e) {
        const Operand whole = place(*e.operands[0]);
        if (!whole.name.empty()) {
            if (const st::Variable* global = global_of(whole.name, e.token.text))
                return at(seat_of(*global, frame_.base, frame_), e, global->unit);
            const std::string full = fmt::format("{}.{}", whole.name, e.token.text);
            return signal(full).value_or(Operand{.name = full});
        }
        const st::Type& type = *whole.seat.type;
        if (type.kind == st::Type::Kind::handle) return field(whole, e);
        if (type.kind == st::Type::Kind::interface) return property(whole.seat, e);
        if (whole.is_value()) return {.name = std::string(e.place.text())};
        const st::Variable* part = st::find_member(type, e.token.text);
        if (!part && type.kind == st::Type::Kind::block) return property(whole.seat, e);
        if (!part) throw Failed(unknown(e));
        if (part->is_byte)
            return {.seat = {part->type, nullptr, &frame_},
                    .value = {.integer = read<std::uint8_t>(whole.seat.at + part->byte)}};
        return at(member_at(whole.seat, *part), e, part->unit);
    }

    Operand element(const st::Expression& e) {
        Operand whole = place(*e.operands[0]);
        if (!whole.name.empty())
            if (auto found = signal(e.place.text())) return *found;
        for (const st::Argument& argument : e.arguments) {
            if (!whole.name.empty()) throw Failed(unknown(e));
            const st::Type& array = *whole.seat.type;
            const Wide index = reckoned(*argument.value, &st::dint_type)->constant.integer;
            if (array.is_pointer() && array.element) {
                whole = pointed_to(e, whole, index * Wide{st::bytes_of(*array.element)});
                continue;
            }
            if (array.kind == st::Type::Kind::text && whole.seat.at) {
                whole = character(e, whole, index);
                continue;
            }
            if (array.kind != st::Type::Kind::array) throw Failed(unknown(e));
            if (index < array.lower || index > array.upper)
                throw Failed(fmt::format("'{}' is not an index from {} to {}",
                                         argument.value->place.text(), array.lower, array.upper));
            const auto at = static_cast<std::size_t>(index - array.lower);
            whole =
                load(whole.seat.part(array.element, 8 * at * st::element_slots(array)), whole.unit);
        }
        return whole;
    }

    static std::string unknown(const st::Expression& e) {
        return fmt::format("'{}' is not known here", e.place.text());
    }

    const Frame& frame_;
    const st::Checked& checked_;
    Catalog nothing_;
    st::TypeDeclaration declared_;
    Diagnostics wrong_;
    st::Checking c_;
};

std::uint64_t bits_of(const st::Type& type, const st::Constant& value) {
    return type.is_real() ? std::bit_cast<std::uint64_t>(value.real)
                          : static_cast<std::uint64_t>(value.integer);
}

Shown show_operand(const std::string& text, const Operand& found) {
    const st::Type& type = *found.seat.type;
    if (found.seat.at) return show(text, found.seat, found.unit);
    if (type.kind == st::Type::Kind::text)
        return {.name = text, .value = text_shown(type, found.value.text), .type = type.name};
    const std::uint64_t bits = bits_of(type, found.value);
    return {.name = text, .value = st::value_text(type, bits), .type = type.name};
}

}  // namespace

Expression::Expression(std::string text, const SourceFile& like)
    : text_(std::move(text)), parsed_(std::make_unique<Parsed>()) {
    Diagnostics wrong;
    const auto file = std::make_shared<SourceFile>(SourceFile{
        .path = like.path,
        .text = fmt::format("FUNCTION watch : BOOL\nwatch := {}\n;\nEND_FUNCTION\n", text_),
        .read_as = like.read_as});
    st::parse(st::read_tokens(file, wrong), parsed_->tree, wrong);
    const auto& units = parsed_->tree.units;
    if (!wrong.empty())
        error_ = wrong.list().front().message;
    else if (units.size() != 1 || units[0]->body.size() != 1)
        error_ = "it is not one expression";
    else
        parsed_->root = units[0]->body[0]->value;
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

Evaluated Expression::value(const Frame& frame) const {
    if (!error_.empty()) return {error_};
    try {
        st::Tree tree;
        const Operand found = Reckoning(tree, frame).value(*parsed_->root);
        Evaluated evaluated{.shown = show_operand(text_, found)};
        evaluated.shown.expression = text_;
        if (found.seat.type->kind == st::Type::Kind::boolean)
            evaluated.truth = found.value.integer != 0;
        return evaluated;
    } catch (const Failed& why) {
        return {why.what()};
    }
}

std::vector<std::byte> Expression::value_for(const st::Type& type, const Frame& frame,
                                             std::string& error) const {
    error = error_;
    if (!error.empty()) return {};
    std::vector<std::byte> bytes(8);
    try {
        st::Tree tree;
        const st::Constant value = Reckoning(tree, frame).value_for(*parsed_->root, type);
        const std::size_t size = value.text.size();
        const bool is_text = type.kind == st::Type::Kind::text;
        if (is_text && st::kept_bytes(value.text, type.room()) < size)
            throw Failed(fmt::format("{} is too long for {}", text_, type.name));
        const std::uint64_t first = is_text ? size : bits_of(type, value);
        std::memcpy(bytes.data(), &first, sizeof first);
        const auto* const text = reinterpret_cast<const std::byte*>(value.text.data());
        if (is_text) bytes.insert(bytes.end(), text, text + size);
        return bytes;
    } catch (const Failed& why) {
        error = why.what();
        return {};
    }
}

}  // namespace lineshaft::debug
