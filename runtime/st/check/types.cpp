#include "runtime/st/check/types.hpp"

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/declarations.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/image.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/namespaces.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/packed.hpp"
#include "runtime/st/types/s5.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

bool is_open_array(const TypeText& text) {
    return text.kind == TypeText::Kind::array && !text.ranges.empty() && !text.ranges.front().first;
}

/// `ARRAY[*] OF INT` of what is given to a call.
const Type* resolve_open_array(Checking& c, const TypeText& text) {
    auto& type = const_cast<Type&>(*resolve_reference(c, text));
    type.referring = Referring::pointer;
    type.is_open = true;
    type.dimensions = text.ranges.size();
    return &type;
}

const Type* resolve_array(Checking& c, const TypeText& text) {
    if (is_open_array(text))
        return c.fail(code::wrong_place, text.place,
                      "an array of any length is a VAR_IN_OUT, an input, or a function's output",
                      "write its bounds: ARRAY[0..9] OF ...");
    const Type* element = resolve(c, *text.element);
    Wide total = 1;
    for (auto it = text.ranges.rbegin(); it != text.ranges.rend(); ++it) {
        Expression *from = it->first, *to = it->second;
        const auto lower = check_whole(c, from, lint_type), upper = check_whole(c, to, lint_type);
        if (!lower || !upper) return nullptr;
        const Wide count = *upper - *lower + 1;
        const bool may_be_none = count == 0 && text.place.dialect().is_loose;  // as TwinCAT has it
        if (count < 1 && !may_be_none)
            return c.fail(code::value_out_of_range, from->place.to(to->place),
                          "the array has no element", "the first bound is the smaller one");
        total *= count;
        if (total > most_elements)
            return c.fail(code::too_deep_or_large, from->place.to(to->place),
                          "the array is too large", "an array has at most 16777216 elements");
        Type& array = c.make_type(Kind::array, {});
        array.lower = static_cast<std::int64_t>(*lower);
        array.upper = static_cast<std::int64_t>(*upper);
        array.element = element;
        array.has_inner = it != text.ranges.rbegin();
        if (element) element = &array;
    }
    return element;
}

/// The members of the structure that is extended come first.
void inherit_members(Checking& c, const Token& name, Type& to, NameMap<Place>& names) {
    const Type* base = resolve_name(c, name);
    to.has_unknown_base = !base || base->has_unknown_base;
    if (!base) return;
    if (base->kind != Kind::structure)
        return void(c.fail(code::type_does_not_fit, name.place,
                           fmt::format("{} is not a structure", describe(*base)),
                           "a structure extends another one"));
    to.base = base;
    for (const Variable* member : base->members) {
        names.emplace(member->text, member->name.place);
        to.members.push_back(&c.checked.variables.emplace_back(*member));
    }
}

/// A POINTER is its number in the bytes of a UNION.
void keep_as_number(Variable& member) {
    if (!member.type || !member.type->is_pointer()) return;
    member.pointer = member.type;
    member.type = &bits_type(64);
}

/// A UNION keeps what has a packed form, and something.
bool has_packed_form(Checking& c, const TypeText& text, const Type& made) {
    for (Variable* member : made.members) {
        keep_as_number(*member);
        if (!member->type) return false;
        if (packed_bits(*member->type, text.place.dialect()) > 0) continue;
        return c.fail(
            code::type_does_not_fit, member->name.place,
            fmt::format("a UNION has no {}",
                        member->type->is_reference() ? "reference" : describe(*member->type)),
            "its members are numbers, times, texts, and structures and arrays of such");
    }
    if (made.members.empty())
        c.fail(code::value_out_of_range, text.place, "the UNION has no member",
               "declare the variables that share its bytes");
    return !made.members.empty();
}

/// `pack_mode` 0 leaves no gaps either.
std::uint8_t pack_of(const TypeText& text) {
    if (text.pack_mode.empty()) return text.place.dialect().most_aligned;
    const auto said = read_integer(text.pack_mode);
    return said && *said > 0 && *said <= 8 ? static_cast<std::uint8_t>(*said) : std::uint8_t{1};
}

