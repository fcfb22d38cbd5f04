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
/// of the order that makes them smallest (0 stands before the first of them), the few that take
/// more bytes than the rest apart. Numbers are as a page's typed arrays have them
/// (little-endian, two's complement), but with the bytes of one significance side by side.
/// tools/report/page/decode.js undoes it.
struct PackedSamples {  // of fewer than 2^32 samples
    std::size_t count = 0;
    double scale = 1;          ///< value = whole number times scale
    std::size_t order = 0;     ///< of the differences
    std::size_t width = 0;     ///< bytes of a difference: 0 (all are zero), 1, 2 or 4
    std::size_t outliers = 0;  ///< differences that take more; 0 stands in their places
    std::vector<std::pair<std::size_t, std::size_t>> missing;  ///< first and count of each stretch
    /// The outliers as doubles; how far each lies behind the one before it (the first one: behind
    /// sample 0), as uint32; `count` differences of `width` bytes.
    std::string bytes;
};

/// Whole numbers below 2^49 stay as they are. Others are rounded to a step of 2^-40 of the power of
/// two above the largest of them; to 2^-24 of it, as a float has it, if they are noise that would
/// take more than three bytes a sample. What is not finite counts as missing.
PackedSamples pack(std::span<const double> samples);

/// Samples that share a pair of extremes.
inline constexpr std::size_t extremes_chunk = 256;

/// The least and the greatest of each chunk of samples (the last one may be shorter), so that a
/// wide view of a page needs no samples: of all chunks the one that comes first, then of all chunks
/// the other one. NaN where a chunk has no finite sample.
std::vector<double> chunk_extremes(std::span<const double> samples);

/// In zlib format.
std::string deflated(const std::string& bytes);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

}  // namespace lineshaft
