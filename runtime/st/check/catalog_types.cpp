#include "runtime/source/letters.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

/// A kind of block by its name: `TON`, `CTU_UDINT`.
struct NamedKind {
    const BlockType* kind = nullptr;   ///< null: there is none of that name
    const Field* data_type = nullptr;  ///< by which it says of what type its whole numbers are
    std::size_t number = 0;            ///< of that type
};

NamedKind find_kind(const Catalog& catalog, std::string_view name) {
    const auto find = [&](std::string_view wanted) {
        const BlockType* kind = find_called(catalog.types(), wanted, &BlockType::name);
        return kind && !kind->is_device() ? kind : nullptr;
    };
    const auto data_type_of = [](const BlockType& kind) {
        const auto it = std::ranges::find(kind.fields, "data_type", &Field::name);
        const bool is_type =
            it != kind.fields.end() && !it->names.empty() && find_elementary(it->names.front());
        return is_type ? &*it : nullptr;
    };
    if (const BlockType* kind = find(name)) return {kind, data_type_of(*kind)};
    const std::size_t end = name.find('_');
    const BlockType* kind = end == name.npos ? nullptr : find(name.substr(0, end));
    const Field* types = kind ? data_type_of(*kind) : nullptr;
    if (!types) return {};
    const std::string_view* type = find_called(types->names, name.substr(end + 1));
    if (!type) return {};
    return {kind, types, static_cast<std::size_t>(type - &*types->names.begin())};
}

/// Enumerations that the standards make a WORD.
constexpr std::string_view code_names[] = {"errorid", "axiserrorid", "error_id", "warning_id"};

Section section_of(Direction direction) {
    if (direction == Direction::output) return Section::output;
    if (direction == Direction::local) return Section::local;
    return direction == Direction::in_out ? Section::in_out : Section::input;
}

const Type* handle_type(Checking& c, std::string_view name) {
    const auto kind = std::ranges::find_if(c.catalog.types(), [&](const BlockType& type) {
        return !type.handle.empty() && same_name(type.handle, name);
    });
    if (kind == c.catalog.types().end()) return nullptr;
    if (const Type* known = find_in(c.catalog_types, kind->handle)) return known;
    Type& type = c.make_type(Kind::handle, std::string(kind->handle));
    type.standard = &*kind;
    type.slots = 1;
    type.initial.integer = -1;
    return c.catalog_types[type.name] = &type;
}

const Type& make_enumeration(Checking& c, const BlockType& kind, const Field& field) {
    Type& values = c.make_type(Kind::enumeration, fmt::format("{}.{}", kind.name, field.name));
    values.slots = 1;
    values.base = &lint_type;
    const auto meanings = meanings_of_numbers(field.name);
    values.of_number.assign(meanings.places.begin(), meanings.places.end());
    values.all_others_as_last = meanings.all_others_as_last;
    values.is_code = find_called(code_names, field.name) != nullptr;
    for (const std::string_view value : field.names) {
        values.numbers.push_back(static_cast<std::int64_t>(values.values.size()));
        values.values.emplace_back(value);
    }
    return values;
}

const Type* type_of(Checking& c, const NamedKind& named, const Field& field) {
    if (field.type == lineshaft::Type::boolean) return &bool_type;
    if (field.type == lineshaft::Type::real) return &lreal_type;
    if (field.type == lineshaft::Type::unsigned_integer) return &ulint_type;
    if (field.type == lineshaft::Type::enumeration) return &make_enumeration(c, *named.kind, field);
    const BlockType* referred = c.catalog.find(field.refers);
    if (referred && !referred->handle.empty()) return standard_type(c, referred->handle);
    if (named.data_type && field.direction != Direction::parameter)
        return find_elementary(named.data_type->names[named.number]);
    return field.is_time() ? &time_type : &lint_type;
}

}  // namespace

const Type* standard_type(Checking& c, std::string_view name, Vendor vendor) {
    const std::string_view wanted = standard_type_name(name);
    const Beginning* beginning = find_beginning(wanted, vendor);
    auto& known = beginning ? c.types_of_vendors[vendor] : c.catalog_types;
    if (const Type* type = find_in(known, name)) return type;
    if (const Type* handle = handle_type(c, wanted)) return handle;
    if (const Type* number = wanted == name ? nullptr : find_elementary(wanted)) return number;
    NamedKind named = find_kind(c.catalog, wanted);
    if (!named.kind) return nullptr;
    const bool says_type = beginning && named.data_type && beginning->part == named.data_type->name;
    if (says_type) named.number = static_cast<std::size_t>(beginning->value);
    const BlockType& kind = *named.kind;
    Type& type = c.make_type(Kind::standard, upper(name));
    type.standard = &kind;
    type.slots = static_cast<std::uint32_t>((kind.size + 7) / 8) + (c.has_tests ? 1 : 0);
    for (const Field& field : kind.fields) {
        Variable& member = c.make_variable({}, field.name, type_of(c, named, field));
        member.section = section_of(field.direction);
        member.slot = static_cast<std::uint32_t>(field.offset / 8);
        member.byte = static_cast<std::uint32_t>(field.offset);
        member.is_byte = field.type == lineshaft::Type::boolean;
        type.members.push_back(&member);
    }
    if (named.data_type)
        type.presets.push_back({named.data_type->name, {.integer = Wide(named.number)}});
    if (beginning && !says_type)
        type.presets.push_back(
            {beginning->part,
             {.integer = beginning->value, .real = static_cast<double>(beginning->value)}});
    return known[type.name] = &type;
}

}  // namespace lineshaft::st
