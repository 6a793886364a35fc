// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HandOver.h
 * @brief One thread makes items, and another one uses them at the same time, in the same order.
 *
 * For work in two steps, each of which depends on the same step for all items before: neither can
 * be done for two items at once, but the first step can be ahead of the second one.
 *
 * Cost: a lock for each item that is put, and one for all items that have come since the last one
 * was taken. The thread that uses them waits awake for a moment, then asleep. If it has not begun
 * when all items are made, it is not waited for.
 */
#ifndef cdmHandOver_h
#define cdmHandOver_h

#include "Core/Basics/LookFor.h"
#include "Core/Basics/ThreadTeam.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace cdm
{
/** A queue between two threads, however long. */
template <typename Item>
class ItemQueue
{
public:
  void Put(Item item)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Items.push_back(std::move(item));
      this->HasNews = true;
    }
    this->Comes.notify_one();
  }
  /** No item is put any more. */
  void End()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->HasEnded = true;
      this->HasNews = true;
    }
    this->Comes.notify_one();
  }

  /** Waits for the next item. Empty: none is left, and none comes any more. */
  std::optional<Item> Take()
  {
    if (this->Taken.empty())
    {
      LookFor([this] { return this->HasNews.load(); });
      std::unique_lock<std::mutex> lock(this->Mutex);
      this->Comes.wait(lock, [this] { return this->HasNews.load(); });
      std::swap(this->Taken, this->Items);
      this->HasNews = this->HasEnded;
    }
    if (this->Taken.empty())
    {
      return std::nullopt;
    }
    std::optional<Item> item = std::move(this->Taken.front());
    this->Taken.pop_front();
    return item;
  }

private:
  std::mutex Mutex;
  std::condition_variable Comes;
  /** Whether there is an item, or none comes any more. Changes with the lock only. */
  std::atomic<bool> HasNews{ false };
  bool HasEnded = false;
  std::deque<Item> Items;
  /** Items that only the thread that takes them sees. */
  std::deque<Item> Taken;
};

/**
 * Calls make(put) on the calling thread, which calls put(item) for one item after the other, and
 * use(item) for each of them in the same order: on a second thread of the team; if that comes too
 * late, afterwards on the calling thread; without one, before put() returns. An exception is thrown
 * again from here.
 * @param team null, or with one thread: the calling thread is the only one
 * @param use returns whether to go on. If not, it is not called again, and put() returns false as
 *   soon as that is known; make() may then be some items ahead
 */
template <typename Item, typename Make, typename Use>
void HandOver(ThreadTeam* team, const Make& make, const Use& use)
{
  std::atomic<bool> isGoingOn{ true };
  if (team == nullptr || team->GetNumberOfThreads() < 2)
  {
    make(
      [&](Item item)
      {
        isGoingOn = isGoingOn && use(item);
        return isGoingOn.load();
      });
    return;
  }
  ItemQueue<Item> items;
  const auto useAll = [&]
  {
    // Nothing more is to be made when this function ends, also by an exception.
    struct Stop
    {
      std::atomic<bool>& IsGoingOn;
      ~Stop() { this->IsGoingOn = false; }
    } const stop{ isGoingOn };
    for (std::optional<Item> item = items.Take(); item && use(*item);)
    {
      item = items.Take();
    }
  };
  const auto makeAll = [&]
  {
    // No item comes any more when this function ends, also by an exception.
    struct End
    {
      ItemQueue<Item>& Items;
      ~End() { this->Items.End(); }
    } const end{ items };
    make(
      [&](Item item)
      {
        items.Put(std::move(item));
        return isGoingOn.load();
      });
  };
  team->RunBoth(makeAll, useAll);
}
} // namespace cdm

#endif
