#include "runtime/serve/registers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace lineshaft {

namespace {

template <class T>
std::uint64_t bits_of(T value) {
    if constexpr (std::is_same_v<T, float>)
        return std::bit_cast<std::uint32_t>(value);
    else if constexpr (std::is_same_v<T, double>)
        return std::bit_cast<std::uint64_t>(value);
    else
        return static_cast<std::uint64_t>(value);
}

/// The nearest that T has.
template <class T>
T nearest_of(double value) {
    using Limits = std::numeric_limits<T>;
    if constexpr (!Limits::is_integer) return static_cast<T>(value);
    if (std::isnan(value)) return 0;
    const double rounded = std::round(value);
    if (rounded <= static_cast<double>(Limits::min())) return Limits::min();
    if (rounded >= static_cast<double>(Limits::max())) return Limits::max();
    return static_cast<T>(rounded);
}

/// Likewise of value / scale; half is away from zero.
template <class T>
T nearest_of(Wide value, const MappedSignal& signal) {
    const Wide product = value * signal.divisor, by = signal.multiplier;
    const Wide left = product % by, half = (by < 0 ? -by : by) / 2 + (by % 2 != 0);
    const bool is_up = (left < 0 ? -left : left) >= half && left != 0;
    const Wide quotient = product / by + (is_up ? ((product < 0) == (by < 0) ? 1 : -1) : 0);
    if (quotient < Wide{std::numeric_limits<T>::min()}) return std::numeric_limits<T>::min();
    if (quotient > Wide{std::numeric_limits<T>::max()}) return std::numeric_limits<T>::max();
    return static_cast<T>(quotient);
}

/// number * scale, if that is a value of the signal.
std::optional<Value> scaled(Wide number, const MappedSignal& signal) {
    const Wide product = number * signal.multiplier;
    if (product % signal.divisor != 0) return {};
    return whole_value(product / signal.divisor, signal.signal.type);
}

/// Calls `with` with a zero of the type.
template <class Call>
auto with_type(RegisterType type, Call with) {
    switch (type) {
        case RegisterType::int16:
            return with(std::int16_t{});
        case RegisterType::int32:
            return with(std::int32_t{});
        case RegisterType::uint32:
            return with(std::uint32_t{});
        case RegisterType::int64:
            return with(std::int64_t{});
        case RegisterType::uint64:
            return with(std::uint64_t{});
        case RegisterType::real32:
            return with(float{});
        case RegisterType::real64:
            return with(double{});
        case RegisterType::bit:
        case RegisterType::uint16:
            break;
    }
    return with(std::uint16_t{});
}

std::uint16_t ordered(const MappedSignal& signal, std::uint16_t word) {
    return signal.little ? static_cast<std::uint16_t>(word << 8 | word >> 8) : word;
}

/// By which power of 2^16 the register at `place` counts.
int power(const MappedSignal& signal, int place) {
    return 16 * (signal.low_first ? place : signal.count - 1 - place);
}

std::optional<Value> value_of(const MappedSignal& mapped, double number) {
    const Signal& signal = mapped.signal;
    if (!std::isfinite(number)) return {};
    if (signal.type == Type::real) return number;
    if (signal.type == Type::boolean)
        return number == 0 || number == 1 ? std::optional<Value>(number == 1) : std::nullopt;
    if (number != std::trunc(number) || number < -0x1p63 || number >= 0x1p64) return {};
    const auto value = whole_value(static_cast<Wide>(number), signal.type);
    const bool is_named = value && signal.type == Type::enumeration;
    return is_named && !signal.names.takes(std::get<std::int64_t>(*value)) ? std::nullopt : value;
}

}  // namespace

void to_registers(const MappedSignal& signal, const Value& value, std::span<std::uint16_t> to) {
    const auto integer = is_integer(signal.signal.type) ? whole(value) : std::nullopt;
    const std::uint64_t bits = with_type(signal.type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::numeric_limits<T>::is_integer)
            if (integer && signal.divisor != 0) return bits_of(nearest_of<T>(*integer, signal));
        return bits_of(nearest_of<T>(as_real(value) / signal.scale));
    });
    for (int i = 0; i < signal.count; ++i)
        to[static_cast<std::size_t>(i)] =
            ordered(signal, static_cast<std::uint16_t>(bits >> power(signal, i)));
}

std::optional<Value> from_registers(const MappedSignal& signal,
                                    std::span<const std::uint16_t> from) {
    std::uint64_t bits = 0;
    for (int i = 0; i < signal.count; ++i)
        bits |= std::uint64_t{ordered(signal, from[static_cast<std::size_t>(i)])}
                << power(signal, i);
    return with_type(signal.type, [&](auto zero) -> std::optional<Value> {
        using T = decltype(zero);
        if constexpr (std::is_same_v<T, float>) {
            zero = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        } else if constexpr (std::is_same_v<T, double>) {
            zero = std::bit_cast<double>(bits);
        } else {
            zero = static_cast<T>(bits);
            if (is_integer(signal.signal.type) && signal.divisor != 0) return scaled(zero, signal);
        }
        return value_of(signal, static_cast<double>(zero) * signal.scale);
    });
}

}  // namespace lineshaft
