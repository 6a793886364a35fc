// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/GridBlock.h"

#include "Core/Basics/ParallelLoop.h"
#include "Core/Basics/SortedIds.h"
#include "Core/Meshes/TetMesh.h"

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <utility>

namespace cdm
{
namespace
{
/** The block has at least one of so many points. */
constexpr std::size_t SmallestShare = 8;
/** The lattice of all lines has at most this many crossings per point. */
constexpr std::size_t LargestLattice = 4;

/** False if less than one of 16 points of a sample shares a coordinate with another one. */
bool HasLines(const RawVector<Vec3>& points)
{
  constexpr std::size_t SampleSize = 1024;
  const std::size_t step = std::max<std::size_t>(1, points.size() / SampleSize);
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<double> sample;
    for (std::size_t i = 0; i < points.size(); i += step)
    {
      sample.push_back(points[i][axis]);
    }
    std::sort(sample.begin(), sample.end());
    std::size_t repeated = 0;
    for (std::size_t i = 1; i < sample.size(); ++i)
    {
      repeated += sample[i] == sample[i - 1] ? 1 : 0;
    }
    if (16 * repeated < sample.size())
    {
      return false;
    }
  }
  return true;
}

/**
 * The lines of an axis that have many points: numbers in ascending order, and each point's or NoId.
 */
struct Lines
{
  std::vector<Id> OfPoints;
  Id Count = 0;

  bool Find(const RawVector<Vec3>& points, int axis);
};

bool Lines::Find(const RawVector<Vec3>& points, int axis)
{
  const std::size_t mostValues = 64 + points.size() / 4;
  std::unordered_map<double, Id> values;
  std::vector<Id> counts;
  this->OfPoints.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    // Neighbors on the curve share two of three coordinates.
    const double x = points[i][axis];
    Id line = i > 0 && points[i - 1][axis] == x ? this->OfPoints[i - 1] : NoId;
    if (line == NoId)
    {
      line = values.emplace(x, static_cast<Id>(values.size())).first->second;
      if (values.size() > mostValues)
      {
        return false;
      }
      counts.resize(values.size(), 0);
    }
    this->OfPoints[i] = line;
    ++counts[line];
  }
  std::vector<Id> sorted(counts);
  std::sort(sorted.rbegin(), sorted.rend());
  std::size_t sum = 0;
  std::size_t middle = 0;
  while (2 * (sum += static_cast<std::size_t>(sorted[middle])) < points.size())
  {
    ++middle;
  }
  const Id least = std::max(4, sorted[middle] / 4);
  std::vector<std::pair<double, Id>> lines;
  for (const auto& [x, line] : values)
  {
    if (counts[line] >= least)
    {
      lines.emplace_back(x, line);
    }
  }
  std::sort(lines.begin(), lines.end());
  std::vector<Id> numbers(counts.size(), NoId);
  for (const auto& [x, line] : lines)
  {
    numbers[line] = this->Count++;
  }
  for (Id& line : this->OfPoints)
  {
    line = numbers[line];
  }
  return this->Count >= 2;
}

