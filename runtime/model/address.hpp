#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lineshaft {

/// A place in a program's process image, by its bytes.
struct ImageAddress {
    enum class Area : std::uint8_t { input, output, memory };  ///< I, Q, M

    Area area = Area::input;
    std::uint32_t byte = 0;  ///< the first
    std::uint8_t bit = 0;    ///< of a bit
    std::uint8_t bits = 1;   ///< 1, 8, 16, 32, 64: X, B, W, D, L

    std::uint32_t end() const { return byte + (bits + 7U) / 8; }  ///< byte behind it
    bool operator==(const ImageAddress&) const = default;
};

/// What the number of an address counts.
enum class AddressCount : std::uint8_t {
    bytes,        ///< `%MW1` has the second byte of `%MW0`
    sizes,        ///< `%MW1` is the second word, `%MX1.0` a bit of the second byte
    words,        ///< as sizes, and `%MX1.9` is a bit of `%MW1`
    sizes_apart,  ///< as sizes, which share no bits; `%QX12` is `%QX12.0`, as in OpenPLC
};

inline constexpr int areas = 3;

/// Bytes that an area may have.
inline constexpr std::uint32_t longest_area = 65536;

/// Also `%IR2`, a REAL's place on OWEN's controllers, as `%ID2`, `%I0.3` and, as the standard
/// numbers bits, `%IX3`. Of a hierarchy, `%IW1.2`, `%QX1.2.3`, each number before the last one (of
/// a bit, its own) counts 256 of the next, of three numbers 64, of four 16 and of five 8 (in
/// CODESYS always 256): `%IW1.2` is the word of number 258, at byte 516. Empty where the text is
/// none; it may lie beyond its area.
std::optional<ImageAddress> read_address(std::string_view text, AddressCount count);

/// `%MW0..%MW99`: one behind the other, without gaps; of an address alone it is it. Empty for what
/// is none, or leaves its area.
std::vector<ImageAddress> addresses_of_range(std::string_view text, AddressCount count);

/// In capital letters, with its size: `%IX0.3`.
std::string text_of(const ImageAddress& address, AddressCount count);

}  // namespace lineshaft
