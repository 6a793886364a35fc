# SPDX-License-Identifier: BSD-3-Clause
# Included by CMake after the validator's project(): its find_package(VTK) stops in Debian 13 without it.
include("${CMAKE_CURRENT_LIST_DIR}/../../Utilities/PythonTargets.cmake")
conforming_delaunay_import_python_targets("${VTK_DIR}")
