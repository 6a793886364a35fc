// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkLayoutExtruder
 * @brief   Makes the polygon boundary of a structure of many materials from a layout and a
 * cross-section.
 *
 * The layout is a list of polygons for each mask, the cross-section a list of process steps: each
 * fills the prism over a mask, or over all of the layout, between two heights with a region, or
 * empties it. Later steps replace what earlier ones left there, as in a process flow: a wafer, a
 * trench etched into it and filled, lines and plugs in an oxide.
 *
 * Method (Fleischmann 1999, section 4.2.1):
 *  1. overlay the polygons of all masks: a planar subdivision with all edges of the layout
 *     (Fig. 4.3; LayoutOverlay.h); masks may overlap, touch and cross in any way;
 *  2. one layer between each two neighbours of all heights; run the steps in their order;
 *  3. collect the interfaces of different regions (LayeredStructure.h). What the layers leave out,
 *     the tetrahedra, is up to the mesher, whose density need not be the same in all layers.
 *
 * Inputs: port 0: vtkPolyData, polygons of the layout; their x and y count only. Outlines may be
 * non-convex, and bridged to holes. Cell array Mask (whole numbers from 0 on): the mask of each
 * polygon; without it all are of mask 0.
 *
 * Outputs: port 0: vtkPolyData, coordinates in double precision, polygons of any number of
 * vertices. Cell arrays BoundaryLabels (int, components front and back): the region ids on the side
 * that the normal points to and on the other one, -1 outside; FacetId (int): equal for the pieces
 * of one connected planar interface, cut at contacts. Field array RegionNames (string) if names were
 * given. vtkGmshMeshWriter names interfaces and outer sides after them. With contacts: cell array
 * ContactId (int; -1: none) and field array ContactNames (string), which the mesher hands on to its
 * boundary, where vtkGmshMeshWriter takes them.
 *
 * Guarantees: each interface polygon is there once, and exactly planar; no two points coincide; no
 * point lies on an edge or in a polygon that it is no vertex of. Vertices of the layout keep their
 * exact coordinates; where edges of masks cross, the crossing is rounded. Deterministic.
 *
 * Failure: an error that names the cells or steps, and an empty output, for a layout without
 * polygons, an outline that crosses itself, points that are not finite, no steps, a mask without
 * polygons, heights that do not ascend, steps that leave nothing, contacts where nothing is. An aborted run has an empty
 * output.
 *
 * Cost: that of the overlay, which grows with the crossings of masks: 3 s for 200 rectangles of a
 * mask that cross each other 2,000 times, in 15 layers; 0.1 s for 25.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: layout and layers.
 */
#ifndef vtkLayoutExtruder_h
#define vtkLayoutExtruder_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

#include <array>
#include <string>
#include <vector>

class vtkPolyData;
namespace cdm
{
struct Status;
}

class CDMMESHING_EXPORT vtkLayoutExtruder : public vtkPolyDataAlgorithm
{
public:
  static vtkLayoutExtruder* New();
  vtkTypeMacro(vtkLayoutExtruder, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * A process step: fill the prism over a mask (-1: over the bounding rectangle of the layout and
   * Margin around it) from one height to another with a region (-1: empty it). Heights in model
   * units, the second one above the first. Whole numbers are passed as double, as ParaView does
   * with rows of a table. Default: none.
   */
  void AddStep(double mask, double bottom, double top, double region);
  void RemoveAllSteps();
  ///@}

  ///@{
  /** The names of the regions, beginning with region 0. Default: none. */
  void AddRegionName(const char* name);
  void RemoveAllRegionNames();
  ///@}

  ///@{
  /**
   * A contact: everything at a height, one of those of the steps, over a mask (-1: over all of the
   * layout) that is an outer boundary or an interface. Where contacts overlap the last one counts.
   * Height in model units. Default: none.
   */
  void AddContact(double mask, double height);
  void RemoveAllContacts();
  ///@}

  ///@{
  /** The names of the contacts, beginning with the first one. Default: none. */
  void AddContactName(const char* name);
  void RemoveAllContactNames();
  ///@}

  ///@{
  /**
   * By how much the structure is larger than the layout on all four sides, for steps without a
   * mask. Model units; default 0; range 0 and above.
   */
  vtkSetInRangeMacro(Margin, double, 0.0, VTK_DOUBLE_MAX, "model units");
  vtkGetMacro(Margin, double);
  ///@}

protected:
  vtkLayoutExtruder();
  ~vtkLayoutExtruder() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  std::vector<std::array<double, 4>> Steps;
  std::vector<std::string> RegionNames;
  std::vector<std::array<double, 2>> Contacts;
  std::vector<std::string> ContactNames;
  double Margin = 0.0;

private:
  struct Structure;
  cdm::Status MakeStructure(vtkPolyData* layout, Structure& structure);

  vtkLayoutExtruder(const vtkLayoutExtruder&) = delete;
  void operator=(const vtkLayoutExtruder&) = delete;
};

#endif
