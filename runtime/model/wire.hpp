#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "runtime/model/scan.hpp"
#include "runtime/model/value.hpp"

namespace lineshaft {

/// A value on its way into an input, before the block is called.
struct Copy {
    const std::byte* source = nullptr;
    std::byte* target = nullptr;
    bool negates = false;  ///< a boolean (`NOT x.q`)
};

/// What becomes of it on the way.
enum class Transfer : std::uint8_t {
    boolean,  ///< 1 byte, negated or as it is: Copy::negates
    plain,    ///< 1 byte, as it is
    negated,  ///< 1 byte, negated
    word,     ///< 8 bytes, as they are
    widened,  ///< an integer to a real
};

/// What arrives.
template <Transfer transfer>
auto fetch(const Copy& wire) {
    if constexpr (transfer == Transfer::boolean)
        return read<bool>(wire.source) != wire.negates;
    else if constexpr (transfer == Transfer::plain)
        return read<bool>(wire.source);
    else if constexpr (transfer == Transfer::negated)
        return !read<bool>(wire.source);
    else if constexpr (transfer == Transfer::word)
        return read<std::uint64_t>(wire.source);
    else
        return static_cast<double>(read<std::int64_t>(wire.source));
}

template <Transfer transfer>
void deliver(const Copy& wire) {
    const auto value = fetch<transfer>(wire);
    std::memcpy(wire.target, &value, sizeof value);
}

/// What feeds a call: what most of them have, or else all kinds.
enum class Feed : std::uint8_t {
    no_wire,
    boolean,
    negated,
    two_booleans,
    two_some_negated,
    word,
    two_words,
    widened,
    many
};

/// A block, or the first of several, and what feeds it.
struct FedBlock {
    Copy copies[2] = {};  ///< unless Feed::many
    std::byte* first = nullptr;
};

/// Feeds and scans. True when a block has an error.
using FeedAndScan = bool (*)(const FedBlock& block, const Scan& now);

/// The input of a kind of block that most are fed by alone: its value, of the first copy, is at
/// hand when the block is scanned, and need not come back from memory.
struct MainInput {
    std::size_t offset = 0;                                       ///< in the block's struct
    FeedAndScan scan[static_cast<std::size_t>(Feed::many)] = {};  ///< by Feed; null: another type
};

}  // namespace lineshaft
