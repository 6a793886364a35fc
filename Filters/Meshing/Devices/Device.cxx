// SPDX-License-Identifier: BSD-3-Clause
#include "Device.h"

#include <vtkMath.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace cdm
{
namespace
{
std::ostream& operator<<(std::ostream& stream, const Parameter& parameter)
{
  return stream << parameter.Name << " = " << parameter.Value;
}

std::string MakeTooDifferent(const char* parameters)
{
  return std::string(parameters) +
    " are too different in size: positions made of them coincide in double precision.";
}
} // namespace

std::vector<Id> Device::FindContactIds() const
{
  std::vector<Id> ids;
  for (Id polygon = 0; polygon < this->Boundary.GetNumberOfPolygons(); ++polygon)
  {
    const Id* vertices = this->Boundary.GetPolygon(polygon);
    const auto found = std::find_if(this->Contacts.begin(), this->Contacts.end(),
      [&](const Contact& contact)
      {
        return contact.Labels == this->Boundary.Labels[polygon] &&
          std::all_of(vertices, vertices + this->Boundary.GetPolygonSize(polygon),
            [&](Id vertex) { return contact.IsAt(this->Boundary.Points[vertex]); });
      });
    ids.push_back(
      found == this->Contacts.end() ? NoId : static_cast<Id>(found - this->Contacts.begin()));
  }
  return ids;
}

std::string CheckLengths(const std::vector<Parameter>& lengths)
{
  for (const Parameter& length : lengths)
  {
    if (!(length.Value >= 1e-9 && length.Value <= 1e9))
    {
      std::ostringstream problem;
      problem << length << " has to be in the range from 1e-9 to 1e9 micrometres.";
      return problem.str();
    }
  }
  return {};
}

std::string CheckAscending(const std::vector<double>& positions, const char* parameters)
{
  for (std::size_t i = 1; i < positions.size(); ++i)
  {
    if (positions[i - 1] >= positions[i])
    {
      return MakeTooDifferent(parameters);
    }
  }
  return {};
}

std::string CheckLess(const Parameter& small, const Parameter& large)
{
  if (small.Value < large.Value)
  {
    return {};
  }
  std::ostringstream problem;
  problem << small << " has to be below " << large << ".";
  return problem.str();
}

std::string SortLines(std::vector<double>& positions, const char* parameters)
{
  std::sort(positions.begin(), positions.end());
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  // Sums of the same lengths in another order differ by some roundings.
  const double rounding = 1e-14 * std::max(std::abs(positions.front()), std::abs(positions.back()));
  for (std::size_t i = 1; i < positions.size(); ++i)
  {
    if (positions[i] - positions[i - 1] <= rounding)
    {
      return MakeTooDifferent(parameters);
    }
  }
  return {};
}

CosineSine GetCosineSine(double degrees)
{
  const double remainder = std::remainder(degrees, 360.0);
  const double angle = std::abs(remainder);
  // Reduce to the first octant, where nothing cancels.
  const double acute = angle > 90.0 ? 180.0 - angle : angle;
  double cosine = std::cos(vtkMath::RadiansFromDegrees(acute));
  double sine = std::sin(vtkMath::RadiansFromDegrees(acute));
  if (acute > 45.0)
  {
    cosine = std::sin(vtkMath::RadiansFromDegrees(90.0 - acute));
    sine = std::cos(vtkMath::RadiansFromDegrees(90.0 - acute));
  }
  return { angle > 90.0 ? -cosine : cosine, remainder < 0.0 ? -sine : sine };
}

double GetSmoothStep(double place)
{
  return 0.5 * (1.0 - GetCosineSine(180.0 * std::clamp(place, 0.0, 1.0)).Cosine);
}
} // namespace cdm
