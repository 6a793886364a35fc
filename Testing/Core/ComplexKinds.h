// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComplexKinds.h
 * @brief Random valid complexes of nine kinds, by a seed: what every criterion has to end on.
 *
 * Bodies touch each other in facets, single edges and points; angles are what chance makes them.
 * Each complex is turned about a random axis, moved by up to 1e6 of its size, and scaled by a power
 * of ten between 1e-9 and 1e9, unless it is to stay as it is.
 */
#ifndef cdmComplexKinds_h
#define cdmComplexKinds_h

#include "Core/Meshes/PolygonSoup.h"
#include "Core/Volume/AdvancingFrontTetrahedralizer.h"
#include "RandomComplexes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace cdm
{
enum class ComplexKind
{
  /** Labelled Delaunay tetrahedra of points in a cube. */
  CubeTetrahedra,
  /** The same of points with small integers as coordinates. */
  GridTetrahedra,
  /** The same of points in a slab of a thickness from 1e-2 to 1e-5. */
  SlabTetrahedra,
  /** Half planes at one edge, 0.1 to 5 degrees apart, and wedges between them. */
  Fan,
  /** Tetrahedra with a common apex, some with common facets, edges, or only that point. */
  Pyramids,
  /** Voronoi cells of points in a box. */
  VoronoiCells,
  /** Boxes beside and within each other, with widths of 1:1000. */
  Boxes,
  /** A box cut by planes that are almost parallel. */
  TiltedPlates,
  /** Slabs as above, of at most eight points. */
  SmallSlabs,
  /** 30 points in a slab of 1 x 1 x 0.001. */
  ManySheets
};
constexpr int NumberOfComplexKinds = 10;
/** Seeds of one kind are so far apart. The kinds from there on take those of the first ones. */
constexpr std::uint64_t SeedStep = 8;

inline const char* GetComplexKindName(ComplexKind kind)
{
  static const char* const names[NumberOfComplexKinds] = { "CubeTetrahedra", "GridTetrahedra",
    "SlabTetrahedra", "Fan", "Pyramids", "VoronoiCells", "Boxes", "TiltedPlates", "SmallSlabs",
    "ManySheets" };
  return names[static_cast<int>(kind)];
}

/** Makes one complex; a generator of its own for each seed. */
class ComplexMaker
{
public:
  ComplexMaker(ComplexKind kind, std::uint64_t seed)
    : Kind(kind), Generator(seed * SeedStep + static_cast<std::uint64_t>(kind))
  {
  }

  /** May be empty if chance has left no region. */
  PolygonSoup Make()
  {
    switch (this->Kind)
    {
      case ComplexKind::CubeTetrahedra:
        return this->MakeTetrahedra(this->MakePoints(this->Choose(5, 13), { 1.0, 1.0, 1.0 }));
      case ComplexKind::GridTetrahedra:
        return this->MakeTetrahedra(this->MakeGridPoints(this->Choose(5, 13)));
      case ComplexKind::SlabTetrahedra:
        return this->MakeTetrahedra(this->MakePoints(
          this->Choose(6, 30), { 1.0, 1.0, std::pow(10.0, -this->Pick(2.0, 5.0)) }));
      case ComplexKind::Fan:
        return this->MakeFan();
      case ComplexKind::Pyramids:
        return this->MakePyramids();
      case ComplexKind::VoronoiCells:
        return this->MakeVoronoiCells();
      case ComplexKind::Boxes:
        return this->MakeBoxes();
      case ComplexKind::TiltedPlates:
        return this->MakeTiltedPlates();
      case ComplexKind::SmallSlabs:
        return this->MakeTetrahedra(this->MakePoints(
          this->Choose(5, 8), { 1.0, 1.0, std::pow(10.0, -this->Pick(2.0, 5.0)) }));
      case ComplexKind::ManySheets:
        return this->MakeTetrahedra(this->MakePoints(30, { 1.0, 1.0, 1e-3 }));
    }
    return {};
  }

  /** Turns, moves and scales. */
  void Place(PolygonSoup& soup)
  {
    const Vec3 axis = MakeRandomDirection(this->Generator);
    const double angle = this->Pick(0.0, 3.0);
    const double distance = this->Choose(0, 1) == 0 ? 0.0 : std::pow(10.0, this->Pick(0.0, 6.0));
    const Vec3 shift = distance * MakeRandomDirection(this->Generator);
    const double scale = std::pow(10.0, this->Choose(-9, 9));
    Rotate(soup.Points, axis, angle);
    for (Vec3& p : soup.Points)
    {
      p = scale * (p + shift);
    }
  }

private:
  double Pick(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Generator);
  }
  int Choose(int low, int high)
  {
    return std::uniform_int_distribution<int>(low, high)(this->Generator);
  }
  /** One of three materials, or outside. */
  Id ChooseRegion() { return this->Choose(-1, 2); }

  std::vector<Vec3> MakePoints(int count, const Vec3& size)
  {
    std::vector<Vec3> points(count);
    for (Vec3& p : points)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] = this->Pick(0.0, size[axis]);
      }
    }
    return points;
  }

  std::vector<Vec3> MakeGridPoints(int count)
  {
    std::vector<Vec3> points;
    while (static_cast<int>(points.size()) < count)
    {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] = this->Choose(0, 5);
      }
      if (std::find(points.begin(), points.end(), p) == points.end())
      {
        points.push_back(p);
      }
    }
    return points;
  }

  static void AddPolygon(
    const std::vector<Id>& outline, const RegionPair& labels, PolygonSoup& soup)
  {
    soup.Connectivity.insert(soup.Connectivity.end(), outline.begin(), outline.end());
    soup.Offsets.push_back(static_cast<Id>(soup.Connectivity.size()));
    soup.Labels.push_back(labels);
  }

  /** The facets of tetrahedra that separate different regions. */
  static PolygonSoup MakeInterfaces(const std::vector<Vec3>& points,
    const std::vector<TetrahedronIds>& tetrahedra, const std::vector<Id>& regions)
  {
    // Of each facet the tetrahedron that it looks out of first, and its region.
    std::map<TriangleIds, std::pair<TriangleIds, RegionPair>> facets;
    for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    {
      for (int i = 0; i < 4; ++i)
      {
        const TriangleIds facet = GetFacet(tetrahedra[t], i);
        TriangleIds key = facet;
        std::sort(key.begin(), key.end());
        const auto place =
          facets.emplace(key, std::make_pair(facet, RegionPair{ OutsideRegion, regions[t] }));
        if (!place.second)
        {
          place.first->second.second.Front = regions[t];
        }
      }
    }
    PolygonSoup soup;
    soup.Points = points;
    for (const auto& facet : facets)
    {
      const auto& [ids, labels] = facet.second;
      if (labels.Front != labels.Back)
      {
        AddPolygon({ ids[0], ids[1], ids[2] }, labels, soup);
      }
    }
    return soup;
  }

  static TetMesh Tetrahedralize(const std::vector<Vec3>& points)
  {
    AdvancingFrontTetrahedralizerInput input;
    input.MeshPoints = &points;
    AdvancingFrontTetrahedralizerOptions options;
    options.CloseOpenBoundary = true;
    AdvancingFrontTetrahedralizerOutput output;
    return TetrahedralizeByAdvancingFront(input, options, {}, output).IsOk() ? output.Mesh
                                                                             : TetMesh();
  }

  PolygonSoup MakeTetrahedra(const std::vector<Vec3>& points)
  {
    const TetMesh mesh = Tetrahedralize(points);
    std::vector<Id> regions(mesh.Tetrahedra.size());
    std::generate(regions.begin(), regions.end(), [this] { return this->ChooseRegion(); });
    return MakeInterfaces(mesh.Points, { mesh.Tetrahedra.begin(), mesh.Tetrahedra.end() }, regions);
  }

  PolygonSoup MakeFan()
  {
    const int sheets = this->Choose(3, 12);
    PolygonSoup soup;
    soup.Points = { { 0, 0, 0 }, { 0, 0, 1 } };
    double angle = 0.0;
    for (int i = 0; i < sheets; ++i)
    {
      const double low = this->Pick(0.5, 1.5);
      const double high = this->Pick(0.5, 1.5);
      soup.Points.push_back(
        { low * std::cos(angle), low * std::sin(angle), this->Pick(-0.5, 0.4) });
      soup.Points.push_back(
        { high * std::cos(angle), high * std::sin(angle), this->Pick(0.6, 1.5) });
      angle += std::pow(10.0, this->Pick(-1.0, std::log10(5.0))) * 0.01745329251994330;
    }
    // Of each wedge between two sheets the region; a sheet is there where these differ.
    std::vector<Id> regions(sheets + 1, OutsideRegion);
    for (int i = 1; i < sheets; ++i)
    {
      regions[i] = this->ChooseRegion();
    }
    for (Id i = 0; i < sheets; ++i)
    {
      const Id a = 2 + 2 * i;
      if (regions[i] != regions[i + 1])
      {
        AddPolygon({ 0, a, a + 1, 1 }, { regions[i], regions[i + 1] }, soup);
      }
      const Id region = regions[i + 1];
      if (i + 1 < sheets && region != OutsideRegion)
      {
        const Id b = a + 2;
        const RegionPair labels{ OutsideRegion, region };
        AddPolygon({ 0, b, a }, labels, soup);
        AddPolygon({ 1, a + 1, b + 1 }, labels, soup);
        AddPolygon({ a, b, b + 1 }, labels, soup);
        AddPolygon({ a, b + 1, a + 1 }, labels, soup);
      }
    }
    return soup;
  }

  PolygonSoup MakePyramids()
  {
    // The Delaunay tetrahedra of points on a sphere and its center all meet there; the points then
    // go along their rays.
    std::vector<Vec3> points(1);
    for (int i = this->Choose(6, 20); i > 0; --i)
    {
      points.push_back(MakeRandomDirection(this->Generator));
    }
    const TetMesh mesh = Tetrahedralize(points);
    std::vector<TetrahedronIds> tetrahedra;
    std::vector<Id> regions;
    Id apex = 0;
    for (std::size_t i = 0; i < mesh.Points.size(); ++i)
    {
      apex = mesh.Points[i] == Vec3() ? static_cast<Id>(i) : apex;
    }
    for (const TetrahedronIds& tetrahedron : mesh.Tetrahedra)
    {
      if (std::find(tetrahedron.begin(), tetrahedron.end(), apex) != tetrahedron.end())
      {
        tetrahedra.push_back(tetrahedron);
        regions.push_back(this->ChooseRegion());
      }
    }
    std::vector<Vec3> moved = mesh.Points;
    for (Vec3& p : moved)
    {
      p = this->Pick(0.3, 1.5) * p;
    }
    return MakeInterfaces(moved, tetrahedra, regions);
  }

  PolygonSoup MakeVoronoiCells()
  {
    // Only cells that end within a box are regions: others may reach far away.
    const TetMesh mesh = Tetrahedralize(this->MakePoints(this->Choose(20, 40), { 1.0, 1.0, 1.0 }));
    std::vector<Id> regions(mesh.Points.size());
    std::generate(regions.begin(), regions.end(), [this] { return this->ChooseRegion(); });
    PolygonSoup soup;
    for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
    {
      const TetrahedronIds& ids = mesh.Tetrahedra[t];
      const Vec3 center = GetCircumcenterOf(GetCorners(mesh.Points, ids));
      soup.Points.push_back(center);
      for (int i = 0; i < 4; ++i)
      {
        for (Id point : ids)
        {
          const bool isEnd = mesh.Neighbors[t][i] == NoId && point != ids[i];
          if (isEnd || Distance(center, { 0.5, 0.5, 0.5 }) > 1.0)
          {
            regions[point] = OutsideRegion;
          }
        }
      }
    }
    AddDualPolygons(mesh, regions, soup);
    return soup;
  }

  static Vec3 GetCircumcenterOf(const std::array<Vec3, 4>& p)
  {
    const Vec3 u = p[1] - p[0];
    const Vec3 v = p[2] - p[0];
    const Vec3 w = p[3] - p[0];
    const Vec3 sum =
      SquaredNorm(u) * Cross(v, w) + SquaredNorm(v) * Cross(w, u) + SquaredNorm(w) * Cross(u, v);
    return p[0] + (0.5 / Dot(u, Cross(v, w))) * sum;
  }

  /** The polygon of each edge between points of different regions: around it, tetrahedron by
   * tetrahedron. */
  static void AddDualPolygons(
    const TetMesh& mesh, const std::vector<Id>& regions, PolygonSoup& soup)
  {
    std::map<EdgeIds, bool> done;
    for (std::size_t first = 0; first < mesh.Tetrahedra.size(); ++first)
    {
      for (const auto& edge : TetrahedronEdges)
      {
        const Id a = mesh.Tetrahedra[first][edge[0]];
        const Id b = mesh.Tetrahedra[first][edge[1]];
        const EdgeIds key{ std::min(a, b), std::max(a, b) };
        if (regions[a] == regions[b] || !done.emplace(key, true).second)
        {
          continue;
        }
        std::vector<Id> outline;
        Id t = static_cast<Id>(first);
        Id from = NoId;
        do
        {
          outline.push_back(t);
          Id next = NoId;
          for (int i = 0; i < 4 && next == NoId; ++i)
          {
            const Id opposite = mesh.Tetrahedra[t][i];
            const Id other = mesh.Neighbors[t][i] / 4;
            const bool isAtEdge = opposite != a && opposite != b && mesh.Neighbors[t][i] != NoId;
            next =
              isAtEdge && other != from && (from != NoId || outline.size() == 1) ? other : NoId;
          }
          from = t;
          t = next;
        } while (t != NoId && t != static_cast<Id>(first));
        if (t == NoId || outline.size() < 3)
        {
          continue;
        }
        const Vec3 direction = mesh.Points[b] - mesh.Points[a];
        Vec3 normal;
        for (std::size_t i = 1; i + 1 < outline.size(); ++i)
        {
          normal = normal +
            Cross(soup.Points[outline[i]] - soup.Points[outline[0]],
              soup.Points[outline[i + 1]] - soup.Points[outline[0]]);
        }
        const bool looksToB = Dot(normal, direction) > 0.0;
        AddPolygon(outline,
          looksToB ? RegionPair{ regions[b], regions[a] } : RegionPair{ regions[a], regions[b] },
          soup);
      }
    }
  }

  PolygonSoup MakeBoxes()
  {
    std::vector<double> lines[3];
    for (std::vector<double>& line : lines)
    {
      line.push_back(0.0);
      for (int i = this->Choose(1, 3); i > 0; --i)
      {
        line.push_back(line.back() + std::pow(10.0, -this->Pick(0.0, 3.0)));
      }
    }
    const int n[3] = { static_cast<int>(lines[0].size()), static_cast<int>(lines[1].size()),
      static_cast<int>(lines[2].size()) };
    PolygonSoup soup;
    for (int k = 0; k < n[2]; ++k)
    {
      for (int j = 0; j < n[1]; ++j)
      {
        for (int i = 0; i < n[0]; ++i)
        {
          soup.Points.push_back({ lines[0][i], lines[1][j], lines[2][k] });
        }
      }
    }
    const auto getPoint = [&](std::array<int, 3> p) { return (p[2] * n[1] + p[1]) * n[0] + p[0]; };
    std::map<std::array<int, 3>, Id> regions;
    for (int k = 0; k + 1 < n[2]; ++k)
    {
      for (int j = 0; j + 1 < n[1]; ++j)
      {
        for (int i = 0; i + 1 < n[0]; ++i)
        {
          regions[{ i, j, k }] = this->ChooseRegion();
        }
      }
    }
    const auto getRegion = [&](const std::array<int, 3>& cell)
    {
      const auto place = regions.find(cell);
      return place == regions.end() ? OutsideRegion : place->second;
    };
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      std::array<int, 3> cell{};
      for (cell[axis] = 0; cell[axis] < n[axis]; ++cell[axis])
      {
        for (cell[u] = 0; cell[u] + 1 < n[u]; ++cell[u])
        {
          for (cell[v] = 0; cell[v] + 1 < n[v]; ++cell[v])
          {
            std::array<int, 3> before = cell;
            --before[axis];
            const RegionPair labels{ getRegion(cell), getRegion(before) };
            if (labels.Front != labels.Back)
            {
              std::array<int, 3> corners[4] = { cell, cell, cell, cell };
              ++corners[1][u];
              ++corners[2][u];
              ++corners[2][v];
              ++corners[3][v];
              AddPolygon({ getPoint(corners[0]), getPoint(corners[1]), getPoint(corners[2]),
                           getPoint(corners[3]) },
                labels, soup);
            }
          }
        }
      }
    }
    return soup;
  }

  PolygonSoup MakeTiltedPlates()
  {
    CellComplex complex({ 1.0, 1.0, 1.0 });
    const Vec3 common = MakeRandomDirection(this->Generator);
    const double tilt = std::pow(10.0, -this->Pick(0.5, 4.0));
    const double spread = std::pow(10.0, -this->Pick(0.5, 3.0));
    const Vec3 inside = this->MakePoints(1, { 1.0, 1.0, 1.0 })[0];
    for (int cut = this->Choose(2, 5); cut > 0; --cut)
    {
      Vec3 normal = common + tilt * MakeRandomDirection(this->Generator);
      normal = (1.0 / Norm(normal)) * normal;
      complex.Cut(normal, Dot(normal, inside) + this->Pick(-spread, spread), 1e-6);
    }
    // Cells of one material are one region; what separates them is left out.
    std::vector<Id> regions(complex.GetNumberOfCells());
    std::generate(regions.begin(), regions.end(), [this] { return this->ChooseRegion(); });
    const auto getRegion = [&](Id cell) { return cell < 0 ? OutsideRegion : regions[cell]; };
    const PolygonSoup cells = complex.GetSoup();
    PolygonSoup soup;
    soup.Points = cells.Points;
    for (Id polygon = 0; polygon < cells.GetNumberOfPolygons(); ++polygon)
    {
      const RegionPair labels{ getRegion(cells.Labels[polygon].Front),
        getRegion(cells.Labels[polygon].Back) };
      if (labels.Front != labels.Back)
      {
        const Id* const ids = cells.GetPolygon(polygon);
        AddPolygon({ ids, ids + cells.GetPolygonSize(polygon) }, labels, soup);
      }
    }
    return soup;
  }

  const ComplexKind Kind;
  std::mt19937_64 Generator;
};
} // namespace cdm

#endif
