#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "runtime/model/value.hpp"

namespace lineshaft {

enum class Direction : std::uint8_t {
    parameter,  ///< constant while the program runs
    input,      ///< constant, wired, or set by a stimulus; copied in before each scan
    output,     ///< written by the block; may be wired, traced, expected
    local,      ///< of the block alone; may be traced, expected, forced, retained, not wired
    in_out,     ///< a reference to another block, by its number: see Context
};

constexpr std::string_view name_of(Direction direction) {
    constexpr std::string_view names[] = {"parameter", "input", "output", "local", "reference"};
    return names[static_cast<std::size_t>(direction)];
}

/// One named value of a block. The table of these is the only place where a block's names, units,
/// limits and doc strings stand; keys, checks, help, schema and trace columns are made from it.
struct Field {
    std::string_view name = {};
    std::string_view doc = {};
    std::string_view unit = {};  ///< `mm/s`; `{p}` in it stands for the value of the enumeration
                                 ///< parameter p, or for the `unit` of the block that the reference
                                 ///< p names, of which `names` has the values
    Direction direction = Direction::parameter;
    Type type = Type::real;
    std::size_t offset = 0;  ///< of the member in the block's struct
    ValueNames names = {};   ///< of an enumeration
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    bool minimum_excluded = false;
    bool maximum_excluded = false;
    bool required = false;
    bool takes_not_finite = false;  ///< INF, -INF and NaN, whatever the limits: a REAL of a program
    std::string_view refers = {};   ///< of a reference: the type that it takes
    std::string_view global = {};   ///< of a reference: it takes the block of that name, and no
                                    ///< program writes it down

    /// Limits of a constant in the program file; a wired value is the block's own business.
    constexpr Field above(double limit) const {
        Field f = *this;
        f.minimum = limit;
        f.minimum_excluded = true;
        return f;
    }
    constexpr Field below(double limit) const {
        Field f = *this;
        f.maximum = limit;
        f.maximum_excluded = true;
        return f;
    }
    constexpr Field at_least(double limit) const {
        Field f = *this;
        f.minimum = limit;
        return f;
    }
    constexpr Field at_most(double limit) const {
        Field f = *this;
        f.maximum = limit;
        return f;
    }
    /// A program that neither sets nor wires it is in error.
    constexpr Field must_be_set() const {
        Field f = *this;
        f.required = true;
        return f;
    }
    /// Names of an enumeration's values.
    constexpr Field one_of(std::span<const std::string_view> values) const {
        Field f = *this;
        f.names = values;
        return f;
    }

    bool is_time() const { return lineshaft::is_time(type, unit); }
    bool admits(const Value& value) const {
        if (type == Type::enumeration) return names.takes(std::get<std::int64_t>(value));
        if (takes_not_finite && !std::isfinite(as_real(value))) return true;
        const auto from_minimum = compare(value, minimum), from_maximum = compare(value, maximum);
        return (minimum_excluded ? from_minimum > 0 : from_minimum >= 0) &&
               (maximum_excluded ? from_maximum < 0 : from_maximum <= 0);
    }
};

/// What is wrong with the rows of a table that each for itself is right.
struct TableFault {
    std::size_t row = 0;  ///< first one that it is true of
    std::string_view message, help;
};

/// A list of rows of numbers that a program may give a block once, before it runs, itself or as the
/// name of a CSV file with such columns: `profile: [[2 kHz, 10 kHz, 200], [10 kHz, 10 kHz, 3400]]`.
/// Plain data: room for `capacity` rows in the block, each of 8 bytes a column, and the number of
/// those given. What a row does not give is as in a new block.
struct TableField {
    std::string_view name = {};
    std::string_view doc = {};
    std::span<const Field> columns = {};  ///< name, unit and limits of each number in a row
    std::size_t capacity = 0;             ///< rows
    std::size_t size_offset = 0;          ///< of the number of rows given, std::int64_t
    std::size_t rows_offset = 0;
    std::size_t needed = 0;  ///< columns that each row gives; 0: all

    std::size_t row_size() const { return columns.size() * sizeof(std::int64_t); }  ///< [bytes]
    bool has_names() const {
        return std::ranges::any_of(columns, [](const Field& c) { return !c.names.empty(); });
    }
    std::optional<TableFault> (*complete)(std::byte* block) =
        nullptr;  ///< checks all rows, and puts in what they leave open; or null
    /// The line through the plane that the rows describe from the first one on, in the unit of the
    /// first column, for who draws it; null: they describe none.
    std::vector<std::array<double, 2>> (*outline)(const std::byte* block) = nullptr;
};

namespace detail {

template <class T>
constexpr Type type_of() {
    if constexpr (std::is_same_v<T, bool>)
        return Type::boolean;
    else if constexpr (std::is_same_v<T, std::int64_t>)
        return Type::integer;
    else if constexpr (std::is_same_v<T, double>)
        return Type::real;
    else {
        static_assert(std::is_enum_v<T> && sizeof(T) == 8,
                      "a field is bool, std::int64_t, double, or an enum class : std::int64_t");
        return Type::enumeration;
    }
}

/// Where a member stands in its block, in bytes.
template <class Block, class T>
std::size_t offset_of(T Block::*member) {
    static const Block probe{};
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&(probe.*member)) -
                                    reinterpret_cast<const std::byte*>(&probe));
}

