#include "tools/lineshaft/packing.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <new>

#include <libdeflate.h>

namespace lineshaft {

namespace {

constexpr double largest_whole = 0x1p49;  // differences of third order are below 2^53
constexpr int fine_bits = 40, coarse_bits = 24;
constexpr std::size_t highest_order = 3;
constexpr std::array<std::size_t, 4> widths{0, 1, 2, 4};  // of a page's arrays of whole numbers
constexpr std::size_t outlier_bytes = sizeof(double) + sizeof(std::uint32_t);
constexpr double noise_bits = 24;  // a sample

using Whole = std::vector<std::int64_t>;

/// The bits of a value with its sign.
std::size_t bits_of(std::int64_t value) {
    const auto size = static_cast<std::uint64_t>(value ^ (value >> 63));
    return value == 0 ? 0 : static_cast<std::size_t>(std::bit_width(size)) + 1;
}

bool is_whole(double value) {
    return !std::isfinite(value) || (std::trunc(value) == value && std::abs(value) < largest_whole);
}

/// `bits` below the power of two above the largest sample.
double step(std::span<const double> samples, int bits) {
    double largest = 0;
    for (const double value : samples)
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    int exponent = 0;
    std::frexp(largest, &exponent);
    return std::ldexp(1, std::max(exponent - bits, std::numeric_limits<double>::min_exponent));
}

/// Missing samples repeat the one before them, which costs nothing.
Whole whole_numbers(std::span<const double> samples, double scale) {
    Whole whole(samples.size());
    std::int64_t last = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (std::isfinite(samples[i])) last = std::llround(samples[i] / scale);
        whole[i] = last;
    }
    return whole;
}

void difference(Whole& values) {
    for (std::size_t i = values.size(); i-- > 1;) values[i] -= values[i - 1];
}

double bits_per_sample(const Whole& values) {
    std::size_t bits = 0;
    for (const std::int64_t value : values) bits += bits_of(value);
    return static_cast<double>(bits) / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

struct Differences {
    Whole values;
    std::size_t order = 0;
    double bits = 0;
};

/// The differences of the order that takes the fewest bits.
Differences smallest_differences(Whole values) {
    Differences best{.values = values, .order = 0, .bits = bits_per_sample(values)};
    for (std::size_t order = 1; order <= highest_order; ++order) {
        difference(values);
        const double bits = bits_per_sample(values);
        if (bits < best.bits) best = {values, order, bits};
    }
    return best;
}

bool fits(std::int64_t value, std::size_t width) {
    return bits_of(value) <= 8 * width;
}

/// The width that leaves the fewest bytes in all, those of the outliers counted.
std::size_t best_width(const Whole& values) {
    std::array<std::size_t, widths.size()> bytes{};
    for (std::size_t k = 0; k < widths.size(); ++k) {
        const auto wider = std::ranges::count_if(
            values, [&](std::int64_t value) { return !fits(value, widths[k]); });
        bytes[k] = widths[k] * values.size() + outlier_bytes * static_cast<std::size_t>(wider);
    }
    return widths[static_cast<std::size_t>(std::ranges::min_element(bytes) - bytes.begin())];
}

/// The bytes of one significance side by side, the lowest first.
void append_planes(std::string& bytes, const std::vector<std::uint64_t>& values,
                   std::size_t width) {
    for (std::size_t plane = 0; plane < width; ++plane)
        for (const std::uint64_t value : values)
            bytes += static_cast<char>(value >> (8 * plane) & 0xff);
}

std::string laid_down(const Whole& differences, PackedSamples& packed) {
    packed.width = best_width(differences);
    std::vector<std::uint64_t> outliers, gaps, rest(differences.begin(), differences.end());
    std::size_t last = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        if (fits(differences[i], packed.width)) continue;
        outliers.push_back(std::bit_cast<std::uint64_t>(static_cast<double>(differences[i])));
        gaps.push_back(i - std::exchange(last, i));
        rest[i] = 0;
    }
    packed.outliers = outliers.size();
    std::string bytes;
    bytes.reserve(outlier_bytes * outliers.size() + packed.width * rest.size());
    append_planes(bytes, outliers, sizeof(double));
    append_planes(bytes, gaps, sizeof(std::uint32_t));
    append_planes(bytes, rest, packed.width);
    return bytes;
}

std::vector<std::pair<std::size_t, std::size_t>> missing_stretches(
    std::span<const double> samples) {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (std::isfinite(samples[i])) continue;
        if (!found.empty() && found.back().first + found.back().second == i)
            ++found.back().second;
        else
            found.emplace_back(i, 1);
    }
    return found;
}

}  // namespace

PackedSamples pack(std::span<const double> samples) {
    PackedSamples packed;
    packed.count = samples.size();
    packed.missing = missing_stretches(samples);
    const bool whole = std::ranges::all_of(samples, is_whole);
    if (!whole) packed.scale = step(samples, fine_bits);
    Differences best = smallest_differences(whole_numbers(samples, packed.scale));
    if (!whole && best.bits > noise_bits) {
        packed.scale = step(samples, coarse_bits);
        best = smallest_differences(whole_numbers(samples, packed.scale));
    }
    packed.order = best.order;
    packed.bytes = laid_down(best.values, packed);
    return packed;
}

std::vector<double> chunk_extremes(std::span<const double> samples) {
    const std::size_t chunks = (samples.size() + extremes_chunk - 1) / extremes_chunk;
    std::vector<double> extremes(2 * chunks, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < chunks; ++k) {
        const double *least = nullptr, *greatest = nullptr;
        const std::size_t first = k * extremes_chunk;
        for (const double& value :
             samples.subspan(first, std::min(extremes_chunk, samples.size() - first))) {
            if (!std::isfinite(value)) continue;
            if (!least || value < *least) least = &value;
            if (!greatest || value > *greatest) greatest = &value;
        }
        if (!least) continue;
        extremes[k] = *std::min(least, greatest);
        extremes[chunks + k] = *std::max(least, greatest);
    }
    return extremes;
}

std::string deflated(const std::string& bytes) {
    constexpr int level = 9;
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(level), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
    out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(),
                                        out.size()));
    return out;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t taken = std::min<std::size_t>(bytes.size() - i, 3);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (k < taken ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= taken ? letters[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace lineshaft
