// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkTechnologyStructureSource
 * @brief   Makes the polygon boundary of a sample semiconductor device of several materials.
 *
 * Structures; all lengths are in micrometres, from 1e-9 to 1e9:
 *  - MOS transistor (thesis Fig. 6.11): a cross-section in x and z, extruded along y from 0 to
 *    DeviceWidth. The silicon surface lies at z = 0; the gate oxide lies on it under the gate and
 *    under the spacers; the flank of a spacer is a quarter of an ellipse in SpacerSegments straight
 *    pieces. Regions: Bulk, GateOxide, Gate, LeftSpacer, RightSpacer.
 *  - Via plug (thesis chapter 7): a cylindrical plug from a bottom metal line along x to a top
 *    metal line along y, in a box of insulator. The plug stands on z = 0, its axis is the z axis;
 *    its outline is a regular polygon with its corners on the circle. Regions: Insulator,
 *    BottomLine, Plug, TopLine.
 *  - NMOS with field oxide (thesis Fig. 7.22): two regions of field oxide, half of them below the
 *    silicon surface at z = 0, leave a channel of ChannelWidth in the middle of the device; the gate
 *    crosses it along y, from 0 to DeviceWidth, on the gate oxide between them; an oxide of the same
 *    thickness everywhere covers the device. Regions: Bulk, LeftFieldOxide, RightFieldOxide (at the
 *    low and at the high y), GateOxide, Gate, CoverOxide.
 *
 * Method:
 *  1. check the parameters;
 *  2. lay out the cross-section, or the mask of all layers, as a planar subdivision;
 *  3. stack it and collect the interfaces of different regions (LayeredStructure.h);
 *  4. rotate all points by RotationAngle about RotationAxis through the origin.
 *
 * Inputs: none.
 *
 * Outputs: port 0: vtkPolyData, coordinates in double precision, polygons of any number of
 * vertices, also non-convex and with collinear vertices. Cell arrays: BoundaryLabels (int,
 * components front and back): the region ids on the side that the normal points to and on the other
 * one, -1 outside; normals point out of the structure, and from the larger to the smaller id.
 * FacetId (int): equal for the pieces of one connected planar interface between two regions. Field
 * array RegionNames (string): names by region id.
 *
 * Guarantees: each interface polygon is there once; no two points coincide; no point lies on an
 * edge or in a polygon that it is no vertex of; each region is closed, of one piece. Without
 * rotation polygons are exactly planar; with it to rounding, while connectivity and arrays are the
 * same. Rotations about x, y or z by multiples of 90 degrees are exact.
 *
 * Failure: an error that names the parameters, and an empty output, if a length is out of range,
 * if parts do not fit into each other, or if they are too different in size for double precision.
 *
 * Cost: O(n^2) for n segments; milliseconds for the defaults, 0.3 s for 720 segments.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: the devices.
 */
#ifndef vtkTechnologyStructureSource_h
#define vtkTechnologyStructureSource_h

#include "cdmMeshingModule.h" // For export macro
#include <vtkPolyDataAlgorithm.h>

