// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Sizing/RegionSizes.h"

#include "Core/Geometry/Measures.h"
#include "Core/Search/BoxTree.h"
#include "Core/Sizing/RegionLocator.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
class RegionSizes
{
public:
  RegionSizes(const TriangleMesh& surface, const RegionSizesOptions& options, double largest)
    : Surface(surface), Growth(options.Growth), Largest(largest), Locator(this->Surface)
  {
  }
  RegionSizes(const RegionSizes&) = delete;
  RegionSizes& operator=(const RegionSizes&) = delete;

  Status Build(const std::vector<RegionSize>& sizes);
  double GetLength(const Vec3& position) const;

private:
  struct SizedRegion
  {
    Id Region;
    double Length;
    /** Its boundary. */
    std::vector<Id> Triangles;
    std::unique_ptr<BoxTree> Tree;
    Box Bounds;
  };

  Status FindBoundary(SizedRegion& region) const;
  double GetDistance(const SizedRegion& region, const Vec3& position, double limit) const;

  /** A copy, which the locator needs: the surface is refined while sizes are asked for. */
  const TriangleMesh Surface;
  const double Growth;
  double Largest;
  RegionLocator Locator;
  /** Shortest first. */
  std::vector<SizedRegion> Regions;
};

Status RegionSizes::Build(const std::vector<RegionSize>& sizes)
{
  std::map<Id, double> lengths;
  for (const RegionSize& size : sizes)
  {
    const auto place = lengths.emplace(size.Region, size.Length).first;
    place->second = std::min(place->second, size.Length);
  }
  Status status = this->Locator.Build();
  this->Largest =
    this->Largest > 0.0 ? this->Largest : Distance(this->Locator.GetLow(), this->Locator.GetHigh());
  for (auto size = lengths.cbegin(); size != lengths.cend() && status.IsOk(); ++size)
  {
    this->Regions.push_back({ size->first, size->second, {}, nullptr, {} });
    status = this->FindBoundary(this->Regions.back());
  }
  std::stable_sort(this->Regions.begin(), this->Regions.end(),
    [](const SizedRegion& a, const SizedRegion& b) { return a.Length < b.Length; });
  return status;
}

Status RegionSizes::FindBoundary(SizedRegion& region) const
{
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < this->Surface.Triangles.size(); ++i)
  {
    const RegionPair sides = this->Locator.GetRegions(static_cast<Id>(i));
    if (region.Region != OutsideRegion &&
      (sides.Front == region.Region || sides.Back == region.Region))
    {
      region.Triangles.push_back(static_cast<Id>(i));
      boxes.push_back(GetBox(this->Surface.Points, this->Surface.Triangles[i]));
      region.Bounds.Add(boxes.back());
    }
  }
  if (boxes.empty())
  {
    return Status::Failure(StatusCode::InvalidOption,
      "RegionSizes: the surface has no region " + std::to_string(region.Region) + ".");
  }
  region.Tree = std::make_unique<BoxTree>(boxes);
  return {};
}

double RegionSizes::GetDistance(const SizedRegion& region, const Vec3& position, double limit) const
{
  return region.Tree->FindDistance(position, limit,
    [&](Id i)
    {
      const TriangleIds& ids = this->Surface.Triangles[region.Triangles[i]];
      return GetDistanceToTriangle(position, this->Surface.Points[ids[0]],
        this->Surface.Points[ids[1]], this->Surface.Points[ids[2]]);
    });
}

double RegionSizes::GetLength(const Vec3& position) const
{
  // Found out once, and only if it may be a region that matters.
  std::optional<Id> located;
  const auto isIn = [&](const SizedRegion& region)
  {
    if (!located && region.Bounds.GetSquaredDistance(position) == 0.0)
    {
      located = this->Locator.Locate(position);
    }
    return located == region.Region;
  };
  double length = this->Largest;
  for (const SizedRegion& region : this->Regions)
  {
    if (region.Length >= length)
    {
      break;
    }
    if (isIn(region))
    {
      return region.Length;
    }
    const double reach = (length - region.Length) / this->Growth;
    const double distance = this->GetDistance(region, position, reach);
    length = distance < reach ? region.Length + this->Growth * distance : length;
  }
  return length;
}
} // namespace

Status LimitByRegions(const TriangleMesh& surface, const RegionSizesOptions& options,
  double largest, SizingField& sizing)
{
  if (options.Sizes.empty())
  {
    return {};
  }
  if (!(options.Growth > 0.0))
  {
    return Status::Failure(StatusCode::InvalidOption,
      "Growth is " + std::to_string(options.Growth) + ": it has to be above 0.");
  }
  for (const RegionSize& size : options.Sizes)
  {
    if (!(size.Length > 0.0))
    {
      return Status::Failure(StatusCode::InvalidOption,
        "RegionSizes: the size of region " + std::to_string(size.Region) + " is " +
          std::to_string(size.Length) + ": it has to be above 0.");
    }
  }
  const auto sizes = std::make_shared<RegionSizes>(surface, options, largest);
  return sizes->Build(options.Sizes)
    .Then(
      [&]
      {
        sizing.Limit([sizes](const Vec3& position) { return sizes->GetLength(position); });
        return Status();
      });
}
} // namespace cdm