/** The points at the crossings of lines; lines are dropped until no point is missing. */
class Lattice
{
public:
  explicit Lattice(const std::array<Lines, 3>& lines)
    : Strides{ 1, std::size_t(lines[0].Count),
        std::size_t(lines[0].Count) * std::size_t(lines[1].Count) },
      Points(this->Strides[2] * std::size_t(lines[2].Count), NoId)
  {
    for (std::size_t i = 0; i < lines[0].OfPoints.size(); ++i)
    {
      const std::array<Id, 3> place{ lines[0].OfPoints[i], lines[1].OfPoints[i],
        lines[2].OfPoints[i] };
      if (!Contains(place, NoId))
      {
        this->GetPoint(place) = static_cast<Id>(i);
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Axes[axis].Kept = lines[axis].Count;
      this->Axes[axis].IsDropped.resize(lines[axis].Count, false);
      this->Axes[axis].Missing.resize(lines[axis].Count, 0);
    }
    this->ForAll(this->GetAllLines(),
      [this](const std::array<Id, 3>& place) { this->CountMissing(place, 1); });
    for (Axis& axis : this->Axes)
    {
      for (Id line = 0; line < axis.Kept; ++line)
      {
        axis.Worst.emplace(axis.Missing[line], line);
      }
    }
  }

  GridBlock GetBlock(std::size_t smallest)
  {
    GridBlock block;
    do
    {
      if (this->Axes[0].Kept < 2 || this->Axes[1].Kept < 2 || this->Axes[2].Kept < 2 ||
        std::size_t(this->Axes[0].Kept) * std::size_t(this->Axes[1].Kept) *
            std::size_t(this->Axes[2].Kept) <
          smallest)
      {
        return block;
      }
    } while (this->DropWorstLine());
    block.Sizes = { this->Axes[0].Kept, this->Axes[1].Kept, this->Axes[2].Kept };
    this->ForAll(this->GetAllLines(),
      [this, &block](const std::array<Id, 3>& place)
      { block.Points.push_back(this->GetPoint(place)); });
    return block;
  }

private:
  struct Axis
  {
    Id Kept;
    std::vector<bool> IsDropped;
    /** Points that are missing on each line, as long as it is kept. */
    std::vector<Id> Missing;
    /** Queue of the lines by how many points they miss at least: the worst line first. */
    std::priority_queue<std::pair<Id, Id>> Worst;
  };
  /** Lines from the first to before the second, on each axis. */
  using Range = std::array<std::pair<Id, Id>, 3>;

  Id& GetPoint(const std::array<Id, 3>& place)
  {
    return this->Points[std::size_t(place[0]) + this->Strides[1] * std::size_t(place[1]) +
      this->Strides[2] * std::size_t(place[2])];
  }

  Range GetAllLines() const
  {
    return { std::make_pair(0, Id(this->Axes[0].IsDropped.size())),
      std::make_pair(0, Id(this->Axes[1].IsDropped.size())),
      std::make_pair(0, Id(this->Axes[2].IsDropped.size())) };
  }

  /** Calls work(place) for the crossings of lines that are kept. */
  template <typename Work>
  void ForAll(const Range& range, const Work& work)
  {
    for (Id z = range[2].first; z < range[2].second; ++z)
    {
      for (Id y = range[1].first; y < range[1].second && !this->Axes[2].IsDropped[z]; ++y)
      {
        for (Id x = range[0].first; x < range[0].second && !this->Axes[1].IsDropped[y]; ++x)
        {
          if (!this->Axes[0].IsDropped[x])
          {
            work(std::array<Id, 3>{ x, y, z });
          }
        }
      }
    }
  }

  void CountMissing(const std::array<Id, 3>& place, Id change)
  {
    if (this->GetPoint(place) == NoId)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        this->Axes[axis].Missing[place[axis]] += change;
      }
    }
  }

  /** False if no point is missing. */
  bool DropWorstLine()
  {
    // All lines of one axis have the same number of crossings.
    int worst = -1;
    double largest = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      Axis& axis = this->Axes[i];
      while (axis.Worst.top().first != axis.Missing[axis.Worst.top().second])
      {
        const Id line = axis.Worst.top().second;
        axis.Worst.pop();
        axis.Worst.emplace(axis.Missing[line], line);
      }
      const double share = double(axis.Worst.top().first) * axis.Kept;
      worst = share > largest ? i : worst;
      largest = std::max(largest, share);
    }
    if (worst < 0)
    {
      return false;
    }
    Axis& axis = this->Axes[worst];
    const Id line = axis.Worst.top().second;
    Range range = this->GetAllLines();
    range[worst] = { line, line + 1 };
    this->ForAll(range, [this](const std::array<Id, 3>& place) { this->CountMissing(place, -1); });
    axis.Worst.pop();
    axis.IsDropped[line] = true;
    --axis.Kept;
    return true;
  }

  std::array<std::size_t, 3> Strides;
  /** The point at each crossing, or NoId. */
  std::vector<Id> Points;
  std::array<Axis, 3> Axes;
};

/** Corners of a box: bit i is set on the upper side of axis i. */
constexpr int NumberOfCorners = 8;
/** Ways to pull the corners: the lowest one, and the diagonals of the faces opposite to it. */
constexpr int NumberOfPatterns = 64;
/**
 * Indices of the vertices of a facet on the hull, in the tetrahedron with the vertex at infinity
 * beyond it.
 */
constexpr Id BeyondPlaces[3] = { 1, 3, 2 };

/** The tetrahedra that one pattern makes of a box. */
struct BoxPattern
{
  /** Corners of the six tetrahedra, the lowest one last. */
  unsigned char Corners[6][4];
  /** Facets in the same box: 4 * tetrahedron + facet; or -1 less a triangle of the faces. */
  signed char Links[6][4];
  /** The facet at each triangle of the faces, which are 4 * axis + 2 * side + half. */
  signed char Facets[12];
};

/**
 * The diagonal of a face across an axis joins corners that differ in one of its axes, or do not.
 */
inline int GetDiagonal(int axis, int corner)
{
  return ((corner >> ((axis + 1) % 3)) ^ (corner >> ((axis + 2) % 3))) & 1;
}

