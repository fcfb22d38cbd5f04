#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "runtime/model/catalog.hpp"

namespace lineshaft {

/// The machine that a block's kept state has been read into, for the block to say whether it may go
/// on with that: `bool is_valid(const Block&, const KeptState&)`. The state is somebody's bytes: a
/// boolean may be neither true nor false, so booleans and enumerations are asked about before they
/// are used. Of fields the runtime has asked already.
struct KeptState {
    Context context;       ///< of the block's task; not live: others are seen so, too
    std::int64_t now = 0;  ///< of the machine [ns]
    std::int64_t tasks = 0;
    bool is_live = true;  ///< else what others see of the block, maybe of an earlier scan
    const std::vector<std::int64_t>* links = nullptr;  ///< places of all BlockType::link, sorted

    bool is_task(std::int64_t number) const { return number >= 0 && number < tasks; }
    bool is_link(std::int64_t place) const {
        return std::binary_search(links->begin(), links->end(), place);
    }
    /// Near enough to reckon with.
    bool is_moment(std::int64_t time) const {
        constexpr std::int64_t far = std::int64_t{1} << 61;
        return time > -far && time < far;
    }
};

/// A number that may still be counted on.
constexpr bool is_count(std::int64_t number) {
    return number >= 0 && number < std::int64_t{1} << 62;
}

/// By their bytes.
template <class... Boolean>
bool are_booleans(const Boolean&... values) {
    static_assert((sizeof(Boolean) + ...) == sizeof...(Boolean));
    const auto byte = [](const auto& value) {
        unsigned char bits = 0;
        std::memcpy(&bits, &value, 1);
        return bits;
    };
    return ((byte(values) <= 1) && ...);
}

/// `last` is the greatest.
template <class Enumeration>
constexpr bool is_one_of(Enumeration value, Enumeration last) {
    return value >= Enumeration{} && value <= last;
}

/// Whether booleans, enumerations and references of a block's fields are such, and what the kind
/// itself says.
bool is_valid(const BlockType& type, const std::byte* block, const KeptState& machine);

}  // namespace lineshaft
