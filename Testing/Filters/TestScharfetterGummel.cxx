// SPDX-License-Identifier: BSD-3-Clause
/**
 * A solver that believes the control volumes: steady drift and diffusion of one carrier in the bulk
 * of the MOS transistor, between contacts at both ends of its length, where everything is a
 * function of x alone. Scaled to the thermal voltage, with unit mobility:
 *   -psi'' = rho,   J = n' - n psi',   J' = 0.
 * The potential of a constant charge is a parabola; n = exp(psi) (C + J int exp(-psi) dx).
 */
#include "FilterTesting.h"

#include <vtkConformingDelaunayMesher.h>
#include <vtkTechnologyStructureSource.h>
#include <vtkVoronoiControlVolumes.h>

#include <vtkIdList.h>

#include <Eigen/Sparse>
#include <Eigen/SparseLU>

#include <cmath>
#include <functional>
#include <map>

using namespace testing_filters;

namespace
{
constexpr double Left = -0.4;
constexpr double Right = 0.4;
constexpr double Area = 0.3 * 0.5;
constexpr double Charge = 60.0;
constexpr double LeftPotential = 0.0;
constexpr double RightPotential = 3.0;
constexpr double LeftDensity = 1.0;
constexpr double RightDensity = 2.0;

double GetPotential(double x)
{
  const double t = (x - Left) / (Right - Left);
  return LeftPotential + (RightPotential - LeftPotential) * t +
    0.5 * Charge * (x - Left) * (Right - x);
}

/** Integral of exp(-psi) from the left contact, by Simpson's rule. */
double Integrate(double x)
{
  const int steps = 2000;
  const double h = (x - Left) / steps;
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i)
  {
    sum += (i == 0 || i == steps ? 1.0
               : i % 2 == 1      ? 4.0
                                 : 2.0) *
      std::exp(-GetPotential(Left + i * h));
  }
  return sum * h / 3.0;
}

double GetCurrentDensity()
{
  return (RightDensity * std::exp(-RightPotential) - LeftDensity * std::exp(-LeftPotential)) /
    Integrate(Right);
}

double GetDensity(double x)
{
  return std::exp(GetPotential(x)) *
    (LeftDensity * std::exp(-LeftPotential) + GetCurrentDensity() * Integrate(x));
}

/** x / (exp(x) - 1). */
double Bernoulli(double x)
{
  return std::abs(x) < 1e-4 ? 1.0 - x / 2.0 + x * x / 12.0 : x / std::expm1(x);
}

struct Edge
{
  Eigen::Index Ends[2];
  double Coupling;
};

/** Points, boxes and couplings of the bulk. */
struct Bulk
{
  std::vector<double> X;
  std::vector<double> Volumes;
  std::vector<Edge> Edges;
};

Bulk MakeBulk(double spacing)
{
  vtkNew<vtkTechnologyStructureSource> device;
  device->SetStructureToMosTransistor();
  // A lattice inside of the bulk, [-0.4, 0.4] x [0, 0.3] x [-0.5, 0], away from its surface.
  std::vector<Point> lattice;
  const int counts[3] = { int(std::lround(0.8 / spacing)), int(std::lround(0.3 / spacing)),
    int(std::lround(0.5 / spacing)) };
  for (const double shift : { 0.5, 1.0 })
  {
    for (int i = 0; i < counts[0]; ++i)
    {
      for (int j = 0; j < counts[1]; ++j)
      {
        for (int k = 0; k < counts[2]; ++k)
        {
          const double x[3] = { i + shift, j + shift, k + shift };
          if (x[0] < counts[0] - 0.25 && x[1] < counts[1] - 0.25 && x[2] < counts[2] - 0.25)
          {
            lattice.push_back({ -0.4 + 0.8 * x[0] / counts[0], 0.3 * x[1] / counts[1],
              -0.5 + 0.5 * x[2] / counts[2] });
          }
        }
      }
    }
  }
  vtkNew<vtkConformingDelaunayMesher> mesher;
  mesher->SetMeshForToFewestPoints();
  mesher->SetInputConnection(device->GetOutputPort());
  mesher->SetInputData(1, MakePoints(lattice));
  mesher->SetMaximumEdgeLength(spacing);
  mesher->SetCriterionToSmallestSphereAndEdges();
  vtkNew<vtkVoronoiControlVolumes> volumes;
  volumes->SetInputConnection(mesher->GetOutputPort());
  volumes->Update();
  EXPECT_EQ(0, volumes->GetNumberOfNegativeCouplings());

  Bulk bulk;
  std::map<vtkIdType, Eigen::Index> indices;
  vtkPointData* boxes = volumes->GetOutput()->GetPointData();
  for (vtkIdType i = 0; i < volumes->GetOutput()->GetNumberOfPoints(); ++i)
  {
    if (boxes->GetArray("RegionId")->GetComponent(i, 0) == 0.0)
    {
      indices[static_cast<vtkIdType>(boxes->GetArray("PointId")->GetComponent(i, 0))] =
        static_cast<Eigen::Index>(bulk.X.size());
      double x[3];
      volumes->GetOutput()->GetPoint(i, x);
      bulk.X.push_back(x[0]);
      bulk.Volumes.push_back(boxes->GetArray("BoxVolume")->GetComponent(i, 0));
    }
  }
  vtkPolyData* couplings = volumes->GetCouplings();
  vtkCellData* data = couplings->GetCellData();
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < couplings->GetNumberOfCells(); ++i)
  {
    if (data->GetArray("RegionId")->GetComponent(i, 0) == 0.0)
    {
      couplings->GetCellPoints(i, ids);
      bulk.Edges.push_back({ { indices.at(ids->GetId(0)), indices.at(ids->GetId(1)) },
        data->GetArray("CouplingArea")->GetComponent(i, 0) /
          data->GetArray("EdgeLength")->GetComponent(i, 0) });
    }
  }
  return bulk;
}

