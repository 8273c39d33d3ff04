#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: run_tests.sh quick|slow
# Runs the rostests that tests/rostests.txt calls so, several at once, and the tests of tests/ that
# are marked so; then prints a summary of all results. The workspace is built, and sourced.
#
# A rostest waits more than it works, and each has a master of its own. ROS's tools report success
# over failures: so the result files decide.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
level=$1
results=build/test_results
processors=$(nproc)

rostests=()
while read -r is package name; do
  [ "$is" != "$level" ] || rostests+=("run_tests_${package}_rostest_test_$name")
done < tests/rostests.txt

status=0
[ ${#rostests[@]} = 0 ] ||
  tools/timed.py "rostests, $level" \
    cmake --build build --parallel $((2 * processors + 1)) --target "${rostests[@]}" || status=1
tools/timed.py "pytest, $level" /usr/bin/python3 -m pytest -n $((processors + 1)) --dist loadgroup -m "$level" \
  --junit-xml=$results/pytest_$level.xml tests || status=1
catkin_test_results $results > /dev/null || status=1
tools/test_summary.py $results || status=1
exit $status
