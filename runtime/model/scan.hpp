#pragma once

#include <cstddef>
#include <cstdint>
#include <new>

namespace lineshaft {

/// What a block knows of the moment it is called.
struct Scan {
    std::int64_t time =
        0;  ///< start of this scan in virtual time [ns], the same for all its blocks
    std::int64_t interval = 0;  ///< nominal interval of the task [ns]
    std::int64_t index = 0;     ///< scans of this task before this one
};

/// What a block is given besides its own memory. It outlives the run and does not change in it.
struct Context {
    const void* kind = nullptr;  ///< what all blocks of the kind share: BlockType::context
    std::byte* const* instances = nullptr;  ///< the program's blocks, by number

    /// The block that a reference names.
    template <class Block>
    Block& instance(std::int64_t number) const {
        return *std::launder(reinterpret_cast<Block*>(instances[number]));
    }
};

/// True once per rising edge of `now`; `last` remembers.
template <class Level>
bool rising_edge(bool now, Level& last) {
    const bool edge = now && !last;
    last = now;
    return edge;
}

/// Nanoseconds to seconds; correctly rounded.
constexpr double seconds(std::int64_t nanoseconds) {
    return static_cast<double>(nanoseconds) / 1e9;
}

}  // namespace lineshaft
