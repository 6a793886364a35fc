// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelTesting.h"

#include "../Support/PointSets.h"

#include <vtkAdvancingFrontTetrahedralizer.h>
#include <vtkBoundaryTriangulator.h>
#include <vtkDelaunaySurfaceRefiner.h>
#include <vtkDistributedTetrahedralizer.h>
#include <vtkIdList.h>
#include <vtkMeshPointGenerator.h>
#include <vtkTechnologyStructureSource.h>

#include <cmath>
#include <random>
#include <set>

using namespace testing_filters;
using namespace testing_parallel;

namespace
{
using Keys = std::vector<CellKey<4>>;

constexpr auto MakeRandomPoints = testing_points::MakeRandom<Point>;
constexpr auto MakeGridPoints = testing_points::MakeGrid<Point>;
constexpr auto MakePointsOnSphere = testing_points::MakeOnSphere<Point>;

/** Points and cells of a piece: every process takes its share, or one has all. */
enum class Sharing
{
  Slices,
  LastHasAll,
  FirstIsEmpty,
  /** Neighbors have a third of their points in common. */
  Overlapping,
  /** Dealt out like cards, with global ids that tell the order. */
  Dealt
};

bool HasItem(Sharing sharing, vtkIdType i, vtkIdType count)
{
  const double place = static_cast<double>(i) / static_cast<double>(count);
  const double begin = static_cast<double>(GetRank()) / GetSize();
  const double end = static_cast<double>(GetRank() + 1) / GetSize();
  const double more = 0.3 / GetSize();
  switch (sharing)
  {
    case Sharing::LastHasAll:
      return GetRank() == GetSize() - 1;
    case Sharing::FirstIsEmpty:
      return GetSize() == 1 ||
        (GetRank() > 0 && static_cast<int>(i) % (GetSize() - 1) == GetRank() - 1);
    case Sharing::Overlapping:
      return place >= begin - more && place < end + more;
    case Sharing::Dealt:
      return static_cast<int>(i) % GetSize() == GetRank();
    default:
      return place >= begin && place < end;
  }
}

/** The piece of this process: points (without cells), or all points and a part of the cells. */
vtkSmartPointer<vtkPolyData> MakePiece(vtkPolyData* whole, Sharing sharing)
{
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Ids");
  piece->GetPointData()->CopyAllocate(whole->GetPointData());
  piece->GetCellData()->CopyAllocate(whole->GetCellData());
  const vtkIdType cells = whole->GetNumberOfPolys();
  std::vector<vtkIdType> places(static_cast<std::size_t>(whole->GetNumberOfPoints()), -1);
  const auto add = [&](vtkIdType i)
  {
    if (places[i] < 0)
    {
      places[i] = points->InsertNextPoint(whole->GetPoint(i));
      piece->GetPointData()->CopyData(whole->GetPointData(), i, places[i]);
      ids->InsertNextValue(i);
    }
    return places[i];
  };
  // In the order of the whole, so that slices are numbered like it.
  for (vtkIdType i = 0; i < whole->GetNumberOfPoints(); ++i)
  {
    if (HasItem(sharing, i, whole->GetNumberOfPoints()))
    {
      add(i);
    }
  }
  vtkNew<vtkCellArray> polys;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    if (HasItem(sharing, cell, cells))
    {
      whole->GetCellPoints(cell, corners);
      vtkIdType triangle[3];
      for (int i = 0; i < 3; ++i)
      {
        triangle[i] = add(corners->GetId(i));
      }
      piece->GetCellData()->CopyData(
        whole->GetCellData(), cell, polys->InsertNextCell(3, triangle));
    }
  }
  piece->SetPoints(points);
  piece->SetPolys(polys);
  piece->GetPointData()->Squeeze();
  piece->GetCellData()->Squeeze();
  // Other pieces of a surface share points, and slices of points that overlap as well.
  if (sharing != Sharing::Slices || cells > 0)
  {
    piece->GetPointData()->SetGlobalIds(ids);
  }
  return piece;
}

