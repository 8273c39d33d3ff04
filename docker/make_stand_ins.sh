#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: make_stand_ins.sh DEFINITIONS FOLDER
# Builds the message packages that a file like stand_ins.txt defines, as Debian would, into FOLDER/usr.
set -euo pipefail
definitions=$(realpath "$1") into=$2
work=$(mktemp -d)
cd "$work"

while IFS= read -r line; do
  case $line in
    "== "*) file=${line#== }; mkdir -p "${file%/*}" ;;
    "#"*) ;;
    *) echo "$line" >> "$file" ;;
  esac
done < "$definitions"

for package in */; do
  name=${package%/}
  cat > "$name/package.xml" <<END
<package format="2">
  <name>$name</name>
  <version>0.0.0</version>
  <description>A stand-in: the messages of $name, and nothing else of it</description>
  <maintainer email="maintainers@mrp.example">The mrp maintainers</maintainer>
  <license>BSD-3-Clause</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>actionlib_msgs</depend>
  <depend>message_generation</depend>
  <depend>message_runtime</depend>
  <depend>std_msgs</depend>
</package>
END
  {
    printf 'cmake_minimum_required(VERSION 3.10)\nproject(%s)\n' "$name"
    echo 'find_package(catkin REQUIRED COMPONENTS actionlib_msgs message_generation std_msgs)'
    [ ! -d "$name/msg" ] || echo 'add_message_files()'
    [ ! -d "$name/srv" ] || echo 'add_service_files()'
    [ ! -d "$name/action" ] || echo 'add_action_files()'
    echo 'generate_messages(DEPENDENCIES actionlib_msgs std_msgs)'
    echo 'catkin_package(CATKIN_DEPENDS actionlib_msgs message_runtime std_msgs)'
  } > "$name/CMakeLists.txt"
  cmake -S "$name" -B "build/$name" -DCMAKE_INSTALL_PREFIX=/usr -DCATKIN_BUILD_BINARY_PACKAGE=ON \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DSETUPTOOLS_DEB_LAYOUT=ON -DCATKIN_ENABLE_TESTING=OFF
  make -C "build/$name"
  DESTDIR=$(realpath -m "$into") make -C "build/$name" install
done
