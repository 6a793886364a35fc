// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MeshPoints/PointTemplates.h"

#include <cmath>

namespace cdm
{
double GetLatticeConstant(PointTemplate kind)
{
  return kind == PointTemplate::BodyCentered ? 2.0 / std::sqrt(3.0)
    : kind == PointTemplate::FaceCentered    ? std::sqrt(2.0)
                                             : 1.0;
}

bool HasTemplatePoint(PointTemplate kind, int middles)
{
  switch (kind)
  {
    case PointTemplate::Corners:
      return middles == 0;
    case PointTemplate::Centers:
      return middles == 3;
    case PointTemplate::BodyCentered:
      return middles == 0 || middles == 3;
    default:
      return middles == 0 || middles == 2;
  }
}

std::vector<std::array<int, 3>> GetTemplatePoints(PointTemplate kind)
{
  std::vector<std::array<int, 3>> places;
  for (int i = 0; i < 27; ++i)
  {
    const std::array<int, 3> place{ i % 3, i / 3 % 3, i / 9 };
    if (HasTemplatePoint(kind, (place[0] == 1) + (place[1] == 1) + (place[2] == 1)))
    {
      places.push_back(place);
    }
  }
  return places;
}
} // namespace cdm