class CDMMESHING_EXPORT vtkTechnologyStructureSource : public vtkPolyDataAlgorithm
{
public:
  static vtkTechnologyStructureSource* New();
  vtkTypeMacro(vtkTechnologyStructureSource, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Values of Structure. */
  enum Structures
  {
    MOS_TRANSISTOR = 0,
    VIA_PLUG = 1,
    NMOS_WITH_FIELD_OXIDE = 2
  };

  ///@{
  /** The device to make. Default MOS_TRANSISTOR. */
  vtkSetClampMacro(Structure, int, MOS_TRANSISTOR, NMOS_WITH_FIELD_OXIDE);
  vtkGetMacro(Structure, int);
  void SetStructureToMosTransistor() { this->SetStructure(MOS_TRANSISTOR); }
  void SetStructureToViaPlug() { this->SetStructure(VIA_PLUG); }
  void SetStructureToNmosWithFieldOxide() { this->SetStructure(NMOS_WITH_FIELD_OXIDE); }
  const char* GetStructureAsString();
  ///@}

  ///@{
  /** Transistors: length of the gate along x. Micrometres; default 0.18; range above 0. */
  vtkSetMacro(GateLength, double);
  vtkGetMacro(GateLength, double);
  ///@}

  ///@{
  /**
   * Transistors: height of gate and spacers above the gate oxide. Micrometres; default 0.2; range
   * above 0; with field oxide the gate has to rise above that.
   */
  vtkSetMacro(GateHeight, double);
  vtkGetMacro(GateHeight, double);
  ///@}

  ///@{
  /** Transistors: thickness of the gate oxide. Micrometres; default 0.005; range above 0. */
  vtkSetMacro(GateOxideThickness, double);
  vtkGetMacro(GateOxideThickness, double);
  ///@}

  ///@{
  /** MOS transistor: length of a spacer along x. Micrometres; default 0.08; range above 0. */
  vtkSetMacro(SpacerWidth, double);
  vtkGetMacro(SpacerWidth, double);
  ///@}

  ///@{
  /** MOS transistor: straight pieces of a spacer's flank. Default 3; range 1 (slanted) to 90. */
  vtkSetClampMacro(SpacerSegments, int, 1, 90);
  vtkGetMacro(SpacerSegments, int);
  ///@}

  ///@{
  /**
   * Transistors: length of the silicon along x. Micrometres; default 0.8; range above GateLength + 2
   * SpacerWidth, or above GateLength + 2 CoverOxideThickness.
   */
  vtkSetMacro(BulkLength, double);
  vtkGetMacro(BulkLength, double);
  ///@}

  ///@{
  /**
   * Transistors: depth of the silicon. Micrometres; default 0.5; range above 0, and above half of
   * FieldOxideThickness.
   */
  vtkSetMacro(BulkDepth, double);
  vtkGetMacro(BulkDepth, double);
  ///@}

  ///@{
  /**
   * Transistors: extent of the device along y. Micrometres; default 0.3; range above 0, and above
   * ChannelWidth.
   */
  vtkSetMacro(DeviceWidth, double);
  vtkGetMacro(DeviceWidth, double);
  ///@}

  ///@{
  /**
   * NMOS with field oxide: width of the channel along y, from one field oxide to the other.
   * Micrometres; default 0.18; range above 2 CoverOxideThickness.
   */
  vtkSetMacro(ChannelWidth, double);
  vtkGetMacro(ChannelWidth, double);
  ///@}

  ///@{
  /**
   * NMOS with field oxide: thickness of the field oxide, half of it above the silicon surface.
   * Micrometres; default 0.16; range above 0.
   */
  vtkSetMacro(FieldOxideThickness, double);
  vtkGetMacro(FieldOxideThickness, double);
  ///@}

  ///@{
  /**
   * NMOS with field oxide: thickness of the oxide that covers all. Micrometres; default 0.03; range
   * above 0.
   */
  vtkSetMacro(CoverOxideThickness, double);
  vtkGetMacro(CoverOxideThickness, double);
  ///@}

  ///@{
  /**
   * Via plug: diameter of the circle around the plug. Micrometres; default 0.3; range above 0,
   * below BottomLineWidth and TopLineWidth.
   */
  vtkSetMacro(ViaDiameter, double);
  vtkGetMacro(ViaDiameter, double);
  ///@}

  ///@{
  /** Via plug: height of the plug. Micrometres; default 0.6; range above 0. */
  vtkSetMacro(ViaHeight, double);
  vtkGetMacro(ViaHeight, double);
  ///@}

  ///@{
  /** Via plug: corners of the plug's outline. Default 24; range 3 to 720. */
  vtkSetClampMacro(NumberOfSegments, int, 3, 720);
  vtkGetMacro(NumberOfSegments, int);
  ///@}

  ///@{
  /**
   * Via plug: width of the bottom line along y. Micrometres; default 0.4; range above ViaDiameter,
   * below BoxSize.
   */
  vtkSetMacro(BottomLineWidth, double);
  vtkGetMacro(BottomLineWidth, double);
  ///@}

  ///@{
  /** Via plug: thickness of the bottom line. Micrometres; default 0.3; range above 0. */
  vtkSetMacro(BottomLineThickness, double);
  vtkGetMacro(BottomLineThickness, double);
  ///@}

  ///@{
  /**
   * Via plug: width of the top line along x. Micrometres; default 0.4; range above ViaDiameter,
   * below BoxSize.
   */
  vtkSetMacro(TopLineWidth, double);
  vtkGetMacro(TopLineWidth, double);
  ///@}

  ///@{
  /** Via plug: thickness of the top line. Micrometres; default 0.3; range above 0. */
  vtkSetMacro(TopLineThickness, double);
  vtkGetMacro(TopLineThickness, double);
  ///@}

  ///@{
  /**
   * Via plug: extent of the box along x and y. Micrometres; default 1; range above BottomLineWidth
   * and TopLineWidth.
   */
  vtkSetMacro(BoxSize, double);
  vtkGetMacro(BoxSize, double);
  ///@}

  ///@{
  /** Angle by which the structure is rotated about RotationAxis. Degrees; default 0; any. */
  vtkSetMacro(RotationAngle, double);
  vtkGetMacro(RotationAngle, double);
  ///@}

  ///@{
  /** Direction of the axis of rotation, through the origin. Default (0, 0, 1); not zero. */
  vtkSetVector3Macro(RotationAxis, double);
  vtkGetVector3Macro(RotationAxis, double);
  ///@}

protected:
  vtkTechnologyStructureSource();
  ~vtkTechnologyStructureSource() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Structure = MOS_TRANSISTOR;

  double GateLength = 0.18;
  double GateHeight = 0.2;
  double GateOxideThickness = 0.005;
  double SpacerWidth = 0.08;
  int SpacerSegments = 3;
  double BulkLength = 0.8;
  double BulkDepth = 0.5;
  double DeviceWidth = 0.3;
  double ChannelWidth = 0.18;
  double FieldOxideThickness = 0.16;
  double CoverOxideThickness = 0.03;

  double ViaDiameter = 0.3;
  double ViaHeight = 0.6;
  int NumberOfSegments = 24;
  double BottomLineWidth = 0.4;
  double BottomLineThickness = 0.3;
  double TopLineWidth = 0.4;
  double TopLineThickness = 0.3;
  double BoxSize = 1.0;

  double RotationAngle = 0.0;
  double RotationAxis[3] = { 0.0, 0.0, 1.0 };

private:
  vtkTechnologyStructureSource(const vtkTechnologyStructureSource&) = delete;
  void operator=(const vtkTechnologyStructureSource&) = delete;
};

#endif
