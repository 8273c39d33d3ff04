#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: publish_site.sh PAGES VERSION REPOSITORY
# Puts built pages into the branch gh-pages of a repository: in its root, and in the folder VERSION. Older
# versions stay in their folders.
set -euo pipefail
pages=$(realpath "$1") version=$2 repository=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git -C "$work" init --quiet --initial-branch gh-pages
git -C "$work" pull --quiet "$repository" gh-pages 2> /dev/null ||
  [ -z "$(git ls-remote "$repository" gh-pages)" ]
find "$work" -mindepth 1 -maxdepth 1 ! -name .git ! -name '[0-9]*.[0-9]*.[0-9]*' -exec rm -r {} +
rm -rf "${work:?}/$version"
cp -r "$pages" "$work/$version"
cp -r "$pages/." "$work"
touch "$work/.nojekyll"
git -C "$work" add --all
git -C "$work" -c user.name=release -c user.email=release@mrp.example commit --quiet --message "Pages of $version"
git -C "$work" push --quiet "$repository" gh-pages