/// `lo AT %B0 : BYTE`, `on AT %X3.0 : BOOL` of a STRUCT OVERLAP; in another one members have bytes
/// of their own, and where `%I*` is, is left open.
void place_member(Checking& c, const Declaration& declared, bool overlaps, Variable& member) {
    const Token& at = declared.at;
    if (at.word != Word::direct || is_left_open(at, member)) return;
    const auto place = read_address("%M" + std::string(at.text.substr(1)), AddressCount::bytes);
    if (!place)
        return void(c.fail(code::not_declared, at.place,
                           fmt::format("'{}' is no place in a structure", at.text),
                           "write the byte, as in %B2, or the bit, as in %X2.0"));
    if (overlaps && place->bits == 1 && member.type == &bool_type)
        member.type = find_codesys_type("BIT");
    if (overlaps) member.address = *place;
    if (!overlaps)
        c.warn(code::not_supported, at.place,
               "the members of a structure stand one behind the other, without the places of AT",
               "write STRUCT OVERLAP for bytes that are kept as AT says");
}

const Type* resolve_structure(Checking& c, const TypeText& text) {
    const bool is_union = text.kind == TypeText::Kind::union_ || text.overlaps;
    Type& type =
        c.make_type(is_union ? Kind::union_ : Kind::structure, is_union ? "UNION" : "STRUCT");
    type.is_unnamed = true;
    type.pack = pack_of(text);
    NameMap<Place> names;
    if (text.base.word != Word::end_of_file) inherit_members(c, text.base, type, names);
    for (const Declaration* declared : text.members) {
        const Type* member = resolve(c, *declared->type);
        refuse_overlay(c, *declared);
        refuse_object(c, *declared, member);
        if (is_told_by_capitals(c, declared->name, names)) continue;
        if (!is_new_name(c, declared->name, names)) continue;
        type.members.push_back(add(c, c.checked.variables, *declared, member));
        place_member(c, *declared, text.overlaps, *type.members.back());
        if (c.routine) c.routines_of_members.emplace(type.members.back(), c.routine);
    }
    note_members_by_others(c, type);
    return is_union && !has_packed_form(c, text, type) ? nullptr : &type;
}

Expression* made_of_value(Checking& c, const Expression& e, const Type& type, std::size_t i) {
    c.note_value(e.token.place, type, i);
    return make_constant(c, e, any_integer_type, {.integer = type.numbers[i]});
}

/// `LONG := SHORT + 1` with the numbers of the values before it.
Expression* with_values_before(Checking& c, Expression* e, const Type& type) {
    if (!e) return e;
    for (std::size_t i = 0; e->kind == E::name && i < type.values.size(); ++i)
        if (same_name(type.values[i], e->token.text)) return made_of_value(c, *e, type, i);
    Expression* made = make_copy(c, *e);
    for (Expression*& operand : made->operands) operand = with_values_before(c, operand, type);
    return made;
}

/// `INT (low := 10, high := 20)`: an INT, some of whose values have names.
void become_named_values(Type& type, const Type& base) {
    type.kind = base.kind;
    type.bits = base.bits;
    type.is_signed = base.is_signed;
    type.counts_ns = base.counts_ns;
    type.base = &base;
    type.has_numbers = type.is_unchecked = false;
    type.has_named_values = true;
    if (type.is_real())
        type.initial.real = type.reals.front();
    else
        type.initial.integer = type.numbers.front();
}

/// `LTIME (short := LT#3s)`, `LREAL (home := 0.0, far := 100.0)` of SIMATIC AX.
const Type* resolve_named_values(Checking& c, const TypeText& text, const Type& base) {
    Type& type = c.make_type(Kind::enumeration, "enumeration");
    type.slots = 1;
    type.is_unnamed = true;
    NameMap<Place> names;
    for (const Argument& value : text.values) {
        Expression* given = value.value;
        if (!check(c, given, &base) || !coerce(c, given, base)) return nullptr;
        if (!is_constant(*given))
            return c.fail(code::not_a_constant, given->place, "a named value is a constant");
        if (!is_new_name(c, value.name, names)) continue;
        type.values.emplace_back(value.name.text);
        if (base.is_real())
            type.reals.push_back(given->constant.real);
        else
            type.numbers.push_back(static_cast<std::int64_t>(given->constant.integer));
    }
    become_named_values(type, base.plain());
    return &type;
}

bool names_values(const TypeText& text, const Type& base) {
    const bool is_named_first = text.name.place.begin == text.place.begin;
    const auto has_both = [](const Argument& a) { return a.is_named() && a.value; };
    return (base.is_real() || base.kind == Kind::time) && is_named_first &&
           !text.place.dialect().is_loose && std::ranges::all_of(text.values, has_both);
}

