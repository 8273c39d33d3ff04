#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: with_rosdep.sh COMMAND...
# Runs a command for which rosdep knows Debian's packages, without a network: python3-rosdep2 ships
# the list of them, and all that rosdep would fetch as well (other systems, ROS distributions) is
# left out.
set -euo pipefail

workspace=$(cd "$(dirname "$0")/.." && pwd)
folder=$workspace/build/rosdep
mkdir -p "$folder/sources"
printf 'yaml file://%s debian\n' /usr/share/python3-rosdep2/debian.yaml "$workspace/apt/rosdep.yaml" > "$folder/sources/debian.list"
printf '%s\n' '%YAML 1.1' '---' 'distributions: {}' 'type: index' 'version: 4' > "$folder/index.yaml"

export ROS_HOME=$folder
export ROSDEP_SOURCE_PATH=$folder/sources
export ROSDISTRO_INDEX_URL=file://$folder/index.yaml
log=$(rosdep update 2>&1) || {
  echo "error: rosdep could not read Debian's list of packages: $log" >&2
  exit 1
}
exec "$@"