struct PatternTable
{
  BoxPattern Patterns[NumberOfPatterns];

  PatternTable()
  {
    for (int pattern = 0; pattern < NumberOfPatterns; ++pattern)
    {
      this->Make(pattern % NumberOfCorners, pattern / NumberOfCorners, this->Patterns[pattern]);
    }
  }

private:
  static void Make(int apex, int diagonals, BoxPattern& pattern)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const int diagonal = (diagonals >> axis) & 1;
      const int u = 1 << ((axis + 1) % 3);
      const int v = 1 << ((axis + 2) % 3);
      const int base = ~apex & (1 << axis);
      for (int half = 0; half < 2; ++half)
      {
        // The third corner is off the diagonal.
        const int ends[2] = { diagonal != 0 ? u : 0, diagonal != 0 ? v : u + v };
        const int third = half != 0 ? (diagonal != 0 ? u + v : v) : (diagonal != 0 ? 0 : u);
        int corners[4] = { base + ends[0], base + ends[1], base + third, apex };
        if (!IsPositive(corners))
        {
          std::swap(corners[0], corners[1]);
        }
        std::copy(corners, corners + 4, pattern.Corners[2 * axis + half]);
      }
    }
    for (int facet = 0; facet < 24; ++facet)
    {
      const int set = GetSet(pattern, facet);
      const int triangle = GetTriangle(set);
      int link = -1 - triangle;
      for (int other = 0; other < 24 && triangle < 0; ++other)
      {
        link = other != facet && GetSet(pattern, other) == set ? other : link;
      }
      pattern.Links[facet / 4][facet % 4] = static_cast<signed char>(link);
      if (triangle >= 0)
      {
        pattern.Facets[triangle] = static_cast<signed char>(facet);
      }
    }
  }

  static bool IsPositive(const int (&corners)[4])
  {
    int d[3][3];
    for (int i = 0; i < 3; ++i)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        d[i][axis] = ((corners[i] >> axis) & 1) - ((corners[3] >> axis) & 1);
      }
    }
    return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
      d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
      d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]) <
      0;
  }

  /** The corners of a facet as bits. */
  static int GetSet(const BoxPattern& pattern, int facet)
  {
    int set = 0;
    for (int place : FacetVertices[facet % 4])
    {
      set |= 1 << pattern.Corners[facet / 4][place];
    }
    return set;
  }

  /** The triangle of the faces with these three corners; negative if there is none. */
  static int GetTriangle(int set)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      int sides = 0;
      int differing = 0;
      for (int corner = 0; corner < NumberOfCorners; ++corner)
      {
        if (((set >> corner) & 1) != 0)
        {
          sides += (corner >> axis) & 1;
          differing += GetDiagonal(axis, corner);
        }
      }
      if (sides % 3 != 0)
      {
        continue;
      }
      // Off the diagonal is the one corner unlike the other two.
      int half = 0;
      for (int corner = 0; corner < NumberOfCorners; ++corner)
      {
        if (((set >> corner) & 1) != 0 && (GetDiagonal(axis, corner) == 1) == (differing == 1))
        {
          half = (corner >> ((axis + 2) % 3)) & 1;
        }
      }
      return 4 * axis + 2 * (sides / 3) + half;
    }
    return -1;
  }
};

const PatternTable& GetPatterns()
{
  static const PatternTable Table;
  return Table;
}

class BlockMesher
{
public:
  BlockMesher(const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads,
    RawVector<TetrahedronIds>& tetrahedra, RawVector<TetrahedronIds>& neighbors)
    : Block(block), Numbers(numbers), Infinite(static_cast<Id>(numbers.size())),
      NumberOfThreads(numberOfThreads), Tetrahedra(tetrahedra), Neighbors(neighbors),
      Table(GetPatterns().Patterns)
  {
  }

