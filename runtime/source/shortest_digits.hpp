#pragma once

#include <cstdint>

namespace lineshaft {

/// digits * 10^exponent
struct ShortDecimal {
    std::uint64_t digits;  ///< at most 17 of them
    int exponent;
};

/// The decimal number of fewest digits that reads back as the finite value > 0, of several the
/// nearest to it; it may end in zeros. After Raffaele Giulietti, "The Schubfach way to render
/// doubles" (2020).
///
/// The value is c 2^q. What reads back as it lies between the middles to its neighbours,
/// (c - 1/2) 2^q and (c + 1/2) 2^q: both belong to it where c is even, and the lower one is nearer
/// where c is a power of two. Let 10^k be the greatest power of ten within their distance. Then
/// there is a multiple of 10^k between them, and one of 10^(k+1) at most: that is the shortest
/// number, and without it the nearest multiple of 10^k is.
///
/// So all three numbers are counted in quarters of 10^k, and compared with multiples of four and
/// forty. A quarter is 2^-h of a power of ten with 128 digits (base two) that is rounded up, a
/// constant. Of a product the whole part counts, made odd where something is left over: then it is
/// neither on a multiple nor beyond one that it does not reach. 128 digits suffice for each double.
ShortDecimal shortest_digits(double value);

}  // namespace lineshaft
