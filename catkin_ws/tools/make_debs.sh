#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: make_debs.sh FOLDER
# Builds the Debian packages mrp (the tutorial's nodes) and mrp-check (the checker) for the Debian on
# which it runs, and puts them into FOLDER.
set -euo pipefail
folder=$(realpath -m "$1")
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
source=$work/source
mkdir "$source"
cp -r src/mrp src/mrp_check "$source"
find "$source" -name __pycache__ -prune -exec rm -r {} +
rm -rf "$source"/mrp/{doc,test} "$source"/mrp_check/test
cp -r tools/debian "$source/debian"
cp ../LICENSE "$source/debian/copyright"

# What the checker needs is what `make check` installs.
packages=$(sed 's/#.*//; s/[[:space:]]*$//; /^$/d; s/$/,/' apt/run.txt apt/tools.txt apt/check.txt | sort -u |
  paste -sd ' ')
sed -i "s/@CHECK@/$packages/" "$source/debian/control"

version=$(sed -n 's:.*<version>\(.*\)</version>.*:\1:p' src/mrp/package.xml)
# shellcheck disable=SC1091  # of the machine
release=$(. /etc/os-release; echo "${VERSION_ID:-14}")
cat > "$source/debian/changelog" <<END
mrp ($version~deb$release) unstable; urgency=medium

  * Release $version: CHANGELOG.rst of each package says what has changed.

 -- The mrp maintainers <maintainers@mrp.example>  $(date -R -d "@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}")
END

log=$work/log
(cd "$source" && dpkg-buildpackage --build=binary --no-sign) > "$log" 2>&1 || {
  cat "$log" >&2
  echo "error: dpkg-buildpackage could not build the packages; its own words are above" >&2
  exit 1
}
mkdir -p "$folder"
rm -f "$folder"/mrp*.deb
cp "$work"/mrp_*.deb "$work"/mrp-check_*.deb "$folder"
lintian --fail-on error,warning --suppress-tags-from-file tools/debian/lintian-reasons.txt "$folder"/*.deb
ls -l "$folder"/*.deb
