// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Pipeline/MeshPurpose.h"

#include <cstdio>

namespace cdm
{
namespace
{
struct PurposeDefaults
{
  const char* Name;
  MeshSettings Settings;
  bool HasDefaultSize;
};

constexpr PurposeDefaults Purposes[NumberOfMeshPurposes] = {
  { "finite volumes", { SurfaceCriterion::SmallestSphere, true, true, 15.0, 1.4, 0.0, true },
    true },
  { "finite elements", { SurfaceCriterion::Delaunay, true, true, 20.0, 1.4, 0.0, true }, true },
  { "fewest points", { SurfaceCriterion::Delaunay, false, true, 15.0, 1.4, 0.0, false }, false },
};

const PurposeDefaults& GetDefaults(MeshPurpose purpose)
{
  return Purposes[static_cast<int>(purpose)];
}

std::string Format(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
} // namespace

MeshSettings MakeSettings(MeshPurpose purpose, const MeshOptionChoices& given)
{
  const MeshSettings& defaults = GetDefaults(purpose).Settings;
  MeshSettings settings;
  settings.Criterion = given.Criterion.value_or(defaults.Criterion);
  settings.AddsSteinerPoints = given.AddsSteinerPoints.value_or(defaults.AddsSteinerPoints);
  settings.RemovesSlivers = given.RemovesSlivers.value_or(defaults.RemovesSlivers);
  settings.DihedralAngleTarget = given.DihedralAngleTarget.value_or(defaults.DihedralAngleTarget);
  settings.RadiusEdgeRatio = given.RadiusEdgeRatio.value_or(defaults.RadiusEdgeRatio);
  settings.MaximumEdgeLength = given.MaximumEdgeLength.value_or(defaults.MaximumEdgeLength);
  settings.GeneratesMeshPoints =
    given.GeneratesMeshPoints.value_or(defaults.GeneratesMeshPoints && settings.AddsSteinerPoints);
  return settings;
}

bool NeedsDefaultSize(MeshPurpose purpose, const MeshOptionChoices& given, bool hasSizing)
{
  return GetDefaults(purpose).HasDefaultSize && !given.MaximumEdgeLength && !hasSizing;
}

const char* GetPurposeName(MeshPurpose purpose)
{
  return GetDefaults(purpose).Name;
}

std::string DescribeSettings(
  MeshPurpose purpose, const MeshOptionChoices& given, const MeshSettings& settings)
{
  std::string chosen;
  std::string automatic;
  const auto add = [&](bool isGiven, const std::string& item)
  {
    std::string& list = isGiven ? chosen : automatic;
    list += (list.empty() ? "" : ", ") + item;
  };
  static const char* const criteria[] = { "Delaunay", "smallest sphere",
    "smallest sphere and edges" };
  add(given.Criterion.has_value(),
    std::string("criterion ") + criteria[static_cast<int>(settings.Criterion)]);
  add(given.AddsSteinerPoints.has_value(),
    settings.AddsSteinerPoints ? "Steiner points" : "no Steiner points");
  add(
    given.RemovesSlivers.has_value(), settings.RemovesSlivers ? "no slivers" : "slivers are kept");
  if (settings.RemovesSlivers)
  {
    add(given.DihedralAngleTarget.has_value(),
      "dihedral angle target " + Format("%g", settings.DihedralAngleTarget));
  }
  if (settings.AddsSteinerPoints)
  {
    add(given.RadiusEdgeRatio.has_value(),
      "radius-edge ratio " + Format("%g", settings.RadiusEdgeRatio));
  }
  add(given.MaximumEdgeLength.has_value(),
    settings.MaximumEdgeLength > 0.0
      ? "maximum edge length " + Format("%.6g", settings.MaximumEdgeLength)
      : "no maximum edge length");
  add(given.GeneratesMeshPoints.has_value(),
    settings.GeneratesMeshPoints ? "mesh points" : "no mesh points");
  std::string text = std::string("Mesh for ") + GetPurposeName(purpose) + ": ";
  if (!automatic.empty())
  {
    text += "[" + automatic + "]";
  }
  return text + (automatic.empty() || chosen.empty() ? "" : ", ") + chosen;
}
} // namespace cdm
