#include "runtime/st/types/s5.hpp"

#include <algorithm>
#include <charconv>

#include "runtime/source/letters.hpp"

namespace lineshaft::st {

namespace {

Type named(Type::Kind kind, const char* name, bool is_signed) {
    Type type;
    type.kind = kind;
    type.name = name;
    type.bits = 16;
    type.is_signed = is_signed;
    return type;
}

const Type s5time = named(Type::Kind::bits, "S5TIME", false),
           timer = named(Type::Kind::integer, "TIMER", true),
           counter = named(Type::Kind::integer, "COUNTER", true);

}  // namespace

const Type &s5time_type = s5time, &timer_type = timer, &counter_type = counter;

const Type* find_s5_type(std::string_view name) {
    for (const Type* type : {&s5time, &timer, &counter})
        if (same_name(name, type->name)) return type;
    return nullptr;
}

std::optional<S5Number> read_s5_number(std::string_view name) {
    const std::string_view digits = name.substr(std::min<std::size_t>(1, name.size()));
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || number < 0 || number > 2047)
        return {};
    const char letter = upper(name[0]);
    if (letter == 'T') return S5Number{&timer, number};
    return letter == 'C' || letter == 'Z' ? std::optional(S5Number{&counter, number})
                                          : std::nullopt;
}

std::optional<Wide> three_digits(Wide value) {
    if (value < 0 || value > 999) return {};
    return value / 100 * 256 + value / 10 % 10 * 16 + value % 10;
}

std::optional<Wide> s5time_of(Wide nanoseconds) {
    constexpr Wide shortest = 10'000'000, bases = 4;
    Wide units = nanoseconds / shortest, base = 0;
    if (nanoseconds < 0) return {};
    for (; units > 999 && base + 1 < bases; ++base) units /= 10;
    const auto digits = three_digits(units);
    return digits ? std::optional(base * 4096 + *digits) : std::nullopt;
}

}  // namespace lineshaft::st
