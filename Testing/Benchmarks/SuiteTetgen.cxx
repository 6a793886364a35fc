// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SuiteTetgen.cxx
 * @brief TetGen on a file of polygons, measured as SuiteMesher measures ours, for Suite.py.
 *
 *     SuiteTetgen SWITCHES INPUT.smesh OUTPUT
 *
 * Prints one line of "name value" pairs: seconds (processor time without reading and writing),
 * megabytes (the peak until then), start (megabytes before it), points and tetrahedra. The mesh
 * goes to OUTPUT.node and OUTPUT.ele.
 * Exit status: 0 meshed, 1 refused, 2 wrong use or a file that cannot be read or written.
 */
#include "Measurement.h"
#include "TetgenFiles.h"

#include <tetgen.h>

#include <cstdio>
#include <ctime>
#include <string>

int main(int argc, char* argv[])
{
  if (argc != 4)
  {
    std::fprintf(stderr, "usage: SuiteTetgen SWITCHES INPUT.smesh OUTPUT\n");
    return 2;
  }
  tetgenbehavior behavior;
  tetgenio in;
  tetgenio out;
  // It adds the extension by itself.
  std::string input = argv[2];
  input.erase(input.rfind('.'));
  std::string switches = argv[1];
  if (!behavior.parse_commandline(&switches[0]) ||
    !in.load_plc(&input[0], static_cast<int>(tetgenbehavior::POLY)))
  {
    return 2;
  }
  const double before = GetMegabytes("VmHWM");
  const std::clock_t start = std::clock();
  try
  {
    tetrahedralize(&behavior, &in, &out);
  }
  catch (int reason)
  {
    std::fprintf(stderr, "TetGen: error %d\n", reason);
    return 1;
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("seconds %g megabytes %g start %g points %d tetrahedra %d\n", seconds,
    GetMegabytes("VmHWM"), before, out.numberofpoints, out.numberoftetrahedra);

  TetgenMesh mesh;
  for (int i = 0; i < out.numberofpoints; ++i)
  {
    const REAL* p = out.pointlist + 3 * i;
    mesh.Points.push_back({ p[0], p[1], p[2] });
  }
  for (int i = 0; i < out.numberoftetrahedra; ++i)
  {
    const int* t = out.tetrahedronlist + out.numberofcorners * i;
    mesh.Tetrahedra.push_back(
      { std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2]), std::size_t(t[3]) });
    if (out.numberoftetrahedronattributes > 0)
    {
      mesh.Marks.push_back(out.tetrahedronattributelist[out.numberoftetrahedronattributes * i]);
    }
  }
  WriteTetgenFiles(mesh, argv[3]);
  return 0;
}
