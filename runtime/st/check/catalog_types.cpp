#include "runtime/st/check/catalog_types.hpp"

#include <algorithm>

#include "runtime/source/letters.hpp"

namespace lineshaft::st {

namespace {

/// What the standard's and Siemens' counters count in, by the number of `data_type`.
constexpr std::string_view counter_types[] = {"int",   "dint", "lint",  "udint",
                                              "ulint", "sint", "usint", "uint"};

/// A kind of the catalogue that counts in one of them.
struct Counter {
    std::string_view kind;
    std::size_t type = 0;
};

/// `CTU`, `CTD_UDINT`, `IEC_DCOUNTER`.
std::optional<Counter> find_counter(std::string_view name) {
    static constexpr std::pair<std::string_view, std::size_t> siemens[] = {
        {"iec_counter", 0},  {"iec_dcounter", 1},  {"iec_udcounter", 3},
        {"iec_scounter", 5}, {"iec_uscounter", 6}, {"iec_ucounter", 7}};
    for (const auto& [own, type] : siemens)
        if (same_name(name, own)) return Counter{"ctu", type};
    const std::size_t end = std::min(name.find('_'), name.size());
    for (const std::string_view kind : {"ctu", "ctd", "ctud"}) {
        if (!same_name(name.substr(0, end), kind)) continue;
        if (end == name.size()) return Counter{kind};
        for (std::size_t type = 0; type < std::size(counter_types); ++type)
            if (same_name(name.substr(end + 1), counter_types[type])) return Counter{kind, type};
    }
    return {};
}

constexpr std::pair<std::string_view, std::string_view> aliases[] = {
    {"ton_time", "ton"},  {"tof_time", "tof"}, {"tp_time", "tp"},    {"ton_ltime", "ton"},
    {"tof_ltime", "tof"}, {"tp_ltime", "tp"},  {"iec_timer", "ton"}, {"iec_ltimer", "ton"}};

/// What Siemens and CODESYS call references.
constexpr std::pair<std::string_view, std::string_view> handles[] = {
    {"to_axis", "axis_ref"},
    {"to_speedaxis", "axis_ref"},
    {"to_positioningaxis", "axis_ref"},
    {"to_synchronousaxis", "axis_ref"},
    {"axis_ref_sm3", "axis_ref"},
    {"axis_ref_virtual_sm3", "axis_ref"},
    {"to_cam", "cam_ref"},
    {"axis_group_ref_sm3", "axes_group_ref"},
    {"mc_path_ref", "path_ref"}};

/// What the numbers mean that Siemens' MC_MOVEABSOLUTE and MC_MOVEVELOCITY have for a Direction,
/// and MC_HOME for its Mode.
std::vector<std::int64_t> numbers_of(std::string_view field) {
    if (field == "Direction") return {0, 1, 2, 0};
    if (field == "HomingMode") return {0, -1, -1, -1, -1, -1, -1, 0};
    return {};
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
    Type& type = c.make_type(Kind::handle, std::string(kind->handle));
    type.standard = &*kind;
    type.slots = 1;
    type.initial.integer = -1;
    return c.catalog_types[type.name] = &type;
}

}  // namespace

const Type* standard_type(Checking& c, std::string_view name) {
    if (const auto it = c.catalog_types.find(name); it != c.catalog_types.end()) return it->second;
    for (const auto& [theirs, ours] : handles)
        if (same_name(theirs, name)) return standard_type(c, ours);
    if (const Type* handle = handle_type(c, name)) return handle;
    const auto counter = find_counter(name);
    const auto* alias =
        std::ranges::find_if(aliases, [&](const auto& a) { return same_name(a.first, name); });
    std::string_view wanted = name;
    if (counter) wanted = counter->kind;
    if (alias != std::end(aliases)) wanted = alias->second;
    const auto kind = std::ranges::find_if(
        c.catalog.types(), [&](const BlockType& type) { return same_name(type.name, wanted); });
    if (kind == c.catalog.types().end() || kind->is_device()) return nullptr;
    Type& type = c.make_type(Kind::standard, upper(name));
    type.standard = &*kind;
    type.slots = static_cast<std::uint32_t>((kind->size + 7) / 8) + (c.has_tests ? 1 : 0);
    for (const Field& field : kind->fields) {
        Variable& member = c.checked.variables.emplace_back();
        member.text = field.name;
        member.section = section_of(field.direction);
        member.slot = static_cast<std::uint32_t>(field.offset / 8);
        member.byte = static_cast<std::uint32_t>(field.offset);
        member.is_byte = field.type == lineshaft::Type::boolean;
        member.type = field.type == lineshaft::Type::boolean ? &bool_type
                      : field.type == lineshaft::Type::real  ? &lreal_type
                      : field.unit == "ns"                   ? &time_type
                                                             : &lint_type;
        const BlockType* referred = c.catalog.find(field.refers);
        if (referred && !referred->handle.empty()) member.type = standard_type(c, referred->handle);
        if (field.type == lineshaft::Type::enumeration) {
            Type& values =
                c.make_type(Kind::enumeration, fmt::format("{}.{}", kind->name, field.name));
            values.slots = 1;
            values.base = &lint_type;
            values.of_number = numbers_of(field.name);
            values.is_code = std::ranges::any_of(
                code_names, [&](std::string_view code) { return same_name(field.name, code); });
            for (const std::string_view value : field.names) {
                values.numbers.push_back(static_cast<std::int64_t>(values.values.size()));
                values.values.emplace_back(value);
            }
            member.type = &values;
        }
        const bool counts = same_name(field.name, "pv") || same_name(field.name, "cv");
        if (counter && counts) member.type = find_elementary(counter_types[counter->type]);
        type.members.push_back(&member);
    }
    if (counter) type.presets.push_back({"data_type", {.integer = Wide(counter->type)}});
    return c.catalog_types[type.name] = &type;
}

}  // namespace lineshaft::st
