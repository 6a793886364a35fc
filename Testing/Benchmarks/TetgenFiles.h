// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetgenFiles.h
 * @brief A mesh in the two files of TetGen, with coordinates that read back the same.
 *
 * TetGen itself writes 16 digits: points that lie on one sphere exactly do not after that.
 */
#ifndef TetgenFiles_h
#define TetgenFiles_h

#include "Core/Basics/Vec3.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

struct TetgenMesh
{
  std::vector<cdm::Vec3> Points;
  std::vector<std::array<std::size_t, 4>> Tetrahedra;
  /** One for each tetrahedron, or none: what tells regions apart. */
  std::vector<double> Marks;
};

/** Writes name.node and name.ele. Ends the program if they cannot be written. */
inline void WriteTetgenFiles(const TetgenMesh& mesh, const std::string& name)
{
  std::FILE* nodes = std::fopen((name + ".node").c_str(), "w");
  std::FILE* elements = std::fopen((name + ".ele").c_str(), "w");
  if (nodes && elements)
  {
    std::fprintf(nodes, "%zu 3 0 0\n", mesh.Points.size());
    for (std::size_t i = 0; i < mesh.Points.size(); ++i)
    {
      const cdm::Vec3& p = mesh.Points[i];
      std::fprintf(nodes, "%zu %.17g %.17g %.17g\n", i, p.X, p.Y, p.Z);
    }
    std::fprintf(elements, "%zu 4 %d\n", mesh.Tetrahedra.size(), mesh.Marks.empty() ? 0 : 1);
    for (std::size_t i = 0; i < mesh.Tetrahedra.size(); ++i)
    {
      const std::array<std::size_t, 4>& t = mesh.Tetrahedra[i];
      std::fprintf(elements, "%zu %zu %zu %zu %zu", i, t[0], t[1], t[2], t[3]);
      if (!mesh.Marks.empty())
      {
        std::fprintf(elements, " %g", mesh.Marks[i]);
      }
      std::fprintf(elements, "\n");
    }
  }
  for (std::FILE* file : { nodes, elements })
  {
    if (!file || std::fclose(file) != 0)
    {
      std::fprintf(stderr, "cannot write %s.node and .ele\n", name.c_str());
      std::exit(2);
    }
  }
}

#endif
