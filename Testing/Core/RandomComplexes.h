// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomComplexes.h
 * @brief Random piecewise linear complexes for the tests: boxes cut by planes, fans of facets at
 * one edge, stacks of layers, all with labels and in any position.
 */
#ifndef cdmRandomComplexes_h
#define cdmRandomComplexes_h

#include "Core/Meshes/PolygonSoup.h"

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace cdm
{
/** A partition of a box into convex cells; each polygon separates two cells or bounds one. */
class CellComplex
{
public:
  explicit CellComplex(const Vec3& size)
  {
    for (int i = 0; i < 8; ++i)
    {
      this->Points.push_back({ (i & 1) * size.X, ((i >> 1) & 1) * size.Y, (i >> 2) * size.Z });
    }
    // Outlines counter-clockwise seen from outside: the front looks out of the cell behind it.
    for (const std::vector<Id>& outline : std::vector<std::vector<Id>>{ { 0, 2, 3, 1 },
           { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
    {
      this->Faces.push_back({ outline, { OutsideRegion, 0 } });
    }
  }

  /** Cut all cells by the plane normal * x = offset, unless it comes too close to a vertex. */
  bool Cut(const Vec3& normal, double offset, double clearance)
  {
    std::vector<double> heights;
    for (const Vec3& p : this->Points)
    {
      heights.push_back(Dot(normal, p) - offset);
      if (std::abs(heights.back()) < clearance)
      {
        return false;
      }
    }
    std::map<EdgeIds, Id> cuts;
    const auto getCut = [&](Id a, Id b)
    {
      const EdgeIds edge{ std::min(a, b), std::max(a, b) };
      const auto [place, isNew] = cuts.emplace(edge, static_cast<Id>(this->Points.size()));
      if (isNew)
      {
        const double t = heights[edge[0]] / (heights[edge[0]] - heights[edge[1]]);
        this->Points.push_back(
          this->Points[edge[0]] + t * (this->Points[edge[1]] - this->Points[edge[0]]));
      }
      return place->second;
    };
    std::vector<Face> faces;
    // For each cell the edges of its cut, and its number above the plane.
    std::map<Id, std::map<Id, Id>> nextInCut;
    std::map<Id, Id> above;
    const auto getAbove = [&](Id cell)
    {
      return cell == OutsideRegion
        ? cell
        : above.emplace(cell, this->NumberOfCells + static_cast<Id>(above.size())).first->second;
    };
    // Which cells are cut has to be known before the faces of one are handed on.
    std::map<Id, int> sides;
    for (const Face& face : this->Faces)
    {
      for (Id cell : { face.Labels.Front, face.Labels.Back })
      {
        for (Id id : face.Outline)
        {
          sides[cell] |= heights[id] > 0.0 ? 2 : 1;
        }
      }
    }
    const auto isCut = [&](Id cell) { return cell != OutsideRegion && sides[cell] == 3; };
    for (const Face& face : this->Faces)
    {
      Face parts[2];
      Id enter = NoId;
      Id leave = NoId;
      for (std::size_t i = 0; i < face.Outline.size(); ++i)
      {
        const Id a = face.Outline[i];
        const Id b = face.Outline[(i + 1) % face.Outline.size()];
        const bool isAbove = heights[a] > 0.0;
        parts[isAbove].Outline.push_back(a);
        if (isAbove != (heights[b] > 0.0))
        {
          const Id cut = getCut(a, b);
          parts[0].Outline.push_back(cut);
          parts[1].Outline.push_back(cut);
          (isAbove ? leave : enter) = cut;
        }
      }
      for (int side = 0; side < 2; ++side)
      {
        if (!parts[side].Outline.empty())
        {
          const auto getLabel = [&](Id cell)
          { return side == 1 && isCut(cell) ? getAbove(cell) : cell; };
          parts[side].Labels = { getLabel(face.Labels.Front), getLabel(face.Labels.Back) };
          faces.push_back(parts[side]);
        }
      }
      if (enter != NoId)
      {
        // The part below closes from enter to leave; the cut runs the other way.
        nextInCut[face.Labels.Back][leave] = enter;
        nextInCut[face.Labels.Front][enter] = leave;
      }
    }
    for (const auto& [cell, next] : nextInCut)
    {
      if (!isCut(cell))
      {
        continue;
      }
      Face face;
      Id point = next.begin()->first;
      do
      {
        face.Outline.push_back(point);
        point = next.at(point);
      } while (point != next.begin()->first);
      // Counter-clockwise seen from above the plane: what is left of the cell lies behind.
      face.Labels = { getAbove(cell), cell };
      faces.push_back(face);
    }
    this->NumberOfCells += static_cast<Id>(above.size());
    this->Faces = std::move(faces);
    return true;
  }

  Id GetNumberOfCells() const { return this->NumberOfCells; }

  PolygonSoup GetSoup() const
  {
    PolygonSoup soup;
    soup.Points = this->Points;
    for (const Face& face : this->Faces)
    {
      soup.Connectivity.insert(soup.Connectivity.end(), face.Outline.begin(), face.Outline.end());
      soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
      soup.Labels.push_back(face.Labels);
    }
    return soup;
  }

private:
  struct Face
  {
    std::vector<Id> Outline;
    RegionPair Labels;
  };

  std::vector<Vec3> Points;
  std::vector<Face> Faces;
  Id NumberOfCells = 1;
};

inline Vec3 MakeRandomDirection(std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Vec3 direction;
  do
  {
    direction = { uniform(generator), uniform(generator), uniform(generator) };
  } while (Norm(direction) > 1.0 || Norm(direction) < 0.1);
  return (1.0 / Norm(direction)) * direction;
}

/** Turn about an axis through the origin by an angle in radians. */
inline void Rotate(std::vector<Vec3>& points, const Vec3& axis, double angle)
{
  for (Vec3& p : points)
  {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    p = c * p + s * Cross(axis, p) + ((1.0 - c) * Dot(axis, p)) * axis;
  }
}

/** Which keeps seven digits. */
inline void RoundToSinglePrecision(std::vector<Vec3>& points)
{
  for (Vec3& point : points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] = static_cast<double>(static_cast<float>(point[axis]));
    }
  }
}

/** A box cut by planes near its center, turned about a random axis by an angle in radians. */
inline PolygonSoup MakeTurnedComplex(
  std::mt19937_64& generator, const Vec3& size, int cuts, double angle)
{
  CellComplex complex(size);
  for (int cut = 0; cut < cuts; ++cut)
  {
    const Vec3 normal = MakeRandomDirection(generator);
    complex.Cut(normal, Dot(normal, 0.5 * size) + 0.1 * (cut - 0.5 * (cuts - 1)), 0.02);
  }
  PolygonSoup soup = complex.GetSoup();
  Rotate(soup.Points, MakeRandomDirection(generator), angle);
  return soup;
}
} // namespace cdm

#endif
