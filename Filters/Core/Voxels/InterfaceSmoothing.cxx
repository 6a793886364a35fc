// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Voxels/InterfaceSmoothing.h"

#include "Core/Basics/IdLists.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Meshes/TriangleIntersection.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cdm
{
namespace
{
/** Parts of a point's move that are left each time it goes back. */
constexpr double WaysBack[4] = { 1.0, 0.5, 0.25, 0.0 };

/** Moves are whole numbers of so small parts of the room that a point has along an axis. */
constexpr double PartsOfReach = 256.0;

/** Steps of relaxation, and their parts of the way to the middle and back (Taubin). */
constexpr int RelaxationSteps = 10;
constexpr double StepIn = 0.5;
constexpr double StepOut = -0.53;

struct NetEdge
{
  EdgeIds Points;
  Id Face;
};

/** Edges of all faces, those of one edge next to each other. */
std::vector<NetEdge> CollectEdges(const FaceNet& net)
{
  std::vector<NetEdge> edges;
  edges.reserve(4 * net.Faces.size());
  for (std::size_t f = 0; f < net.Faces.size(); ++f)
  {
    const std::array<Id, 4>& ids = net.Faces[f].Points;
    for (int i = 0; i < 4; ++i)
    {
      const Id a = ids[i];
      const Id b = ids[(i + 1) % 4];
      edges.push_back({ MakeEdge(a, b), static_cast<Id>(f) });
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const NetEdge& a, const NetEdge& b)
    { return a.Points != b.Points ? a.Points < b.Points : a.Face < b.Face; });
  return edges;
}

/** Whether the faces at each point hang together by edges at it. */
std::vector<char> FindConnectedPoints(const FaceNet& net)
{
  std::vector<std::pair<Id, Id>> pairs;
  pairs.reserve(4 * net.Faces.size());
  for (std::size_t f = 0; f < net.Faces.size(); ++f)
  {
    for (const Id id : net.Faces[f].Points)
    {
      pairs.emplace_back(id, static_cast<Id>(f));
    }
  }
  IdLists facesOfPoints;
  facesOfPoints.Build(static_cast<Id>(net.Points.size()), pairs);
  const auto shareEdge = [&](Id f, Id g)
  {
    int common = 0;
    for (const Id id : net.Faces[f].Points)
    {
      const std::array<Id, 4>& others = net.Faces[g].Points;
      common += Contains(others, id);
    }
    return common > 1;
  };
  std::vector<char> isConnected(net.Points.size());
  std::vector<Id> reached;
  std::vector<Id> rest;
  for (std::size_t point = 0; point < net.Points.size(); ++point)
  {
    const IdLists::Range faces = facesOfPoints[static_cast<Id>(point)];
    reached.assign(1, *faces.begin());
    rest.assign(faces.begin() + 1, faces.end());
    for (std::size_t i = 0; i < reached.size(); ++i)
    {
      const auto isApart = [&](Id f) { return !shareEdge(f, reached[i]); };
      const auto next = std::stable_partition(rest.begin(), rest.end(), isApart);
      reached.insert(reached.end(), next, rest.end());
      rest.erase(next, rest.end());
    }
    isConnected[point] = rest.empty();
  }
  return isConnected;
}

/** Finds for each point the points that it follows; none for points that stay. */
IdLists FindGuides(const FaceNet& net)
{
  const std::vector<NetEdge> edges = CollectEdges(net);
  std::vector<EdgeIds> all;
  std::vector<char> isJunction;
  std::vector<int> junctions(net.Points.size(), 0);
  std::vector<char> isMovable = FindConnectedPoints(net);
  std::vector<char> isOnGridEdge(net.Points.size(), 0);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end)
  {
    while (end < edges.size() && edges[end].Points == edges[begin].Points)
    {
      ++end;
    }
    const int side = net.Faces[edges[begin].Face].Side;
    const int otherSide = net.Faces[edges[end - 1].Face].Side;
    const bool isGridEdge = end - begin == 2 && side != otherSide && side > 0 && otherSide > 0;
    const bool isBorder = end - begin == 2 && side != otherSide && !isGridEdge;
    all.push_back(edges[begin].Points);
    isJunction.push_back(end - begin != 2 || isBorder);
    for (const Id id : edges[begin].Points)
    {
      junctions[id] += isJunction.back();
      isOnGridEdge[id] |= isGridEdge;
    }
  }
  for (std::size_t point = 0; point < net.Points.size(); ++point)
  {
    isMovable[point] = isMovable[point] &&
      (junctions[point] == 2 || (junctions[point] == 0 && !isOnGridEdge[point]));
  }
  std::vector<std::pair<Id, Id>> pairs;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    for (const auto& [point, other] :
      { std::make_pair(all[i][0], all[i][1]), std::make_pair(all[i][1], all[i][0]) })
    {
      if (isMovable[point] && (junctions[point] == 0 || isJunction[i]))
      {
        pairs.emplace_back(point, other);
      }
    }
  }
  IdLists guides;
  guides.Build(static_cast<Id>(net.Points.size()), pairs);
  return guides;
}

