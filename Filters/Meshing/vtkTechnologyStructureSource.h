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
 *    silicon surface at z = 0, leave a channel of ChannelWidth in the middle of the device; the
 *    gate crosses it along y, from 0 to DeviceWidth, on the gate oxide between them; an oxide of
 *    the same thickness everywhere covers the device. Regions: Bulk, LeftFieldOxide,
 *    RightFieldOxide (at the low and at the high y), GateOxide, Gate, CoverOxide.
 *    Contacts of the transistors: SourceContact, DrainContact, GateContact, SubstrateContact; of
 *    the via plug: BottomContact, TopContact.
 *  - LOCOS (thesis Fig. 4.2): an oxide grown on silicon beside a nitride mask, which covers x < 0,
 *    with a bird's beak under the bent edge of the mask; extruded along y. The silicon was there up
 *    to z = 0. Regions: Bulk, FieldOxide, Nitride. Contact: SubstrateContact.
 *  - DRAM interconnect (thesis Fig. 7.10): word lines along x, above them bit lines along y with
 *    plugs down to z = 0 in every other gap between word lines, in an insulator; all conductors are
 *    tapered. Regions: Insulator, WordLine1, ..., BitLine1, ... Contacts: the surface of each
 *    conductor, WordLine1Contact and so on; SubstrateContact, the bottom of the insulator.
 *  - Two-layer interconnect (thesis Fig. 7.13 and 7.14): two metal lines along y on silicon, an
 *    oxide that follows their topography, on it two metal lines along x that follow it too.
 *    Regions: Bulk, Oxide, LowerLine1, LowerLine2, UpperLine1, UpperLine2. Contacts: where each
 *    line touches the oxide, LowerLine1Contact and so on; SubstrateContact.
 *  - Via with barrier (thesis Fig. 7.15 to 7.19): a cylindrical hole down to metal at z = 0, lined
 *    by a barrier, with the gas in it and above. Regions: Insulator, BottomMetal, Barrier, Gas.
 *    Contacts: Inlet (the top of the gas), Surface (where gas touches the barrier), BottomContact.
 *  - Damascene (thesis Fig. 7.20): the same with a trench along y above the via. NumberOfSegments
 *    is that of the via in both.
 *  - CMOS inverter (thesis Fig. 7.24): two transistors along y, the second one a mirror image of
 *    the first, each with shallow trench isolation on all four sides, a gate between two spacers,
 *    and contacts through the oxide film to source, drain and gate; metal lines for ground and
 *    supply, one that joins the gates, one that joins the drains. Regions: Silicon, Oxide (film and
 *    trenches), NmosGate, PmosGate, NmosSourceSpacer, NmosDrainSpacer, PmosSourceSpacer,
 *    PmosDrainSpacer, Ground, Supply, Input, Output, and Passivation if there is one. Contacts:
 *    NmosSourceContact, NmosDrainContact, NmosGateContact, PmosSourceContact, PmosDrainContact,
 *    PmosGateContact (where metal touches them), SubstrateContact, and Vss, Vdd, Vin, Vout (the
 *    tops of Ground, Supply, Input and Output).
 *
 * Method:
 *  1. check the parameters;
 *  2. lay out the cross-section, or the masks of all layers, as a planar subdivision;
 *  3. stack it and collect the interfaces of different regions (LayeredStructure.h);
 *  4. rotate all points by RotationAngle about RotationAxis through the origin.
 *
 * Inputs: none.
 *
 * Outputs: port 0: vtkPolyData, coordinates in double precision, polygons of any number of
 * vertices, also non-convex and with collinear vertices. Cell arrays: BoundaryLabels (int,
 * components front and back): the region ids on the side that the normal points to and on the other
 * one, -1 outside; normals point out of the structure, and from the larger to the smaller id.
 * FacetId (int): equal for the pieces of one connected planar interface between two regions.
 * ContactId (int): the contact that the polygon belongs to, or -1; contacts are made of whole
 * facets, and the array reaches the boundary that vtkConformingDelaunayMesher gives out, and the
 * writer of Gmsh files. Field arrays RegionNames and ContactNames (string): names by region and
 * contact id.
 *
 * Guarantees: each interface polygon is there once; no two points coincide; no point lies on an
 * edge or in a polygon that it is no vertex of; each region is closed, of one piece. Without
 * rotation polygons are exactly planar; with it to rounding, while connectivity and arrays are the
 * same. Rotations about x, y or z by multiples of 90 degrees are exact.
 *
 * Failure: an error that names the parameters, and an empty output, if a length is out of range,
 * if parts do not fit into each other, or if they are too different in size for double precision.
 *
 * Cost: milliseconds for the defaults, 0.1 s for a via of 720 segments.
 *
 * References: P. Fleischmann, "Mesh Generation for Technology CAD in Three Dimensions", TU Wien
 * 1999: the devices.
 */