/// A block's name with values is the block, with arguments of its FB_init.
const Type* resolve_enumeration(Checking& c, const TypeText& text) {
    const bool has_base = text.name.word != Word::end_of_file;
    const Type* base = has_base ? resolve_name(c, text.name) : &int_type;
    const bool has_none = text.values.empty() && base && base->is_instance();  // `edge : R_TRIG()`
    if (!base || base->kind == Kind::block || has_none) return base;
    if (names_values(text, *base)) return resolve_named_values(c, text, *base);
    if (base->kind != Kind::integer && base->kind != Kind::bits)
        return c.fail(code::not_supported, text.place, "arguments behind a type are not supported",
                      "write values behind ':=': (name := value)");
    Type& type = c.make_type(Kind::enumeration, "enumeration");
    type.slots = 1;
    type.base = base;
    type.is_unnamed = type.has_numbers = true;
    NameMap<Place> names;
    std::int64_t number = 0;
    for (const Argument& value : text.values) {
        if (!value.is_named())
            return c.fail(code::wrong_arguments, value.value->place,
                          "a value of an enumeration has a name", "write values as name := 1");
        Expression* given = with_values_before(c, value.value, type);
        if (given)
            if (const auto whole = check_whole(c, given, has_base ? *base : lint_type))
                number = static_cast<std::int64_t>(*whole);
        const auto fits = [&](const Type& in) {
            return number >= smallest(in) && number <= largest(in);
        };
        if (!has_base && !fits(*type.base)) type.base = fits(dint_type) ? &dint_type : &lint_type;
        if (!is_new_name(c, value.name, names)) continue;
        type.counted &= number == static_cast<std::int64_t>(type.values.size());
        type.values.emplace_back(value.name.text);
        type.places.push_back(value.name.place);
        type.numbers.push_back(number++);
        c.note_value(value.name.place, type, type.values.size() - 1);
    }
    const bool is_from_zero = text.place.dialect().enumerations_begin_at_zero && type.name_of(0);
    if (!is_from_zero && !type.numbers.empty()) type.initial.integer = type.numbers.front();
    const bool takes_numbers =
        text.place.dialect().enumerations_are_numbers || text.place.source->is_library();
    type.is_unchecked = takes_numbers && !text.is_strict;
    const bool is_named_first = has_base && text.name.place.begin == text.place.begin;
    if (is_named_first && !text.place.dialect().is_loose && !type.numbers.empty())
        become_named_values(type, base->plain());
    return &type;
}

const Type* resolve_subrange(Checking& c, const TypeText& text) {
    const Type* base = resolve_name(c, text.name);
    if (!base) return nullptr;
    const bool are_bits = base->kind == Kind::bits && !text.place.dialect().subranges_are_integers;
    if (base->kind != Kind::integer && !are_bits)
        return c.fail(code::type_does_not_fit, text.place,
                      fmt::format("{} has no subranges", describe(*base)),
                      "a subrange is one of an integer type");
    if (are_bits && !text.place.dialect().is_loose)
        c.warn(code::type_does_not_fit, text.place,
               fmt::format("{} has no subranges in IEC 61131-3", describe(*base)),
               fmt::format("write {}, which has them", integer_type(base->bits, false).name));
    Expression *from = text.ranges.front().first, *to = text.ranges.front().second;
    const auto lower = check_whole(c, from, *base), upper = check_whole(c, to, *base);
    if (!lower || !upper) return nullptr;
    if (*lower > *upper)
        return c.fail(code::value_out_of_range, text.place, "the subrange has no value",
                      "the first bound is the smaller one");
    Type& type = c.checked.types.emplace_back(*base);
    type.name = fmt::format("{}({}..{})", base->name, *lower, *upper);
    type.is_subrange = true;
    type.is_unchecked = text.place.dialect().is_loose;
    type.base = base;
    type.lower = static_cast<std::int64_t>(*lower);
    type.upper = static_cast<std::int64_t>(*upper);
    type.initial.integer = *lower;  // 6.4.4.4
    return &type;
}

