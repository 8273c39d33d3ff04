#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: rebuild_upstream.sh FOLDER
# Fetches Debian's sources of rospy, rosmaster, librostime and catkin into a folder. Builds them as they
# are, where tests/test_upstream.py must fail, and with the patches in src/mrp/doc/upstream, where it must pass. It
# needs the network, some minutes, and a workspace that is built and sourced.
#
# A folder FOLDER/roscpp_core, or catkin, that is there is taken for the sources of librostime, or catkin.
set -euo pipefail
here=$(cd "$(dirname "$0")/../src/mrp/doc/upstream" && pwd)
mkdir -p "$1/lists/partial" "$1/cache/archives/partial"
cd "$1"

# shellcheck source=/dev/null
. /etc/os-release
echo "deb-src http://deb.debian.org/debian $VERSION_CODENAME main" > sources.list
options=(-o "Dir::Etc::SourceList=$PWD/sources.list" -o Dir::Etc::SourceParts=/no/such
  -o "Dir::State::Lists=$PWD/lists" -o "Dir::Cache=$PWD/cache" -o APT::Sandbox::User=)
apt-get update "${options[@]}"
apt-get source --download-only "${options[@]}" ros-ros-comm
[ -e roscpp_core ] || apt-get source --download-only "${options[@]}" ros-roscpp-core
[ -e catkin ] || apt-get source --download-only "${options[@]}" ros-catkin

# NAME: plain or patched
build() {
  rm -rf "$1"
  mkdir -p "$1/workspace/src"
  dpkg-source -x ros-ros-comm_*.dsc "$1/ros_comm"
  if [ -e roscpp_core ]; then cp -r roscpp_core "$1"; else dpkg-source -x ros-roscpp-core_*.dsc "$1/roscpp_core"; fi
  if [ -e catkin ]; then cp -r catkin "$1"; else dpkg-source -x ros-catkin_*.dsc "$1/catkin"; fi
  if [ "$1" = patched ]; then
    for patch in "$here"/catkin/*.patch; do patch -d "$1/catkin" -p1 < "$patch"; done
    for patch in "$here"/*.patch; do patch -d "$1/ros_comm" -p1 < "$patch"; done
    for patch in "$here"/roscpp_core/*.patch; do patch -d "$1/roscpp_core" -p1 < "$patch"; done
  fi
  cp -r "$1/ros_comm/clients/rospy" "$1/ros_comm/tools/rosmaster" "$1/workspace/src"
  catkin_make -C "$1/workspace" -DPYTHON_EXECUTABLE=/usr/bin/python3 install > "$1/log"
  mkdir "$1/lib"
  g++ -O2 -shared -fPIC -Wl,-soname,librostime.so.1d -I"$1/roscpp_core/rostime/include" \
    "$1"/roscpp_core/rostime/src/*.cpp -o "$1/lib/librostime.so.1d" -lcpp_common
}

# Print what a sleep of C++ without a clock says, and its exit code: 124, since it never ends.
cpp_sleeps() {
  printf '%s\n' '#include <ros/rate.h>' '#include <ros/time.h>' \
    "int main() { ros::Time::init(); ros::Time::setNow(ros::Time()); $2; }" > sleeps.cpp
  g++ sleeps.cpp -o sleeps -lrostime
  code=0
  LD_LIBRARY_PATH="$PWD/$1/lib" timeout 3 ./sleeps 2>&1 || code=$?
  echo "$code"
}

# Configure a workspace that has catkin's own sources, and print of which CMake that complains.
complaints() {
  rm -rf "$1/with_catkin"
  mkdir -p "$1/with_catkin/src"
  cp -r "$1/catkin" "$1/with_catkin/src"
  cp "$1/catkin/cmake/toplevel.cmake" "$1/with_catkin/src/CMakeLists.txt"
  env -u CMAKE_POLICY_VERSION_MINIMUM cmake -S "$1/with_catkin/src" -B "$1/with_catkin/build" \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 2>&1 | grep -c '^ *Compatibility with CMake' || true
}

tests() {
  cd "$here/../../../.."
  MRP_UPSTREAM="$OLDPWD/$1/workspace/install/lib/python3/dist-packages" \
    /usr/bin/python3 -m pytest -q tests/test_upstream.py
}

build plain
build patched
warning='/use_sim_time is set, and no message has come on /clock: sleep waits for the first one'
for sleep in 'ros::Rate(1).sleep()' 'ros::Duration(1).sleep()' 'ros::Time::sleepUntil(ros::Time(1))'; do
  diff <(cpp_sleeps plain "$sleep") <(echo 124)
  diff <(cpp_sleeps patched "$sleep") <(printf '%s\n' "$warning" 124)
  echo "$sleep: silent without the patch, and not with it"
done
# CMake complains from Debian 13 on, and stops on 14 at the first file.
echo "CMake complains $(complaints plain) times of catkin without the patch, and $(complaints patched) times with it"
[ "$(complaints patched)" = 0 ]
(tests patched)
! (tests plain) || { echo "error: expected tests to fail without the patches" >&2; exit 1; }
