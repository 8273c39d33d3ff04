#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: debug.sh NODE
# Starts one of the tutorial's nodes under gdb, or under pdb: in the namespace of the launch file, and
# in the place of the node of that name, if one runs. The workspace is sourced.
set -euo pipefail
node=${1%.py}

if [ -f "devel/lib/mrp/$node" ]; then
  debugger=(gdb --quiet -ex 'set confirm off' -ex 'set pagination off' -x tools/debug_cpp.py --args "devel/lib/mrp/$node")
elif [ -f "src/mrp/src/$node.py" ]; then
  debugger=(/usr/bin/python3 -c 'from tools import debug_python; debug_python.main()' "src/mrp/src/$node.py")
else
  names=$(find src/mrp/src -maxdepth 1 -name '*_node.*' -printf '%f\n' | sed 's/\..*//' | sort)
  echo "error: expected NODE=NAME, one of: ${names//$'\n'/, }" >&2
  exit 2
fi

if ! /usr/bin/python3 -c 'import rosgraph; exit(not rosgraph.is_master_online())'; then
  echo "error: no master answers at $ROS_MASTER_URI: start the nodes in another terminal with: make run" >&2
  exit 1
fi
exec "${debugger[@]}" __ns:=mrp
