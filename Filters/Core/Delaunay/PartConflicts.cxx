// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Delaunay/PartConflicts.h"

#include "Core/Basics/SortedIds.h"
#include "Core/Delaunay/FacetForm.h"
#include "Core/Geometry/Predicates.h"
#include "Core/Geometry/PulledSphere.h"
#include "Core/Geometry/SphereForm.h"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace cdm
{
namespace
{
/** Calls a function with the form that tests boxes for the query. */
template <typename Function>
auto CallWithForm(const ConflictQuery& query, const Function& function)
{
  const auto& v = query.Vertices;
  return query.IsFacet != 0 ? function(FacetForm(v[0], v[1], v[2], v[3]))
                            : function(SphereForm(v[0], v[1], v[2], v[3]));
}

double GetSquaredDistance(const Box& box, const Vec3& p)
{
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double d = std::max({ box.Low[axis] - p[axis], p[axis] - box.High[axis], 0.0 });
    sum += d * d;
  }
  return sum;
}

/** Points of an octree in conflict with a query, up to a number of them, nearest to its center. */
template <typename Form>
class ConflictSearch
{
public:
  ConflictSearch(
    const ConflictQuery& query, const Form& form, const PartPoints& points, std::size_t limit)
    : Query(query), Center(query.Vertices[static_cast<std::size_t>(query.Center)]), Shape(form),
      Points(points), Limit(limit)
  {
  }

  double Order(const Box& box) const
  {
    const double distance = GetSquaredDistance(box, this->Center);
    return (this->Found.size() == this->Limit && distance >= this->Found.back().first) ||
        !this->Shape.MayTouch(box.Low, box.High)
      ? Infinity
      : distance;
  }

  void Visit(Id point, const Vec3& position)
  {
    ++this->NumberOfTests;
    const std::pair<double, Id> found{ SquaredNorm(position - this->Center), point };
    if (this->Found.size() == this->Limit && !(found < this->Found.back()))
    {
      return;
    }
    // In twice the working precision, which tells nearly always and is much faster than exactly.
    const int side = this->Shape.GetSide(position);
    if (side < 0 || (side == 0 && !IsInConflict(this->Query, this->Points[point])))
    {
      return;
    }
    if (this->Found.size() == this->Limit)
    {
      this->Found.pop_back();
    }
    this->Found.insert(std::upper_bound(this->Found.begin(), this->Found.end(), found), found);
  }

  std::size_t GetNumberOfTests() const { return this->NumberOfTests; }
  std::vector<Id> GetFound() const
  {
    std::vector<Id> points(this->Found.size());
    std::transform(this->Found.begin(), this->Found.end(), points.begin(),
      [](const std::pair<double, Id>& found) { return found.second; });
    return points;
  }

private:
  const ConflictQuery& Query;
  const Vec3 Center;
  const Form& Shape;
  const PartPoints& Points;
  const std::size_t Limit;
  std::size_t NumberOfTests = 0;
  /** Squared distance and point, ascending. */
  std::vector<std::pair<double, Id>> Found;
};

} // namespace

bool IsInConflict(const ConflictQuery& query, const NumberedPoint& point)
{
  std::array<Vec3, 4> v = query.Vertices;
  std::array<std::int64_t, 4> numbers = query.Numbers;
  if (query.IsFacet != 0)
  {
    const int side = Orientation(v[0], v[1], v[2], point.Position);
    if (side != 0)
    {
      return side > 0;
    }
    std::swap(v[1], v[2]);
    std::swap(numbers[1], numbers[2]);
  }
  if (Contains(numbers, point.Number))
  {
    return false;
  }
  const int position = InSphere(v[0], v[1], v[2], v[3], point.Position);
  if (position != 0)
  {
    return position > 0;
  }
  // Only the order of the numbers counts.
  const auto getRank = [&](std::int64_t number)
  {
    return static_cast<Id>(std::count_if(numbers.begin(), numbers.end(),
             [number](std::int64_t other) { return other < number; })) +
      (point.Number < number ? 1 : 0);
  };
  return GetPulledPosition(v,
           { getRank(numbers[0]), getRank(numbers[1]), getRank(numbers[2]), getRank(numbers[3]) },
           point.Position, getRank(point.Number), Orientation) > 0;
}

std::vector<std::size_t> FindPartsInConflict(
  const ConflictQuery& query, const std::vector<PartPoints::OtherPart>& others)
{
  return CallWithForm(query,
    [&](const auto& form)
    {
      std::vector<std::size_t> parts;
      for (const PartPoints::OtherPart& other : others)
      {
        if (form.MayTouch(other.Bounds.Low, other.Bounds.High))
        {
          parts.push_back(other.Part);
        }
      }
      return parts;
    });
}

std::vector<Id> FindOwnConflicts(const ConflictQuery& query, const PartPoints& points,
  std::size_t limit, std::size_t& numberOfTests)
{
  return CallWithForm(query,
    [&](const auto& form)
    {
      ConflictSearch<std::decay_t<decltype(form)>> search(query, form, points, limit);
      points.GetOctree().Visit(search);
      numberOfTests += search.GetNumberOfTests();
      return search.GetFound();
    });
}
} // namespace cdm
