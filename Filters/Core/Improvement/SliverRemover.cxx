// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Improvement/SliverRemover.h"

#include "Core/Improvement/BorderPeeling.h"
#include "Core/Improvement/FlipSearch.h"
#include "Core/Improvement/FlippableMesh.h"
#include "Core/Improvement/SliverPointMoves.h"
#include "Core/Improvement/StarSmoothing.h"
#include "Core/Meshes/MeshInvariants.h"
#include "Core/Surface/StructuralEdges.h"

#include <algorithm>

namespace cdm
{
namespace
{
class SliverRemoval
{
public:
  SliverRemoval(TetMesh& mesh, const SliverRemoverOptions& options, SliverRemoverReport& report)
    : Mesh(mesh, options.DihedralAngleTarget), Flips(this->Mesh, options.QualityBeforeDelaunay),
      Peeling(this->Mesh, this->Flips, options.FlatnessRatio * GetBoundingBoxDiagonal(mesh.Points)),
      Options(options), Report(report)
  {
  }

  Status Run(const ExecutionContext& context);

private:
  void Improve(Id tetrahedron);
  bool PeelAndFlip(const ExecutionContext& context);
  bool HasMovableSlivers() const;

  FlippableMesh Mesh;
  const FlipSearch Flips;
  BorderPeeling Peeling;
  const SliverRemoverOptions& Options;
  SliverRemoverReport& Report;
};

/** Flips it away, hands it over or, if the mesh need not stay Delaunay, smooths it. */
void SliverRemoval::Improve(Id tetrahedron)
{
  const Flip flip = this->Flips.FindBest(tetrahedron);
  if (!flip.New.empty())
  {
    this->Mesh.Apply(flip);
    ++this->Report.Flips;
  }
  else if (this->Peeling.HandOver(tetrahedron))
  {
    ++this->Report.Flips;
    ++this->Report.PeeledTetrahedra;
  }
  else if (this->Options.QualityBeforeDelaunay &&
    SmoothPointOf(tetrahedron, this->Options.IsFree, this->Mesh))
  {
    ++this->Report.MovedPoints;
  }
}

bool SliverRemoval::HasMovableSlivers() const
{
  const TetMesh& mesh = this->Mesh.GetMesh();
  const std::vector<char>& isFree = this->Options.IsFree;
  for (std::size_t t = 0; t < mesh.Tetrahedra.size(); ++t)
  {
    const TetrahedronIds& ids = mesh.Tetrahedra[t];
    if (this->Mesh.GetAngle(static_cast<Id>(t)) < this->Mesh.GetTarget() &&
      (this->Options.AreBoundaryPointsFree ||
        std::any_of(ids.begin(), ids.end(),
          [&isFree](Id point) { return !isFree.empty() && isFree[point] != 0; })))
    {
      return true;
    }
  }
  return false;
}

/** False if aborted. */
bool SliverRemoval::PeelAndFlip(const ExecutionContext& context)
{
  // Peel first: the tetrahedra around each point, which it asks for, change with the first flip.
  bool isAborted = false;
  for (const bool isPeeling : { true, false })
  {
    this->Mesh.ScheduleAll();
    const std::size_t numberOfTasks = this->Mesh.GetNumberOfTasks();
    for (std::size_t done = 0; this->Mesh.GetNumberOfTasks() > 0 && !isAborted; ++done)
    {
      if (done % StepsBetweenChecks == 0)
      {
        const double fraction = static_cast<double>(done) / (done + numberOfTasks);
        isAborted =
          !context.Continue(isPeeling ? 0.2 * fraction : 0.2 + 0.8 * fraction, "Removing slivers");
      }
      const Id tetrahedron = this->Mesh.TakeTask();
      if (tetrahedron == NoId)
      {
        continue;
      }
      if (!isPeeling)
      {
        this->Improve(tetrahedron);
      }
      else if (this->Peeling.PeelOff(tetrahedron))
      {
        ++this->Report.PeeledTetrahedra;
      }
    }
  }
  this->Mesh.Compact();
  return !isAborted;
}

Status SliverRemoval::Run(const ExecutionContext& context)
{
  this->Mesh.MeasureAngles(context.GetNumberOfThreads());
  this->Report.SmallestDihedralAngleBefore = this->Mesh.GetSmallestAngle();
  const bool mayMove = (!this->Options.IsFree.empty() || this->Options.AreBoundaryPointsFree) &&
    !this->Options.QualityBeforeDelaunay;
  const double share = mayMove ? 0.2 : 1.0;
  bool isAborted = !this->PeelAndFlip(context.Part(0.0, share));
  if (mayMove && !isAborted && this->HasMovableSlivers())
  {
    const Status status = MoveSliverPoints(this->Mesh.GetTarget(), this->Options.IsFree,
      this->Options.AreBoundaryPointsFree, context.Part(share, 1.0), this->Mesh.GetMesh(),
      this->Report.MovedPoints);
    isAborted = !status.IsOk();
    this->Mesh.MeasureAngles(context.GetNumberOfThreads());
  }
  this->Report.SmallestDihedralAngleAfter = this->Mesh.GetSmallestAngle();
  return isAborted ? Status::Aborted() : Status{};
}
} // namespace

Status RemoveSlivers(TetMesh& mesh, const SliverRemoverOptions& options,
  const ExecutionContext& context, SliverRemoverReport& report)
{
  return RunGuarded(
    [&]() -> Status
    {
      report = {};
      const Status status = CheckMeshInvariants(mesh, context.GetNumberOfThreads());
      if (status.IsOk() && !options.IsFree.empty() && options.IsFree.size() != mesh.Points.size())
      {
        return Status::InvalidInput(
          "Which points are free has to be said for each point, or for none.");
      }
      return status.IsOk() ? SliverRemoval(mesh, options, report).Run(context) : status;
    });
}
} // namespace cdm
