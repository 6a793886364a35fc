// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartTetrahedralization.h"

#include "Core/Delaunay/PartConflictRounds.h"
#include "Core/Delaunay/PartStarRounds.h"

#include <utility>

namespace cdm
{
PartTetrahedralization::PartTetrahedralization(
  std::vector<NumberedPoint> own, int part, const std::vector<Box>& bounds, const Box& cell)
  : Points(std::make_unique<PartPoints>(std::move(own), part, bounds, cell)),
    Rounds(std::make_unique<PartConflictRounds>(*this->Points))
{
}

void PartTetrahedralization::CompareStars()
{
  this->Rounds = std::make_unique<PartStarRounds>(*this->Points);
}
} // namespace cdm
