// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDistributedTetrahedralizer
 * @brief   Stage 3 on several processes: Delaunay tetrahedra of points that no process has to know
 * all of.
 *
 * The tetrahedra of vtkAdvancingFrontTetrahedralizer depend on the points and their numbering only.
 * So each process makes those at the points in its own part of space, and the parts fit.
 *
 * Method (Fleischmann 1999, section 6.4; Filters/Core/Delaunay/PartTetrahedralization.h):
 *  1. points are numbered, by their global ids if they have any, otherwise from the first process
 *     to the last, the mesh points after the input; space is cut into boxes with equally many
 *     points, and each point goes to the process whose box holds it, with its point data;
 *  2. each process tetrahedralizes its points and those around its box. A tetrahedron is final if
 *     no process has a point in its sphere; where that is not certain, they are asked, and what
 *     they answer with goes into the next round;
 *  3. with a surface: each process gets all of it, finds its triangles among the facets of its
 *     tetrahedra, and fills the regions between them; processes tell each other the regions of
 *     tetrahedra that they share;
 *  4. a tetrahedron belongs to the process that has its lowest numbered point. Ghost cells are
 *     added level by level, as many as the pipeline asks for. ParaView asks for one, and counts
 *     them with the others: its filter RemoveGhostInformation leaves them out.
 *
 * Inputs: port 0: vtkPointSet, a piece of it on each process, some may be empty: a Delaunay surface
 * of triangles as vtkDelaunaySurfaceRefiner makes it, optionally with BoundaryLabels; or points
 * alone, to be meshed up to their convex hull. Port 1, optional: vtkPointSet, mesh points. Points
 * at the same place are one, whichever processes they come from, and so are triangles that two
 * processes have.
 *
 * Outputs: port 0: vtkUnstructuredGrid of VTK_TETRA with the cell array RegionId (int), the points
 * used with the point data that both inputs have, and global point ids (GlobalPointIds). With
 * several processes vtkGhostType marks cells and points of other processes. Port 1: the triangles
 * of the boundary whose lowest numbered point is here, with BoundaryLabels (int, 2 components), the
 * cell data of the surface, and points like those of port 0; without a surface the convex hull.
 *
 * Guarantees: those of vtkAdvancingFrontTetrahedralizer; all processes together have its
 * tetrahedra, each once, whatever the number of processes and the pieces of the input are, if the
 * points are numbered alike. Cells and points follow their numbers. Deterministic.
 *
 * Failure: an error on all processes, and empty outputs, if one of them has one; those it did not
 * happen on name the process. Surfaces have to be closed: there is no CloseOpenBoundary, and there
 * are no seeds. A weakly Delaunay triangle that is a facet of the mesh by chance is not complained
 * about. A warning on the first process counts mesh points in no meshed region. Aborting one
 * process aborts all. An aborted run has empty outputs.
 *
 * Cost: see Testing/Benchmarks/Distributed.md. Every process has all of the surface; mesh points
 * may be as many as all processes can hold. All processes of the controller have to update the
 * filter.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999.
 */
#ifndef vtkDistributedTetrahedralizer_h
#define vtkDistributedTetrahedralizer_h

#include "cdmMeshingModule.h" // For export macro
#include <vtkUnstructuredGridAlgorithm.h>

class vtkMultiProcessController;

class CDMMESHING_EXPORT vtkDistributedTetrahedralizer : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkDistributedTetrahedralizer* New();
  vtkTypeMacro(vtkDistributedTetrahedralizer, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The processes that mesh together. Default: the global controller; null: this process alone. */
  virtual void SetController(vtkMultiProcessController*);
  vtkMultiProcessController* GetController() const { return this->Controller; }
  ///@}

  ///@{
  /**
   * Of the last run: rounds of questions and answers; points of other processes that this one
   * needed to know; bytes that it sent; mesh points left out on all processes.
   */
  vtkGetMacro(NumberOfRounds, int);
  vtkGetMacro(NumberOfHaloPoints, vtkIdType);
  vtkGetMacro(NumberOfBytesSent, vtkIdType);
  vtkGetMacro(NumberOfUnusedMeshPoints, vtkIdType);
  ///@}

protected:
  vtkDistributedTetrahedralizer();
  ~vtkDistributedTetrahedralizer() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  vtkMultiProcessController* Controller = nullptr;
  int NumberOfRounds = 0;
  vtkIdType NumberOfHaloPoints = 0;
  vtkIdType NumberOfBytesSent = 0;
  vtkIdType NumberOfUnusedMeshPoints = 0;

private:
  vtkDistributedTetrahedralizer(const vtkDistributedTetrahedralizer&) = delete;
  void operator=(const vtkDistributedTetrahedralizer&) = delete;
};

#endif