/**
 * The other data set's tetrahedra, each owned by one process; ghosts, points and arrays as well.
 */
void ExpectSameAsSerial(vtkPolyData* whole, vtkPolyData* wholeMeshPoints, Sharing sharing)
{
  SCOPED_TRACE("sharing " + std::to_string(static_cast<int>(sharing)));
  vtkNew<vtkAdvancingFrontTetrahedralizer> serial;
  serial->SetInputData(whole);
  serial->SetInputData(1, wholeMeshPoints);
  serial->SetCloseOpenBoundary(whole->GetNumberOfPolys() == 0);
  serial->Update();
  const Keys expected = GetCells<4>(serial->GetOutput(), "RegionId");
  const auto expectedBoundary =
    GetCells<3>(vtkPolyData::SafeDownCast(serial->GetOutputDataObject(1)), "BoundaryLabels");

  vtkNew<vtkDistributedTetrahedralizer> filter;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->SetInputData(MakePiece(whole, sharing));
  if (wholeMeshPoints)
  {
    filter->SetInputData(1, MakePiece(wholeMeshPoints, sharing));
  }
  filter->UpdatePiece(GetRank(), GetSize(), GetSize() > 1 ? 1 : 0);
  EXPECT_EQ(recorder->Errors, "");
  vtkUnstructuredGrid* mesh = filter->GetOutput();
  const Keys own = GetCells<4>(mesh, "RegionId");
  EXPECT_EQ(GatherCells(own).size(), expected.size());
  EXPECT_TRUE(GatherCells(own) == expected) << "not the tetrahedra of one process";
  auto boundary = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  const auto allTriangles = GatherCells(GetCells<3>(boundary, "BoundaryLabels"));
  EXPECT_EQ(allTriangles.size(), expectedBoundary.size());
  EXPECT_TRUE(allTriangles == expectedBoundary) << "not the boundary of one process";

  // Ghosts: what others own at the points of the own cells.
  std::set<Point> ownPoints;
  for (const CellKey<4>& key : own)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      ownPoints.insert({ key[3 * i], key[3 * i + 1], key[3 * i + 2] });
    }
  }
  Keys expectedGhosts;
  for (const CellKey<4>& key : expected)
  {
    bool touches = false;
    for (std::size_t i = 0; i < 4; ++i)
    {
      touches = touches || ownPoints.count({ key[3 * i], key[3 * i + 1], key[3 * i + 2] }) != 0;
    }
    if (touches && !std::binary_search(own.begin(), own.end(), key))
    {
      expectedGhosts.push_back(key);
    }
  }
  const Keys ghosts = GetCells<4>(mesh, "RegionId", true);
  EXPECT_EQ(ghosts.size(), expectedGhosts.size());
  EXPECT_TRUE(ghosts == expectedGhosts) << "not one level of ghosts";

  // Every point belongs to one process; its id is the same everywhere.
  vtkDataArray* ids = mesh->GetPointData()->GetGlobalIds();
  EXPECT_NE(ids, nullptr);
  vtkUnsignedCharArray* pointGhosts = mesh->GetPointGhostArray();
  EXPECT_EQ(pointGhosts != nullptr, GetSize() > 1);
  std::vector<std::array<double, 4>> numbered;
  std::vector<std::array<double, 1>> owned;
  for (vtkIdType i = 0; ids && i < mesh->GetNumberOfPoints(); ++i)
  {
    double x[3];
    mesh->GetPoint(i, x);
    numbered.push_back({ ids->GetTuple1(i), x[0], x[1], x[2] });
    if (!pointGhosts || pointGhosts->GetValue(i) == 0)
    {
      owned.push_back({ ids->GetTuple1(i) });
    }
  }
  auto all = GatherCells(numbered);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  EXPECT_EQ(std::adjacent_find(
              all.begin(), all.end(), [](const auto& a, const auto& b) { return a[0] == b[0]; }),
    all.end());
  const auto allOwned = GatherCells(owned);
  EXPECT_EQ(std::adjacent_find(allOwned.begin(), allOwned.end()), allOwned.end());
  std::set<std::array<double, 3>> usedPoints;
  for (const CellKey<4>& key : expected)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      usedPoints.insert({ key[3 * i], key[3 * i + 1], key[3 * i + 2] });
    }
  }
  EXPECT_EQ(all.size(), usedPoints.size());
  if (mesh->GetNumberOfPoints() > 0)
  {
    ExpectLinear(mesh, 1e-12);
    EXPECT_GT(GetVolume(mesh), 0.0);
  }
  if (boundary->GetNumberOfPoints() > 0)
  {
    ExpectLinear(boundary, 1e-12);
  }
}

