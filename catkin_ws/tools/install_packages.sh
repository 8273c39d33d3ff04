#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: install_packages.sh LIST...
# Installs the Debian packages of the lists that are not installed yet. A line of a list is a
# package, or alternatives: "a | b" is satisfied by any one of them. Does nothing if all are there.
set -euo pipefail

container="Run it in the container instead: make docker-run"

fail() {
  echo "error: $*" >&2
  exit 1
}

# A system with ROS Noetic's own packages has what it needs in /opt/ros.
[ ! -e /opt/ros/noetic/setup.bash ] || exit 0

if ! command -v apt-get > /dev/null || ! command -v dpkg-query > /dev/null; then
  fail "this system has no apt-get; ROS 1 comes from Debian's packages. $container"
fi

installed() {
  dpkg-query --show --showformat '${db:Status-Status}' "$1" 2> /dev/null | grep -qx installed
}

# Prints the lines of which no alternative is installed.
missing() {
  local line package
  sed -e 's/#.*//' -e 's/ *| */ /g' -e 's/ *$//' "$@" | while read -r line; do
    for package in $line; do
      ! installed "$package" || continue 2
    done
    [ -z "$line" ] || echo "$line"
  done
}

lines=$(missing "$@" | sort -u)
[ -n "$lines" ] || exit 0

listed=${lines// / or }
listed=${listed//$'\n'/, }
as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo > /dev/null ||
    fail "installing packages needs root or sudo; missing: $listed"
  as_root=(sudo)
fi

echo "Installing Debian's packages: $listed"
"${as_root[@]}" apt-get update ||
  echo "warning: apt-get update failed; going on with the package lists as they are" >&2

packages=()
while read -r line; do
  found=
  for package in $line; do
    if apt-cache show "$package" > /dev/null 2>&1; then
      packages+=("$package")
      found=yes
      break
    fi
  done
  [ -n "$found" ] || fail "no package archive of this system has '${line// / or }'. $container"
done <<< "$lines"

"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y --no-install-recommends "${packages[@]}" ||
  fail "apt-get could not install the packages; its own message is above"
