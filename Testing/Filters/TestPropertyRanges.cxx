// SPDX-License-Identifier: BSD-3-Clause
/**
 * Every property with a range, as found in the headers of all filters: what is out of it is an error
 * and changes nothing, both ends are allowed.
 */
#include "FilterTesting.h"

#include "Includes.h"

#include <cmath>
#include <type_traits>

using namespace testing_filters;

namespace
{
template <class T>
bool IsEndless(T largest)
{
  return largest == (std::is_same<T, int>::value ? T(VTK_INT_MAX) : T(VTK_DOUBLE_MAX));
}

/** Values below, above and beside the range, as far as the type has such. */
template <class T>
std::vector<T> GetValuesOutside(T smallest, T largest)
{
  std::vector<T> values{ smallest - 1 };
  if (!IsEndless(largest))
  {
    values.push_back(largest + 1);
  }
  if constexpr (std::is_same<T, double>::value)
  {
    const double infinity = std::numeric_limits<double>::infinity();
    values.insert(values.end(),
      { std::nextafter(smallest, -infinity), std::nextafter(largest, infinity), -infinity, infinity,
        std::numeric_limits<double>::quiet_NaN() });
  }
  return values;
}

template <class T>
std::string ToText(T value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

template <class Filter, class T>
void CheckRange(const char* name, void (Filter::*set)(T), T (Filter::*get)(),
  T (Filter::*getSmallest)(), T (Filter::*getLargest)())
{
  SCOPED_TRACE(name);
  vtkNew<Filter> filter;
  vtkNew<EventRecorder> recorder;
  recorder->Watch(filter);
  const T smallest = (filter->*getSmallest)();
  const T largest = (filter->*getLargest)();
  ASSERT_LT(smallest, largest);
  EXPECT_TRUE((filter->*get)() >= smallest && (filter->*get)() <= largest) << "the default";
  for (const T start : { smallest, largest })
  {
    (filter->*set)(start);
    ASSERT_EQ((filter->*get)(), start);
    ASSERT_EQ(recorder->Errors, "");
    for (const T value : GetValuesOutside(smallest, largest))
    {
      const vtkMTimeType time = filter->GetMTime();
      (filter->*set)(value);
      EXPECT_EQ((filter->*get)(), start) << value;
      EXPECT_EQ(filter->GetMTime(), time) << value;
      EXPECT_TRUE(Contains(recorder->Errors, std::string(name) + " cannot be ")) << value;
      EXPECT_TRUE(Contains(recorder->Errors, "It stays ")) << recorder->Errors;
      if (!IsEndless(largest))
      {
        EXPECT_TRUE(
          Contains(recorder->Errors, "from " + ToText(smallest) + " to " + ToText(largest) + " ("))
          << recorder->Errors;
      }
      recorder->Errors.clear();
    }
  }
}
} // namespace

TEST(PropertyRanges, EveryRangeIsKept)
{
  int count = 0;
#define RANGED(Filter, Name, Type)                                                                 \
  {                                                                                                \
    SCOPED_TRACE(#Filter);                                                                         \
    CheckRange<Filter, Type>(#Name, &Filter::Set##Name, &Filter::Get##Name,                        \
      &Filter::Get##Name##MinValue, &Filter::Get##Name##MaxValue);                                 \
    ++count;                                                                                       \
  }
#include "Properties.h"
#undef RANGED
  EXPECT_GT(count, 60) << "the list made from the headers is not complete";
}

TEST(PropertyRanges, ErrorsNamePropertyValueRangeAndUnit)
{
  vtkNew<EventRecorder> recorder;
  const auto expectError = [&recorder](const char* text)
  { EXPECT_TRUE(Contains(recorder->Errors, text)) << recorder->Errors; };
  vtkNew<vtkConformingDelaunayMesher> mesher;
  recorder->Watch(mesher);
  mesher->SetMinimumAngle(12.5);
  mesher->SetMinimumAngle(45.0);
  expectError("MinimumAngle cannot be 45: give a number from 0 to 30 (degrees). It stays 12.5.");
  mesher->SetMaximumArea(-5.0);
  expectError(
    "MaximumArea cannot be -5: give a finite number from 0 on (square model units). It stays 0.");
  mesher->SetCriterion(3);
  expectError("Criterion cannot be 3: give a whole number from -1 to 2 (one of Criteria; -1: "
              "automatic). It stays -1.");
  mesher->SetMaximumGapEdges(-1);
  expectError(
    "MaximumGapEdges cannot be -1: give a whole number from 0 on (open edges). It stays 0.");
  vtkNew<vtkGmshMeshWriter> writer;
  recorder->Watch(writer);
  writer->SetScale(0.0);
  expectError(
    "Scale cannot be 0: give a finite number above 0 (factor of the coordinates). It stays 1.");
}
