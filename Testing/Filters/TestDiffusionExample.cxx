// SPDX-License-Identifier: BSD-3-Clause
#include "Diffusion.h"

#include "FilterTesting.h"

#include <vtkDelaunayMeshCriteria.h>

#include <vtkFieldData.h>

using namespace diffusion;

namespace
{
double GetFieldValue(vtkUnstructuredGrid* grid, const char* name)
{
  vtkNew<vtkDelaunayMeshCriteria> criteria;
  criteria->SetInputData(grid);
  criteria->Update();
  return criteria->GetOutput()->GetFieldData()->GetArray(name)->GetComponent(0, 0);
}

/** Cuts off all but two digits, as printed in Fig. 3.10. */
double CutOff(double value)
{
  const double size = std::abs(value);
  const double unit = size >= 9.999 ? 1.0 : size >= 0.9999 ? 0.1 : 0.01;
  return std::copysign(unit * std::floor(size / unit + 1e-6), value);
}

/** The smallest concentration within 20 steps, from a Gaussian that is one edge wide. */
double GetSmallest(const System& system, vtkUnstructuredGrid* grid)
{
  const Result result = Diffuse(system, MakeGaussian(grid, Spacing), 0.1 * Spacing * Spacing, 20);
  // The dose is conserved, and a maximum at the start is one for ever.
  EXPECT_NEAR(1.0,
    system.Masses.dot(result.Concentrations) / system.Masses.dot(MakeGaussian(grid, Spacing)),
    1e-12);
  EXPECT_LE(result.Largest, 1.0 + 1e-12);
  return result.Smallest;
}
} // namespace

TEST(DiffusionExample, StacksOfTheThesis)
{
  EXPECT_EQ(3072, MakeStack(Stack::T6, 8)->GetNumberOfCells());
  EXPECT_EQ(2560, MakeStack(Stack::T5, 8)->GetNumberOfCells());
  EXPECT_EQ(2560, MakeStack(Stack::ShiftedT5, 8)->GetNumberOfCells());
  EXPECT_EQ(0.0, GetFieldValue(MakeStack(Stack::T6, 8), "NonDelaunayTetrahedra"));
  EXPECT_EQ(0.0, GetFieldValue(MakeStack(Stack::T5, 8), "NonDelaunayTetrahedra"));
  EXPECT_GT(GetFieldValue(MakeStack(Stack::ShiftedT5, 8), "NonDelaunayTetrahedra"), 0.0);
  for (const Stack stack : { Stack::T6, Stack::T5, Stack::ShiftedT5 })
  {
    EXPECT_EQ(0.0, GetFieldValue(MakeStack(stack, 8), "InvertedTetrahedra"));
    EXPECT_EQ(0.0, GetFieldValue(MakeStack(stack, 8), "FlatTetrahedra"));
    EXPECT_EQ(6.0 * 64.0 * 2.0, GetFieldValue(MakeStack(stack, 8), "BorderFacets"));
  }
  // Fig. 3.6: obtuse angles of 125.3 degrees, cotangent -1 / sqrt(2).
  EXPECT_NEAR(180.0 / std::acos(-1.0) * std::acos(-1.0 / std::sqrt(3.0)),
    GetFieldValue(MakeStack(Stack::T6, 8), "MeshLargestDihedralAngle"), 1e-10);
  EXPECT_NEAR(90.0, GetFieldValue(MakeStack(Stack::T5, 8), "MeshLargestDihedralAngle"), 1e-10);
}

TEST(DiffusionExample, CotangentSums)
{
  // Crit. 3.3 fails at the diagonal of every cube of T6. In Fig. 3.6 that is edge (3, 4), with two
  // right angles and twice the cotangent -1 / sqrt(2) at opposite edges of the length sqrt(2) h:
  // the entry of the matrix is minus their sum over six.
  const System cube = AssembleElements(MakeStack(Stack::T6, 1));
  EXPECT_NEAR(Spacing / 3.0, cube.Stiffness.coeff(1, 6), 1e-14);
  EXPECT_GE(GetFieldValue(MakeStack(Stack::T6, 8), "NegativeCotangentSums"), 512.0);
  EXPECT_EQ(0.0, GetFieldValue(MakeStack(Stack::T5, 8), "NegativeCotangentSums"));
  EXPECT_EQ(0.0, GetFieldValue(MakeStack(Stack::ShiftedT5, 8), "NegativeCotangentSums"));
}

