// SPDX-License-Identifier: BSD-3-Clause
#include "ComplexWithPoints.h"
#include "Core/Improvement/LookAhead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

using namespace cdm;

namespace
{
/** The tetrahedra of a turned complex with points inside are items, in random order. */
class SearchedComplex
{
public:
  explicit SearchedComplex(int numberOfThreads)
    : Generator(1), Complex(this->Generator, numberOfThreads)
  {
    this->Ahead = std::make_unique<LookAhead<Id>>(this->GetMesh(), 1, 1);
    this->Searches.assign(this->GetMesh().GetMesh().Tetrahedra.size(), 0);
    this->Items.resize(this->Searches.size());
    std::iota(this->Items.begin(), this->Items.end(), 0);
    std::shuffle(this->Items.begin(), this->Items.end(), this->Generator);
    PointCavity cavity;
    while (!this->FindCavity(this->Replaceable, cavity))
    {
      ++this->Replaceable;
    }
  }

  std::size_t GetNumberOfItems() const { return this->Searches.size(); }
  const TetrahedronIds& GetIds(std::size_t item) const
  {
    return this->GetMesh().GetMesh().Tetrahedra[this->Items[item]];
  }
  bool IsOpen(std::size_t item) const
  {
    return this->GetMesh().GetTetrahedra().GetStamp(this->Items[item]) < this->FirstStamp;
  }
  /** How many times each item has been searched. */
  const std::vector<int>& GetSearches() const { return this->Searches; }

  /** An item's change is its number; its search sees its own tetrahedron and the one to be replaced. */
  Id Get(std::size_t item)
  {
    return this->Ahead->Get(
      item, this->Searches.size(),
      [this](std::size_t k) { return this->IsOpen(k) ? this->Items[k] : NoId; },
      [this](int, std::size_t k, LookAhead<Id>::Found& found)
      {
        ++this->Searches[k];
        found.What = static_cast<Id>(k);
        found.Visited = { this->Replaceable, this->Items[k] };
      });
  }

  /** Inserts a point into a tetrahedron. */
  void ReplaceOne()
  {
    PointCavity cavity;
    const Id replaced = this->Replaceable;
    ASSERT_TRUE(this->FindCavity(replaced, cavity));
    this->FirstStamp = this->GetMesh().GetTetrahedra().GetNextStamp();
    this->GetMesh().Insert(this->GetInside(replaced), cavity);
  }

private:
  RefinedMesh& GetMesh() { return this->Complex.GetMesh(); }
  const RefinedMesh& GetMesh() const { return this->Complex.GetMesh(); }
  Vec3 GetInside(Id tetrahedron) const
  {
    const std::array<Vec3, 4> v = this->GetMesh().GetTetrahedra().GetCorners(tetrahedron);
    return 0.4 * v[0] + 0.3 * v[1] + 0.2 * v[2] + 0.1 * v[3];
  }
  bool FindCavity(Id tetrahedron, PointCavity& cavity)
  {
    DynamicTetrahedralization& tetrahedra = this->GetMesh().GetTetrahedra();
    return tetrahedra.FindCavity(
      this->GetInside(tetrahedron), tetrahedra.GetNumberOfPoints(), tetrahedron, cavity);
  }

  std::mt19937_64 Generator;
  ComplexWithPoints Complex;
  std::unique_ptr<LookAhead<Id>> Ahead;
  std::vector<int> Searches;
  /** The tetrahedron of each item. */
  std::vector<Id> Items;
  /** The first tetrahedron that a point may be inserted into. */
  Id Replaceable = 0;
  /** Tetrahedra with this stamp or a later one are no items. */
  std::int64_t FirstStamp = std::numeric_limits<std::int64_t>::max();
};
} // namespace

TEST(LookAhead, EachItemIsSearchedOnceWhereNothingChanges)
{
  for (int threads : { 1, 2, 5 })
  {
    SCOPED_TRACE(threads);
    SearchedComplex complex(threads);
    ASSERT_GT(complex.GetNumberOfItems(), 1000U);
    for (std::size_t i = 0; i < complex.GetNumberOfItems(); ++i)
    {
      EXPECT_EQ(complex.Get(i), static_cast<Id>(i));
    }
    EXPECT_EQ(complex.GetSearches(), std::vector<int>(complex.GetNumberOfItems(), 1));
  }
}

/** What the earlier one does would likely spoil what is found, or mend both. */
TEST(LookAhead, ItemsAtAnEdgeOfEarlierOnesWait)
{
  SearchedComplex complex(2);
  complex.Get(0);
  std::set<Id> points;
  for (std::size_t i = 0; i < complex.GetNumberOfItems(); ++i)
  {
    const TetrahedronIds& ids = complex.GetIds(i);
    const auto common =
      std::count_if(ids.begin(), ids.end(), [&](Id id) { return points.count(id) > 0; });
    EXPECT_TRUE(i == 0 || common < 2 || complex.GetSearches()[i] == 0) << i;
    points.insert(ids.begin(), ids.end());
  }
  EXPECT_EQ(complex.GetSearches()[0], 1);
  const std::vector<int>& searches = complex.GetSearches();
  EXPECT_GT(std::count(searches.begin(), searches.end(), 1), 1);
}

TEST(LookAhead, ItemsAreSearchedAgainWhereTetrahedraAreReplaced)
{
  for (int threads : { 1, 2, 5 })
  {
    SCOPED_TRACE(threads);
    SearchedComplex complex(threads);
    complex.Get(0);
    const std::vector<int> before = complex.GetSearches();
    complex.ReplaceOne();
    for (std::size_t i = 1; i < complex.GetNumberOfItems(); ++i)
    {
      if (complex.IsOpen(i))
      {
        EXPECT_EQ(complex.Get(i), static_cast<Id>(i));
        EXPECT_EQ(complex.GetSearches()[i], before[i] + 1) << i;
      }
    }
  }
}
