// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Diffusion.h
 * @brief Transient diffusion by finite elements and by the box method on stacks of cubes.
 *
 * Example of the thesis, section 3.2.3: the same points, the same equation, the same solver, and
 * three ways to cut cubes into tetrahedra. Delaunay is what the box method needs, and neither
 * enough nor necessary for finite elements: there no sum of dihedral cotangents may be negative
 * (Crit. 3.3).
 *
 * Both methods lead to (M / dt + D S) c_new = M / dt c_old, with implicit Euler steps, a diagonal M
 * and without flux through the boundary. Where S has positive entries off its diagonal
 * concentrations may become negative.
 */
#ifndef Diffusion_h
#define Diffusion_h

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVoronoiControlVolumes.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace diffusion
{
enum class Stack
{
  /** Two corners and four tetrahedra around a diagonal of each cube; some angles are obtuse. */
  T6,
  /** Four corners and a regular tetrahedron for each cube. */
  T5,
  /** T5 with the middle of each block of eight cubes shifted by half an edge: not Delaunay. */
  ShiftedT5
};

/** Edge of a cube: that of the element matrices printed in Fig. 3.10. */
constexpr double Spacing = 10.0;

inline Eigen::Vector3d GetPoint(vtkUnstructuredGrid* grid, vtkIdType id)
{
  Eigen::Vector3d point;
  grid->GetPoint(id, point.data());
  return point;
}

/** Tetrahedra of the cube (i, j, k), as corners numbered x + 2 y + 4 z. */
inline std::vector<std::array<int, 4>> GetCubeTetrahedra(Stack stack, int i, int j, int k)
{
  if (stack == Stack::T6)
  {
    return { { 0, 1, 2, 4 }, { 7, 6, 5, 3 }, { 1, 6, 2, 4 }, { 1, 6, 4, 5 }, { 1, 6, 5, 3 },
      { 1, 6, 3, 2 } };
  }
  // The diagonals of all cubes join points whose coordinates have an even sum.
  const int flip = (i + j + k) % 2;
  std::vector<std::array<int, 4>> tetrahedra = { { 0, 3, 5, 6 }, { 1, 0, 3, 5 }, { 2, 0, 3, 6 },
    { 4, 0, 5, 6 }, { 7, 3, 5, 6 } };
  for (auto& tetrahedron : tetrahedra)
  {
    for (int& corner : tetrahedron)
    {
      corner ^= flip;
    }
  }
  return tetrahedra;
}

/** size x size x size cubes; of eight: 3072 tetrahedra (T6), 2560 (T5 and shifted T5). */
inline vtkSmartPointer<vtkUnstructuredGrid> MakeStack(Stack stack, int size)
{
  const int points = size + 1;
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  for (int id = 0; id < points * points * points; ++id)
  {
    const int index[3] = { id % points, id / points % points, id / points / points };
    const bool isMiddle = index[0] % 2 == 1 && index[1] % 2 == 1 && index[2] % 2 == 1;
    const double shift = stack == Stack::ShiftedT5 && isMiddle ? 0.5 : 0.0;
    coordinates->InsertNextPoint(
      Spacing * (index[0] + shift), Spacing * index[1], Spacing * index[2]);
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(coordinates);
  grid->AllocateEstimate(6 * size * size * size, 4);
  for (int cube = 0; cube < size * size * size; ++cube)
  {
    const int index[3] = { cube % size, cube / size % size, cube / size / size };
    for (const auto& corners : GetCubeTetrahedra(stack, index[0], index[1], index[2]))
    {
      vtkIdType ids[4];
      for (int i = 0; i < 4; ++i)
      {
        ids[i] = index[0] + corners[i] % 2 +
          points * (index[1] + corners[i] / 2 % 2 + points * (index[2] + corners[i] / 4));
      }
      const Eigen::Vector3d origin = GetPoint(grid, ids[0]);
      const Eigen::Vector3d normal =
        (GetPoint(grid, ids[1]) - origin).cross(GetPoint(grid, ids[2]) - origin);
      if (normal.dot(GetPoint(grid, ids[3]) - origin) < 0.0)
      {
        std::swap(ids[2], ids[3]);
      }
      grid->InsertNextCell(VTK_TETRA, 4, ids);
    }
  }
  return grid;
}

/** Stiffness matrix of a tetrahedron with linear elements, for a unit diffusion constant. */
inline Eigen::Matrix4d GetElementMatrix(const std::array<Eigen::Vector3d, 4>& corners)
{
  Eigen::Matrix3d edges;
  edges << corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0];
  Eigen::Matrix<double, 3, 4> gradients;
  gradients.rightCols<3>() = edges.inverse().transpose();
  gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
  return std::abs(edges.determinant()) / 6.0 * gradients.transpose() * gradients;
}

/** M (its diagonal) and S. */
struct System
{
  Eigen::VectorXd Masses;
  Eigen::SparseMatrix<double> Stiffness;
};

/** Linear finite elements with lumped masses. */
inline System AssembleElements(vtkUnstructuredGrid* grid)
{
  System system;
  system.Masses = Eigen::VectorXd::Zero(grid->GetNumberOfPoints());
  std::vector<Eigen::Triplet<double>> entries;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    grid->GetCellPoints(cell, ids);
    std::array<Eigen::Vector3d, 4> corners;
    for (int i = 0; i < 4; ++i)
    {
      corners[i] = GetPoint(grid, ids->GetId(i));
    }
    const Eigen::Matrix4d element = GetElementMatrix(corners);
    const double volume =
      (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) / 6.0;
    for (int i = 0; i < 4; ++i)
    {
      system.Masses[ids->GetId(i)] += volume / 4.0;
      for (int j = 0; j < 4; ++j)
      {
        entries.emplace_back(ids->GetId(i), ids->GetId(j), element(i, j));
      }
    }
  }
  system.Stiffness.resize(grid->GetNumberOfPoints(), grid->GetNumberOfPoints());
  system.Stiffness.setFromTriplets(entries.begin(), entries.end());
  return system;
}