const Type* resolve_text(Checking& c, const TypeText& text) {
    Expression* length = text.length;
    const auto whole = check_whole(c, length, lint_type);
    if (!whole) return nullptr;
    const bool is_any = text.place.dialect().texts_have_any_length;
    if (*whole < (is_any ? 0 : 1) || (*whole > longest_text && !is_any))
        return c.fail(code::value_out_of_range, length->place,
                      fmt::format("a STRING has between {} and 32767 characters", is_any ? 0 : 1));
    if (*whole > longest_text)
        c.warn(code::value_out_of_range, length->place, "a STRING keeps 32767 characters here",
               "what is longer is cut off");
    const auto kept = static_cast<std::uint32_t>(std::min(*whole, longest_text));
    const bool is_wide = same_name(text.name.text, "wstring") && has_wide_texts(text.place);
    Type& type = c.make_type(Kind::text, fmt::format("{}STRING[{}]", is_wide ? "W" : "", kept));
    type.length = kept;
    type.is_wide = is_wide;
    return &type;
}

}  // namespace

const Type* resolve(Checking& c, const TypeText& text) {
    if (text.base.word != Word::end_of_file && text.kind != TypeText::Kind::structure)
        c.fail(code::wrong_place, text.base.place, "only a structure extends another type",
               "write STRUCT behind ':'");
    switch (text.kind) {
        case TypeText::Kind::name:
            return resolve_name(c, text.name);
        case TypeText::Kind::array:
            return resolve_array(c, text);
        case TypeText::Kind::structure:
        case TypeText::Kind::union_:
            return resolve_structure(c, text);
        case TypeText::Kind::enumeration:
            return resolve_enumeration(c, text);
        case TypeText::Kind::subrange:
            return resolve_subrange(c, text);
        case TypeText::Kind::text:
            return resolve_text(c, text);
        case TypeText::Kind::reference:
            return resolve_reference(c, text);
    }
    return nullptr;
}

const Type& long_time_type(const Place& place) {
    const bool has_no_sign =
        place.dialect().is_loose && place.dialect().times_count_ms && !place.source->is_prelude();
    return has_no_sign ? unsigned_ltime_type : ltime_type;
}

const Type* in_dialect(const Type* type, const Place& place) {
    if (type == &ltime_type) return &long_time_type(place);
    if (has_wide_texts(place)) return type;
    return type == &wide_string_type ? &string_type : type == &wide_char_type ? &char_type : type;
}

/// A DATE and a DT of a Siemens controller begin with 1990-01-01.
static const Type* begun_in_dialect(const Type* type, const Place& place) {
    const bool in_1990 = place.dialect().dates_begin_1990 && !place.source->is_prelude();
    const bool is_begun =
        (type->kind == Kind::date || type->kind == Kind::moment) && !type->counts_ns;
    if (!in_1990 || !is_begun) return in_dialect(type, place);
    static const auto begun = [](const Type& of) {
        Type made = of;
        made.initial.integer = 7305 * Wide{86'400'000'000'000};
        return made;
    };
    static const Type date = begun(date_type), moment = begun(moment_type);
    return type->kind == Kind::date ? &date : &moment;
}

bool refers_to_open_array(const TypeText& text) {
    return text.kind == TypeText::Kind::reference && text.name.word == Word::ref_to_ &&
           text.element && is_open_array(*text.element);
}

const Type* resolve_parameter(Checking& c, const TypeText& text) {
    if (refers_to_open_array(text)) return resolve_open_array(c, *text.element);
    return is_open_array(text) ? resolve_open_array(c, text) : resolve(c, text);
}

/// `axis` of the catalogue is a block of the program, and of a test; AXIS of a vendor's project is
/// another type.
static bool is_of_catalog_alone(const Checking& c, const Type& type, const Token& name) {
    return type.is_object() && !name.place.dialect().axes_are_types && !c.is_in_test();
}

