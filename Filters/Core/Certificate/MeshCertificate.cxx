// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Certificate/MeshCertificate.h"

#include "Core/Certificate/BasicChecks.h"
#include "Core/Certificate/FullCriteria.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace cdm
{
namespace
{
std::string Format(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/** "3 names", "1 name". */
std::string Count(Id count, const char* singular, const char* plural)
{
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

/** "3 of 40 (7.5 %)"; the share only where there is something. */
std::string FormatShare(Id count, Id all)
{
  std::string text = std::to_string(count) + " of " + std::to_string(all);
  if (count > 0)
  {
    text += " (" + Format("%.2g", 100.0 * count / all) + " %)";
  }
  return text;
}

/** What there is, with commas between. */
class List
{
public:
  void Add(Id count, const char* singular, const char* plural)
  {
    if (count != 0)
    {
      this->Add(Count(count, singular, plural));
    }
  }
  void Add(const std::string& item) { this->Text += (this->Text.empty() ? "" : ", ") + item; }
  std::string Text;
};

/** "3 under 5 (2 at sharp angles, 1 across layers)". */
std::string FormatFlatter(const FlatterTetrahedra& flatter, const char* bound)
{
  List reasons;
  reasons.Add(flatter.AtSharpAngles, "at sharp angles", "at sharp angles");
  reasons.Add(flatter.AcrossLayers, "across layers", "across layers");
  reasons.Add(flatter.GetOthers(), "elsewhere", "elsewhere");
  return std::to_string(flatter.Count) + " under " + bound +
    (flatter.Count > 0 ? " (" + reasons.Text + ")" : "");
}

std::string ListFaults(const MeshCertificate& c, double volumeTolerance)
{
  List list;
  list.Add(
    c.GetCount(MeshFault::InvertedTetrahedron), "inverted tetrahedron", "inverted tetrahedra");
  list.Add(c.GetCount(MeshFault::FlatTetrahedron), "flat tetrahedron", "flat tetrahedra");
  list.Add(c.GetCount(MeshFault::OverfullFacet), "overfull facet", "overfull facets");
  list.Add(c.WrongNeighbors, "wrong neighbour", "wrong neighbours");
  list.Add(c.CoincidentPoints, "coincident point", "coincident points");
  list.Add(c.UnboundFacets + c.MissingBoundaryTriangles, "boundary fault", "boundary faults");
  if (!(c.LargestVolumeError <= volumeTolerance))
  {
    list.Add("volume error " + Format("%.1g", c.LargestVolumeError));
  }
  return list.Text;
}

/** Where the smallest spheres of the boundary are not empty (Crit. 3.1); empty if all are. */
std::string ListFilledSpheres(const MeshCertificate& c)
{
  const Id filled = c.GetCount(MeshFault::FacetSphere);
  if (filled == 0)
  {
    return {};
  }
  std::string places;
  for (const InterfaceSpheres& spheres : c.Interfaces)
  {
    if (spheres.Violations != 0)
    {
      const std::string back = std::to_string(spheres.Regions.Back);
      places += (places.empty() ? ": " : ", ") + std::to_string(spheres.Violations) + " of " +
        std::to_string(spheres.Facets) +
        (spheres.Regions.Front == OutsideRegion
            ? " outside of region " + back
            : " between regions " + std::to_string(spheres.Regions.Front) + " and " + back);
    }
  }
  return std::to_string(filled) + " of " + std::to_string(c.BorderFacets) +
    " boundary triangles have a point in their smallest sphere" + places + ".";
}

/** What solvers have to know that add up boxes without signs; empty if it makes no difference. */
std::string DescribeUnsignedBoxes(const MeshCertificate& c)
{
  const auto worst = std::max_element(c.Regions.begin(), c.Regions.end(),
    [](const RegionVolume& a, const RegionVolume& b)
    { return a.UnsignedBoxRatio < b.UnsignedBoxRatio; });
  if (worst == c.Regions.end() || worst->UnsignedBoxRatio < 1.005)
  {
    return {};
  }
  return " A solver that computes boxes by itself, without the signs of their parts, makes them " +
    Format("%.2f", worst->UnsignedBoxRatio) + " times as large in region " +
    std::to_string(worst->Region) + ": give it the signed couplings and boxes.";
}

std::string GetNumbers(const MeshCertificate& c)
{
  std::string text = Count(c.Tetrahedra, "tetrahedron, ", "tetrahedra, ") +
    Count(c.Points, "point, ", "points, ") +
    Count(static_cast<Id>(c.Regions.size()), "region", "regions") + "; boundary: smallest sphere " +
    "filled at " + FormatShare(c.GetCount(MeshFault::FacetSphere), c.BorderFacets) +
    " triangles and " + FormatShare(c.GetCount(MeshFault::EdgeSphere), c.StructuralEdges) +
    " structural edges";
  if (c.Level == CertificateLevel::Full)
  {
    text += "; negative couplings " +
      FormatShare(c.GetCount(MeshFault::NegativeCoupling), c.Couplings) +
      "; open control volumes " + std::to_string(c.GetCount(MeshFault::OpenControlVolume)) +
      "; non-Delaunay facets " + FormatShare(c.GetCount(MeshFault::NonDelaunayFacet), c.Facets) +
      "; negative cotangent sums " +
      FormatShare(c.GetCount(MeshFault::NegativeCotangentSum), c.Edges);
  }
  if (c.Tetrahedra != 0)
  {
    text += "; dihedral angles " + Format("%.2f", c.SmallestDihedralAngle) + " to " +
      Format("%.2f", c.LargestDihedralAngle) + " degrees, tetrahedra " +
      FormatFlatter(c.Under5Degrees, "5") + " and " + FormatFlatter(c.Under15Degrees, "15");
  }
  if (c.HasBoundary || c.Level == CertificateLevel::Full)
  {
    text += "; volume error " + Format("%.1g", c.LargestVolumeError);
  }
  return text;
}
} // namespace

double RegionVolume::GetRelativeError() const
{
  const double difference = std::abs(this->Volume - this->EnclosedVolume);
  return difference == 0.0        ? 0.0
    : this->EnclosedVolume == 0.0 ? Infinity
                                  : difference / std::abs(this->EnclosedVolume);
}

MeshVerdict MeshCertificate::GetVerdict(double volumeTolerance) const
{
  if (!ListFaults(*this, volumeTolerance).empty())
  {
    return MeshVerdict::Invalid;
  }
  if (this->GetCount(MeshFault::NonDelaunayTetrahedron) != 0 ||
    this->GetCount(MeshFault::NonDelaunayFacet) != 0)
  {
    return MeshVerdict::NotDelaunay;
  }
  return this->Level == CertificateLevel::Full && this->GetCount(MeshFault::NegativeCoupling) == 0
    ? MeshVerdict::CleanForFiniteVolumes
    : MeshVerdict::Delaunay;
}

bool MeshCertificate::IsDelaunay(double volumeTolerance) const
{
  return this->GetVerdict(volumeTolerance) >= MeshVerdict::Delaunay;
}

bool MeshCertificate::IsClean(double volumeTolerance) const
{
  return this->GetVerdict(volumeTolerance) == MeshVerdict::CleanForFiniteVolumes;
}

const char* MeshCertificate::GetVerdictName() const
{
  static const char* const names[] = { "INVALID", "NOT DELAUNAY", "DELAUNAY",
    "CLEAN FOR FINITE VOLUMES" };
  return names[static_cast<int>(this->GetVerdict())];
}

std::string MeshCertificate::DescribeFlatTetrahedra() const
{
  const FlatterTetrahedra& all = this->Under15Degrees;
  const FlatterTetrahedra& flattest = this->Under5Degrees;
  if (all.Count == 0)
  {
    return {};
  }
  List reasons;
  const auto add = [&](Id count, Id flattestCount, const char* reason)
  {
    if (count != 0)
    {
      reasons.Add(std::to_string(count) +
        (flattestCount != 0 ? " (" + std::to_string(flattestCount) + " below 5) " : " ") + reason);
    }
  };
  add(all.AtSharpAngles, flattest.AtSharpAngles, "at sharp angles of the input");
  add(all.AcrossLayers, flattest.AcrossLayers,
    "across layers one tetrahedron thick, with all points on boundaries");
  add(all.GetOthers(), flattest.GetOthers(), "elsewhere");
  return Count(all.Count, "tetrahedron has", "tetrahedra have") +
    " a dihedral angle below 15 degrees, " + std::to_string(flattest.Count) +
    " below 5 degrees: " + reasons.Text + ".";
}

std::string MeshCertificate::GetReasons() const
{
  switch (this->GetVerdict())
  {
    case MeshVerdict::Invalid:
    {
      const Id filled = this->GetCount(MeshFault::NonDelaunayTetrahedron);
      return ListFaults(*this, VolumeTolerance) +
        (filled == 0 ? "."
                     : "; " +
              Count(filled, "tetrahedron has a point in its circumsphere.",
                "tetrahedra have a point in their circumsphere."));
    }
    case MeshVerdict::NotDelaunay:
      return FormatShare(this->GetCount(MeshFault::NonDelaunayTetrahedron), this->Tetrahedra) +
        " tetrahedra have a point in their circumsphere.";
    default:
      break;
  }
  const std::string spheres = ListFilledSpheres(*this);
  const std::string rest =
    (spheres.empty() ? spheres : " " + spheres) + DescribeUnsignedBoxes(*this);
  if (this->Tetrahedra == 0)
  {
    return "The mesh is empty.";
  }
  if (this->Level == CertificateLevel::Basic)
  {
    return "Valid, all circumspheres are empty; the couplings of the box method were not looked "
           "at." +
      rest;
  }
  const Id negative = this->GetCount(MeshFault::NegativeCoupling);
  return negative == 0
    ? "Valid, all circumspheres are empty, no coupling of the box method is negative." + rest
    : FormatShare(negative, this->Couplings) + " couplings of the box method are negative." + rest;
}

std::string MeshCertificate::GetText() const
{
  const bool isTiny = this->GetVerdict() != MeshVerdict::Invalid &&
    this->Level == CertificateLevel::Full && this->SmallestVolumeRatio < TinyVolumeRatio;
  return std::string(this->GetVerdictName()) +
    (isTiny ? ", but the smallest tetrahedron has " + Format("%.1g", this->SmallestVolumeRatio) +
          " of the median volume"
            : "") +
    "\n" + this->GetReasons() + "\n" + GetNumbers(*this) +
    (this->Settings.empty() ? "" : "\n" + this->Settings);
}

Status CertifyMesh(const TetMesh& mesh, const TriangleMesh* boundary,
  const ExecutionContext& context, MeshCertificate& certificate, const CertificateOptions& options)
{
  return RunGuarded(
    [&]() -> Status
    {
      certificate = {};
      certificate.Level = options.Level;
      Status status = CheckMeshInput(mesh, boundary);
      if (!status.IsOk())
      {
        return status;
      }
      if (!mesh.Neighbors.empty() && mesh.Neighbors.size() != mesh.Tetrahedra.size())
      {
        return Status::InvalidInput("The mesh needs four neighbours for each tetrahedron, or none: "
                                    "BuildNeighbors() makes them.");
      }
      const bool isFull = options.Level == CertificateLevel::Full;
      const double share = isFull ? 0.6 : 1.0;
      const SphereCriteria criteria(mesh.Points, context.GetNumberOfThreads());
      BasicFindings findings;
      return CheckBasics(
        mesh, boundary, criteria, options, context.Part(0.0, share), certificate, findings)
        .Then(
          [&]
          {
            return isFull ? EvaluateFullCriteria(mesh, boundary, criteria, findings, options,
                              context.Part(share, 1.0), certificate)
                          : Status();
          });
    });
}
} // namespace cdm
