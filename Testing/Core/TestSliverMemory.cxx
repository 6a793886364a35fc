// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverMemory.h"

#include <gtest/gtest.h>

using namespace cdm;

TEST(SliverMemory, PointsAreImmovableUntilTheyGetOtherNeighbors)
{
  SliverMemory memory;
  const Id inside = memory.MakeName();
  const Id onSurface = 7;
  for (const Id point : { inside, onSurface })
  {
    EXPECT_FALSE(memory.IsImmovable(point, SliverPlace::Elsewhere));
    memory.SetImmovable(point, SliverPlace::Elsewhere);
    EXPECT_TRUE(memory.IsImmovable(point, SliverPlace::Elsewhere));
    // What was searched for others says nothing about tetrahedra at sharp angles.
    EXPECT_FALSE(memory.IsImmovable(point, SliverPlace::SharpAngle));
    // Far away.
    memory.SetChanged({ 1, 2, 3, memory.MakeName() });
    EXPECT_TRUE(memory.IsImmovable(point, SliverPlace::Elsewhere));
    memory.SetChanged({ 1, 2, 3, point });
    EXPECT_FALSE(memory.IsImmovable(point, SliverPlace::Elsewhere));
    memory.SetImmovable(point, SliverPlace::Elsewhere);
    EXPECT_TRUE(memory.IsImmovable(point, SliverPlace::Elsewhere));
  }
  EXPECT_FALSE(memory.IsImmovable(memory.MakeName(), SliverPlace::Elsewhere));
}

TEST(SliverMemory, SliversAreHopelessUntilAPointGetsOtherNeighbors)
{
  SliverMemory memory;
  const TetrahedronIds sliver{ 4, 5, 6, memory.MakeName() };
  EXPECT_FALSE(memory.IsHopeless(sliver, SliverAttempt::Move));
  memory.SetHopeless(sliver, SliverAttempt::Insertion);
  EXPECT_TRUE(memory.IsHopeless(sliver, SliverAttempt::Move));
  EXPECT_TRUE(memory.IsHopeless(sliver, SliverAttempt::Insertion));
  EXPECT_FALSE(memory.IsHopeless(sliver, SliverAttempt::SurfaceMove));
  memory.SetChanged({ 1, 2, 3, 8 });
  EXPECT_TRUE(memory.IsHopeless(sliver, SliverAttempt::Move));
  memory.SetChanged({ 1, 2, 3, 6 });
  EXPECT_FALSE(memory.IsHopeless(sliver, SliverAttempt::Move));
}

TEST(SliverMemory, FlatTetrahedraAreUnroundableUntilAPointGetsOtherNeighbors)
{
  SliverMemory memory;
  const TetrahedronIds flat{ 4, 5, 6, 7 };
  EXPECT_FALSE(memory.IsUnroundable(flat));
  memory.SetUnroundable({ 7, 6, 5, 4 });
  EXPECT_TRUE(memory.IsUnroundable(flat));
  // A failed rounding says nothing about moves of the tetrahedron's points.
  EXPECT_FALSE(memory.IsHopeless(flat, SliverAttempt::Move));
  memory.SetChanged({ 1, 2, 3, 8 });
  EXPECT_TRUE(memory.IsUnroundable(flat));
  memory.SetChanged({ 1, 2, 3, 4 });
  EXPECT_FALSE(memory.IsUnroundable(flat));
}
