// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Basics/Status.h"
#include "Core/CInterface/cdmEngine.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace
{
using Arrays = std::unique_ptr<cdmArrays, decltype(&cdmDeleteArrays)>;

Arrays MakeArrays()
{
  return { cdmNewArrays(), cdmDeleteArrays };
}

void Set(const Arrays& arrays, const char* name, const std::vector<double>& values)
{
  EXPECT_EQ(cdmSetReals(arrays.get(), name, values.data(), static_cast<int64_t>(values.size())), 0);
}

void Set(const Arrays& arrays, const char* name, const std::vector<int64_t>& values)
{
  EXPECT_EQ(
    cdmSetIntegers(arrays.get(), name, values.data(), static_cast<int64_t>(values.size())), 0);
}

/** A tetrahedron as four triangles. */
Arrays MakeInput()
{
  Arrays input = MakeArrays();
  Set(input, "points",
    std::vector<double>{ 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 });
  Set(input, "polygon_connectivity", std::vector<int64_t>{ 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3 });
  Set(input, "polygon_offsets", std::vector<int64_t>{ 0, 3, 6, 9, 12 });
  Set(input, "mesh_for", std::vector<int64_t>{ 2 });
  return input;
}

std::string GetText(const Arrays& arrays, const char* name)
{
  int type = -1;
  int64_t count = 0;
  int components = 0;
  const void* values = cdmGetValues(arrays.get(), name, &type, &count, &components);
  return values && type == cdmText
    ? std::string(static_cast<const char*>(values), static_cast<std::size_t>(count))
    : std::string("no text");
}

int RunStage(const char* stage, const Arrays& input, const Arrays& output)
{
  return cdmRun(stage, input.get(), output.get(), nullptr);
}
} // namespace

TEST(CInterface, MeshesPolygons)
{
  const Arrays input = MakeInput();
  const Arrays output = MakeArrays();
  ASSERT_EQ(RunStage("mesh_polygons", input, output), 0) << GetText(output, "error");
  int type = -1;
  int64_t count = 0;
  int components = 0;
  const void* values = cdmGetValues(output.get(), "tetrahedra", &type, &count, &components);
  ASSERT_NE(values, nullptr);
  EXPECT_EQ(type, cdmInt32);
  EXPECT_EQ(count, 1);
  EXPECT_EQ(components, 4);
  values = cdmGetValues(output.get(), "points", &type, &count, &components);
  ASSERT_NE(values, nullptr);
  EXPECT_EQ(type, cdmReal64);
  EXPECT_EQ(count, 4);
  EXPECT_EQ(components, 3);
  EXPECT_EQ(GetText(output, "verdict"), "DELAUNAY");
  EXPECT_EQ(cdmGetValues(output.get(), "nothing", &type, &count, &components), nullptr);
  const int64_t number = cdmGetNumberOfArrays(output.get());
  EXPECT_GT(number, 10);
  EXPECT_STREQ(cdmGetName(output.get(), 0), "add_steiner_points");
  EXPECT_EQ(cdmGetName(output.get(), number), nullptr);
}

TEST(CInterface, RefusesWhatItDoesNotKnow)
{
  const auto expect = [](const char* stage, const Arrays& input, const char* text)
  {
    const Arrays output = MakeArrays();
    EXPECT_EQ(RunStage(stage, input, output), static_cast<int>(cdm::StatusCode::InvalidOption));
    EXPECT_NE(GetText(output, "error").find(text), std::string::npos) << GetText(output, "error");
    EXPECT_EQ(cdmGetNumberOfArrays(output.get()) > 3, GetText(output, "warnings") != "no text");
  };
  expect("mesh_everything", MakeInput(), "no stage mesh_everything");
  Arrays input = MakeInput();
  Set(input, "colour", std::vector<double>{ 1.0 });
  expect("mesh_polygons", input, "no option colour");
  input = MakeInput();
  Set(input, "criterion", std::vector<int64_t>{ 3 });
  expect("mesh_polygons", input, "criterion is 3");
  input = MakeInput();
  Set(input, "criterion", std::vector<double>{ 1.0 });
  expect("mesh_polygons", input, "a whole number");
  input = MakeInput();
  Set(input, "polygon_connectivity", std::vector<int64_t>{ 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 4 });
  expect("mesh_polygons", input, "the id 4 at 11");
  input = MakeInput();
  Set(input, "polygon_offsets", std::vector<int64_t>{ 0, 3, 6, 9 });
  expect("mesh_polygons", input, "polygon_offsets");
  input = MakeInput();
  Set(input, "labels", std::vector<int64_t>{ -1, 0 });
  expect("mesh_polygons", input, "labels has 1 rows");
  input = MakeInput();
  Set(input, "labels", std::vector<int64_t>{ -1, 0, 1 });
  expect("mesh_polygons", input, "rows of 2");
}