vtkSmartPointer<vtkPolyData> WithLinear(vtkPolyData* input)
{
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->ShallowCopy(input);
  vtkNew<vtkDoubleArray> linear;
  linear->SetName("Linear");
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    linear->InsertNextValue(Linear(input->GetPoint(i)));
  }
  copy->GetPointData()->AddArray(linear);
  return copy;
}

constexpr Sharing Sharings[] = { Sharing::Slices, Sharing::LastHasAll, Sharing::FirstIsEmpty,
  Sharing::Overlapping, Sharing::Dealt };

/** One process has something wrong with it: all have an error, this one its own. */
void ExpectErrorEverywhere(vtkDistributedTetrahedralizer* filter, int culprit, const char* text)
{
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_TRUE(Contains(recorder->Errors, text)) << recorder->Errors;
  const std::string process = "Process " + std::to_string(culprit) + " failed";
  EXPECT_EQ(Contains(recorder->Errors, process), GetRank() != culprit) << recorder->Errors;
  ExpectEmptyOutputs(filter);
}
} // namespace

TEST(DistributedTetrahedralizer, RandomPoints)
{
  const unsigned seed = 21;
  std::cout << "seed " << seed << "\n";
  const auto points = MakePoints(MakeRandomPoints(4000, seed));
  for (Sharing sharing : Sharings)
  {
    ExpectSameAsSerial(points, nullptr, sharing);
  }
  ExpectSameAsSerial(MakePoints(MakeRandomPoints(5, seed)), nullptr, Sharing::Slices);
}

TEST(DistributedTetrahedralizer, Grids)
{
  const unsigned seed = 22;
  std::cout << "seed " << seed << "\n";
  for (Sharing sharing : Sharings)
  {
    ExpectSameAsSerial(MakePoints(MakeGridPoints(12, 0.1, 0.0, seed)), nullptr, sharing);
  }
  ExpectSameAsSerial(MakePoints(MakeGridPoints(12, 1.0, 0.0, seed)), nullptr, Sharing::Slices);
  ExpectSameAsSerial(MakePoints(MakeGridPoints(12, 1.0, 0.17, seed)), nullptr, Sharing::Slices);
}

TEST(DistributedTetrahedralizer, PointsOnOneSphere)
{
  const unsigned seed = 29;
  std::cout << "seed " << seed << "\n";
  const auto few = MakePoints(MakePointsOnSphere(9945, seed));
  for (Sharing sharing : Sharings)
  {
    ExpectSameAsSerial(few, nullptr, sharing);
  }
  // Whether each tetrahedron has been tested against each point shows in the time it takes.
  const auto many = MakePointsOnSphere(6000029, seed);
  EXPECT_EQ(many.size(), 45504u);
  ExpectSameAsSerial(MakePoints(many), nullptr, Sharing::Slices);
}

