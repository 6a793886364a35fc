// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RemeshingPasses.h
 * @brief The passes over a surface of which remeshing consists (SurfaceRemesher.h): splits, collapses,
 * flips, moves, and what is done before them to strips.
 */
#ifndef cdmRemeshingPasses_h
#define cdmRemeshingPasses_h

#include "Core/Surface/ChangeableSurface.h"
#include "Core/Surface/SurfaceRemesher.h"

#include <algorithm>
#include <vector>

namespace cdm
{
/** What edges are to be like at a position. */
double GetWantedLength(
  const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options, const Vec3& position);

/** Input, options and threads have to outlive the object. */
class RemeshingPasses
{
public:
  RemeshingPasses(const SurfaceRemesherInput& input, const SurfaceRemesherOptions& options,
    std::vector<double> lengths, const std::vector<Id>& facets,
    const std::vector<StructuralEdge>& edges, ThreadTeam& threads);

  /** Collapses the short edges of strips, which moves no point. False if aborted. */
  bool CollapseStrips(const ExecutionContext& context);
  /**
   * Splits long edges once, collapses what is short beside the pieces, and so on down to the wanted
   * length. False if aborted.
   */
  bool CutStrips(const ExecutionContext& context);
  /** Rounds of all passes, until they hardly make the surface coarser. False if aborted. */
  bool Run(const ExecutionContext& context);
  /** Points that stay where they are: corners, and points where parts of the surface touch. */
  const std::vector<char>& GetFixedPoints() const { return this->IsFixed; }
  void FixPoint(Id point) { this->IsFixed[point] = 1; }
  /** The surface as it is now, and where its points come from. */
  void MakeOutput(SurfaceRemesherOutput& output) const;
  /**
   * The edges of chains, sorted by their points.
   * @param sources which points are left; the edges have their numbers in this list
   */
  std::vector<StructuralEdge> ListStructuralEdges(const std::vector<Id>& sources) const;

private:
  const Vec3& GetPoint(Id point) const { return this->Surface.GetPoints()[point]; }
  /** Length of an edge, 1 as wanted by lengths at its ends. */
  double GetRatio(Id a, Id b, const std::vector<double>& lengths) const
  {
    return Distance(this->GetPoint(a), this->GetPoint(b)) / std::min(lengths[a], lengths[b]);
  }

  void FindCurvatureLengths(const std::vector<StructuralEdge>& edges);
  /** Finds the lengths of edges at a point that is new or has moved. */
  void SetLengths(Id point);
  Id CountTriangles() const;
  void FindFixedPoints();
  bool IsRegular(Id point) const;
  std::vector<EdgeIds> ListEdges() const;
  bool Split(const ExecutionContext& context);
  bool HasLongerBeside(const EdgeIds& edge, double ratio) const;
  void SplitEdge(const EdgeIds& edge);
  bool Collapse(const ExecutionContext& context);
  bool CollapseEdge(Id point, Id target);
  bool Flip(const ExecutionContext& context);
  void FlipEdge(const EdgeIds& edge);
  bool Smooth(const ExecutionContext& context);
  bool EnlargeAngles(const ExecutionContext& context);
  void EnlargeAngle(Id point);
  std::vector<Vec3> FindDirections(Id point) const;
  bool FindBetterPlace(Id point, Vec3& place) const;
  bool Move(Id point, const Vec3& place);
  double GetWorstAngleCosine(
    const std::vector<NewTriangle>& triangles, Id point, const Vec3& place) const;

  const SurfaceRemesherInput& Input;
  const SurfaceRemesherOptions& Options;
  ChangeableSurface Surface;
  /** Wanted length of edges at each point, and the same where the surface is curved. */
  std::vector<double> WantedLengths;
  std::vector<double> Lengths;
  /** For each point of the input how long edges may be there, as the surface is curved. */
  std::vector<double> CurvatureLengths;
  std::vector<char> IsFixed;
  /** Every other round: the next one mends what that has made. */
  bool AcceptsSmallAngles = false;
  /** Whether edges that are too long anyway may get a little longer. */
  bool AcceptsLongEdges = false;
  /** Edges are to be so many times as long as wanted: 1 but for strips. */
  double Scale = 1.0;
};
} // namespace cdm

#endif