  bool Run(const ExecutionContext& context);

private:
  void NumberBoxes();
  int GetPattern(Id place) const;
  void MakeBox(Id box);
  void ConnectBeyond(Id tetrahedron);
  Id GetSize(int axis) const { return this->Block.Sizes[axis]; }
  Id GetStride(int axis) const
  {
    return axis == 0 ? 1 : axis == 1 ? this->GetSize(0) : this->GetSize(0) * this->GetSize(1);
  }
  /** The index of a corner from that of the lowest corner. */
  Id GetCorner(Id place, int corner) const
  {
    return place + ((corner & 1) != 0 ? this->GetStride(0) : 0) +
      ((corner & 2) != 0 ? this->GetStride(1) : 0) + ((corner & 4) != 0 ? this->GetStride(2) : 0);
  }
  template <typename Work>
  bool ForAll(std::size_t size, const ExecutionContext& context, const Work& work) const
  {
    return ParallelLoop(size, { this->NumberOfThreads, std::size_t(1) << 13 }, context,
      "Tetrahedralizing the points",
      [&work](std::size_t begin, std::size_t end, std::size_t)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          work(static_cast<Id>(i));
        }
      });
  }

  const GridBlock& Block;
  const std::vector<Id>& Numbers;
  const Id Infinite;
  const int NumberOfThreads;
  RawVector<TetrahedronIds>& Tetrahedra;
  RawVector<TetrahedronIds>& Neighbors;
  const BoxPattern* const Table;

  /** Boxes in the order of the points at their lowest corners: the index of each, and back. */
  std::vector<Id> PlacesOfBoxes;
  std::vector<Id> BoxesOfPlaces;
  RawVector<unsigned char> Patterns;
};

void BlockMesher::NumberBoxes()
{
  const std::size_t count = this->Block.Points.size();
  std::vector<Id> placesOfPoints(static_cast<std::size_t>(this->Infinite), NoId);
  std::size_t place = 0;
  for (Id z = 0; z < this->GetSize(2); ++z)
  {
    for (Id y = 0; y < this->GetSize(1); ++y)
    {
      for (Id x = 0; x < this->GetSize(0); ++x, ++place)
      {
        if (x + 1 < this->GetSize(0) && y + 1 < this->GetSize(1) && z + 1 < this->GetSize(2))
        {
          placesOfPoints[this->Block.Points[place]] = static_cast<Id>(place);
        }
      }
    }
  }
  this->BoxesOfPlaces.resize(count, NoId);
  for (Id corner : placesOfPoints)
  {
    if (corner != NoId)
    {
      this->BoxesOfPlaces[corner] = static_cast<Id>(this->PlacesOfBoxes.size());
      this->PlacesOfBoxes.push_back(corner);
    }
  }
}

int BlockMesher::GetPattern(Id place) const
{
  Id numbers[NumberOfCorners];
  int apex = 0;
  for (int corner = 0; corner < NumberOfCorners; ++corner)
  {
    numbers[corner] = this->Numbers[this->Block.Points[this->GetCorner(place, corner)]];
    apex = numbers[corner] < numbers[apex] ? corner : apex;
  }
  int pattern = apex;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = 1 << ((axis + 1) % 3);
    const int v = 1 << ((axis + 2) % 3);
    const int base = ~apex & (1 << axis);
    int lowest = base;
    for (int corner : { base + u, base + v, base + u + v })
    {
      lowest = numbers[corner] < numbers[lowest] ? corner : lowest;
    }
    pattern += NumberOfCorners * (GetDiagonal(axis, lowest) << axis);
  }
  return pattern;
}

void BlockMesher::MakeBox(Id box)
{
  const Id place = this->PlacesOfBoxes[box];
  const BoxPattern& pattern = this->Table[this->Patterns[box]];
  Id points[NumberOfCorners];
  for (int corner = 0; corner < NumberOfCorners; ++corner)
  {
    points[corner] = this->Block.Points[this->GetCorner(place, corner)];
  }
  // The facets beyond the triangles of the faces.
  const Id position[3] = { place % this->GetSize(0), place / this->GetStride(1) % this->GetSize(1),
    place / this->GetStride(2) };
  Id beyond[12];
  Id firstTriangle = 6 * static_cast<Id>(this->PlacesOfBoxes.size());
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const Id facesOfSide = (this->GetSize(u) - 1) * (this->GetSize(v) - 1);
    for (int side = 0; side < 2; ++side)
    {
      if (position[axis] != (side == 0 ? 0 : this->GetSize(axis) - 2))
      {
        const Id stride = this->GetStride(axis);
        const Id other = this->BoxesOfPlaces[side == 0 ? place - stride : place + stride];
        const BoxPattern& otherPattern = this->Table[this->Patterns[other]];
        for (int half = 0; half < 2; ++half)
        {
          beyond[4 * axis + 2 * side + half] =
            24 * other + otherPattern.Facets[4 * axis + 2 * (1 - side) + half];
        }
      }
      else
      {
        for (int half = 0; half < 2; ++half)
        {
          const int triangle = 4 * axis + 2 * side + half;
          const Id t =
            firstTriangle + 2 * (position[u] + position[v] * (this->GetSize(u) - 1)) + half;
          const int facet = pattern.Facets[triangle];
          const unsigned char* const corners = pattern.Corners[facet / 4];
          TetrahedronIds& ids = this->Tetrahedra[t];
          ids[0] = this->Infinite;
          for (int i = 0; i < 3; ++i)
          {
            ids[BeyondPlaces[i]] = points[corners[FacetVertices[facet % 4][i]]];
          }
          this->Neighbors[t][0] = 24 * box + facet;
          beyond[triangle] = 4 * t;
        }
      }
      firstTriangle += 2 * facesOfSide;
    }
  }
  for (int i = 0; i < 6; ++i)
  {
    const unsigned char* const corners = pattern.Corners[i];
    const signed char* const links = pattern.Links[i];
    TetrahedronIds& neighbors = this->Neighbors[6 * box + i];
    for (int k = 0; k < 4; ++k)
    {
      neighbors[k] = links[k] >= 0 ? 24 * box + links[k] : beyond[-1 - links[k]];
    }
    this->Tetrahedra[6 * box + i] = { points[corners[0]], points[corners[1]], points[corners[2]],
      points[corners[3]] };
  }
}

