#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the container's command in the installed workspace.
set -e

# "--": or else catkin's set-up would take the command's arguments for its own.
# shellcheck source=/dev/null
source /opt/mrp/setup.bash --

# With --network none the host's name is nobody's address, and a node would not even reach itself.
if [ -z "$ROS_HOSTNAME$ROS_IP" ] && ! getent ahostsv4 "$HOSTNAME" > /dev/null; then
  export ROS_HOSTNAME=localhost
fi

# roslaunch would give this folder the group of /tmp, and is not allowed to.
mkdir -p "$ROS_HOME/log"

exec "$@"
