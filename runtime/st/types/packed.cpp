#include "runtime/st/types/packed.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <iterator>

namespace lineshaft::st {

namespace {

using Kind = Type::Kind;
using Coding = PackedFormat::Coding;

enum Scale : std::uint8_t { in_ns, in_ms, in_seconds, in_days };

constexpr std::int64_t scales[] = {1, 1'000'000, 1'000'000'000, 86'400'000'000'000};
constexpr std::int64_t day_of_1990 = 7305;  ///< counted from 1970-01-01

/// Where the next value of the type may begin on an S7, which needs so many bits. Booleans share
/// bytes, and what is longer than a byte begins at an even one.
std::uint64_t begin_on_s7(const Type& type, std::uint64_t at, const Dialect& dialect) {
    if (type.kind == Kind::boolean) return at;
    const bool is_byte = type.is_scalar() && packed_bits(type, dialect) == 8;
    return rounded_up(at, is_byte ? 8 : 16);
}

std::uint64_t begin_of(const Type& member, const Type& structure, std::uint64_t at,
                       const Dialect& dialect) {
    return dialect.packs_as_s7 ? begin_on_s7(member, at, dialect)
                               : begin_behind(at, member, structure);
}

std::optional<PackedFormat> of_time(const Type& type, const Dialect& dialect) {
    const bool is_long = type.name.starts_with('L'), is_s7 = dialect.packs_as_s7;
    PackedFormat made{.coding = Coding::clock, .bytes = 4, .is_big = is_s7, .scale = in_ms};
    if (is_long) return PackedFormat{Coding::clock, 8, is_s7, in_ns};
    if (type.kind == Kind::date && is_s7) return PackedFormat{Coding::dated, 2, true, in_days};
    if (type.kind == Kind::moment && is_s7) return PackedFormat{Coding::digits, 8, true, 0};
    if (type.kind == Kind::date || type.kind == Kind::moment) made.scale = in_seconds;
    return made;
}

std::uint64_t raw_bytes(const std::byte* bytes, const PackedFormat& format) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < format.bytes; ++i)
        value = value << 8 |
                std::to_integer<std::uint64_t>(bytes[format.is_big ? i : format.bytes - 1 - i]);
    return value;
}

std::int64_t signed_value(std::uint64_t raw, const PackedFormat& format) {
    const int unused = 64 - 8 * format.bytes;
    return static_cast<std::int64_t>(raw << unused) >> unused;
}

/// Year, month, day, hour, minute, second, ms and the day of the week, from Sunday on.
constexpr int digits_of[] = {2, 2, 2, 2, 2, 2, 3, 1};

/// ns since 1970. What is no digit counts as it is.
std::int64_t moment_of_digits(std::uint64_t raw) {
    std::int64_t parts[8] = {};
    int at = 16;
    for (std::size_t i = 0; i < std::size(parts); ++i)
        for (int digit = 0; digit < digits_of[i]; ++digit)
            parts[i] = parts[i] * 10 + static_cast<std::int64_t>(raw >> (4 * --at) & 0xF);
    using namespace std::chrono;
    const year_month month{
        year(static_cast<int>(parts[0] + (parts[0] < 90 ? 2000 : 1900))),
        std::chrono::month(static_cast<unsigned>(std::clamp<std::int64_t>(parts[1], 1, 12)))};
    const auto days = sys_days(month / 1).time_since_epoch().count() + parts[2] - 1;
    const auto seconds = ((days * 24 + parts[3]) * 60 + parts[4]) * 60 + parts[5];
    return (seconds * 1000 + parts[6]) * 1'000'000;
}

/// What is before 1990 is the first moment of it, what is behind 2089 the last.
std::uint64_t digits_of_moment(std::int64_t nanoseconds) {
    using namespace std::chrono;
    constexpr std::int64_t ms = 1'000'000, day = 86'400'000;
    const auto day_of = [](int of_year) {
        return std::int64_t{sys_days(year(of_year) / 1 / 1).time_since_epoch().count()};
    };
    const std::int64_t all =
        std::clamp(nanoseconds / ms, day_of(1990) * day, day_of(2090) * day - 1);
    const sys_days date{days(all / day)};
    const year_month_day civil(date);
    const std::int64_t clock = all % day;
    const std::int64_t parts[] = {static_cast<int>(civil.year()) % 100,
                                  static_cast<unsigned>(civil.month()),
                                  static_cast<unsigned>(civil.day()),
                                  clock / 3'600'000,
                                  clock / 60'000 % 60,
                                  clock / 1000 % 60,
                                  clock % 1000,
                                  weekday(date).c_encoding() + 1};
    std::uint64_t made = 0;
    for (std::size_t i = 0; i < std::size(parts); ++i) {
        std::int64_t unit = 1;
        for (int digit = 1; digit < digits_of[i]; ++digit) unit *= 10;
        for (; unit > 0; unit /= 10)
            made = made << 4 | static_cast<std::uint64_t>(parts[i] / unit % 10);
    }
    return made;
}

std::int64_t quotient_down(std::int64_t value, std::int64_t by) {
    return value / by - (value % by < 0 ? 1 : 0);
}

void load_units(std::byte* slots, const std::byte* bytes, std::uint64_t longest) {
    std::u16string units(longest, u'\0');
    std::memcpy(units.data(), bytes, 2 * longest);
    const std::string text = text_of_units(std::u16string_view(units).substr(0, units.find(u'\0')));
    const std::uint64_t length = text.size();
    std::memcpy(slots, &length, sizeof length);
    std::memcpy(slots + sizeof length, text.data(), length);
}

void store_units(std::byte* bytes, const std::byte* slots, std::uint64_t longest) {
    std::uint64_t length = 0;
    std::memcpy(&length, slots, sizeof length);
    std::u16string units = units_of({reinterpret_cast<const char*>(slots + sizeof length), length});
    units.resize(std::min<std::uint64_t>(units.size(), longest));
    std::memcpy(bytes, units.c_str(), 2 * (units.size() + 1));
}

}  // namespace

