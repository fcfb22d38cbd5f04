#include "tests/allocations.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

thread_local std::int64_t count = 0;

void* try_allocate(std::size_t size, std::size_t alignment) {
    ++count;
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* allocate(std::size_t size, std::size_t alignment) {
    void* const place = try_allocate(size, alignment);
    if (!place) throw std::bad_alloc();
    return place;
}

constexpr std::size_t usual = alignof(std::max_align_t);

}  // namespace

std::int64_t lineshaft::test::allocations() {
    return count;
}

// Sanitizers bring all of these, so all are replaced together.
void* operator new(std::size_t size) {
    return allocate(size, usual);
}
void* operator new[](std::size_t size) {
    return allocate(size, usual);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return try_allocate(size, usual);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return try_allocate(size, usual);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* place) noexcept {
    std::free(place);
}
void operator delete[](void* place) noexcept {
    std::free(place);
}
void operator delete(void* place, std::size_t) noexcept {
    std::free(place);
}
void operator delete[](void* place, std::size_t) noexcept {
    std::free(place);
}
void operator delete(void* place, const std::nothrow_t&) noexcept {
    std::free(place);
}
void operator delete[](void* place, const std::nothrow_t&) noexcept {
    std::free(place);
}
void operator delete(void* place, std::align_val_t) noexcept {
    std::free(place);
}
void operator delete[](void* place, std::align_val_t) noexcept {
    std::free(place);
}
void operator delete(void* place, std::size_t, std::align_val_t) noexcept {
    std::free(place);
}
void operator delete[](void* place, std::size_t, std::align_val_t) noexcept {
    std::free(place);
}