TEST(DistributedTetrahedralizer, DuplicatePointsOnTheCut)
{
  // Whole planes of a grid lie on a cut; each point comes twice, from different processes.
  const unsigned seed = 30;
  std::cout << "seed " << seed << "\n";
  std::vector<Point> doubled = MakeGridPoints(8, 1.0, 0.0, seed);
  const std::vector<Point> others = MakeGridPoints(8, 1.0, 0.0, seed + 1);
  doubled.insert(doubled.end(), others.begin(), others.end());
  const auto corners = MakePoints({ { 0, 0, 0 }, { 7, 0, 0 }, { 0, 7, 0 }, { 7, 7, 7 } });
  for (Sharing sharing : Sharings)
  {
    ExpectSameAsSerial(corners, MakePoints(doubled), sharing);
  }
  vtkNew<vtkDistributedTetrahedralizer> filter;
  filter->SetInputData(MakePiece(corners, Sharing::Slices));
  filter->SetInputData(1, MakePiece(MakePoints(doubled), Sharing::Slices));
  filter->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(filter->GetNumberOfUnusedMeshPoints(), 512 + 4) << "copies of each other, of corners";
}

TEST(DistributedTetrahedralizer, ProcessesThatHaveNothing)
{
  // No points, no arrays, no vtkPoints: on one process, or on all but one.
  const auto points = WithLinear(MakePoints(MakeRandomPoints(500, 31)));
  vtkNew<vtkDistributedTetrahedralizer> alone;
  alone->SetController(nullptr);
  alone->SetInputData(points);
  alone->Update();
  const Keys expected = GetCells<4>(alone->GetOutput(), "RegionId");
  for (int owner = 0; owner < GetSize(); ++owner)
  {
    vtkNew<vtkPolyData> nothing;
    vtkNew<vtkDistributedTetrahedralizer> filter;
    vtkNew<EventRecorder> recorder;
    recorder->Watch(filter);
    filter->SetInputData(GetRank() == owner ? points.Get() : nothing.Get());
    filter->UpdatePiece(GetRank(), GetSize(), 0);
    EXPECT_EQ(recorder->Errors, "");
    EXPECT_TRUE(GatherCells(GetCells<4>(filter->GetOutput(), "RegionId")) == expected);
    if (filter->GetOutput()->GetNumberOfPoints() > 0)
    {
      ExpectLinear(filter->GetOutput(), 1e-12);
    }
  }
}

TEST(DistributedTetrahedralizer, TwoInputs)
{
  const unsigned seed = 23;
  std::cout << "seed " << seed << "\n";
  ExpectSameAsSerial(MakePoints(MakeGridPoints(5, 0.25, 0.0, seed)),
    MakePoints(MakeRandomPoints(1000, seed)), Sharing::Slices);
}

TEST(DistributedTetrahedralizer, RegionsOfADevice)
{
  vtkNew<vtkTechnologyStructureSource> device;
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputConnection(device->GetOutputPort());
  vtkNew<vtkMeshPointGenerator> generator;
  generator->SetInputConnection(triangulator->GetOutputPort());
  generator->SetSpacing(0.06, 0.06, 0.06);
  vtkNew<vtkDelaunaySurfaceRefiner> refiner;
  refiner->SetInputConnection(triangulator->GetOutputPort());
  refiner->SetInputConnection(1, generator->GetOutputPort());
  refiner->Update();
  const auto surface = WithLinear(refiner->GetOutput());
  const auto points = WithLinear(vtkPolyData::SafeDownCast(refiner->GetOutputDataObject(2)));
  EXPECT_GT(points->GetNumberOfPoints(), 400);
  for (Sharing sharing : Sharings)
  {
    ExpectSameAsSerial(surface, points, sharing);
  }
}