/**
 * Solves sum over the edges of a point of (flux out of it) = source, with values prescribed at the
 * contacts. getWeights gives what the values at an edge's ends count in the flux from the first to
 * the second.
 */
Eigen::VectorXd Solve(const Bulk& bulk,
  const std::function<std::pair<double, double>(const Edge&)>& getWeights, double source,
  double left, double right)
{
  const auto size = static_cast<Eigen::Index>(bulk.X.size());
  const auto isContact = [&](Eigen::Index i) { return bulk.X[i] == Left || bulk.X[i] == Right; };
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd sources(size);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    sources[i] = bulk.X[i] == Left ? left : bulk.X[i] == Right ? right : source * bulk.Volumes[i];
    if (isContact(i))
    {
      entries.emplace_back(i, i, 1.0);
    }
  }
  for (const Edge& edge : bulk.Edges)
  {
    const auto [first, second] = getWeights(edge);
    for (const int end : { 0, 1 })
    {
      const Eigen::Index row = edge.Ends[end];
      if (!isContact(row))
      {
        const double sign = end == 0 ? 1.0 : -1.0;
        entries.emplace_back(row, edge.Ends[0], sign * first);
        entries.emplace_back(row, edge.Ends[1], sign * second);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  EXPECT_EQ(Eigen::Success, solver.info());
  return solver.solve(sources);
}

struct Solution
{
  std::size_t Points = 0;
  double PotentialError = 0.0;
  double DensityError = 0.0;
  double LeftCurrent = 0.0;
  double RightCurrent = 0.0;
  double SmallestDensity = 0.0;
};

/** Root of the mean square over the boxes, relative to the largest value. */
double GetError(
  const Bulk& bulk, const Eigen::VectorXd& values, const std::function<double(double)>& exact)
{
  double squares = 0.0;
  double volume = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < bulk.X.size(); ++i)
  {
    const double expected = exact(bulk.X[i]);
    const double difference = values[static_cast<Eigen::Index>(i)] - expected;
    squares += bulk.Volumes[i] * difference * difference;
    volume += bulk.Volumes[i];
    largest = std::max(largest, std::abs(expected));
  }
  return std::sqrt(squares / volume) / largest;
}

Solution Simulate(double spacing)
{
  const Bulk bulk = MakeBulk(spacing);
  const Eigen::VectorXd psi = Solve(
    bulk, [](const Edge& edge) { return std::make_pair(edge.Coupling, -edge.Coupling); }, Charge,
    LeftPotential, RightPotential);
  // The flux of carriers from the first to the second end is minus the current density's.
  const auto getWeights = [&](const Edge& edge)
  {
    const double difference = psi[edge.Ends[1]] - psi[edge.Ends[0]];
    return std::make_pair(
      edge.Coupling * Bernoulli(-difference), -edge.Coupling * Bernoulli(difference));
  };
  const Eigen::VectorXd n = Solve(bulk, getWeights, 0.0, LeftDensity, RightDensity);
  Solution solution;
  solution.Points = bulk.X.size();
  solution.PotentialError = GetError(bulk, psi, GetPotential);
  solution.DensityError = GetError(bulk, n, GetDensity);
  solution.SmallestDensity = n.minCoeff();
  for (const Edge& edge : bulk.Edges)
  {
    const auto [first, second] = getWeights(edge);
    const double flux = first * n[edge.Ends[0]] + second * n[edge.Ends[1]];
    for (const int end : { 0, 1 })
    {
      const double out = end == 0 ? flux : -flux;
      const double x = bulk.X[edge.Ends[end]];
      solution.LeftCurrent += x == Left ? out : 0.0;
      solution.RightCurrent += x == Right ? out : 0.0;
    }
  }
  std::printf("spacing %g: %zu points, errors: potential %.3g, density %.3g, current %.3g\n",
    spacing, bulk.X.size(), solution.PotentialError, solution.DensityError,
    solution.LeftCurrent / (-GetCurrentDensity() * Area) - 1.0);
  return solution;
}
} // namespace

TEST(ScharfetterGummel, LinearPotentialIsExact)
{
  const Bulk bulk = MakeBulk(0.1);
  const Eigen::VectorXd psi = Solve(
    bulk, [](const Edge& edge) { return std::make_pair(edge.Coupling, -edge.Coupling); }, 0.0, -4.0,
    4.0);
  for (std::size_t i = 0; i < bulk.X.size(); ++i)
  {
    EXPECT_NEAR(10.0 * bulk.X[i], psi[static_cast<Eigen::Index>(i)], 1e-12);
  }
}

TEST(ScharfetterGummel, CurrentIsConservedAndErrorsFallWithTheSquareOfTheSpacing)
{
  const Solution coarse = Simulate(0.1);
  const Solution fine = Simulate(0.05);
  for (const Solution& solution : { coarse, fine })
  {
    EXPECT_NEAR(0.0, (solution.LeftCurrent + solution.RightCurrent) / solution.LeftCurrent, 1e-6);
    EXPECT_GT(solution.SmallestDensity, 0.0) << "the maximum principle";
  }
  const double exact = -GetCurrentDensity() * Area;
  EXPECT_NEAR(1.0, fine.LeftCurrent / exact, 0.01);
  // Second order in the mean distance of points, the cube root of the volume of each.
  const double refinement = std::log(std::cbrt(double(fine.Points) / double(coarse.Points)));
  EXPECT_GT(std::log(coarse.PotentialError / fine.PotentialError) / refinement, 1.9);
  EXPECT_GT(std::log(coarse.DensityError / fine.DensityError) / refinement, 1.9);
}
