#pragma once

#include <cstddef>
#include <vector>

namespace lineshaft {

/// What is larger than a huge page begins at one, and the system is asked for huge pages: thousands
/// of axes, of which a scan touches a few lines each, are otherwise as many misses of the
/// processor's address translation.
struct HugePages {
    using value_type = std::byte;
    template <class>
    struct rebind {
        using other = HugePages;
    };

    std::byte* allocate(std::size_t count);
    void deallocate(std::byte* memory, std::size_t count) noexcept;

    bool operator==(const HugePages&) const = default;
};

/// Memory of a machine's blocks and inputs.
using BlockMemory = std::vector<std::byte, HugePages>;

}  // namespace lineshaft
