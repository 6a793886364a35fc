# SPDX-License-Identifier: BSD-3-Clause
# In Debian 13 the CMake files of ParaView, and of its VTK, name Python modules without the tag of the
# interpreter that their files have: vtkCommonCore.so instead of vtkCommonCore.cpython-313-...so. So
# find_package() stops.
#
#   conforming_delaunay_import_python_targets(<folder of CMake files>)
#
# imports the targets of the modules that these files name, from copies with the right names in the
# build folder. find_package() leaves out targets that are there. Where the names are right nothing
# happens.
function (conforming_delaunay_import_python_targets dir)
  string(REGEX REPLACE "/lib/.*" "" prefix "${dir}")
  set(copies "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/python_targets")
  file(GLOB files RELATIVE "${dir}" "${dir}/*Python*-targets.cmake")
  foreach (file IN LISTS files)
    string(REPLACE ".cmake" "-*.cmake" locations "${file}")
    file(GLOB locations RELATIVE "${dir}" "${dir}/${locations}")
    set(is_wrong OFF)
    foreach (location IN LISTS locations)
      file(READ "${dir}/${location}" text)
      if (NOT text MATCHES "\\\${_IMPORT_PREFIX}(/[^\"]+)\\.so\"")
        continue ()
      endif ()
      set(module "${prefix}${CMAKE_MATCH_1}")
      file(GLOB tagged_module "${module}.*.so")
      if (tagged_module AND NOT EXISTS "${module}.so")
        set(is_wrong ON)
        string(REPLACE "${module}" "" tag "${tagged_module}")
        string(REPLACE ".so\"" "${tag}\"" text "${text}")
      endif ()
      file(WRITE "${copies}/${location}" "${text}")
    endforeach ()
    if (is_wrong)
      # The copy speaks of paths as if it were where the original is.
      file(READ "${dir}/${file}" text)
      string(REPLACE "get_filename_component(_IMPORT_PREFIX \"\${CMAKE_CURRENT_LIST_FILE}\" PATH)"
        "set(_IMPORT_PREFIX \"${dir}\")" text "${text}")
      file(WRITE "${copies}/${file}" "${text}")
      include("${copies}/${file}")
    endif ()
  endforeach ()
endfunction ()
