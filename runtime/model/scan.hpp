#pragma once

#include <cstddef>
#include <cstdint>
#include <new>

namespace lineshaft {

struct BlockType;

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
    std::byte* const* seen = nullptr;  ///< the same, those of other tasks as they published them
    const BlockType* const* types = nullptr;  ///< of the blocks, by number
    std::byte* memory = nullptr;              ///< of the whole machine
    int task = -1;                            ///< that scans the block
    int blocks = 0;                           ///< how many the program has
    const std::int64_t* published = nullptr;  ///< scans of each task whose outputs all others see

    /// The block that a reference names.
    template <class Block>
    Block& instance(std::int64_t number) const {
        return *std::launder(reinterpret_cast<Block*>(instances[number]));
    }

    /// The same to read from: as wires see it.
    template <class Block>
    const Block& seen_instance(std::int64_t number) const {
        return *std::launder(reinterpret_cast<const Block*>(seen[number]));
    }

    /// What a block keeps in place of a pointer, so that a checkpoint of the bytes is all there is:
    /// the place of something in the machine's memory.
    template <class T>
    std::int64_t place_of(const T& in_memory) const {
        return reinterpret_cast<const std::byte*>(&in_memory) - memory;
    }
    template <class T>
    T& at(std::int64_t place) const {
        return *std::launder(reinterpret_cast<T*>(memory + place));
    }

    /// Whether all others see what that scan of a task has written.
    bool is_published(std::int64_t by_task, std::int64_t scan) const {
        return published[by_task] > scan;
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