TEST(DistributedTetrahedralizer, RegionsWithoutLabels)
{
  // A cavity, in which nothing is, in a cube beside two boxes: regions are found.
  for (const auto& polygons : { MakeTwoBoxes(), MakeCubeWithCavity(), MakeCube() })
  {
    vtkNew<vtkBoundaryTriangulator> triangulator;
    polygons->GetCellData()->RemoveArray("BoundaryLabels");
    triangulator->SetInputData(polygons);
    vtkNew<vtkDelaunaySurfaceRefiner> refiner;
    refiner->SetInputConnection(triangulator->GetOutputPort());
    refiner->SetMaximumEdgeLength(0.3);
    refiner->Update();
    for (Sharing sharing : Sharings)
    {
      ExpectSameAsSerial(WithLinear(refiner->GetOutput()), nullptr, sharing);
    }
  }
}

TEST(DistributedTetrahedralizer, GhostLevels)
{
  vtkNew<vtkDistributedTetrahedralizer> filter;
  filter->SetInputData(MakePiece(MakePoints(MakeRandomPoints(2000, 24)), Sharing::Dealt));
  long long cells[3];
  for (int level = 0; level < 3; ++level)
  {
    filter->UpdatePiece(GetRank(), GetSize(), level);
    cells[level] = filter->GetOutput()->GetNumberOfCells();
    const Keys own = GetCells<4>(filter->GetOutput(), "RegionId");
    const Keys ghosts = GetCells<4>(filter->GetOutput(), "RegionId", true);
    EXPECT_EQ(own.size() + ghosts.size(), static_cast<std::size_t>(cells[level]));
    EXPECT_EQ(ghosts.empty(), level == 0 || GetSize() == 1);
  }
  if (GetSize() > 1)
  {
    EXPECT_LT(cells[0], cells[1]);
    EXPECT_LT(cells[1], cells[2]);
  }
}

TEST(DistributedTetrahedralizer, SameForAnyNumberOfProcesses)
{
  // Numbered by where they lie in the list of all, whatever piece they are in.
  const auto points = MakePoints(MakeRandomPoints(3000, 25));
  vtkNew<vtkDistributedTetrahedralizer> filter;
  filter->SetInputData(MakePiece(points, Sharing::Dealt));
  filter->UpdatePiece(GetRank(), GetSize(), 0);
  vtkNew<vtkDistributedTetrahedralizer> alone;
  alone->SetController(nullptr);
  alone->SetInputData(points);
  alone->Update();
  EXPECT_TRUE(GatherCells(GetCells<4>(filter->GetOutput(), "RegionId")) ==
    GetCells<4>(alone->GetOutput(), "RegionId"));
  EXPECT_EQ(alone->GetNumberOfBytesSent(), 0);
  EXPECT_EQ(filter->GetNumberOfBytesSent() > 0, GetSize() > 1);
  EXPECT_GT(filter->GetNumberOfRounds(), 0);
}

TEST(DistributedTetrahedralizer, ErrorsOfOneProcessEndAll)
{
  const auto points = MakePoints(MakeRandomPoints(100, 26));
  vtkNew<vtkDistributedTetrahedralizer> filter;
  for (int culprit = 0; culprit < GetSize(); ++culprit)
  {
    const auto piece = MakePiece(points, Sharing::Dealt);
    if (GetRank() == culprit)
    {
      piece->GetPoints()->SetPoint(3, 0.0, std::nan(""), 0.0);
    }
    filter->SetInputData(piece);
    ExpectErrorEverywhere(
      filter, culprit, "Point 3 of the input has coordinates that are not finite");

    // A cell that is no triangle.
    const auto cube = MakeCube();
    if (GetRank() != culprit)
    {
      cube->SetPolys(nullptr);
    }
    filter->SetInputData(cube);
    ExpectErrorEverywhere(filter, culprit, "not triangles");
  }

  // Two points with one global id.
  const auto confused = MakePiece(points, Sharing::Dealt);
  auto ids = vtkIdTypeArray::SafeDownCast(confused->GetPointData()->GetGlobalIds());
  ids->SetValue(1, 5);
  ids->SetValue(2, 5);
  filter->SetInputData(confused);
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_TRUE(Contains(recorder->Errors, "have the global id 5")) << recorder->Errors;
  ExpectEmptyOutputs(filter);
}