std::optional<PackedFormat> packed_format(const Type& given, const Dialect& dialect) {
    const Type& type = given.plain();
    const auto bytes = static_cast<std::uint8_t>(type.bits / 8);
    const bool is_big = dialect.packs_as_s7;
    switch (type.kind) {
        case Kind::boolean:
            return PackedFormat{is_big || type.is_one_bit ? Coding::bit : Coding::truth, 1, is_big,
                                0};
        case Kind::integer:
        case Kind::bits:
            return PackedFormat{type.is_signed ? Coding::with_sign : Coding::whole, bytes, is_big,
                                0};
        case Kind::real:
            return PackedFormat{Coding::real, bytes, is_big, 0};
        case Kind::time:
        case Kind::date:
        case Kind::clock:
        case Kind::moment:
            return of_time(type, dialect);
        case Kind::enumeration:
            if (!type.base || !(type.counted || type.is_unchecked)) return {};
            return packed_format(*type.base, dialect);
        default:
            return {};
    }
}

std::uint64_t packed_bits(const Type& type, const Dialect& dialect) {
    if (type.kind == Kind::boolean && (dialect.packs_as_s7 || type.is_one_bit)) return 1;
    if (type.is_scalar()) {
        const auto format = packed_format(type, dialect);
        return format ? 8U * format->bytes : 0;
    }
    if (type.kind == Kind::array) {
        const std::uint64_t bits = type.element ? packed_stride(type, dialect) * type.count() : 0;
        return dialect.packs_as_s7 ? rounded_up(bits, 16) : bits;
    }
    if (type.kind == Kind::text && type.is_wide) return 16 * (std::uint64_t{type.length} + 1);
    if (type.kind == Kind::text) return 8 * (type.length + (dialect.packs_as_s7 ? 2 : 1));
    if (type.kind != Kind::structure && type.kind != Kind::union_) return 0;
    std::uint64_t end = 0;
    for (const Variable* member : type.members) {
        const std::uint64_t bits = member->type ? packed_bits(*member->type, dialect) : 0;
        if (bits == 0) return 0;
        const bool is_union = type.kind == Kind::union_;
        end = is_union ? std::max(end, place_in_union(*member) + bits)
                       : begin_of(*member->type, type, end, dialect) + bits;
    }
    return rounded_up(end, dialect.packs_as_s7 ? 16 : 8 * alignment_of(type));
}

std::uint64_t packed_stride(const Type& array, const Dialect& dialect) {
    const std::uint64_t bits = packed_bits(*array.element, dialect);
    return dialect.packs_as_s7 ? begin_on_s7(*array.element, bits, dialect) : rounded_up(bits, 8);
}