const Type* resolve_name(Checking& c, const Token& name) {
    if (c.is_lost(name)) return nullptr;
    if (const Type* type = find_elementary(name.text); type && !name.quoted)
        return type == &string_type        ? &unsized_string(name.place.dialect())
               : type == &wide_string_type ? &unsized_wide_string(name.place)
                                           : begun_in_dialect(type, name.place);
    if (name.place.dialect().is_loose && !name.quoted)
        if (const Type* type = find_codesys_type(name.text)) return type;
    const bool has_s5 = name.place.dialect().has_s7_instructions || is_library(name);
    if (has_s5 && !name.quoted && !c.look_up(&Names::types, name) && !c.find_routine(name))
        if (const Type* type = find_s5_type(name.text)) return type;
    if (NamedType* named = c.look_up(&Names::types, name)) {
        const Type* type = resolve_declared(c, *named);
        c.note(name.place, *named);
        return type;
    }
    if (const Routine* routine = c.find_routine(name)) {
        c.note(name.place, *routine);
        if (routine->type) return routine->type;
        return c.fail(code::type_does_not_fit, name.place,
                      fmt::format("'{}' is a function, not a type", name.text),
                      "call it; only function blocks have instances");
    }
    if (const auto own = without_project(c, name)) {
        if (NamedType* type = c.look_up(&Names::types, *own)) return resolve_declared(c, *type);
        const Routine* routine = c.find_routine(*own);
        if (routine && routine->type) return routine->type;
    }
    const std::string_view bare = without_library(name.text);
    if (const Type* type = standard_type(c, bare, name.place.dialect().vendor);
        type && !is_of_catalog_alone(c, *type, name)) {
        c.note(name.place, *type);
        return type;
    }
    if (c.tree.lost.contains(name.text) || may_be_elsewhere(c, name.place)) return nullptr;
    std::string_view instead = instead_of_type(bare, name.place.dialect().vendor);
    if (instead.empty()) instead = c.catalog.instead_of(bare);
    if (!instead.empty())
        return c.fail(code::not_supported, name.place,
                      fmt::format("the type {} is not supported", name.text), std::string(instead));
    if (name.text.find('.') != name.text.npos && !name.quoted)
        return refuse_qualified(c, name), nullptr;
    std::vector<std::string> names = {"BOOL", "INT",  "DINT",  "LINT", "UINT",  "UDINT",
                                      "WORD", "REAL", "LREAL", "TIME", "STRING"};
    for (const auto& [known, type] : c.users.types) names.emplace_back(known);
    for (const auto& [known, routine] : c.users.routines)
        if (routine->type) names.emplace_back(known);
    for (const BlockType& kind : c.catalog.types())
        names.emplace_back(kind.handle.empty() ? kind.name : kind.handle);
    std::ranges::sort(names);
    const auto near = nearest(name.text, names);
    if (near.empty() && c.may_be_foreign(name)) return nullptr;
    return c.fail(
        code::not_declared, name.place, fmt::format("'{}' is not a type", name.text),
        near.empty() ? "declare it with TYPE, or as a FUNCTION_BLOCK" : suggest(name.text, near));
}

/// `TYPE Colour : (red, green) := Colour.green;`
static Expression* without_own_name(Checking& c, const TypeDeclaration& declared) {
    Expression* value = declared.initial;
    const bool is_of_type = value->kind == E::member && value->operands[0]->kind == E::name &&
                            same_name(value->operands[0]->token.text, declared.name.text);
    return is_of_type ? make_name(c, *value, value->token.text) : value;
}

const Type* resolve_declared(Checking& c, NamedType& named) {
    if (named.type) return named.type;
    const TypeDeclaration& declared = *named.declaration;
    if (named.visiting)
        return c.fail(code::contains_itself, declared.name.place,
                      fmt::format("the type '{}' contains itself", declared.name.text),
                      "a value of it would have no end");
    named.visiting = true;
    const Type* type = resolve(c, *declared.type);
    named.visiting = false;
    if (!type) return nullptr;
    const bool is_own = declared.type->kind != TypeText::Kind::name;
    if (is_own) {
        auto& own = const_cast<Type&>(*type);
        own.name = std::string(name_with_namespace(c, declared.name).text);
        own.is_unnamed = false;
        own.texts_are_names = declared.texts_are_names && own.has_values();
        own.is_strict = declared.type->is_strict;
    }
    if (declared.initial) {
        Type& copy = c.checked.types.emplace_back(*type);
        copy.initial_value = declared.initial;
        type = &copy;
        Expression* value = without_own_name(c, declared);
        named.visiting = true;
        check_initial(c, value, copy);
        named.visiting = false;
        copy.initial_value = value;
    }
    if (is_own)  // within the declaration its values have no need of its name
        const_cast<Type&>(*type).is_qualified_only = declared.type->is_qualified_only;
    auto& values = c.names_beside(declared.name).values;
    const bool are_names = is_own && !declared.type->is_qualified_only;
    for (std::size_t i = 0; i < type->values.size() && are_names; ++i) {
        Token value = declared.name;
        value.text = type->values[i];
        value = name_with_namespace(c, value);
        const auto [it, is_new] = values.emplace(value.text, NamedValue{type, i});
        if (!is_new) it->second.ambiguous = true;
    }
    if (declared.initial)
        for (auto& [name, value] : values)
            if (value.type && value.type->name == type->name) value.type = type;
    c.note(declared.name.place, *type, declared.name.place);
    return named.type = type;
}

}  // namespace lineshaft::st
