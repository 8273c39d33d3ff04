#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs Sphinx and the theme of the pages into build/docs_env, from PyPI: Debian's are too old, and
# differ from release to release. Does nothing, and needs no network, if they are there. Prints the
# Python to call. MRP_DOCS_ENV names another folder, such as that of a workspace this one was copied from.
set -euo pipefail
cd "$(dirname "$0")/.."

locked=tools/locked/docs.txt
env=${MRP_DOCS_ENV:-$PWD/build/docs_env}

if ! cmp --silent $locked "$env/installed"; then
  echo "Installing Sphinx and the theme of the pages from PyPI: 37 packages, about 15 MB to fetch" >&2
  /usr/bin/python3 -m venv --clear "$env"
  "$env/bin/pip" -qq --disable-pip-version-check install --require-hashes -r $locked >&2 || {
    echo "error: pip could not fetch them; its own message is above. The pages need a network once." >&2
    exit 1
  }
  # Debian's packages come last: the pages ask ROS for its defaults.
  echo /usr/lib/python3/dist-packages > "$(echo "$env"/lib/python3*/site-packages)/debian.pth"
  cp $locked "$env/installed"
fi
echo "$env/bin/python"