std::uint64_t packed_offset(const Type& structure, const Variable& wanted, const Dialect& dialect) {
    std::uint64_t end = 0;
    if (structure.kind == Kind::union_) return place_in_union(wanted);
    for (const Variable* member : structure.members) {
        const std::uint64_t begin = begin_of(*member->type, structure, end, dialect);
        if (member == &wanted) return begin;
        end = begin + packed_bits(*member->type, dialect);
    }
    return end;
}

std::uint64_t load_packed(const std::byte* bytes, std::uint64_t bit, PackedFormat format) {
    bytes += bit / 8;
    const std::uint64_t raw = raw_bytes(bytes, format);
    switch (format.coding) {
        case Coding::bit:
            return raw >> (bit % 8) & 1;
        case Coding::truth:
            return raw != 0;
        case Coding::whole:
            return raw;
        case Coding::with_sign:
            return static_cast<std::uint64_t>(signed_value(raw, format));
        case Coding::real:
            if (format.bytes == 8) return raw;
            return std::bit_cast<std::uint64_t>(
                double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))});
        case Coding::clock:
            return (format.scale == in_seconds
                        ? raw
                        : static_cast<std::uint64_t>(signed_value(raw, format))) *
                   static_cast<std::uint64_t>(scales[format.scale]);
        case Coding::dated:
            return (raw + day_of_1990) * static_cast<std::uint64_t>(scales[in_days]);
        case Coding::digits:
            return static_cast<std::uint64_t>(moment_of_digits(raw));
    }
    return raw;
}

void store_packed(std::byte* bytes, std::uint64_t bit, PackedFormat format, std::uint64_t value) {
    bytes += bit / 8;
    const auto number = static_cast<std::int64_t>(value);
    if (format.coding == Coding::bit) {
        const auto mask = static_cast<std::byte>(1U << (bit % 8));
        *bytes = (value & 1) != 0 ? *bytes | mask : *bytes & ~mask;
        return;
    }
    if (format.coding == Coding::real && format.bytes == 4)
        value = std::bit_cast<std::uint32_t>(static_cast<float>(std::bit_cast<double>(value)));
    if (format.coding == Coding::clock)
        value = static_cast<std::uint64_t>(quotient_down(number, scales[format.scale]));
    if (format.coding == Coding::dated)
        value = static_cast<std::uint64_t>(quotient_down(number, scales[in_days]) - day_of_1990);
    if (format.coding == Coding::digits) value = digits_of_moment(number);
    for (std::size_t i = 0; i < format.bytes; ++i, value >>= 8)
        bytes[format.is_big ? format.bytes - 1 - i : i] = static_cast<std::byte>(value);
}

PackedText packed_text(const Type& text, const Dialect& dialect) {
    return {static_cast<std::uint16_t>(text.length), dialect.packs_as_s7 && !text.is_wide,
            text.is_wide};
}

void load_packed_text(std::byte* slots, const std::byte* bytes, std::uint64_t bit,
                      PackedText form) {
    const std::byte* first = bytes + bit / 8;
    if (form.is_wide) return load_units(slots, first, form.length);
    std::uint64_t length = 0;
    if (form.is_s7)
        length = std::min<std::uint64_t>(std::to_integer<std::uint64_t>(first[1]), form.length);
    else
        length =
            static_cast<std::uint64_t>(std::find(first, first + form.length, std::byte{0}) - first);
    std::memcpy(slots, &length, sizeof length);
    std::memcpy(slots + sizeof length, first + (form.is_s7 ? 2 : 0), length);
}

void store_packed_text(std::byte* bytes, std::uint64_t bit, PackedText form,
                       const std::byte* slots) {
    std::byte* first = bytes + bit / 8;
    if (form.is_wide) return store_units(first, slots, form.length);
    std::uint64_t length = 0;
    std::memcpy(&length, slots, sizeof length);
    length = std::min<std::uint64_t>(length, form.length);
    if (form.is_s7) {
        first[0] = static_cast<std::byte>(std::min<std::uint64_t>(form.length, 254));
        first[1] = static_cast<std::byte>(std::min<std::uint64_t>(length, 254));
    } else {
        first[length] = std::byte{0};
    }
    std::memcpy(first + (form.is_s7 ? 2 : 0), slots + sizeof length, length);
}

}  // namespace lineshaft::st
