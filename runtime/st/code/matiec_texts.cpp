#include <cmath>

#include "runtime/source/letters.hpp"
#include "runtime/st/code/meaning.hpp"

namespace lineshaft::st::meaning {

namespace {

/// A point that does not begin the text.
bool has_point(std::string_view text) {
    const std::size_t point = text.rfind('.');
    return point != text.npos && point > 0;
}

/// What is no digit is passed over. The digits of 2# and 8# are shifted in an int, which on x86
/// goes by as many places modulo 32.
std::uint64_t with_base(std::string_view digits, unsigned bits) {
    std::uint64_t value = 0;
    unsigned shift = 0;
    for (std::size_t i = digits.size(); i > 0 && shift < 64; --i) {
        const int digit = digit_of(digits[i - 1]);
        if (digit >= 1 << bits) continue;
        const auto of_int = static_cast<std::uint32_t>(digit) << (shift & 31);
        value |= bits == 4
                     ? static_cast<std::uint64_t>(digit) << shift
                     : static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(of_int)});
        shift += bits;
    }
    return value;
}

std::uint64_t whole_of(std::string_view text) {
    if (text.starts_with("2#")) return with_base(text.substr(2), 1);
    if (text.starts_with("8#")) return with_base(text.substr(2), 3);
    if (text.starts_with("16#")) return with_base(text.substr(3), 4);
    constexpr int most_digits = 20;
    const std::uint64_t sign = text.starts_with('-') ? ~std::uint64_t{0} : 1;
    std::uint64_t value = 0, unit = sign;
    int digits = 0;
    for (std::size_t i = text.size(); i > 0 && digits < most_digits; --i) {
        const auto c = static_cast<signed char>(text[i - 1]);
        if (c >= '0' && c <= '9') {
            value += static_cast<std::uint64_t>(c - '0') * unit;
            unit *= 10;
            ++digits;
        } else if (c >= '.') {
            value = 0;
            unit = sign;
            digits = 0;
        }
    }
    return value;
}

}  // namespace

std::uint64_t matiec_find_text(const std::byte* in, const std::byte* what) {
    const std::string_view text = text_at(in), wanted = text_at(what);
    if (wanted.empty()) return 0;
    std::size_t first = 0, equal = 0;
    while (first + equal < text.size() && equal < wanted.size()) {
        if (text[first + equal] == wanted[equal]) {
            ++equal;
        } else {
            first += equal + 1;
            equal = 0;
        }
    }
    return equal == wanted.size() ? first + 1 : 0;
}

std::uint64_t matiec_integer_of_text(const std::byte* from, bool is_time) {
    const std::string_view text = text_at(from);
    if (!is_time || !has_point(text)) return whole_of(text);
    const double seconds = std::trunc(number_of_text<double>(from, false));
    return fits<std::int64_t>(seconds) ? whole<std::int64_t>(seconds) : std::uint64_t{1} << 63;
}

double matiec_real_of_text(const std::byte* from) {
    const std::string_view text = text_at(from);
    return has_point(text) ? number_of_text<double>(from, false)
                           : static_cast<double>(static_cast<std::int64_t>(whole_of(text)));
}

}  // namespace lineshaft::st::meaning
