# SPDX-License-Identifier: BSD-3-Clause
# Sourced by demo.sh, test.sh and benchmark.sh as build.sh TESTS [TARGET...]: installs the Debian
# packages that are missing, and those in the array more_packages; configures build/, with the tests
# if TESTS is ON, and builds the targets, or everything. Changes to the folder of the project.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  g++ cmake ninja-build            # compiler and build tools
  paraview-dev python3-paraview    # ParaView 5.11 with its VTK 9.2, pvpython
  mpi-default-dev                  # ParaView's CMake package asks for MPI
  libcgal-dev                      # exact predicates
  libgtest-dev                     # unit tests
  xvfb libqt5svg5                  # a display, and the icons of the GUI on it
  qttools5-dev qtxmlpatterns5-dev-tools   # help pages in ParaView
)
if [ "$1" = ON ]; then
  packages+=(
    libeigen3-dev gmsh       # solvers, and meshes to compare with
    xdotool imagemagick      # a mouse for the GUI, and pictures of the whole screen
    clang-format-14 clang-tidy-14   # the style of the sources
    python3-venv             # environments for the wheel
  )
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
