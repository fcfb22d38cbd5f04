#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

/// Numbers for addresses, of 32 bits, which a program may keep, reckon with, and make pointers of
/// again. A variable gets a range of numbers, a byte each, when one of its addresses becomes a
/// number first; so a number leads to a variable that had one, or nowhere. Nothing here throws.
namespace lineshaft::st {

struct Code;

/// Variables that may have numbers, and places of the table in which they are found, where each is
/// near the one that its address says.
inline constexpr std::uint32_t most_numbered = 3072, numbered_places = 4096;

/// The two variables of a program that have them.
struct NumberedAddresses {
    std::byte* references = nullptr;  ///< `numbered_places` references, to the first bytes
    /// How many there are, the first number of each place, and their places, in the order of these.
    std::byte* numbers = nullptr;
};
/// Slots of that one.
inline constexpr std::uint32_t slots_of_numbers = 1 + numbered_places + most_numbered;

/// The number of what a reference is to: 0 of NULL. Empty: there are too many variables.
std::optional<std::uint64_t> number_of_reference(const Code& code, const std::byte* reference,
                                                 const NumberedAddresses& known);

/// What has that number becomes `reference`, or NULL: nothing has.
void find_reference(const Code& code, std::uint64_t number, const NumberedAddresses& known,
                    std::byte* reference);

}  // namespace lineshaft::st
