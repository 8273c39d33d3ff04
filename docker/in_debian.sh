#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: in_debian.sh RELEASE TARGET...: makes targets of the Makefile in a bare Debian, in a container.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck disable=SC2016  # expanded in the container
exec docker run --rm --network host --volume "$PWD:/mrp" --workdir /mrp "debian:$1-slim" sh -ec '
  { apt-get update && apt-get install -y --no-install-recommends ca-certificates git make; } > /tmp/log 2>&1 ||
    { cat /tmp/log >&2; exit 1; }
  git config --global --add safe.directory /mrp
  make "$@"' make "${@:2}"
