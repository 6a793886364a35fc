// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointSearches.h
 * @brief Visitors of a PointOctree: the searches of the surface refiner.
 *
 * Each is given to PointOctree::Visit() and holds what it has found afterwards. Order() says how
 * near a box is, infinity where nothing is to be found.
 */
#ifndef cdmPointSearches_h
#define cdmPointSearches_h

#include "Core/Basics/Types.h"
#include "Core/Basics/Vec3.h"
#include "Core/Geometry/Box.h"
#include "Core/Geometry/Measures.h"
#include "Core/Geometry/Predicates.h"

#include <vector>

namespace cdm
{
/** Distances below this have squares that may be zero. */
constexpr double SamePoint = 1e-150;

/** The nearest point to a position other than one, if it is nearer than a distance. */
class NearestPointVisitor
{
public:
  NearestPointVisitor(const Vec3& position, Id except, double farthest = Infinity)
    : SquaredDistance(farthest * farthest), Position(position), Except(except), Farthest(farthest)
  {
  }

  double Order(const Box& box) const
  {
    const double distance = box.GetSquaredDistance(this->Position);
    return distance < this->SquaredDistance ? distance : Infinity;
  }

  Box GetReach() const { return Box::MakeAround(this->Position, this->Farthest); }

  void Visit(Id id, const Vec3& p)
  {
    const double distance = SquaredNorm(p - this->Position);
    if (id != this->Except && distance < this->SquaredDistance)
    {
      this->SquaredDistance = distance;
      this->Nearest = id;
    }
  }

  Id Nearest = NoId;
  double SquaredDistance;

private:
  Vec3 Position;
  Id Except;
  double Farthest;
};

/** Points strictly inside the diametral sphere of an edge, other than its ends. */
class DiametralSphereVisitor
{
public:
  DiametralSphereVisitor(const std::vector<Vec3>& points, const EdgeIds& edge)
    : Edge(edge), A(points[edge[0]]), B(points[edge[1]]), Center(0.5 * (this->A + this->B)),
      Reach(0.5 * Distance(this->A, this->B) * (1.0 + 1e-9) + GetRounding(this->Center))
  {
  }

  double Order(const Box& box) const
  {
    const double distance = box.GetSquaredDistance(this->Center);
    return distance <= this->Reach * this->Reach ? distance : Infinity;
  }

  Box GetReach() const { return Box::MakeAround(this->Center, this->Reach); }

  void Visit(Id id, const Vec3& p)
  {
    const double distance = SquaredNorm(p - this->Center);
    if (id != this->Edge[0] && id != this->Edge[1] && distance < this->Deepest &&
      InDiametralSphere(this->A, this->B, p) > 0)
    {
      this->Found = id;
      this->Deepest = distance;
    }
  }

  /** The deepest point inside, or NoId. */
  Id Found = NoId;

private:
  EdgeIds Edge;
  Vec3 A;
  Vec3 B;
  Vec3 Center;
  double Reach;
  double Deepest = Infinity;
};
} // namespace cdm

#endif
