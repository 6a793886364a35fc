// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Pipeline/RegionVolumes.h"

#include "Core/Meshes/SurfaceArea.h"
#include "Core/Meshes/VolumeSums.h"

#include <cmath>
#include <map>

namespace cdm
{
namespace
{
/** Six times the volumes of regions. */
class Volumes
{
public:
  explicit Volumes(const Vec3& origin) : Origin(origin) {}

  void Add(
    const TriangleMesh& surface, const TriangleIds& ids, bool isReversed, const RegionPair& labels)
  {
    const long double volume = (isReversed ? -1.0L : 1.0L) *
      GetSixVolumes(
        this->Origin, surface.Points[ids[0]], surface.Points[ids[1]], surface.Points[ids[2]]);
    // The back is where the normal points away from.
    if (labels.Back >= 0)
    {
      this->Sums[labels.Back].Add(volume);
    }
    if (labels.Front >= 0)
    {
      this->Sums[labels.Front].Add(-volume);
    }
  }
  double Get(Id region) const { return this->Sums.at(region).Get(); }

private:
  std::map<Id, CompensatedSum> Sums;
  const Vec3 Origin;
};
} // namespace

std::vector<Id> FindChangedRegions(
  const TriangleMesh& before, const TriangleMesh& boundary, double ratio)
{
  // One of the boundary triangles that come from each triangle before.
  std::vector<Id> triangles(before.Triangles.size(), NoId);
  const Vec3 origin = before.Points.empty() ? Vec3() : before.Points.front();
  Volumes now(origin);
  Volumes then(origin);
  for (std::size_t t = 0; t < boundary.Triangles.size(); ++t)
  {
    now.Add(boundary, boundary.Triangles[t], false, boundary.Labels[t]);
    if (boundary.SourceCells[t] != NoId)
    {
      triangles[boundary.SourceCells[t]] = static_cast<Id>(t);
    }
    else
    {
      then.Add(boundary, boundary.Triangles[t], false, boundary.Labels[t]);
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (triangles[t] != NoId)
    {
      const TriangleIds& ids = before.Triangles[t];
      const bool isReversed = Dot(GetAreaVector(before, ids),
                                GetAreaVector(boundary, boundary.Triangles[triangles[t]])) < 0.0;
      then.Add(before, ids, isReversed, boundary.Labels[triangles[t]]);
    }
  }
  const auto isChanged = [&](Id region)
  {
    return region >= 0 &&
      std::abs(now.Get(region) - then.Get(region)) > ratio * std::abs(now.Get(region));
  };
  std::vector<Id> found;
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    if (triangles[t] != NoId)
    {
      const RegionPair& labels = boundary.Labels[triangles[t]];
      if (isChanged(labels.Front) || isChanged(labels.Back))
      {
        found.push_back(static_cast<Id>(t));
      }
    }
  }
  return found;
}
} // namespace cdm
