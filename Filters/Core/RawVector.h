// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RawVector.h
 * @brief A std::vector of plain data whose new elements have no value.
 *
 * Setting hundreds of megabytes to zero on one thread, to be overwritten by several, takes as long as
 * the rest of their work.
 */
#ifndef cdmRawVector_h
#define cdmRawVector_h

#include <memory>
#include <new>
#include <utility>
#include <vector>

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
} // namespace cdm

#endif