/** Neighbors of a tetrahedron with the vertex at infinity: around each edge, through the block. */
void BlockMesher::ConnectBeyond(Id tetrahedron)
{
  const Id facet = this->Neighbors[tetrahedron][0];
  for (int i = 0; i < 3; ++i)
  {
    Id t = facet / 4;
    int in = facet % 4;
    int out = FacetVertices[in][i];
    const Id opposite = this->Tetrahedra[t][out];
    TetrahedronIds edge;
    int size = 0;
    for (Id vertex : this->Tetrahedra[t])
    {
      if (vertex != opposite && vertex != this->Tetrahedra[t][in])
      {
        edge[size++] = vertex;
      }
    }
    Id next = this->Neighbors[t][out];
    while (this->Tetrahedra[next / 4][0] != this->Infinite)
    {
      t = next / 4;
      in = next % 4;
      for (int k = 0; k < 4; ++k)
      {
        const Id vertex = this->Tetrahedra[t][k];
        out = k != in && vertex != edge[0] && vertex != edge[1] ? k : out;
      }
      next = this->Neighbors[t][out];
    }
    const int* const other = FacetVertices[out];
    this->Neighbors[tetrahedron][BeyondPlaces[i]] =
      4 * (next / 4) + BeyondPlaces[std::find(other, other + 3, in) - other];
  }
}

bool BlockMesher::Run(const ExecutionContext& context)
{
  this->NumberBoxes();
  const std::size_t boxes = this->PlacesOfBoxes.size();
  this->Patterns.resize(boxes);
  return this->ForAll(boxes, context.Part(0.0, 0.3),
           [this](Id box)
           {
             this->Patterns[box] =
               static_cast<unsigned char>(this->GetPattern(this->PlacesOfBoxes[box]));
           }) &&
    this->ForAll(boxes, context.Part(0.3, 0.9), [this](Id box) { this->MakeBox(box); }) &&
    this->ForAll(GetNumberOfTetrahedra(this->Block) - 6 * boxes, context.Part(0.9, 1.0),
      [this, boxes](Id i) { this->ConnectBeyond(static_cast<Id>(6 * boxes) + i); });
}
} // namespace

GridBlock FindGridBlock(const RawVector<Vec3>& points)
{
  std::array<Lines, 3> lines;
  if (points.size() < NumberOfCorners || !HasLines(points))
  {
    return GridBlock();
  }
  std::size_t size = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!lines[axis].Find(points, axis))
    {
      return GridBlock();
    }
    size *= static_cast<std::size_t>(lines[axis].Count);
    if (size > LargestLattice * points.size())
    {
      return GridBlock();
    }
  }
  return Lattice(lines).GetBlock(
    std::max<std::size_t>(NumberOfCorners, points.size() / SmallestShare));
}

std::size_t GetNumberOfTetrahedra(const GridBlock& block)
{
  const std::size_t x = static_cast<std::size_t>(block.Sizes[0] - 1);
  const std::size_t y = static_cast<std::size_t>(block.Sizes[1] - 1);
  const std::size_t z = static_cast<std::size_t>(block.Sizes[2] - 1);
  return 6 * x * y * z + 4 * (x * y + y * z + z * x);
}

bool MeshGridBlock(const GridBlock& block, const std::vector<Id>& numbers, int numberOfThreads,
  const ExecutionContext& context, RawVector<TetrahedronIds>& tetrahedra,
  RawVector<TetrahedronIds>& neighbors)
{
  return BlockMesher(block, numbers, numberOfThreads, tetrahedra, neighbors).Run(context);
}
} // namespace cdm