/** Without any option: what finite volumes ask for; and what was used comes back. */
TEST(CInterface, OptionsThatAreNotGivenAreAsThePurposeAsks)
{
  const auto getReal = [](const Arrays& output, const char* name)
  {
    int type = -1;
    int64_t count = 0;
    int components = 0;
    const void* values = cdmGetValues(output.get(), name, &type, &count, &components);
    return values && type == cdmReal64 && count == 1 ? *static_cast<const double*>(values) : -1.0;
  };
  const Arrays input = MakeInput();
  Set(input, "mesh_for", std::vector<int64_t>{ 0 });
  Arrays output = MakeArrays();
  ASSERT_EQ(RunStage("mesh_polygons", input, output), 0) << GetText(output, "error");
  EXPECT_EQ(GetText(output, "verdict"), "CLEAN FOR FINITE VOLUMES");
  EXPECT_NE(GetText(output, "settings").find("Mesh for finite volumes: ["), std::string::npos);
  const double size = getReal(output, "maximum_edge_length");
  EXPECT_GT(size, 0.0);
  EXPECT_LT(size, 0.1);
  Set(input, "maximum_edge_length", std::vector<double>{ 0.5 });
  output = MakeArrays();
  ASSERT_EQ(RunStage("mesh_polygons", input, output), 0) << GetText(output, "error");
  EXPECT_EQ(getReal(output, "maximum_edge_length"), 0.5);
  Set(input, "mesh_for", std::vector<int64_t>{ 3 });
  output = MakeArrays();
  EXPECT_NE(RunStage("mesh_polygons", input, output), 0);
  EXPECT_NE(GetText(output, "error").find("mesh_for is 3"), std::string::npos);
}

TEST(CInterface, AbortsAndAsksForSizes)
{
  const Arrays input = MakeInput();
  Set(input, "add_steiner_points", std::vector<int64_t>{ 1 });
  cdmCallbacks callbacks = { nullptr, nullptr, nullptr, 1 };
  double size = 0.2;
  callbacks.Data = &size;
  callbacks.Sizing = [](const double*, void* data) { return *static_cast<double*>(data); };
  Arrays output = MakeArrays();
  EXPECT_EQ(cdmRun("mesh_polygons", input.get(), output.get(), &callbacks), 0);
  int type = -1;
  int64_t count = 0;
  int components = 0;
  ASSERT_NE(cdmGetValues(output.get(), "tetrahedra", &type, &count, &components), nullptr);
  EXPECT_GT(count, 100);
  size = -1.0;
  output = MakeArrays();
  EXPECT_EQ(cdmRun("mesh_polygons", input.get(), output.get(), &callbacks),
    static_cast<int>(cdm::StatusCode::InvalidInput));
  EXPECT_NE(GetText(output, "error").find("not positive"), std::string::npos);
  callbacks.Sizing = nullptr;
  callbacks.Progress = [](double, const char*, void*) { return 1; };
  output = MakeArrays();
  EXPECT_EQ(cdmRun("mesh_polygons", input.get(), output.get(), &callbacks),
    static_cast<int>(cdm::StatusCode::Aborted));
}
