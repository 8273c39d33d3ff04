#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: rootless.sh LIST...
# Runs the four nodes where the user may install nothing: in Docker or podman, if one answers. Otherwise
# it fetches the Debian packages of the lists that are missing, unpacks them in build/rootless, and lays
# them over /usr and /etc, which only what it starts sees.
set -euo pipefail
shopt -s nullglob
folder=$(dirname "$(dirname "$(realpath "$0")")")/build/rootless

fail() {
  echo "error: $*" >&2
  exit 1
}

# podman understands what make says to docker.
refused=
for engine in docker podman; do
  command -v $engine > /dev/null || continue
  if words=$($engine info 2>&1 > /dev/null); then
    mkdir -p "$folder/engine"
    ln -sf "$(command -v $engine)" "$folder/engine/docker"
    PATH=$folder/engine:$PATH exec make docker-run
  fi
  refused+=$'\n'"'$engine info' says: ${words%%$'\n'*}"
done

needs="without root, this system needs Docker or podman"
command -v apt-get > /dev/null || fail "$needs: it has no apt-get, and neither of them answers$refused"
words=$(unshare --user --map-root-user --mount true 2>&1) ||
  fail "$needs: it lets no user make a namespace"$'\n'"'unshare' says: ${words%%$'\n'*}$refused"

# As the user, with lists and archives of its own.
apt_get() {
  apt-get -qq -o Debug::NoLocking=1 -o "Dir::State::Lists=$folder/lists" -o "Dir::Cache=$folder/cache" "$@"
}

if [ ! -e "$folder/done" ]; then
  mkdir -p "$folder"/{lists,cache/archives}/partial "$folder"/root/{etc,usr/{bin,sbin,lib,lib64}}
  for name in bin sbin lib lib64; do
    ln -sfn "usr/$name" "$folder/root/$name"
  done
  echo "Fetching Debian packages to run the four nodes into $folder"
  apt_get update
  mapfile -t packages < <(sed '/^#/d; s/ *|.*//' "$@")
  apt_get install --yes --no-install-recommends --download-only "${packages[@]}" > /dev/null
  for package in "$folder"/cache/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink -C "$folder/root"
  done
  rm -r "$folder"/{lists,cache}
  touch "$folder/done"
fi

# What a package does when it is installed, and is not done here: to choose a BLAS and a LAPACK.
libraries=("$folder"/root/usr/lib/*/{blas,lapack})
LD_LIBRARY_PATH=$(IFS=:; echo "${libraries[*]#"$folder/root"}")
export LD_LIBRARY_PATH MRP_HAS_PACKAGES=yes
# shellcheck disable=SC2016  # expanded by the other shell
exec unshare --user --map-root-user --mount bash -ec '
  for name in usr etc; do
    mount -t overlay -o "lowerdir=$0/$name:/$name" overlay "/$name"
  done
  exec make run' "$folder/root"
