#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# check_debian.sh FOLDER: in a bare Debian, as root: installs the packages FOLDER/*.deb, uses them as
# a user would (Python, ParaView without any option, a C++ project), and removes them again. FOLDER has
# the project Consumer of this folder, too. See Utilities/test_in.sh packages.
set -euo pipefail
cd "$1"
export DEBIAN_FRONTEND=noninteractive
apt-get update -q
apt-get install -q -y --no-install-recommends ./*.deb xvfb xauth
dpkg -s conforming-delaunay conforming-delaunay-dev | grep -E '^(Package|Version|Installed-Size)'

echo "== Python"
python3 - <<'EOF'
import conforming_delaunay as cd
source = cd.vtkTechnologyStructureSource()
mesher = cd.vtkConformingDelaunayMesher()
mesher.SetInputConnection(source.GetOutputPort())
mesher.Update()
print(cd.__version__, mesher.GetOutput().GetNumberOfCells(), "tetrahedra")
print(cd.mesh(source.GetOutput()))
EOF

echo "== ParaView"
cat >check.py <<'EOF'
from paraview.simple import *
try:
    mesher = ConformingDelaunayMesher(Input=TechnologyStructureSource())
    mesher.UpdatePipeline()
    text = "%d tetrahedra" % mesher.GetDataInformation().GetNumberOfCells()
except BaseException as error:
    text = "failed: %r" % error
with open("check.txt", "w") as file:
    file.write(text + "\n")
EOF
rm -f check.txt
QT_QPA_PLATFORM=xcb timeout 300 xvfb-run -a -s "-screen 0 1280x800x24" \
  paraview --script=check.py >paraview.log 2>&1 &
paraview=$!
for _ in $(seq 280); do
  if [ -e check.txt ]; then
    break
  fi
  sleep 1
done
kill "$paraview" 2>/dev/null || true
wait "$paraview" 2>/dev/null || true
cat check.txt
grep -q ' tetrahedra$' check.txt
ls /usr/lib/paraview-*/plugins/ConformingDelaunay/Macros

echo "== a project in C++"
cmake -S Consumer -B consumer-build
cmake --build consumer-build
ctest --test-dir consumer-build --output-on-failure

echo "== removed"
apt-get purge -q -y conforming-delaunay conforming-delaunay-dev
# Files of other packages are as they were.
dpkg --verify paraview python3-paraview
left="$(find / -xdev \( -iname '*conforming*delaunay*' -o -name 'libcdm*' -o -name '*.distrib' \) \
  -not -path "$PWD/*" -not -path '/proc/*' -not -path '/project/*' -not -path '/root/*' \
  -not -path '/var/cache/*' | head)"
if [ -n "$left" ]; then
  echo "left behind: $left"
  exit 1
fi
echo "nothing is left"
