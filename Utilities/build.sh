# SPDX-License-Identifier: BSD-3-Clause
# Sourced by demo.sh, test.sh and benchmark.sh as build.sh TESTS [TARGET...]: installs the Debian
# packages that are missing, and those in the array more_packages; configures build/, with the tests
# if TESTS is ON, and builds the targets, or everything. Changes to the folder of the project.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  g++ cmake ninja-build            # compiler and build tools
  paraview-dev python3-paraview    # ParaView with its VTK, pvpython
  mpi-default-dev python3-dev      # ParaView's CMake package asks for MPI and Python
  libcgal-dev                      # exact predicates
  libgtest-dev                     # unit tests
  xvfb                             # a display
  qttools5-dev qtxmlpatterns5-dev-tools   # help pages in ParaView
)
if [ "$1" = ON ]; then
  packages+=(
    libeigen3-dev gmsh       # solvers, and meshes to compare with
    xdotool imagemagick      # a mouse for the GUI, and pictures of the whole screen
    python3-venv             # environments for the wheel
    getdp python3-meshio     # readers of the files that are written
  )
fi
# Debian 12 has ParaView 5.11 with VTK 9.2 and Qt 5, Debian 13 has ParaView 5.13 with VTK 9.3 and Qt 6.
if grep -q '^VERSION_ID="12"' /etc/os-release; then
  packages+=(libqt5svg5)           # the icons of the GUI
  if [ "$1" = ON ]; then
    packages+=(clang-format-14 clang-tidy-14)   # the style of the sources
  fi
else
  packages+=(qt6-svg-plugins qt6-base-dev)      # the icons of the GUI, and what the plugin adds to it
fi
packages+=(${more_packages[@]+"${more_packages[@]}"})

missing=()
for package in "${packages[@]}"; do
  if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
    missing+=("$package")
  fi
done
if [ "${#missing[@]}" -gt 0 ]; then
  echo "== installing ${missing[*]}"
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
  fi
  export DEBIAN_FRONTEND=noninteractive
  "${as_root[@]}" apt-get update -q
  # Without fsync after each file the installation takes half the time.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y \
    --no-install-recommends -o Dpkg::Options::=--force-unsafe-io "${missing[@]}"
fi

echo "== configuring build/"
cmake -G Ninja -S . -B build \
  -D CMAKE_BUILD_TYPE=Release \
  -D CONFORMINGDELAUNAY_BUILD_PLUGIN=ON \
  -D CONFORMINGDELAUNAY_WRAP_PYTHON=ON \
  -D CONFORMINGDELAUNAY_BUILD_TESTING="$1"

echo "== building"
if [ "$#" -gt 1 ]; then
  cmake --build build --target "${@:2}"
else
  cmake --build build
fi