TEST(DistributedTetrahedralizer, BadInputIsRefusedEverywhere)
{
  const auto expectError = [](vtkPolyData* piece, const char* text)
  {
    vtkNew<vtkDistributedTetrahedralizer> filter;
    filter->SetInputData(piece);
    vtkNew<EventRecorder> recorder;
    recorder->Watch(filter);
    filter->UpdatePiece(GetRank(), GetSize(), 0);
    EXPECT_TRUE(Contains(recorder->Errors, text)) << recorder->Errors;
    ExpectEmptyOutputs(filter);
  };
  const auto slice = [](const std::vector<Point>& points)
  { return MakePiece(MakePoints(points), Sharing::Dealt); };
  expectError(slice({}), "The input has no points");
  expectError(slice({ { 1, 1, 1 }, { 1, 1, 1 } }), "four points that do not coincide");
  expectError(slice({ { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 }, { 3, 3, 3 } }), "on one line");
  expectError(slice({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 5, 5, 0 } }), "in one plane");

  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeCrossingBoxes());
  // Triangulated, but not refined: an edge of the second box comes close to the first one.
  SurfaceBuilder flat;
  flat.AddBox({ 0, 0, 0 }, { 10, 10, 10 });
  flat.AddBox({ 2, 2, 10.01 }, { 3, 3, 10.02 });
  triangulator->SetInputData(flat.Build());
  triangulator->Update();
  expectError(MakePiece(triangulator->GetOutput(), Sharing::Dealt), "are not Delaunay");

  SurfaceBuilder open;
  open.AddBox({ 0, 0, 0 }, { 1, 1, 1 }, -1, 0, 3);
  triangulator->SetInputData(open.Build());
  triangulator->Update();
  expectError(MakePiece(triangulator->GetOutput(), Sharing::Dealt), "encloses nothing");
}

TEST(DistributedTetrahedralizer, AbortOfOneProcessEndsAll)
{
  vtkNew<vtkDistributedTetrahedralizer> filter;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  recorder->AbortAt = GetRank() == 0 ? 0.05 : 2.0;
  filter->SetInputData(MakePiece(MakePoints(MakeRandomPoints(20000, 27)), Sharing::Slices));
  filter->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(recorder->Errors, "");
  ExpectEmptyOutputs(filter);
}

TEST(DistributedTetrahedralizer, CountsUnusedMeshPoints)
{
  vtkNew<vtkBoundaryTriangulator> triangulator;
  triangulator->SetInputData(MakeCube());
  triangulator->Update();
  vtkNew<vtkDistributedTetrahedralizer> filter;
  filter->SetInputData(MakePiece(triangulator->GetOutput(), Sharing::Slices));
  filter->SetInputData(
    1, MakePiece(MakePoints({ { 5, 5, 5 }, { 6, 5, 5 }, { 0.5, 0.5, 0.5 } }), Sharing::Slices));
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  filter->UpdatePiece(GetRank(), GetSize(), 0);
  EXPECT_EQ(recorder->Errors, "");
  EXPECT_EQ(filter->GetNumberOfUnusedMeshPoints(), 2);
  EXPECT_EQ(Contains(recorder->Warnings, "Left out 2 mesh points"), GetRank() == 0);
  vtkUnstructuredGrid* mesh = filter->GetOutput();
  EXPECT_EQ(Sum(mesh->GetNumberOfCells()), 12);
  vtkNew<vtkUnstructuredGrid> nothing;
  EXPECT_NEAR(GetVolume(mesh), mesh->GetNumberOfCells() / 12.0, 1e-14);
}

int main(int argc, char** argv)
{
  return testing_parallel::RunAllTests(argc, argv);
}
