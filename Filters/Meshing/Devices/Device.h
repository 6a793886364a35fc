// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Device.h
 * @brief The sample devices of vtkTechnologyStructureSource, one source file for each, and what
 * they share.
 *
 * Each function checks its parameters and makes a device; it returns an empty string, or what is
 * wrong with them. Lengths are in micrometres; what they mean is said in
 * vtkTechnologyStructureSource.h.
 */
#ifndef cdmDevice_h
#define cdmDevice_h

#include "Core/Meshes/PolygonSoup.h"

#include <functional>
#include <string>
#include <vector>

namespace cdm
{
/** A terminal: those polygons between two regions of which all vertices are at a place. */
struct Contact
{
  std::string Name;
  RegionPair Labels;
  std::function<bool(const Vec3&)> IsAt;
};

/** The polygons of a device, and what is known of them. */
struct Device
{
  PolygonSoup Boundary;
  std::vector<Id> FacetIds;
  std::vector<std::string> RegionNames;
  std::vector<Contact> Contacts;

  /** For each polygon the index of its contact, or NoId. */
  std::vector<Id> FindContactIds() const;
};

struct Parameter
{
  const char* Name;
  double Value;
};

/** Empty, or which of these lengths are not in the range from 1e-9 to 1e9. */
std::string CheckLengths(const std::vector<Parameter>& lengths);

/** Empty, or that the positions do not ascend and which parameters make them. */
std::string CheckAscending(const std::vector<double>& positions, const char* parameters);

/** Empty, or that the first one is not below the second one. */
std::string CheckLess(const Parameter& small, const Parameter& large);

/**
 * Sorts the positions and drops repeated ones. Empty, or that two of them differ by no more than
 * rounding and which parameters make them.
 */
std::string SortLines(std::vector<double>& positions, const char* parameters);

struct CosineSine
{
  double Cosine;
  double Sine;
};

/** Exact for multiples of 90 degrees. */
CosineSine GetCosineSine(double degrees);

/**
 * A smooth step: from 0 at place 0 to 1 at place 1, with slope 0 at both ends, constant beyond
 * them.
 */
double GetSmoothStep(double place);

struct MosParameters
{
  double GateLength, GateHeight, GateOxideThickness, SpacerWidth;
  double BulkLength, BulkDepth, DeviceWidth;
  int SpacerSegments;
};

struct NmosParameters
{
  double GateLength, GateHeight, GateOxideThickness, BulkLength, BulkDepth, DeviceWidth;
  double ChannelWidth, FieldOxideThickness, CoverOxideThickness;
};

struct ViaPlugParameters
{
  double ViaDiameter, ViaHeight, BottomLineWidth, BottomLineThickness;
  double TopLineWidth, TopLineThickness, BoxSize;
  int NumberOfSegments;
};

struct LocosParameters
{
  double BulkLength, BulkDepth, DeviceWidth, FieldOxideThickness, PadOxideThickness;
  double NitrideThickness, StepLength;
  int ProfileSegments;
};

struct DramParameters
{
  double LinePitch, LineWidth, LineThickness, InsulatorThickness, SidewallAngle;
  int NumberOfWordLines, NumberOfBitLines;
};

struct TwoLayerParameters
{
  double LinePitch, LineWidth, LineThickness, InsulatorThickness, BulkDepth, StepLength;
  int ProfileSegments;
};

/** With a trench above the via it is a damascene structure. */
struct LinedViaParameters
{
  double ViaDiameter, ViaHeight, BottomLineThickness, BarrierThickness, BarrierAsymmetry;
  double GasHeight, BoxSize, TrenchWidth, TrenchDepth;
  int NumberOfSegments;
  bool HasTrench;
};

struct CmosParameters
{
  double GateLength, GateHeight, GateOxideThickness, SpacerWidth, BulkDepth, ChannelWidth;
  double DiffusionLength, ContactWidth, TrenchWidth, TrenchDepth;
  double InsulatorThickness, LineThickness, PassivationThickness;
  int SpacerSegments;
};

std::string MakeMosTransistor(const MosParameters& parameters, Device& device);
std::string MakeNmosTransistor(const NmosParameters& parameters, Device& device);
std::string MakeViaPlug(const ViaPlugParameters& parameters, Device& device);
std::string MakeLocos(const LocosParameters& parameters, Device& device);
std::string MakeDramInterconnect(const DramParameters& parameters, Device& device);
std::string MakeTwoLayerInterconnect(const TwoLayerParameters& parameters, Device& device);
std::string MakeLinedVia(const LinedViaParameters& parameters, Device& device);
std::string MakeCmosInverter(const CmosParameters& parameters, Device& device);
} // namespace cdm

#endif
