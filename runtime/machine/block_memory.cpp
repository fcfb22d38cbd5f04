#include "runtime/machine/block_memory.hpp"

#include <new>

#include <sys/mman.h>

namespace lineshaft {

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

std::align_val_t alignment_of(std::size_t bytes) {
    return std::align_val_t(bytes < huge_page ? alignof(std::max_align_t) : huge_page);
}

}  // namespace

std::byte* HugePages::allocate(std::size_t count) {
    void* const memory = ::operator new(count, alignment_of(count));
    if (count >= huge_page) ::madvise(memory, count, MADV_HUGEPAGE);  // or it stays as it is
    return static_cast<std::byte*>(memory);
}

void HugePages::deallocate(std::byte* memory, std::size_t count) noexcept {
    ::operator delete(memory, alignment_of(count));
}

}  // namespace lineshaft
