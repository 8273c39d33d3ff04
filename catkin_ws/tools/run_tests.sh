#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: run_tests.sh quick|slow
# Runs the rostests of make test or all others, several at once, and the tests of pytest that are marked
# so; then prints a summary of all results. After the slow ones, each test that the ledgers of the pages
# name must have passed. The workspace is built, and sourced.
#
# A rostest waits more than it works, and each has a master of its own: so several run at once, beside
# pytest; fewer of the slow ones, which have all the time that pytest takes. ROS's tools report success
# over failures: so the result files decide.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
level=$1
results=build/test_results
processors=$(nproc)
at_once=$((2 * processors))
[ "$level" = quick ] || at_once=$(((processors + 1) / 2))

# Those of make test, as ctest calls them: all of the tutorial, and what most labs and the viewer rest on.
matter_most="^_ctest_(mrp_rostest_.*|mrp_labs_rostest_test_roscpp|mrp_view_rostest_python__name_view|\
mrp_labs_rostest_python__name_(idioms|output|slow_subscriber))\.test\$"
chosen=(ctest --test-dir build --tests-regex "$matter_most")
[ "$level" = quick ] || chosen=(ctest --test-dir build --exclude-regex "$matter_most")
rostests=$("${chosen[@]}" --show-only | sed -n 's/^ *Test .*: //p')

status=0
if [ -n "$rostests" ]; then
  # shellcheck disable=SC2046  # each of its words is a variable
  env $(/usr/bin/python3 -m mrp_testing.compiler_cache) \
    make --no-print-directory -C build -j "$processors" tests || status=1
  # What a shell starts beside itself is deaf to Ctrl-C, and nodes would inherit that.
  (trap - INT; exec "${chosen[@]}" --parallel "$at_once" --output-on-failure) \
    > build/rostests.log 2>&1 &
fi
/usr/bin/python3 -m pytest -n $((processors + 1)) --dist loadgroup -m "$level" \
  --junit-xml="$results/pytest_$level.xml" || status=1
if [ -n "$rostests" ]; then
  wait $! || status=1
  cat build/rostests.log
fi
catkin_test_results "$results" > /dev/null || status=1
[ "$level" = quick ] || tools/check_proofs.py || status=1
tools/test_summary.py "$results" || status=1
exit $status