/** The box method: Voronoi boxes, and area over length for each edge. */
inline System AssembleBoxes(vtkUnstructuredGrid* grid)
{
  vtkNew<vtkVoronoiControlVolumes> filter;
  filter->SetInputData(grid);
  filter->Update();
  System system;
  system.Masses = Eigen::VectorXd::Zero(grid->GetNumberOfPoints());
  vtkPointData* boxes = filter->GetOutput()->GetPointData();
  for (vtkIdType i = 0; i < filter->GetOutput()->GetNumberOfPoints(); ++i)
  {
    const auto point = static_cast<vtkIdType>(boxes->GetArray("PointId")->GetComponent(i, 0));
    system.Masses[point] += boxes->GetArray("BoxVolume")->GetComponent(i, 0);
  }
  vtkPolyData* couplings = filter->GetCouplings();
  vtkDataArray* areas = couplings->GetCellData()->GetArray("CouplingArea");
  vtkDataArray* lengths = couplings->GetCellData()->GetArray("EdgeLength");
  std::vector<Eigen::Triplet<double>> entries;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < couplings->GetNumberOfCells(); ++i)
  {
    couplings->GetCellPoints(i, ids);
    const double coupling = areas->GetComponent(i, 0) / lengths->GetComponent(i, 0);
    for (const int end : { 0, 1 })
    {
      entries.emplace_back(ids->GetId(end), ids->GetId(end), coupling);
      entries.emplace_back(ids->GetId(end), ids->GetId(1 - end), -coupling);
    }
  }
  system.Stiffness.resize(grid->GetNumberOfPoints(), grid->GetNumberOfPoints());
  system.Stiffness.setFromTriplets(entries.begin(), entries.end());
  return system;
}

/** exp(-r^2 / (2 width^2)) around a corner of the stack. */
inline Eigen::VectorXd MakeGaussian(vtkUnstructuredGrid* grid, double width)
{
  Eigen::VectorXd concentrations(grid->GetNumberOfPoints());
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    concentrations[i] = std::exp(-0.5 * GetPoint(grid, i).squaredNorm() / (width * width));
  }
  return concentrations;
}

struct Result
{
  Eigen::VectorXd Concentrations;
  /** Extreme values over all points and steps. */
  double Smallest = 0.0;
  double Largest = 0.0;
};

/** Implicit Euler steps of a length times the diffusion constant. */
inline Result Diffuse(
  const System& system, const Eigen::VectorXd& start, double timeStep, int numberOfSteps)
{
  Eigen::SparseMatrix<double> matrix = timeStep * system.Stiffness;
  matrix += Eigen::SparseMatrix<double>(system.Masses.asDiagonal());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  Result result{ start, start.minCoeff(), start.maxCoeff() };
  for (int step = 0; step < numberOfSteps; ++step)
  {
    result.Concentrations = solver.solve(system.Masses.cwiseProduct(result.Concentrations)).eval();
    result.Smallest = std::min(result.Smallest, result.Concentrations.minCoeff());
    result.Largest = std::max(result.Largest, result.Concentrations.maxCoeff());
  }
  return result;
}
} // namespace diffusion

#endif
