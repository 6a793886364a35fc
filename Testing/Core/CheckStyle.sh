#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# CheckStyle.sh format SOURCE_DIR CLANG_FORMAT
# CheckStyle.sh tidy SOURCE_DIR CLANG_TIDY BUILD_DIR
# Whether all sources are formatted, or the filters are without findings of clang-tidy, which are
# printed. Exit status 77: the program is not installed.
set -euo pipefail
program="$3"
if [ ! -x "$program" ]; then
  echo "There is no clang-$1 14: skipped."
  exit 77
fi
cd "$2"
if [ "$1" = format ]; then
  find Filters Plugin Testing \( -name '*.cxx' -o -name '*.h' \) -print0 |
    xargs -0 "$program" --dry-run -Werror
else
  # Predicates.cxx is full of CGAL's headers, in which the analyzer finds fault.
  find Filters -name '*.cxx' ! -name Predicates.cxx -print0 |
    xargs -0 -n 1 -P "$(nproc)" "$program" -p "$4" --quiet --warnings-as-errors='*' 2>/dev/null
fi
