#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lineshaft {

/// The samples of one column made small for a page: whole numbers times a scale, their differences
/// of the order that makes them smallest (0 stands before the first of them), zigzag (0, -1, 1, -2
/// become 0, 1, 2, 3), the bytes of one significance side by side, deflated.
/// tools/report/page/decode.js undoes it.
struct PackedSamples {
    std::size_t count = 0;
    double scale = 1;               ///< value = whole number times scale
    std::size_t order = 0;          ///< of the differences
    std::size_t width = 0;          ///< bytes of a difference, but of the outliers
    std::size_t outliers = 0;       ///< differences that take more bytes; 0 stands in their places
    std::size_t outlier_width = 0;  ///< bytes of one, and of how far it is from the one before
    std::vector<std::pair<std::size_t, std::size_t>> missing;  ///< first and count of each stretch
    /// In zlib format: `width` planes of `count` bytes, the lowest byte first; then, in
    /// `outlier_width` planes of `outliers` bytes each, how far each outlier lies behind the one
    /// before it (the first one: behind sample 0); then the outliers.
    std::string planes;
};

/// Whole numbers below 2^49 stay as they are. Others are rounded to a step of 2^-40 of the power of
/// two above the largest of them; to 2^-24 of it, as a float has it, if they are noise that would
/// take more than three bytes a sample. What is not finite counts as missing.
PackedSamples pack(std::span<const double> samples);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

}  // namespace lineshaft