#ifndef vtkTechnologyStructureSource_h
#define vtkTechnologyStructureSource_h

#include "cdmMeshingModule.h" // For export macro
#include "vtkConformingDelaunayRanges.h"
#include <vtkPolyDataAlgorithm.h>

#include <string> // For MakeDevice

namespace cdm
{
struct Device;
}

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
    NMOS_WITH_FIELD_OXIDE = 2,
    LOCOS = 3,
    DRAM_INTERCONNECT = 4,
    TWO_LAYER_INTERCONNECT = 5,
    VIA_WITH_BARRIER = 6,
    DAMASCENE = 7,
    CMOS_INVERTER = 8
  };

  ///@{
  /** The device to make. Default MOS_TRANSISTOR. */
  vtkSetInRangeMacro(Structure, int, MOS_TRANSISTOR, CMOS_INVERTER, "one of Structures");
  vtkGetMacro(Structure, int);
  void SetStructureToMosTransistor() { this->SetStructure(MOS_TRANSISTOR); }
  void SetStructureToViaPlug() { this->SetStructure(VIA_PLUG); }
  void SetStructureToNmosWithFieldOxide() { this->SetStructure(NMOS_WITH_FIELD_OXIDE); }
  void SetStructureToLocos() { this->SetStructure(LOCOS); }
  void SetStructureToDramInterconnect() { this->SetStructure(DRAM_INTERCONNECT); }
  void SetStructureToTwoLayerInterconnect() { this->SetStructure(TWO_LAYER_INTERCONNECT); }
  void SetStructureToViaWithBarrier() { this->SetStructure(VIA_WITH_BARRIER); }
  void SetStructureToDamascene() { this->SetStructure(DAMASCENE); }
  void SetStructureToCmosInverter() { this->SetStructure(CMOS_INVERTER); }
  const char* GetStructureAsString();
  ///@}

  ///@{
  /**
   * Transistors, CMOS inverter: length of the gate along x. Micrometres; default 0.18; range above
   * 0.
   */
  vtkSetMacro(GateLength, double);
  vtkGetMacro(GateLength, double);
  ///@}

  ///@{
  /**
   * Transistors, CMOS inverter: height of gate and spacers above the gate oxide. Micrometres;
   * default 0.2; range above 0; with field oxide the gate has to rise above that.
   */
  vtkSetMacro(GateHeight, double);
  vtkGetMacro(GateHeight, double);
  ///@}

  ///@{
  /**
   * Transistors, CMOS inverter: thickness of the gate oxide. Micrometres; default 0.005; range
   * above 0.
   */
  vtkSetMacro(GateOxideThickness, double);
  vtkGetMacro(GateOxideThickness, double);
  ///@}

  ///@{
  /**
   * MOS transistor, CMOS inverter: length of a spacer along x. Micrometres; default 0.08; range
   * above 0.
   */
  vtkSetMacro(SpacerWidth, double);
  vtkGetMacro(SpacerWidth, double);
  ///@}

  ///@{
  /**
   * MOS transistor, CMOS inverter: straight pieces of a spacer's flank. Default 3; range 1
   * (slanted) to 90.
   */
  vtkSetInRangeMacro(SpacerSegments, int, 1, 90, "straight pieces");
  vtkGetMacro(SpacerSegments, int);
  ///@}

  ///@{
  /**
   * Transistors, LOCOS: length of the silicon along x. Micrometres; default 0.8; range above
   * GateLength + 2 SpacerWidth, above GateLength + 2 CoverOxideThickness, or above 2 StepLength.
   */
  vtkSetMacro(BulkLength, double);
  vtkGetMacro(BulkLength, double);
  ///@}

  ///@{
  /**
   * All devices with silicon: its depth. Micrometres; default 0.5; range above 0, above half of
   * FieldOxideThickness, and above TrenchDepth.
   */
  vtkSetMacro(BulkDepth, double);
  vtkGetMacro(BulkDepth, double);
  ///@}

  ///@{
  /**
   * Transistors, LOCOS: extent of the device along y. Micrometres; default 0.3; range above 0, and
   * above ChannelWidth.
   */
  vtkSetMacro(DeviceWidth, double);
  vtkGetMacro(DeviceWidth, double);
  ///@}

  ///@{
  /**
   * NMOS with field oxide, CMOS inverter: width of a channel along y, between the isolations.
   * Micrometres; default 0.18; range above 2 CoverOxideThickness, or above ContactWidth.
   */
  vtkSetMacro(ChannelWidth, double);
  vtkGetMacro(ChannelWidth, double);
  ///@}

  ///@{
  /**
   * NMOS with field oxide, LOCOS: thickness of the field oxide; half of it, or 0.56 of what was
   * grown, is above the silicon surface. Micrometres; default 0.16; range above 0.
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
   * Vias: diameter of the circle around the plug, or of the hole. Micrometres; default 0.3; range
   * above 0, below BottomLineWidth and TopLineWidth, or below BoxSize.
   */
  vtkSetMacro(ViaDiameter, double);
  vtkGetMacro(ViaDiameter, double);
  ///@}

  ///@{
  /** Vias: height of the plug, or depth of the hole. Micrometres; default 0.6; range above 0. */
  vtkSetMacro(ViaHeight, double);
  vtkGetMacro(ViaHeight, double);
  ///@}

  ///@{
  /** Vias: corners of the circle. Default 24; range 3 to 720. */
  vtkSetInRangeMacro(NumberOfSegments, int, 3, 720, "corners of the circle");
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
  /** Vias: thickness of the metal below. Micrometres; default 0.3; range above 0. */
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
   * Vias: extent of the box along x and y. Micrometres; default 1; range above BottomLineWidth and
   * TopLineWidth, or above ViaDiameter and TrenchWidth.
   */
  vtkSetMacro(BoxSize, double);
  vtkGetMacro(BoxSize, double);
  ///@}

  ///@{
  /**
   * LOCOS: thickness of the oxide under the mask. Micrometres; default 0.02; range above 0, below
   * FieldOxideThickness.
   */
  vtkSetMacro(PadOxideThickness, double);
  vtkGetMacro(PadOxideThickness, double);
  ///@}

  ///@{
  /** LOCOS: thickness of the nitride mask along z. Micrometres; default 0.1; range above 0. */
  vtkSetMacro(NitrideThickness, double);
  vtkGetMacro(NitrideThickness, double);
  ///@}

  ///@{
  /**
   * LOCOS: how far the bird's beak reaches under the mask. Two-layer interconnect: over what length
   * beside a lower line the oxide comes down. Micrometres; default 0.1; range above 0.
   */
  vtkSetMacro(StepLength, double);
  vtkGetMacro(StepLength, double);
  ///@}

  ///@{
  /** LOCOS, two-layer interconnect: straight pieces of StepLength. Default 6; range 1 to 90. */
  vtkSetInRangeMacro(ProfileSegments, int, 1, 90, "straight pieces");
  vtkGetMacro(ProfileSegments, int);
  ///@}

  ///@{
  /**
   * Interconnects: distance of the centers of lines on one layer. Micrometres; default 0.4; range
   * above 2 LineWidth, or above LineWidth + 2 StepLength.
   */
  vtkSetMacro(LinePitch, double);
  vtkGetMacro(LinePitch, double);
  ///@}

  ///@{
  /**
   * Interconnects: width of lines at the bottom, and of plugs at the top. Micrometres; default
   * 0.16; range above 0.
   */
  vtkSetMacro(LineWidth, double);
  vtkGetMacro(LineWidth, double);
  ///@}

  ///@{
  /**
   * Interconnects, CMOS inverter: thickness of metal lines. Micrometres; default 0.2; range above
   * 0.
   */
  vtkSetMacro(LineThickness, double);
  vtkGetMacro(LineThickness, double);
  ///@}

  ///@{
  /**
   * Interconnects: thickness of the insulator below, between and above lines. CMOS inverter:
   * distance of the metal lines from the gates. Micrometres; default 0.15; range above 0.
   */
  vtkSetMacro(InsulatorThickness, double);
  vtkGetMacro(InsulatorThickness, double);
  ///@}

  ///@{
  /**
   * DRAM interconnect: by how much the sides of lines are slanted; plugs are as narrow at the
   * bottom as lines at the top. Degrees; default 5; range 0.1 to 45.
   */
  vtkSetMacro(SidewallAngle, double);
  vtkGetMacro(SidewallAngle, double);
  ///@}

  ///@{
  /** DRAM interconnect: number of word lines, along x. Default 8; range 1 to 100. */
  vtkSetInRangeMacro(NumberOfWordLines, int, 1, 100, "lines");
  vtkGetMacro(NumberOfWordLines, int);
  ///@}

  ///@{
  /** DRAM interconnect: number of bit lines, along y. Default 2; range 1 to 100. */
  vtkSetInRangeMacro(NumberOfBitLines, int, 1, 100, "lines");
  vtkGetMacro(NumberOfBitLines, int);
  ///@}

  ///@{
  /**
   * Via with barrier, damascene: thickness of the barrier. Micrometres; default 0.03; range above
   * 0, below ViaHeight and TrenchDepth.
   */
  vtkSetMacro(BarrierThickness, double);
  vtkGetMacro(BarrierThickness, double);
  ///@}

  ///@{
  /**
   * Via with barrier, damascene: by which part of BarrierThickness the inner side of the barrier in
   * the via is shifted along x, as at a place away from the center of the wafer. Default 0; range 0
   * to 0.95.
   */
  vtkSetInRangeMacro(BarrierAsymmetry, double, 0.0, 0.95, "ratio of BarrierThickness");
  vtkGetMacro(BarrierAsymmetry, double);
  ///@}

  ///@{
  /**
   * Via with barrier, damascene: height of the gas above the barrier on the wafer. Micrometres;
   * default 0.4; range above 0.
   */
  vtkSetMacro(GasHeight, double);
  vtkGetMacro(GasHeight, double);
  ///@}

  ///@{
  /**
   * Damascene: width of the trench along x, with the barrier; range above ViaDiameter + 2
   * BarrierThickness, below BoxSize. CMOS inverter: width of the isolation trench around the
   * transistors; range above 0. Micrometres; default 0.5.
   */
  vtkSetMacro(TrenchWidth, double);
  vtkGetMacro(TrenchWidth, double);
  ///@}

  ///@{
  /**
   * Damascene: depth of the trench. CMOS inverter: depth of the isolation trench, below BulkDepth.
   * Micrometres; default 0.3; range above 0.
   */
  vtkSetMacro(TrenchDepth, double);
  vtkGetMacro(TrenchDepth, double);
  ///@}

  ///@{
  /**
   * CMOS inverter: length of source and drain along x, from the spacer to the trench. Micrometres;
   * default 0.3; range above ContactWidth.
   */
  vtkSetMacro(DiffusionLength, double);
  vtkGetMacro(DiffusionLength, double);
  ///@}

  ///@{
  /**
   * CMOS inverter: sides of the square contacts, and width of the metal lines. Micrometres; default
   * 0.12; range above 0, below GateLength, DiffusionLength and ChannelWidth.
   */
  vtkSetMacro(ContactWidth, double);
  vtkGetMacro(ContactWidth, double);
  ///@}

  ///@{
  /**
   * CMOS inverter: thickness of the oxide above the metal lines, which then also fills the space
   * below and between them. Micrometres; default 0: none, the lines are bare; range 0 and above.
   */
  vtkSetMacro(PassivationThickness, double);
  vtkGetMacro(PassivationThickness, double);
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

  double PadOxideThickness = 0.02;
  double NitrideThickness = 0.1;
  double StepLength = 0.1;
  int ProfileSegments = 6;
  double LinePitch = 0.4;
  double LineWidth = 0.16;
  double LineThickness = 0.2;
  double InsulatorThickness = 0.15;
  double SidewallAngle = 5.0;
  int NumberOfWordLines = 8;
  int NumberOfBitLines = 2;
  double BarrierThickness = 0.03;
  double BarrierAsymmetry = 0.0;
  double GasHeight = 0.4;
  double TrenchWidth = 0.5;
  double TrenchDepth = 0.3;
  double DiffusionLength = 0.3;
  double ContactWidth = 0.12;
  double PassivationThickness = 0.0;

  double RotationAngle = 0.0;
  double RotationAxis[3] = { 0.0, 0.0, 1.0 };

private:
  /** Empty, or what is wrong with the parameters. */
  std::string MakeDevice(cdm::Device& device);

  vtkTechnologyStructureSource(const vtkTechnologyStructureSource&) = delete;
  void operator=(const vtkTechnologyStructureSource&) = delete;
};

#endif
