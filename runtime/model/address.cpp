#include "runtime/model/address.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view area_letters = "IQM", size_letters = "XBWDLR";
constexpr std::uint8_t sizes[] = {1, 8, 16, 32, 64, 32};

/// The number at the beginning, which is taken off; empty for none, or one that is too long.
std::optional<std::uint32_t> take_number(std::string_view& text) {
    constexpr std::uint32_t most = 100'000'000;
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number > most) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

std::uint32_t bytes_of_size(const ImageAddress& address) {
    return (address.bits + 7U) / 8;
}

/// Bits that have one number before the point.
std::uint32_t bits_together(AddressCount count) {
    return count == AddressCount::words ? 16 : 8;
}

/// Numbers that each level of `%IW2.5.7.1` has below the first; so all fit into an area, but for
/// those of CODESYS.
std::uint32_t numbers_in_level(AddressCount count, std::size_t levels) {
    if (count != AddressCount::bytes) return 256;
    constexpr std::uint32_t numbers[] = {256, 64, 16, 8};
    return numbers[std::min(std::max<std::size_t>(levels, 1), std::size(numbers)) - 1];
}

void set_bit(ImageAddress& address, std::uint32_t number, std::uint32_t bit, AddressCount count) {
    address.byte = number * (bits_together(count) / 8) + bit / 8;
    address.bit = bit % 8;
}

}  // namespace

std::optional<ImageAddress> read_address(std::string_view text, AddressCount count) {
    if (text.size() < 3 || text.front() != '%') return {};
    const auto area = area_letters.find(upper(text[1]));
    const auto size = size_letters.find(upper(text[2]));
    if (area == area_letters.npos) return {};
    ImageAddress address{.area = static_cast<ImageAddress::Area>(area)};
    if (size != size_letters.npos) address.bits = sizes[size];
    text.remove_prefix(size == size_letters.npos ? 2 : 3);
    const auto first = take_number(text);
    if (!first) return {};
    address.byte = *first;
    const auto points = static_cast<std::size_t>(std::ranges::count(text, '.'));
    const std::uint32_t most_inner =
        numbers_in_level(count, address.bits > 1 ? points : points - 1);
    bool is_hierarchical = false;
    while (text.starts_with('.') && (address.bits > 1 || text.find('.', 1) != text.npos)) {
        text.remove_prefix(1);
        const auto inner = take_number(text);
        if (!inner || *inner >= most_inner || address.byte > longest_area) return {};
        address.byte = address.byte * most_inner + *inner;
        is_hierarchical = true;
    }
    if (is_hierarchical || count != AddressCount::bytes) address.byte *= bytes_of_size(address);
    if (address.bits > 1) return text.empty() ? std::optional(address) : std::nullopt;
    const std::uint32_t together = bits_together(count);
    if (text.empty() && count == AddressCount::sizes_apart) return address;
    if (text.empty()) {
        set_bit(address, *first / together, *first % together, count);
        return address;
    }
    if (text.front() != '.') return {};
    text.remove_prefix(1);
    const auto bit = take_number(text);
    if (!bit || *bit >= together || !text.empty()) return {};
    set_bit(address, address.byte, *bit, count);
    return address;
}

std::vector<ImageAddress> addresses_of_range(std::string_view text, AddressCount count) {
    const std::size_t dots = text.find("..");
    auto address = read_address(text.substr(0, dots), count);
    const auto last = dots == text.npos ? address : read_address(text.substr(dots + 2), count);
    if (!address || !last || address->area != last->area || address->bits != last->bits) return {};
    if (last->end() > longest_area) return {};
    const auto first_bit = [](const ImageAddress& a) { return 8 * a.byte + a.bit; };
    std::vector<ImageAddress> all;
    for (std::uint32_t bit = first_bit(*address); bit <= first_bit(*last); bit += address->bits) {
        address->byte = bit / 8;
        address->bit = bit % 8;
        all.push_back(*address);
    }
    return all;
}

std::string text_of(const ImageAddress& address, AddressCount count) {
    std::size_t size = 0;
    while (sizes[size] != address.bits) ++size;
    const bool is_bit = address.bits == 1;
    const std::uint32_t together = is_bit                         ? bits_together(count) / 8
                                   : count == AddressCount::bytes ? 1
                                                                  : bytes_of_size(address);
    const std::string text =
        fmt::format("%{}{}{}", area_letters[static_cast<std::size_t>(address.area)],
                    size_letters[size], address.byte / together);
    return is_bit ? fmt::format("{}.{}", text, 8 * (address.byte % together) + address.bit) : text;
}

}  // namespace lineshaft
