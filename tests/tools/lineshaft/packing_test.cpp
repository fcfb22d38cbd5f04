#include "tools/lineshaft/packing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <catch2/catch.hpp>
#include <libdeflate.h>

using namespace lineshaft;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Takes `count` numbers from the front, their bytes of one significance side by side.
std::vector<std::uint64_t> take(std::string_view& bytes, std::size_t width, std::size_t count) {
    std::vector<std::uint64_t> values(count);
    for (std::size_t i = 0; i < width * count; ++i)
        values[i % count] |= std::uint64_t{static_cast<unsigned char>(bytes.at(i))}
                             << (8 * (i / count));
    bytes.remove_prefix(width * count);
    return values;
}

std::vector<std::int64_t> differences(const PackedSamples& packed) {
    REQUIRE(packed.bytes.size() == packed.width * packed.count + 12 * packed.outliers);
    std::string_view bytes = packed.bytes;
    const auto outliers = take(bytes, 8, packed.outliers);
    const auto gaps = take(bytes, 4, packed.outliers);
    std::vector<std::int64_t> values;
    const std::size_t above = packed.width == 0 ? 0 : 64 - 8 * packed.width;
    for (const std::uint64_t value : take(bytes, packed.width, packed.count))
        values.push_back(static_cast<std::int64_t>(value << above) >> above);
    std::size_t place = 0;
    for (std::size_t k = 0; k < packed.outliers; ++k)
        values.at(place += gaps[k]) = static_cast<std::int64_t>(std::bit_cast<double>(outliers[k]));
    return values;
}

/// As tools/report/page/decode.js does it.
std::vector<double> unpack(const PackedSamples& packed) {
    std::vector<std::int64_t> values = differences(packed);
    for (std::size_t order = packed.order; order-- > 0;)
        for (std::size_t i = 1; i < values.size(); ++i) values[i] += values[i - 1];
    std::vector<double> samples(packed.count);
    for (std::size_t i = 0; i < packed.count; ++i)
        samples[i] = static_cast<double>(values[i]) * packed.scale;
    for (const auto& [first, count] : packed.missing)
        std::fill_n(samples.begin() + static_cast<std::ptrdiff_t>(first), count, missing);
    return samples;
}

double greatest_error(const std::vector<double>& samples) {
    const std::vector<double> back = unpack(pack(samples));
    REQUIRE(back.size() == samples.size());
    double worst = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        REQUIRE(std::isnan(back[i]) == !std::isfinite(samples[i]));
        if (!std::isnan(back[i])) worst = std::max(worst, std::abs(back[i] - samples[i]));
    }
    return worst;
}

}  // namespace

TEST_CASE("whole numbers come back exactly", "[packing]") {
    CHECK(greatest_error({}) == 0);
    CHECK(greatest_error({7}) == 0);
    CHECK(greatest_error({0, 1, 0, 0, 1}) == 0);
    CHECK(greatest_error({-3, 0x1p49 - 1, 1 - 0x1p49, 12, 0}) == 0);
    std::mt19937_64 random(1);
    std::vector<double> samples(1000);
    for (double& sample : samples) sample = std::floor(std::ldexp(random(), -16)) - 0x1p47;
    CHECK(greatest_error(samples) == 0);
}

TEST_CASE("reals come back to 2^-41 of the power of two above the largest, noise to 2^-25",
          "[packing]") {
    std::vector<double> samples(5000);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = 20 * std::sin(1e-3 * static_cast<double>(i));
    CHECK(greatest_error(samples) <= 32 * 0x1p-41);
    CHECK(greatest_error({0.1, 1e-300, -0.3}) <= 0.5 * 0x1p-25);
    CHECK(greatest_error({1.5e300, -1e300, 3}) <= 0x1p998 * 0x1p-25);
    CHECK(greatest_error({5e-324, 1e-310}) <= 1e-300);
}

TEST_CASE("missing samples stay missing", "[packing]") {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    CHECK(greatest_error({missing, missing, 1, 2, missing, 3, infinite}) == 0);
    CHECK(greatest_error({missing}) == 0);
    CHECK(pack(std::vector<double>{missing, missing, 0.5, missing}).missing ==
          std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {3, 1}});
}

TEST_CASE("a straight line takes next to nothing, noise no more than a float", "[packing]") {
    std::vector<double> line(100000), noise(100000);
    std::mt19937_64 random(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i] = 0.0125 * static_cast<double>(i);
        noise[i] = std::ldexp(random(), -64);
    }
    CHECK(deflated(pack(line).bytes).size() < line.size() / 4);
    CHECK(deflated(pack(noise).bytes).size() < noise.size() * 4);
    CHECK(greatest_error(noise) <= 0x1p-25);
}

TEST_CASE("a few wide differences among narrow ones are outliers and cost little", "[packing]") {
    std::vector<double> steps(100000);
    for (std::size_t i = 0; i < steps.size(); ++i)
        steps[i] = std::floor(static_cast<double>(i) / 1000) * 0x1p40;
    const PackedSamples packed = pack(steps);
    CHECK(packed.width == 0);
    CHECK(packed.outliers == 99);
    CHECK(deflated(packed.bytes).size() < 1000);
    CHECK(greatest_error(steps) == 0);
}

TEST_CASE("deflated bytes come back", "[packing]") {
    const std::string bytes(100000, 'x');
    const std::string small = deflated(bytes);
    CHECK(small.size() < 1000);
    std::string back(bytes.size(), '\0');
    libdeflate_decompressor* const decompressor = libdeflate_alloc_decompressor();
    CHECK(libdeflate_zlib_decompress(decompressor, small.data(), small.size(), back.data(),
                                     back.size(), nullptr) == LIBDEFLATE_SUCCESS);
    libdeflate_free_decompressor(decompressor);
    CHECK(back == bytes);
}

TEST_CASE("extremes of a chunk stand in the order of their samples", "[packing]") {
    CHECK(chunk_extremes({}).empty());
    std::vector<double> samples(3 * extremes_chunk + 1, missing);
    std::fill_n(samples.begin(), extremes_chunk, 1);
    samples[7] = 5;
    samples[9] = -2;
    samples[extremes_chunk + 3] = -8;
    samples[extremes_chunk + 4] = std::numeric_limits<double>::infinity();
    samples[extremes_chunk + 5] = 4;
    samples.back() = 6;
    const std::vector<double> found = chunk_extremes(samples);
    const std::vector<double> wanted{5, -8, missing, 6, -2, 4, missing, 6};
    REQUIRE(found.size() == wanted.size());
    for (std::size_t k = 0; k < found.size(); ++k)
        CHECK((found[k] == wanted[k] || (std::isnan(found[k]) && std::isnan(wanted[k]))));
}

TEST_CASE("base64 as RFC 4648 has it", "[packing]") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe\xfd") == "//79");
}
