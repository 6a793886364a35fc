# SPDX-License-Identifier: BSD-3-Clause
# Debian packages, by `cpack` in the build folder: conforming-delaunay (libraries, Python package,
# ParaView plugin with macros, manual, examples) and conforming-delaunay-dev (headers, CMake package).
# They fit the ParaView that they were built with.
if (NOT CONFORMINGDELAUNAY_BUILD_PLUGIN)
  return()
endif ()

# ParaView's programs load the plugins that these files list. They lie beside the programs, in /usr/bin;
# Debian's packages have none.
set(plugin_list
  "../${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/conforming_delaunay.plugins.xml")
foreach (program IN ITEMS paraview pvserver)
  file(WRITE "${CMAKE_BINARY_DIR}/packages/${program}.conf" "${plugin_list}\n")
  install(FILES "${CMAKE_BINARY_DIR}/packages/${program}.conf" DESTINATION "${CMAKE_INSTALL_BINDIR}"
    COMPONENT autoload EXCLUDE_FROM_ALL)
endforeach ()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME conforming-delaunay)
set(CPACK_PACKAGE_VENDOR "ConformingDelaunay")
set(CPACK_PACKAGE_CONTACT "The authors of ConformingDelaunay <conforming-delaunay@localhost>")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
# ParaView's macros install the list of plugins without a component.
set(CPACK_COMPONENTS_ALL
  runtime python paraview_plugins Unspecified documentation autoload development)
foreach (component IN ITEMS RUNTIME PYTHON PARAVIEW_PLUGINS UNSPECIFIED DOCUMENTATION AUTOLOAD)
  set(CPACK_COMPONENT_${component}_GROUP main)
endforeach ()
set(CPACK_COMPONENT_DEVELOPMENT_GROUP development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_MAIN_PACKAGE_NAME conforming-delaunay)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME conforming-delaunay-dev)
set(CPACK_COMPONENT_GROUP_MAIN_DESCRIPTION "${PROJECT_DESCRIPTION}.
 The filters for VTK pipelines and Python, the plugin for ParaView with its macros, the manual, examples.")
set(CPACK_COMPONENT_GROUP_DEVELOPMENT_DESCRIPTION "${PROJECT_DESCRIPTION}.
 Headers and CMake package for programs in C++.")

# ParaView's libraries have no package of their own, nor a promise from one version to the next.
string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" paraview_release "${ParaView_VERSION}")
math(EXPR next_minor "${CMAKE_MATCH_2} + 1")
set(paraview_range
  "paraview (>= ${paraview_release}), paraview (<< ${CMAKE_MATCH_1}.${next_minor}~)")
set(CPACK_DEBIAN_MAIN_PACKAGE_DEPENDS
  "${paraview_range}, python3-paraview, python3-numpy, libc6, libstdc++6, libgmp10")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "conforming-delaunay (= ${PROJECT_VERSION}), paraview-dev, mpi-default-dev, python3-dev, g++, cmake")
include(CPack)
