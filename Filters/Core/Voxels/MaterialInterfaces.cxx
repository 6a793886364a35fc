// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Voxels/MaterialInterfaces.h"

#include "Core/Voxels/InterfaceSmoothing.h"
#include "Core/Voxels/SurfaceReduction.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace cdm
{
namespace
{
/** Largest move of a point, in units of the edges of the cells beside it. */
constexpr double Reach = 0.49;
/** The same along an axis where a cell beside the point has other regions on both sides. */
constexpr double ThinReach = 0.25;

using Index = std::array<Id, 3>;

Status CheckGrid(const LabelledGrid& grid)
{
  static const char* const names[3] = { "x", "y", "z" };
  std::int64_t cells = 1;
  std::int64_t corners = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<double>& places = grid.Coordinates[axis];
    if (places.size() < 2)
    {
      return Status::InvalidInput(
        std::string("The grid has no cells along ") + names[axis] + ": it has to be a volume.");
    }
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      if (!std::isfinite(places[i]) || (i > 0 && !(places[i] > places[i - 1])))
      {
        return Status::InvalidInput(std::string("The coordinates along ") + names[axis] +
          " are not finite and ascending (number " + std::to_string(i) + ").");
      }
    }
    const std::int64_t size = static_cast<std::int64_t>(places.size());
    cells *= size - 1;
    corners *= size;
    if (size > std::numeric_limits<Id>::max() || corners > std::numeric_limits<Id>::max())
    {
      return Status::Failure(
        StatusCode::LimitReached, "The grid has more than 2^31 - 1 corners: cut it into blocks.");
    }
  }
  if (static_cast<std::int64_t>(grid.Regions.size()) != cells)
  {
    return Status::InvalidInput("The grid has " + std::to_string(cells) + " cells, but " +
      std::to_string(grid.Regions.size()) + " labels.");
  }
  std::vector<Id> wrong;
  bool hasRegion = false;
  for (std::size_t i = 0; i < grid.Regions.size(); ++i)
  {
    hasRegion = hasRegion || grid.Regions[i] > OutsideRegion;
    if (grid.Regions[i] < OutsideRegion)
    {
      wrong.push_back(static_cast<Id>(i));
    }
  }
  if (!wrong.empty())
  {
    return Status::InvalidInput(
      "Labels below -1 are no regions: use 0 and above, or -1 for outside.", std::move(wrong));
  }
  return hasRegion
    ? Status{}
    : Status::InvalidInput("All cells are outside: label those that are to be meshed 0 or above.");
}

/** Makes the net, one layer of corners after the other. */
class NetMaker
{
public:
  NetMaker(const LabelledGrid& grid, FaceNet& net) : Grid(grid), Net(net)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Size[axis] = static_cast<Id>(grid.Coordinates[axis].size()) - 1;
    }
  }

  /** False if aborted. */
  bool Run(const ExecutionContext& context)
  {
    this->AddLayer(0);
    for (Id k = 0; k <= this->Size[2]; ++k)
    {
      if (!context.Continue(static_cast<double>(k) / (this->Size[2] + 1), "Finding interfaces"))
      {
        return false;
      }
      this->Lower.swap(this->Upper);
      for (Id j = 0; j < this->Size[1]; ++j)
      {
        for (Id i = 0; i < this->Size[0]; ++i)
        {
          this->AddFace({ i, j, k }, 2);
        }
      }
      if (k == this->Size[2])
      {
        break;
      }
      this->AddLayer(k + 1);
      for (Id j = 0; j <= this->Size[1]; ++j)
      {
        for (Id i = 0; i <= this->Size[0]; ++i)
        {
          if (j < this->Size[1])
          {
            this->AddFace({ i, j, k }, 0);
          }
          if (i < this->Size[0])
          {
            this->AddFace({ i, j, k }, 1);
          }
        }
      }
    }
    return true;
  }

