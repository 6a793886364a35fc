# SPDX-License-Identifier: BSD-3-Clause
# Debian packages, by `cpack` in the build folder: conforming-delaunay (libraries, Python package,
# ParaView plugin with macros, manual, examples) and conforming-delaunay-dev (headers, CMake package).
# They fit the ParaView that they were built with.
if (NOT CONFORMINGDELAUNAY_BUILD_PLUGIN)
  return()
endif ()

# ParaView's programs load the plugins that a file with the name of the program lists. Debian 12 has no
# such files; they are looked for beside the programs, in /usr/bin. Debian 13 has one, which goes first: it
# is diverted (dpkg-divert), and ours has its lines, too. A plugin in /usr/share/paraview/plugins, which
# that file names, would be known but not loaded.
set(plugin_list "/usr/${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/conforming_delaunay.plugins.xml")
get_filename_component(versioned_dir "${PARAVIEW_PLUGIN_SUBDIR}" DIRECTORY)
set(debian_list "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/${versioned_dir}/paraview.conf")
set(packages_dir "${CMAKE_BINARY_DIR}/packages")
file(WRITE "${packages_dir}/pvserver.conf" "${plugin_list}\n")
install(FILES "${packages_dir}/pvserver.conf" DESTINATION "${CMAKE_INSTALL_BINDIR}"
  COMPONENT autoload EXCLUDE_FROM_ALL)
set(known_plugins)
set(list_dir "${CMAKE_INSTALL_BINDIR}")
set(scripts prerm)
if (EXISTS "${debian_list}")
  file(READ "${debian_list}" known_plugins)
  get_filename_component(list_dir "${debian_list}" DIRECTORY)
  list(APPEND scripts preinst postrm)
endif ()
foreach (script IN LISTS scripts)
  configure_file(Utilities/DebianPackages.${script}.in "${packages_dir}/${script}" @ONLY)
  execute_process(COMMAND chmod 755 "${packages_dir}/${script}")
  list(APPEND CPACK_DEBIAN_MAIN_PACKAGE_CONTROL_EXTRA "${packages_dir}/${script}")
endforeach ()
string(STRIP "${known_plugins}" known_plugins)
if (NOT known_plugins STREQUAL "")
  string(APPEND known_plugins "\n")
endif ()
# In case this build runs where the packages are installed.
string(REPLACE "${plugin_list}\n" "" known_plugins "${known_plugins}")
file(WRITE "${packages_dir}/paraview.conf" "${known_plugins}${plugin_list}\n")
install(FILES "${packages_dir}/paraview.conf" DESTINATION "${list_dir}"
  COMPONENT autoload EXCLUDE_FROM_ALL)

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
  "conforming-delaunay (= ${PROJECT_VERSION}), paraview-dev, mpi-default-dev, python3-dev, g++, cmake, make | ninja-build")
include(CPack)