/** Finds how far each point is from the mean of its guides; zero for points and axes that stay. */
void FindPulls(const FaceNet& net, const IdLists& guides, const std::vector<Vec3>& places,
  std::vector<Vec3>& pulls)
{
  for (std::size_t point = 0; point < net.Points.size(); ++point)
  {
    const IdLists::Range ids = guides[static_cast<Id>(point)];
    pulls[point] = {};
    // Sums of differences: where coordinates are equal nothing moves, not even by rounding.
    for (const Id id : ids)
    {
      pulls[point] = pulls[point] + (places[id] - places[point]);
    }
    for (int axis = 0; axis < 3 && !ids.empty(); ++axis)
    {
      const bool isFree = net.Points[point].Up[axis] > 0.0;
      pulls[point][axis] = isFree ? pulls[point][axis] / static_cast<double>(ids.size()) : 0.0;
    }
  }
}

/**
 * Finds the weights of the filter as a sum of Chebyshev polynomials. A wave that is pulled to the
 * middle by k times its height keeps the part exp(-(k / limit)^2): a smooth transition from all to
 * nothing, so that edges do not make waves beside them. limit: k of a wave of this length along one
 * axis of a surface.
 */
std::vector<double> FindWeights(double length)
{
  const double pi = std::acos(-1.0);
  const double limit = length > 2.0 ? 0.5 * (1.0 - std::cos(2.0 * pi / length)) : 1.0;
  // Further weights are below 1e-4.
  const int count = static_cast<int>(std::ceil(10.0 / std::acos(1.0 - limit)));
  const int samples = 4 * count;
  std::vector<double> weights(count + 1, 0.0);
  for (int sample = 0; sample < samples; ++sample)
  {
    const double angle = pi * (sample + 0.5) / samples;
    const double ratio = (1.0 - std::cos(angle)) / limit;
    for (int i = 0; i <= count; ++i)
    {
      weights[i] += (i == 0 ? 1.0 : 2.0) / samples * std::exp(-ratio * ratio) * std::cos(i * angle);
    }
  }
  return weights;
}

/** The moves of a low pass filter. False if aborted. */
bool Filter(const FaceNet& net, const IdLists& guides, double length,
  const ExecutionContext& context, const std::vector<Vec3>& corners, std::vector<Vec3>& moves)
{
  const std::vector<double> weights = FindWeights(length);
  const int steps = static_cast<int>(weights.size()) - 1;
  // Positions by the last two polynomials, relative to the corners.
  std::vector<Vec3> before(corners.size());
  std::vector<Vec3> current(corners.size());
  std::vector<Vec3> places = corners;
  std::vector<Vec3> pulls(corners.size());
  moves.assign(corners.size(), {});
  double sum = weights[0];
  for (int step = 1; step <= steps; ++step)
  {
    if (!context.Continue(static_cast<double>(step) / (steps + 1), "Smoothing interfaces"))
    {
      return false;
    }
    FindPulls(net, guides, places, pulls);
    sum += weights[step];
    for (std::size_t point = 0; point < corners.size(); ++point)
    {
      const Vec3 next =
        step == 1 ? pulls[point] : 2.0 * (current[point] + pulls[point]) - before[point];
      before[point] = current[point];
      current[point] = next;
      places[point] = corners[point] + next;
      moves[point] = moves[point] + weights[step] * next;
    }
  }
  for (Vec3& move : moves)
  {
    move = (1.0 / sum) * move;
  }
  return true;
}

/** The nearest move within the limits of a point. */
Vec3 Limit(const FaceNet::Point& limits, const Vec3& move)
{
  Vec3 limited;
  for (int axis = 0; axis < 3; ++axis)
  {
    limited[axis] = std::min(std::max(move[axis], -limits.Down[axis]), limits.Up[axis]);
  }
  return limited;
}

/**
 * Short waves that come from the limits, as where edges of the surface would become rounder than
 * they can.
 */
