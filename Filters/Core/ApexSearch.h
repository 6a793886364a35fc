// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ApexSearch.h
 * @brief The fourth points of the triangles around one vertex (thesis 6.4.2, Crit. 6.2), fast.
 *
 * The task is that of FourthPointSearch, for many triangles with a common vertex and among the
 * points of a PointTree that have not dropped out.
 *
 * Method:
 *  1. gather the points around the vertex's leaf, once for its eight vertices, and those around the
 *     vertex, once for its triangles;
 *  2. select the smallest lambda among them in double arithmetic; if the sphere is covered by the
 *     gathered ball, count the points not outside of it by more than the forward error bounds: if
 *     only the triangle and the point itself are left, that is the exact answer;
 *  3. otherwise search the tree, nodes with the smallest lower bound of lambda first; leave out
 *     boxes behind the triangle or outside of the best sphere, by their box or their slab;
 *  4. points that the bounds cannot tell apart: corners of an axis-parallel box are cospherical by
 *     their coordinates alone; all others are left to the exact predicates.
 *
 * The normal and circumcenter of a badly shaped triangle are calculated in double-double
 * arithmetic: the bounds stay tight, and the number of points left to the predicates small.
 *
 * Guarantees: the answer is exact. Not thread safe: one search for each thread.
 * Cost: proportional to the points near the sphere; see the numbers in Testing/Benchmarks.
 */
#ifndef cdmApexSearch_h
#define cdmApexSearch_h

#include "DoubleDouble.h"
#include "PencilKernels.h"
#include "PointTree.h"
#include "Types.h"
#include "Vec3.h"

#include <vector>

namespace cdm
{
struct Apex
{
  /** The point of smallest lambda strictly in front, or NoId: the triangle is on the hull. */
  Id Point = NoId;
  /** Point is the only one on the sphere, and no other is on the circumcircle. */
  bool IsUnique = false;
  /** Otherwise: all points on the sphere in front, Point included, and on the circumcircle. */
  std::vector<Id> Cospherical;
  std::vector<Id> Cocircular;
  /** All points of the cell, those of the triangle included, are the corners of a box. */
  bool IsBox = false;
  /** The corners: bit 0, 1, 2 of the index for the upper x, y, z. */
  Id Corners[8];
};

class ApexSearch
{
public:
  explicit ApexSearch(const PointTree& tree);

  /** To be called when points have come back to the tree. */
  void Forget() { this->Leaf = NoId; }

  /** Choose the vertex of the triangles to come. */
  void SetVertex(Id vertex);

  /** To be called when points come back into the tree: the gathered ones lack them. */
  void ForgetNearPoints() { this->Leaf = NoId; }

  /** Search in front of the triangle (vertex, b, c). */
  void Find(Id b, Id c, Apex& result);

private:
  /** A point in a pencil with twice the digits: lambda is power / (2 |n|^2 height). */
  struct Measured
  {
    DoubleDouble Power;
    DoubleDouble Height;
    double PowerError;
    double HeightError;
  };
  struct WaitingNode
  {
    double Bound;
    std::int32_t Level;
    Id Index;
  };

  void GatherLeaf(Id leaf);
  bool CollectNear(const double* box, double radius);
  bool PreparePencil(const Vec3& u, const Vec3& w);
  void PreparePrecisely(Id b, Id c);
  int Measure(Id point, Measured& measured) const;
  static bool IsAbove(const Measured& a, const Measured& b);
  void SetSphere(const Measured& measured);
  void SetSphere(double lambda, double lambdaError);
  bool IsCovered(double radius) const;
  bool Improve(const Vec3& x, double square);
  bool SearchTree(Id b, Id c);
  bool IsInHullPlane(Id b, Id c) const;
  void Resolve(Id b, Id c, Apex& result);
  bool ResolveBox(Id b, Id c, Apex& result) const;

  const PointTree& Tree;
  const PencilKernels& Kernels;
  Id Vertex = NoId;
  Vec3 Position;
  Pencil Current;
  double NormalLength = 0.0;
  /** What the true lambda of the pencil's sphere is surely not above, in units of 2 n. */
  double LambdaLimit = 0.0;
  /** The sphere's lambda as far as double tells. */
  double Lambda = 0.0;
  /** The point that the sphere belongs to. */
  Id Selected = NoId;

  // The pencil with twice the digits: n, n x t (which is 2 h |n|^2), |n|^2, and |u| |w|, |u| + |w|.
  bool IsPrecise = false;
  bool IsHopeless = false;
  DoubleDouble3 PreciseNormal;
  DoubleDouble3 PreciseOffset;
  DoubleDouble PreciseSquare;
  Measured Best;
  double Lengths = 0.0;
  double Sides = 0.0;

  // Points around the leaf, and around the vertex.
  Id Leaf = NoId;
  /** Leaves are surrounded by this share of their own diagonal; it follows the density. */
  double Margin = 1.0;
  double Radius = 0.0;
  double GatheredBox[6];
  std::vector<Id> GatheredIds;
  std::vector<double> Gathered[3];
  /** Two balls around the vertex: most spheres fit into the small one. */
  struct Ball
  {
    double Radius = 0.0;
    std::vector<Id> Ids;
    std::vector<double> Coordinates[4];
    NearPoints View;
  };
  void Fill(Ball& ball, const double* const* from, const Id* ids, int size, const double* center);
  bool FindNear(const Ball& ball, Id b, Id c, Apex& result);
  Ball Small;
  Ball Large;

  /** Planes on the hull with many points: a search in front of each triangle would see them all. */
  struct HullPlane
  {
    Vec3 A;
    Vec3 B;
    Vec3 C;
  };
  static constexpr int NumberOfHullPlanes = 8;
  HullPlane HullPlanes[NumberOfHullPlanes];
  int NextHullPlane = 0;

  std::vector<Id> Candidates;
  std::vector<Measured> Measures;
  std::vector<WaitingNode> Waiting;
};
} // namespace cdm

#endif