template <class Block, class T>
Field field(Direction direction, std::string_view name, T Block::*member, std::string_view unit,
            std::string_view doc) {
    Field f;
    f.name = name;
    f.doc = doc;
    f.unit = unit;
    f.direction = direction;
    f.type = type_of<T>();
    f.offset = offset_of(member);
    return f;
}

/// The field of a member of one of the block's parts.
template <class Block, class Part, class T>
Field field(Direction direction, std::string_view name, Part Block::*part, T Part::*member,
            std::string_view unit, std::string_view doc) {
    Field f = field(direction, name, member, unit, doc);
    f.offset += offset_of(part);
    return f;
}

}  // namespace detail

template <class Block, class T>
Field parameter(std::string_view name, T Block::*member, std::string_view unit,
                std::string_view doc) {
    return detail::field(Direction::parameter, name, member, unit, doc);
}

template <class Block, class Part, class T>
Field parameter(std::string_view name, Part Block::*part, T Part::*member, std::string_view unit,
                std::string_view doc) {
    return detail::field(Direction::parameter, name, part, member, unit, doc);
}

template <class Block, class T>
Field input(std::string_view name, T Block::*member, std::string_view unit, std::string_view doc) {
    return detail::field(Direction::input, name, member, unit, doc);
}

template <class Block, class Part, class T>
Field input(std::string_view name, Part Block::*part, T Part::*member, std::string_view unit,
            std::string_view doc) {
    return detail::field(Direction::input, name, part, member, unit, doc);
}

template <class Block, class T>
Field output(std::string_view name, T Block::*member, std::string_view unit, std::string_view doc) {
    return detail::field(Direction::output, name, member, unit, doc);
}

template <class Block, class T>
Field local(std::string_view name, T Block::*member, std::string_view unit, std::string_view doc) {
    return detail::field(Direction::local, name, member, unit, doc);
}

template <class Block, class Part, class T>
Field local(std::string_view name, Part Block::*part, T Part::*member, std::string_view unit,
            std::string_view doc) {
    return detail::field(Direction::local, name, part, member, unit, doc);
}

/// `axis: shaft`: the number of a block of type `refers`, which a program must give. The block is
/// scanned in the order of the file with all that refer to the same one in its task.
template <class Block>
Field in_out(std::string_view name, std::int64_t Block::*member, std::string_view refers,
             std::string_view doc) {
    Field f = detail::field(Direction::in_out, name, member, "", doc);
    f.refers = refers;
    f.required = true;
    return f;
}

template <class Block, class Part, class T>
Field output(std::string_view name, Part Block::*part, T Part::*member, std::string_view unit,
             std::string_view doc) {
    return detail::field(Direction::output, name, part, member, unit, doc);
}

/// The list of a member with `std::int64_t size` and an array `rows`, whose element is a plain
/// struct of the columns.
template <class Block, class T>
TableField table(std::string_view name, T Block::*member, std::span<const Field> columns,
                 std::string_view doc) {
    using Row = typename decltype(T::rows)::value_type;
    static_assert(sizeof(Row) % sizeof(std::int64_t) == 0);
    const std::size_t place = detail::offset_of(member);
    return {.name = name,
            .doc = doc,
            .columns = columns,
            .capacity = std::tuple_size_v<decltype(T::rows)>,
            .size_offset = place + detail::offset_of(&T::size),
            .rows_offset = place + detail::offset_of(&T::rows)};
}

/// One number of a row; limits as those of a field.
/// A column of real numbers; `{p}` in its unit means what it does in a field's.
inline Field real_column(std::string_view name, std::string_view unit, std::string_view doc) {
    Field f;
    f.name = name;
    f.doc = doc;
    f.unit = unit;
    return f;
}

/// A column of names of an enumeration; a file has them or their numbers.
inline Field name_column(std::string_view name, std::span<const std::string_view> names,
                         std::string_view doc) {
    Field f;
    f.name = name;
    f.doc = doc;
    f.type = Type::enumeration;
    f.names = names;
    return f;
}

inline Field column(std::string_view name, std::string_view unit, std::string_view doc) {
    Field f;
    f.name = name;
    f.doc = doc;
    f.unit = unit;
    f.type = Type::integer;
    return f;
}

}  // namespace lineshaft
