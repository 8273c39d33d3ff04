#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs make test-all, and leaves its JUnit files in /results, if that is mounted. (Their own folder
# cannot be mounted: make test deletes it first.)
status=0
make test-all || status=$?
if [ -d /results ]; then
  cp -r catkin_ws/build/test_results/. /results || status=1
fi
exit $status
