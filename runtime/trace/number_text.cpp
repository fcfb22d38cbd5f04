#include "runtime/trace/number_text.hpp"

#include <charconv>
#include <cmath>

#include <fmt/compile.h>

namespace lineshaft {

namespace {

constexpr double below_exponent = 1e15;

bool is_small_integer(double value) {
    return std::abs(value) < below_exponent &&
           value == static_cast<double>(static_cast<std::int64_t>(value)) &&
           !(value == 0 && std::signbit(value));
}

}  // namespace

char* write_integer(char* to, std::int64_t value) {
    return std::to_chars(to, to + longest_number, value).ptr;
}

char* write_real(char* to, double value) {
    if (is_small_integer(value)) return write_integer(to, static_cast<std::int64_t>(value));
    if (!std::isfinite(value)) return to;
    return fmt::format_to(to, FMT_COMPILE("{}"), value);
}

char* write_seconds(char* to, std::int64_t nanoseconds) {
    constexpr std::uint64_t second = 1'000'000'000;
    auto whole = static_cast<std::uint64_t>(nanoseconds);
    if (nanoseconds < 0) {
        *to++ = '-';
        whole = 0 - whole;
    }
    to = std::to_chars(to, to + longest_number, whole / second).ptr;
    std::uint64_t part = whole % second;
    if (part == 0) return to;
    *to = '.';
    for (int i = 9; i > 0; --i, part /= 10) to[i] = static_cast<char>('0' + part % 10);
    for (to += 9; *to == '0';) --to;
    return to + 1;
}

}  // namespace lineshaft
