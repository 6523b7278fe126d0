// Vectors of large tables that are read at random. On Linux their memory is asked to be in huge
// pages: a lookup then misses the cache, but not the translation of its address as well.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace whit {

template <typename T>
class HugePageAllocator {
 public:
  using value_type = T;

  HugePageAllocator() = default;
  template <typename U>
  HugePageAllocator(const HugePageAllocator<U>&) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) {
    if (n > kMostBytes / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = n * sizeof(T);

    // Small tables would waste most of a page.
    const std::size_t alignment = bytes >= kHugePage ? kHugePage : kCacheLine;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;

    void* const memory = std::aligned_alloc(alignment, rounded);
    if (!memory) throw std::bad_alloc();

#if defined(__linux__)
    // The advice is a hint. Without huge pages the table is only slower.
    if (alignment == kHugePage) madvise(memory, rounded, MADV_HUGEPAGE);
#endif

    return static_cast<T*>(memory);
  }

  void deallocate(T* memory, std::size_t) { std::free(memory); }

  template <typename U>
  bool operator==(const HugePageAllocator<U>&) const {
    return true;
  }

 private:
  static constexpr std::size_t kHugePage = std::size_t{2} << 20, kCacheLine = 64;
  static constexpr std::size_t kMostBytes = (static_cast<std::size_t>(-1) >> 1) - kHugePage;
};

template <typename T>
using HugeVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace whit
