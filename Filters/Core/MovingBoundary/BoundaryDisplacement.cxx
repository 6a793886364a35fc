// SPDX-License-Identifier: BSD-3-Clause
#include "Core/MovingBoundary/BoundaryDisplacement.h"

#include "Core/Meshes/SimplexIncidence.h"
#include "Core/Meshes/VoronoiMeasures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace cdm
{
namespace
{
/** Sine of the angle above which two normals are those of different planes. */
constexpr double PlaneTolerance = 1e-6;
/** A displacement leaves a plane if more than this part of it is across the plane. */
constexpr double SlideTolerance = 1e-9;
constexpr int MaximumNumberOfSweeps = 200;
constexpr double OverRelaxation = 1.7;
/** Sweeps end when no component changes by more than this part of the largest displacement. */
constexpr double SweepTolerance = 1e-5;

/** The directions in which a point may move without a change of the shape of the boundary. */
class Freedom
{
public:
  void AddNormal(const Vec3& normal)
  {
    switch (this->Dimension)
    {
      case 3:
        this->Direction = normal;
        this->Dimension = 2;
        return;
      case 2:
      {
        const Vec3 edge = Cross(this->Direction, normal);
        const double sine = Norm(edge);
        if (sine > PlaneTolerance)
        {
          this->Direction = (1.0 / sine) * edge;
          this->Dimension = 1;
        }
        return;
      }
      case 1:
        this->Dimension = std::abs(Dot(this->Direction, normal)) > PlaneTolerance ? 0 : 1;
        return;
      default:
        return;
    }
  }

  bool IsPlane() const { return this->Dimension == 2; }
  bool IsFree() const { return this->Dimension > 0; }
  void Fix() { this->Dimension = 0; }

  Vec3 Project(const Vec3& v) const
  {
    switch (this->Dimension)
    {
      case 3:
        return v;
      case 2:
        return v - Dot(this->Direction, v) * this->Direction;
      case 1:
        return Dot(this->Direction, v) * this->Direction;
      default:
        return {};
    }
  }

private:
  int Dimension = 3;
  /** Direction of the plane's normal, or of the edge. */
  Vec3 Direction;
};

class Spreading
{
public:
  explicit Spreading(const BoundaryDisplacementInput& input)
    : Input(input), Mesh(*input.Mesh), IsOnBoundary(Mesh.Points.size(), 0),
      Freedoms(Mesh.Points.size()), Displacements(Mesh.Points.size())
  {
  }

  bool Run(const ExecutionContext& context)
  {
    this->FindFreedoms();
    this->CollectNeighbors();
    double largest = 0.0;
    for (std::size_t point = 0; point < this->Displacements.size(); ++point)
    {
      if (this->IsOnBoundary[point])
      {
        const Vec3& given = this->Input.Given[point];
        this->Displacements[point] = given - this->Freedoms[point].Project(given);
        largest = std::max(largest, Norm(given));
      }
    }
    const std::vector<Vec3> fixed = this->Displacements;
    const std::vector<Id> followers = this->FindFollowers();
    double change = Infinity;
    for (int sweep = 0; sweep < MaximumNumberOfSweeps && change > SweepTolerance * largest; ++sweep)
    {
      if (!context.Continue(static_cast<double>(sweep) / MaximumNumberOfSweeps, "Moving points"))
      {
        return false;
      }
      change = 0.0;
      const auto relax = [&](Id point)
      {
        const Vec3 mean = fixed[point] + this->Freedoms[point].Project(this->GetMean(point));
        const Vec3 step = OverRelaxation * (mean - this->Displacements[point]);
        change = std::max({ change, std::abs(step.X), std::abs(step.Y), std::abs(step.Z) });
        this->Displacements[point] = this->Displacements[point] + step;
      };
      // There and back: no direction is preferred.
      std::for_each(followers.begin(), followers.end(), relax);
      std::for_each(followers.rbegin(), followers.rend(), relax);
    }
    return true;
  }

  std::vector<Vec3>& GetDisplacements() { return this->Displacements; }

private:
  struct Link
  {
    Id From;
    Id To;
    double Weight;
  };

  void FindFreedoms()
  {
    const std::vector<Vec3>& points = this->Mesh.Points;
    for (const TriangleIds& ids : this->Input.Boundary->Triangles)
    {
      const Vec3 cross = Cross(points[ids[1]] - points[ids[0]], points[ids[2]] - points[ids[0]]);
      const Vec3 normal = (1.0 / Norm(cross)) * cross;
      const bool staysInPlane = std::all_of(ids.begin(), ids.end(),
        [&](Id id)
        {
          const Vec3& given = this->Input.Given[id];
          return std::abs(Dot(normal, given)) <= SlideTolerance * Norm(given);
        });
      for (const Id id : ids)
      {
        this->IsOnBoundary[id] = 1;
        if (staysInPlane && !this->Input.IsPrescribed[id])
        {
          this->Freedoms[id].AddNormal(normal);
        }
        else
        {
          this->Freedoms[id].Fix();
        }
      }
    }
  }

  /** Edges of the mesh for points inside, those of the boundary for points on it. */
  void CollectNeighbors()
  {
    const std::vector<Vec3>& points = this->Mesh.Points;
    const auto isInside = [this](Id point) { return !this->IsOnBoundary[point]; };
    const SimplexIncidence incidence(this->Mesh, 1);
    std::vector<SimplexIncidence::Record> scratch;
    for (Id point = 0; point < static_cast<Id>(points.size()); ++point)
    {
      incidence.ForEachEdge(point, scratch,
        [&](const TriangleIds& ids, auto begin, auto end)
        {
          if (!isInside(ids[0]) && !isInside(ids[1]))
          {
            return;
          }
          double weight = 0.0;
          for (auto record = begin; record != end; ++record)
          {
            const TetrahedronIds& t = this->Mesh.Tetrahedra[record->Simplex / 6];
            weight += GetCouplings(
              points[t[0]], points[t[1]], points[t[2]], points[t[3]])[record->Simplex % 6]
                        .High;
          }
          for (int i = 0; i < 2; ++i)
          {
            if (isInside(ids[i]))
            {
              this->Links.push_back({ ids[i], ids[1 - i], weight });
            }
          }
        });
    }
    for (const TriangleIds& ids : this->Input.Boundary->Triangles)
    {
      for (int i = 0; i < 3; ++i)
      {
        const Id a = ids[i];
        const Id b = ids[(i + 1) % 3];
        const Vec3 u = points[a] - points[ids[(i + 2) % 3]];
        const Vec3 v = points[b] - points[ids[(i + 2) % 3]];
        const double cotangent = Dot(u, v) / Norm(Cross(u, v));
        this->AddBoundaryLink(a, b, cotangent);
        this->AddBoundaryLink(b, a, cotangent);
      }
    }
    std::stable_sort(this->Links.begin(), this->Links.end(),
      [](const Link& a, const Link& b)
      { return a.From != b.From ? a.From < b.From : a.To < b.To; });
    // The two triangles of an edge give it a weight together.
    std::size_t count = 0;
    for (const Link& link : this->Links)
    {
      if (count > 0 && this->Links[count - 1].From == link.From &&
        this->Links[count - 1].To == link.To)
      {
        this->Links[count - 1].Weight += link.Weight;
      }
      else
      {
        this->Links[count++] = link;
      }
    }
    this->Links.resize(count);
    this->Begin.assign(points.size() + 1, 0);
    for (Link& link : this->Links)
    {
      // Only a mesh that is not Delaunay has negative ones.
      link.Weight = std::max(link.Weight, 0.0);
      ++this->Begin[link.From + 1];
    }
    std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
  }

  void AddBoundaryLink(Id from, Id to, double cotangent)
  {
    const Freedom& freedom = this->Freedoms[from];
    if (freedom.IsPlane())
    {
      this->Links.push_back({ from, to, cotangent });
    }
    else if (freedom.IsFree())
    {
      const Vec3 offset = this->Mesh.Points[to] - this->Mesh.Points[from];
      const double length = Norm(offset);
      if (Norm(offset - freedom.Project(offset)) <= PlaneTolerance * length)
      {
        this->Links.push_back({ from, to, 1.0 / length });
      }
    }
  }

  /** Free points within the distance of those that are given a displacement, ascending. */
  std::vector<Id> FindFollowers() const
  {
    // Edges are kept at their free ends; distances run from the given points to these.
    std::vector<double> distances(this->Mesh.Points.size(), Infinity);
    std::vector<std::vector<Id>> freeNeighbors(this->Mesh.Points.size());
    for (Id point = 0; point < static_cast<Id>(this->Mesh.Points.size()); ++point)
    {
      for (Id i = this->Begin[point]; i < this->Begin[point + 1]; ++i)
      {
        freeNeighbors[this->Links[i].To].push_back(point);
      }
    }
    using Entry = std::pair<double, Id>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    for (Id point = 0; point < static_cast<Id>(this->Mesh.Points.size()); ++point)
    {
      if (this->IsOnBoundary[point] && this->Input.Given[point] != Vec3{})
      {
        distances[point] = 0.0;
        queue.push({ 0.0, point });
      }
    }
    while (!queue.empty())
    {
      const auto [distance, point] = queue.top();
      queue.pop();
      for (const Id next : freeNeighbors[point])
      {
        const double reached =
          distance + cdm::Distance(this->Mesh.Points[point], this->Mesh.Points[next]);
        if (distance <= distances[point] && reached <= this->Input.FollowDistance &&
          reached < distances[next])
        {
          distances[next] = reached;
          queue.push({ reached, next });
        }
      }
    }
    std::vector<Id> followers;
    for (Id point = 0; point < static_cast<Id>(distances.size()); ++point)
    {
      if (distances[point] < Infinity && this->Freedoms[point].IsFree())
      {
        followers.push_back(point);
      }
    }
    return followers;
  }

  Vec3 GetMean(Id point) const
  {
    Vec3 sum;
    double weights = 0.0;
    for (Id i = this->Begin[point]; i < this->Begin[point + 1]; ++i)
    {
      sum = sum + this->Links[i].Weight * this->Displacements[this->Links[i].To];
      weights += this->Links[i].Weight;
    }
    return weights > 0.0 ? (1.0 / weights) * sum : Vec3{};
  }

  const BoundaryDisplacementInput& Input;
  const TetMesh& Mesh;
  std::vector<char> IsOnBoundary;
  std::vector<Freedom> Freedoms;
  std::vector<Vec3> Displacements;
  /** Links from free points to their neighbors; those of point p are Begin[p] to Begin[p + 1]. */
  std::vector<Link> Links;
  std::vector<Id> Begin;
};
} // namespace

bool SpreadBoundaryDisplacement(const BoundaryDisplacementInput& input,
  const ExecutionContext& context, std::vector<Vec3>& displacements)
{
  Spreading spreading(input);
  if (!spreading.Run(context))
  {
    return false;
  }
  displacements = std::move(spreading.GetDisplacements());
  return true;
}
} // namespace cdm