bool Relax(const FaceNet& net, const IdLists& guides, const ExecutionContext& context,
  const std::vector<Vec3>& corners, std::vector<Vec3>& moves)
{
  std::vector<Vec3> places(corners.size());
  std::vector<Vec3> pulls(corners.size());
  for (int step = 0; step < 2 * RelaxationSteps; ++step)
  {
    if (!context.Continue(0.5 * step / RelaxationSteps, "Smoothing interfaces"))
    {
      return false;
    }
    for (std::size_t point = 0; point < corners.size(); ++point)
    {
      moves[point] = Limit(net.Points[point], moves[point]);
      places[point] = corners[point] + moves[point];
    }
    FindPulls(net, guides, places, pulls);
    for (std::size_t point = 0; point < corners.size(); ++point)
    {
      moves[point] = moves[point] + (step % 2 == 0 ? StepIn : StepOut) * pulls[point];
    }
  }
  return true;
}

/**
 * The positions after the moves, within the limits. Moves are rounded down: far from what was rough
 * they fade away, but never end, and the mesher would have to tell surfaces that are flat from
 * those that are flat to twelve digits.
 */
void Move(const FaceNet& net, const std::vector<Vec3>& moves, std::vector<Vec3>& places)
{
  for (std::size_t point = 0; point < places.size(); ++point)
  {
    const FaceNet::Point& limits = net.Points[point];
    const Vec3 move = Limit(limits, moves[point]);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double unit = (limits.Up[axis] + limits.Down[axis]) / PartsOfReach;
      if (unit > 0.0)
      {
        places[point][axis] += unit * std::trunc(move[axis] / unit);
      }
    }
  }
}
} // namespace

void TriangulateFaces(
  const FaceNet& net, const std::vector<Vec3>& places, std::vector<TriangleIds>& triangles)
{
  triangles.clear();
  triangles.reserve(2 * net.Faces.size());
  for (const FaceNet::Face& face : net.Faces)
  {
    const auto& [a, b, c, d] = face.Points;
    const auto isTurnedRight = [&](Id p, Id q, Id r)
    {
      return ProjectedOrientation(face.Axis, places[p], places[q], places[r]) ==
        (face.IsUp ? 1 : -1);
    };
    const bool isFirstShorter = Distance(places[a], places[c]) <= Distance(places[b], places[d]);
    const bool isFirstRight = isTurnedRight(a, b, c) && isTurnedRight(a, c, d);
    const bool isSecondRight = isTurnedRight(a, b, d) && isTurnedRight(b, c, d);
    if (isFirstRight && (isFirstShorter || !isSecondRight))
    {
      triangles.push_back({ a, b, c });
      triangles.push_back({ a, c, d });
    }
    else
    {
      triangles.push_back({ a, b, d });
      triangles.push_back({ b, c, d });
    }
  }
}

bool SmoothFaces(const FaceNet& net, double length, const ExecutionContext& context,
  std::vector<Vec3>& places, std::vector<TriangleIds>& triangles, Id& heldPoints)
{
  const std::vector<Vec3> corners = places;
  const IdLists guides = FindGuides(net);
  std::vector<Vec3> moves;
  if (!Filter(net, guides, length, context.Part(0.0, 0.2), corners, moves) ||
    !Relax(net, guides, context.Part(0.2, 0.3), corners, moves))
  {
    return false;
  }
  Move(net, moves, places);

  const std::vector<Vec3> smooth = places;
  std::vector<unsigned char> timesBack(places.size(), 0);
  std::vector<char> isActive;
  heldPoints = 0;
  double begin = 0.3;
  for (;;)
  {
    TriangulateFaces(net, places, triangles);
    std::vector<TrianglePair> pairs;
    const double end = 0.5 * (begin + 1.0);
    if (!FindIntersectingPairs(places, triangles, isActive, context.Part(begin, end), pairs))
    {
      return false;
    }
    begin = end;
    if (pairs.empty())
    {
      break;
    }
    std::vector<char> isChanged(places.size(), 0);
    for (const TrianglePair& pair : pairs)
    {
      for (const Id t : pair)
      {
        for (const Id id : triangles[t])
        {
          isChanged[id] = timesBack[id] < 3 && smooth[id] != corners[id];
        }
      }
    }
    for (std::size_t point = 0; point < places.size(); ++point)
    {
      if (isChanged[point])
      {
        heldPoints += timesBack[point] == 0;
        const double way = WaysBack[++timesBack[point]];
        places[point] =
          way > 0.0 ? corners[point] + way * (smooth[point] - corners[point]) : corners[point];
      }
    }
    // Pairs that were not looked at, as there were too many, are found by another full search.
    isActive.clear();
    if (pairs.size() < MaximumNumberOfPairs)
    {
      isActive.resize(triangles.size());
      for (std::size_t f = 0; f < net.Faces.size(); ++f)
      {
        const std::array<Id, 4>& ids = net.Faces[f].Points;
        isActive[2 * f] = isActive[2 * f + 1] =
          std::any_of(ids.begin(), ids.end(), [&](Id id) { return isChanged[id] != 0; });
      }
    }
  }
  return true;
}
} // namespace cdm
