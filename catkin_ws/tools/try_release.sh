#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: try_release.sh VERSION REPOSITORY
# Does in a clone what release.yml does when the tag VERSION is pushed to REPOSITORY, for the architecture
# of this machine; publishes nothing, and lists what it would publish. The images stay in the engine.
set -euo pipefail
version=$1 repository=$2
owner=$(basename "$(dirname "$repository")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git clone --quiet "$(dirname "$0")/../.." "$work/clone"
cd "$work/clone"
git config user.name release
git config user.email release@mrp.example
make release VERSION="$version" REPOSITORY="$repository"

docker/in_debian.sh trixie release-notes > "$work/notes.md"
for debian in bookworm trixie forky; do
  docker/in_debian.sh $debian deb
  cp catkin_ws/build/debs/*.deb "$work"
done
for stage in runtime view check; do
  make docker-push-$stage PUSH="docker build" REGISTRY="ghcr.io/${owner,,}" TAG="$version"
done
docker/in_debian.sh trixie docs
git init --quiet --bare "$work/published"
catkin_ws/tools/publish_site.sh catkin_ws/build/docs "$version" "$work/published"

echo "Publishing $version at $repository would make:"
echo "  release notes, $(wc -l < "$work/notes.md") lines"
(cd "$work" && stat --printf '  %n, %s bytes\n' ./*.deb)
docker image ls --format 'image {{.Repository}}:{{.Tag}}, {{.Size}}; as :latest, too, with an SBOM, for amd64 and arm64' \
  "ghcr.io/${owner,,}/*" | sed 's/^/  /'
pages=$(git -C "$work/published" ls-tree -r --name-only gh-pages)
echo "  branch gh-pages: $(grep -c '^[^0-9].*html$' <<< "$pages") pages, the same in $version/, and" \
  "$(grep -o '<loc>' catkin_ws/build/docs/sitemap.xml | wc -l) addresses in sitemap.xml"
