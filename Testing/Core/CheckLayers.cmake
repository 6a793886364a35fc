# SPDX-License-Identifier: BSD-3-Clause
# Core knows no VTK, Meshing knows no ParaView, CGAL is seen by one file only; a folder of Core knows
# only those before it.
#   cmake -D SOURCE_DIR=<folder of the project> -P CheckLayers.cmake
set(folders Basics Geometry Search Meshes Certificate BoxMethod Sizing Delaunay Repair Surface
  MeshPoints Volume Improvement MovingBoundary Voxels Pipeline CInterface)
file(GLOB core "${SOURCE_DIR}/Filters/Core/*/*.h" "${SOURCE_DIR}/Filters/Core/*/*.cxx")
file(GLOB_RECURSE meshing "${SOURCE_DIR}/Filters/Meshing/*.h"
  "${SOURCE_DIR}/Filters/Meshing/*.cxx")
set(problems 0)

function (forbid pattern what)
  foreach (path IN LISTS ARGN)
    file(STRINGS "${path}" lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]${pattern}")
    foreach (line IN LISTS lines)
      message("${path}: ${line}: ${what}")
      math(EXPR problems "${problems} + 1")
    endforeach ()
  endforeach ()
  set(problems "${problems}" PARENT_SCOPE)
endfunction ()

forbid("vtk" "the engine knows no VTK" ${core})
forbid("(vtkPV|vtkSM[^P]|vtkSI|pq)" "the filters know no ParaView" ${meshing})
forbid("CGAL/" "the filters know no CGAL" ${meshing})
list(FILTER core EXCLUDE REGEX "/Predicates\\.cxx$")
forbid("CGAL/" "CGAL belongs into Predicates.cxx" ${core})

set(later ${folders})
foreach (folder IN LISTS folders)
  list(REMOVE_ITEM later "${folder}")
  file(GLOB sources "${SOURCE_DIR}/Filters/Core/${folder}/*.h"
    "${SOURCE_DIR}/Filters/Core/${folder}/*.cxx")
  list(LENGTH sources count)
  if (count EQUAL 0)
    message(FATAL_ERROR "There is no folder Filters/Core/${folder}")
  endif ()
  foreach (other IN LISTS later)
    forbid("Core/${other}/" "${folder} does not know ${other}" ${sources})
  endforeach ()
endforeach ()

# The certificate judges the stages: it shares with them the exact predicates, containers, formulas and
# incidences, and nothing that searches or decides.
file(GLOB certificate "${SOURCE_DIR}/Filters/Core/Certificate/*.h"
  "${SOURCE_DIR}/Filters/Core/Certificate/*.cxx")
forbid("Core/Search/" "the certificate has a search of its own" ${certificate})
foreach (path IN LISTS certificate)
  file(STRINGS "${path}" lines REGEX "^#include \"Core/Meshes/")
  foreach (line IN LISTS lines)
    if (NOT line MATCHES
        "/(TetMesh|TriangleMesh|MeshInvariants|SimplexIncidence|VolumeSums|VoronoiMeasures)\\.h")
      message("${path}: ${line}: the certificate is independent of the stages")
      math(EXPR problems "${problems} + 1")
    endif ()
  endforeach ()
endforeach ()

if (problems GREATER 0)
  message(FATAL_ERROR "${problems} includes across the layers")
endif ()
