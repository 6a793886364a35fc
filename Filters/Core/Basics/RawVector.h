// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RawVector.h
 * @brief A std::vector of plain data whose new elements have no value, on large pages of memory.
 *
 * Setting hundreds of megabytes to zero on one thread, to be overwritten by several, takes as long
 * as the rest of their work; and random access to them on pages of 4 KB misses the table of pages
 * most of the time. Where the system can, large arrays are put on pages of 2 MB.
 */
#ifndef cdmRawVector_h
#define cdmRawVector_h

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#ifdef __linux__
#include <cstdint>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace cdm
{
template <typename T>
struct RawAllocator : std::allocator<T>
{
  template <typename Other>
  struct rebind
  {
    using other = RawAllocator<Other>;
  };

#ifdef __linux__
  T* allocate(std::size_t count)
  {
    if (count < LargePage / sizeof(T))
    {
      return std::allocator<T>::allocate(count);
    }
    void* const memory = ::operator new(count * sizeof(T), std::align_val_t(LargePage));
    // A hint only: it does not matter if it fails.
    madvise(memory, count * sizeof(T), MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count)
  {
    if (count < LargePage / sizeof(T))
    {
      std::allocator<T>::deallocate(memory, count);
    }
    else
    {
      ::operator delete(memory, std::align_val_t(LargePage));
    }
  }

  static constexpr std::size_t LargePage = std::size_t(1) << 21;
#endif

  template <typename Element>
  void construct(Element* place)
  {
    ::new (static_cast<void*>(place)) Element;
  }
  template <typename Element, typename... Arguments>
  void construct(Element* place, Arguments&&... arguments)
  {
    ::new (static_cast<void*>(place)) Element(std::forward<Arguments>(arguments)...);
  }
};

template <typename T>
using RawVector = std::vector<T, RawAllocator<T>>;

/**
 * Gives the memory of the elements from begin to end back to the system, where it takes it before
 * the vector ends. Their values are lost.
 */
template <typename T>
void ReleaseMemory([[maybe_unused]] RawVector<T>& items, [[maybe_unused]] std::size_t begin,
  [[maybe_unused]] std::size_t end)
{
#ifdef __linux__
  if (items.size() < RawAllocator<T>::LargePage / sizeof(T))
  {
    return;
  }
  // Whole pages only: their other elements stay.
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  char* const first = reinterpret_cast<char*>(items.data() + begin);
  char* const last = reinterpret_cast<char*>(items.data() + end);
  const auto size = static_cast<std::size_t>(last - first);
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(first) % page) % page;
  const std::size_t after = reinterpret_cast<std::uintptr_t>(last) % page;
  if (size > before + after)
  {
    madvise(first + before, size - before - after, MADV_DONTNEED);
  }
#endif
}
} // namespace cdm

#endif
