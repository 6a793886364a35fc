// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LookFor.h
 * @brief Waits awake for a moment, since a thread that has fallen asleep wakes late.
 *
 * On a virtual machine a thread that was woken came to searches of 2.5 milliseconds when half of
 * them were done.
 */
#ifndef cdmLookFor_h
#define cdmLookFor_h

#include <thread>

namespace cdm
{
/**
 * Looks a thousand times, for half a millisecond, whether a condition holds, and leaves the core to
 * other threads in between. Whether it came to hold: if not, the caller falls asleep.
 */
template <typename Condition>
bool LookFor(const Condition& condition)
{
  constexpr int looks = 1000;
  for (int i = 0; i < looks; ++i)
  {
    if (condition())
    {
      return true;
    }
    std::this_thread::yield();
  }
  return false;
}
} // namespace cdm

#endif