private:
  bool IsInside(const Index& cell) const
  {
    return cell[0] >= 0 && cell[1] >= 0 && cell[2] >= 0 && cell[0] < this->Size[0] &&
      cell[1] < this->Size[1] && cell[2] < this->Size[2];
  }

  Id GetRegion(const Index& cell) const
  {
    return this->IsInside(cell)
      ? this->Grid
          .Regions[(static_cast<std::size_t>(cell[2]) * this->Size[1] + cell[1]) * this->Size[0] +
            cell[0]]
      : OutsideRegion;
  }

  Id& GetCorner(std::vector<Id>& layer, Id i, Id j) const
  {
    return layer[static_cast<std::size_t>(j) * (this->Size[0] + 1) + i];
  }

  static Index GetNeighbor(Index cell, int axis, Id step)
  {
    cell[axis] += step;
    return cell;
  }

  /** Points of the corners of layer k that see more than one region, as the upper layer. */
  void AddLayer(Id k)
  {
    this->Upper.assign(static_cast<std::size_t>(this->Size[0] + 1) * (this->Size[1] + 1), NoId);
    for (Id j = 0; j <= this->Size[1]; ++j)
    {
      for (Id i = 0; i <= this->Size[0]; ++i)
      {
        const Id first = this->GetRegion({ i, j, k });
        for (int octant = 1; octant < 8; ++octant)
        {
          if (this->GetRegion({ i - (octant & 1), j - ((octant >> 1) & 1), k - (octant >> 2) }) !=
            first)
          {
            this->GetCorner(this->Upper, i, j) = static_cast<Id>(this->Net.Points.size());
            this->AddPoint({ i, j, k });
            break;
          }
        }
      }
    }
  }

  void AddPoint(const Index& corner)
  {
    FaceNet::Point point;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<double>& places = this->Grid.Coordinates[axis];
      const Id i = corner[axis];
      point.Place[axis] = places[i];
      point.Down[axis] = point.Up[axis] = 0.0;
      if (i > 0 && i < this->Size[axis])
      {
        const double reach = this->IsThin(corner, axis) ? ThinReach : Reach;
        point.Down[axis] = reach * (places[i] - places[i - 1]);
        point.Up[axis] = reach * (places[i + 1] - places[i]);
      }
    }
    this->Net.Points.push_back(point);
  }

  /** Whether one of the eight cells has other regions on both sides. */
  bool IsThin(const Index& corner, int axis) const
  {
    for (int octant = 0; octant < 8; ++octant)
    {
      const Index cell{ corner[0] - (octant & 1), corner[1] - ((octant >> 1) & 1),
        corner[2] - (octant >> 2) };
      const Id region = this->GetRegion(cell);
      if (this->IsInside(cell) && this->GetRegion(GetNeighbor(cell, axis, -1)) != region &&
        this->GetRegion(GetNeighbor(cell, axis, 1)) != region)
      {
        return true;
      }
    }
    return false;
  }

  /** The face at the low end of a cell along an axis, if it is an interface. */
  void AddFace(const Index& cell, int axis)
  {
    const Id high = this->GetRegion(cell);
    const Id low = this->GetRegion(GetNeighbor(cell, axis, -1));
    if (high == low)
    {
      return;
    }
    FaceNet::Face face;
    face.Axis = static_cast<unsigned char>(axis);
    face.IsUp = high < low;
    face.Regions = { std::min(high, low), std::max(high, low) };
    face.Side = static_cast<unsigned char>(cell[axis] == 0 ? 1 + 2 * axis
        : cell[axis] == this->Size[axis]                   ? 2 + 2 * axis
                                                           : 0);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (int n = 0; n < 4; ++n)
    {
      Index corner = cell;
      corner[u] += n == 1 || n == 2;
      corner[v] += n > 1;
      const Id id =
        this->GetCorner(corner[2] == cell[2] ? this->Lower : this->Upper, corner[0], corner[1]);
      face.Points[face.IsUp ? n : (4 - n) % 4] = id;
    }
    this->Net.Faces.push_back(face);
  }

  const LabelledGrid& Grid;
  FaceNet& Net;
  Index Size;
  /** Points of the corners below and above a slice of cells, or NoId. */
  std::vector<Id> Lower;
  std::vector<Id> Upper;
};

double GetShortestEdge(const LabelledGrid& grid)
{
  double shortest = Infinity;
  for (const std::vector<double>& places : grid.Coordinates)
  {
    for (std::size_t i = 1; i < places.size(); ++i)
    {
      shortest = std::min(shortest, places[i] - places[i - 1]);
    }
  }
  return shortest;
}
} // namespace

namespace
{
Status RunExtractMaterialInterfaces(const LabelledGrid& grid,
  const MaterialInterfacesOptions& options, const ExecutionContext& context, TriangleMesh& surface,
  MaterialInterfacesReport& report)
{
  surface = {};
  report = {};
  Status status = CheckGrid(grid);
  if (!status.IsOk())
  {
    return status;
  }
  FaceNet net;
  const bool isSmooth = options.SmoothingLength > 0.0;
  const double endOfNet = isSmooth || options.Reduce ? 0.1 : 1.0;
  const double endOfSmoothing = !isSmooth ? endOfNet : options.Reduce ? 0.4 : 1.0;
  if (!NetMaker(grid, net).Run(context.Part(0.0, endOfNet)))
  {
    return Status::Aborted();
  }
  if (net.Faces.size() > static_cast<std::size_t>(std::numeric_limits<Id>::max()) / 12)
  {
    return Status::Failure(
      StatusCode::LimitReached, "The interfaces have too many faces: cut the grid into blocks.");
  }
  report.Faces = static_cast<Id>(net.Faces.size());
  TriangleMesh result;
  for (const FaceNet::Point& point : net.Points)
  {
    result.Points.push_back({ point.Place[0], point.Place[1], point.Place[2] });
  }
  if (!isSmooth)
  {
    TriangulateFaces(net, result.Points, result.Triangles);
  }
  else if (!SmoothFaces(net, options.SmoothingLength, context.Part(endOfNet, endOfSmoothing),
             result.Points, result.Triangles, report.HeldPoints))
  {
    return Status::Aborted();
  }
  SurfaceReductionOptions reduction;
  for (const FaceNet::Face& face : net.Faces)
  {
    result.Labels.insert(result.Labels.end(), 2, face.Regions);
    reduction.Patches.insert(reduction.Patches.end(), 2, face.Side);
  }
  if (options.Reduce)
  {
    reduction.MaximumDeviation = options.MaximumDeviation * GetShortestEdge(grid);
    reduction.FeatureAngle = options.FeatureAngle;
    SurfaceReductionReport reductionReport;
    status = ReduceSurface(reduction, context.Part(endOfSmoothing, 1.0), result, reductionReport);
    if (!status.IsOk())
    {
      return status;
    }
    report.RemovedPoints = reductionReport.RemovedPoints;
    report.LargestDeviation = reductionReport.LargestDeviation;
  }
  surface = std::move(result);
  return {};
}
} // namespace

Status ExtractMaterialInterfaces(const LabelledGrid& grid, const MaterialInterfacesOptions& options,
  const ExecutionContext& context, TriangleMesh& surface, MaterialInterfacesReport& report)
{
  return RunGuarded(
    [&] { return RunExtractMaterialInterfaces(grid, options, context, surface, report); });
}
} // namespace cdm