TEST(DiffusionExample, ElementMatricesOfFigure310)
{
  // The points of Fig. 3.9 in units of half a cube's edge; 6 is the middle point, shifted towards
  // 10.
  const auto at = [](double x, double y, double z)
  { return Eigen::Vector3d(0.5 * Spacing * x, 0.5 * Spacing * y, 0.5 * Spacing * z); };
  const Eigen::Vector3d p6 = at(3, 2, 2);
  const Eigen::Vector3d p10 = at(4, 2, 2);
  const Eigen::Vector3d p14 = at(2, 4, 2);
  const Eigen::Vector3d p17 = at(4, 4, 2);
  const Eigen::Vector3d p2 = at(2, 2, 0);
  const Eigen::Vector3d p16 = at(4, 4, 0);
  const Eigen::Vector3d p18 = at(2, 2, 4);
  const Eigen::Vector3d p26 = at(4, 4, 4);
  struct Printed
  {
    std::array<Eigen::Vector3d, 4> Corners;
    std::array<double, 16> Entries;
    /** Rows of the points 14 and 10. */
    int Row;
    int Column;
  };
  const std::array<double, 16> regular{ 2.5, -0.83, -0.83, -0.83, -0.83, 2.5, -0.83, -0.83, -0.83,
    -0.83, 2.5, -0.83, -0.83, -0.83, -0.83, 2.5 };
  const Printed printed[] = {
    { { p10, p6, p14, p2 },
      { 5, -6.6, 0.83, 0.83, -6.6, 10, -1.6, -1.6, 0.83, -1.6, 0.83, 0, 0.83, -1.6, 0, 0.83 }, 2,
      0 },
    { { p6, p10, p14, p18 },
      { 10, -6.6, -1.6, -1.6, -6.6, 5, 0.83, 0.83, -1.6, 0.83, 0.83, 0, -1.6, 0.83, 0, 0.83 }, 2,
      1 },
    { { p10, p17, p14, p26 },
      { 1.6, -1.6, 0, 0, -1.6, 5, -1.6, -1.6, 0, -1.6, 1.6, 0, 0, -1.6, 0, 1.6 }, 2, 0 },
    { { p10, p14, p17, p16 },
      { 1.6, 0, -1.6, 0, 0, 1.6, -1.6, 0, -1.6, -1.6, 5, -1.6, 0, 0, -1.6, 1.6 }, 1, 0 },
    { { p2, p10, p16, p14 }, regular, 3, 1 }, { { p10, p18, p26, p14 }, regular, 3, 0 }
  };
  double sum = 0.0;
  for (const Printed& tetrahedron : printed)
  {
    const Eigen::Matrix4d matrix = GetElementMatrix(tetrahedron.Corners);
    for (int row = 0; row < 4; ++row)
    {
      for (int column = 0; column < 4; ++column)
      {
        const double value = std::abs(matrix(row, column)) < 1e-12 ? 0.0 : matrix(row, column);
        EXPECT_NEAR(tetrahedron.Entries[4 * row + column], CutOff(value), 1e-9)
          << row << " " << column;
      }
    }
    sum += matrix(tetrahedron.Row, tetrahedron.Column);
  }
  EXPECT_NEAR(0.0, sum, 1e-14);

  // The same entry of the global matrix of the eight cubes.
  const auto grid = MakeStack(Stack::ShiftedT5, 2);
  const System system = AssembleElements(grid);
  vtkIdType ids[2] = { -1, -1 };
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    ids[0] = (GetPoint(grid, i) - p10).norm() == 0.0 ? i : ids[0];
    ids[1] = (GetPoint(grid, i) - p14).norm() == 0.0 ? i : ids[1];
  }
  ASSERT_TRUE(ids[0] >= 0 && ids[1] >= 0);
  EXPECT_NEAR(0.0, system.Stiffness.coeff(ids[0], ids[1]), 1e-14);
}

TEST(DiffusionExample, OnlyElementsOnT6GoNegative)
{
  const auto t6 = MakeStack(Stack::T6, 8);
  const auto t5 = MakeStack(Stack::T5, 8);
  const auto shifted = MakeStack(Stack::ShiftedT5, 8);
  const double start = MakeGaussian(t6, Spacing).minCoeff();
  ASSERT_GT(start, 0.0);
  // "The absolute value of the emerging negative concentrations is much larger than the minimal
  // initial concentration."
  EXPECT_LT(GetSmallest(AssembleElements(t6), t6), -1000.0 * start);
  EXPECT_GT(GetSmallest(AssembleBoxes(t6), t6), 0.0);
  EXPECT_GT(GetSmallest(AssembleElements(t5), t5), 0.0);
  EXPECT_GT(GetSmallest(AssembleBoxes(t5), t5), 0.0);
  EXPECT_GT(GetSmallest(AssembleElements(shifted), shifted), 0.0);
}

TEST(DiffusionExample, BoxesDependOnThePointsOnly)
{
  const System t6 = AssembleBoxes(MakeStack(Stack::T6, 4));
  const System t5 = AssembleBoxes(MakeStack(Stack::T5, 4));
  EXPECT_LT((t6.Masses - t5.Masses).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(Eigen::MatrixXd(t6.Stiffness - t5.Stiffness).cwiseAbs().maxCoeff(), 1e-12);
}
