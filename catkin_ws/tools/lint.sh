#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks the style of all sources; goes on to the end, and fails if any check did.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1

ruff_version=0.17.5
vulture_version=2.16
tools=catkin_ws/build/lint/bin
ruff=$tools/ruff
vulture=$tools/vulture

status=0
check() {
  local name=$1
  shift
  if "$@"; then
    echo "[OK]   $name"
  else
    echo "[FAIL] $name"
    status=1
  fi
}

# Debian has no ruff, and another vulture on each platform.
if [ "$("$ruff" --version 2> /dev/null)" != "ruff $ruff_version" ] ||
  [ "$("$vulture" --version 2> /dev/null)" != "vulture $vulture_version" ]; then
  /usr/bin/python3 -m venv catkin_ws/build/lint &&
    "$tools/pip" --quiet install "ruff==$ruff_version" "vulture==$vulture_version" || exit 1
fi

# Of what git knows or would know, the files with these endings.
files() {
  git ls-files --cached --others --exclude-standard -- "$@"
}

# The original is quoted as it is printed, and what the checker must accept is in many styles.
mapfile -t cpp < <(files '*.cpp' '*.h' ':!catkin_ws/tests/errata/original' \
  ':!catkin_ws/tests/check/correct')
mapfile -t xml < <(files '*.launch' '*.test' '*.xml')
mapfile -t shell < <(files '*.sh' '.ci/*')

check "catkin_lint" env -C catkin_ws tools/with_rosdep.sh catkin_lint --rosdistro Debian --strict -W2 src
check "clang-format" clang-format --dry-run --Werror "${cpp[@]}"
check "ruff check" "$ruff" check --no-cache --config catkin_ws/ruff.toml catkin_ws docker
check "ruff format" "$ruff" format --check --no-cache --config catkin_ws/ruff.toml catkin_ws docker
# What another program looks at by its name: expat, roslaunch, and the confinement's watcher. What a
# defect's head says is read by the tests and by the pages.
check "vulture" "$vulture" catkin_ws/src/mrp_check/{src,scripts} \
  --ignore-names '*ElementHandler,ignore_unset_args,cpu,open_files,file_size,erratum,fails,says,finds,tells,missed'
check "shellcheck" shellcheck "${shell[@]}"
check "xmllint" xmllint --noout "${xml[@]}"
exit $status
