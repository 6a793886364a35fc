#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# CheckFormat.sh SOURCE_DIR CLANG_FORMAT
# Whether all sources are formatted. Exit status 77: the program is not installed.
set -euo pipefail
if [ ! -x "$2" ]; then
  echo "There is no clang-format 14: skipped."
  exit 77
fi
cd "$1"
find Filters Plugin Testing \( -name '*.cxx' -o -name '*.h' \) -print0 |
  xargs -0 "$2" --dry-run -Werror
