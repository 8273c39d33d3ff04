#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs into build/lint what `make lint`, `make test-browser` and `make docker-dev` need and Debian
# does not have.
# Does nothing if it is there.
set -euo pipefail
cd "$(dirname "$0")/.."

# Debian has no ruff, and another mypy and vulture on each platform. Its eslint cannot
# read today's JavaScript. Its npm brings 350 packages, and cannot be installed beside the nodejs of
# NodeSource.
# lock_versions.sh writes the files of exact versions and hashes.
wanted=$(cat tools/locked/{lint.txt,package-lock.json})
[ "$(cat build/lint/installed 2> /dev/null)" != "$wanted" ] || exit 0
/usr/bin/python3 -m venv build/lint
build/lint/bin/pip --quiet install --require-hashes -r tools/locked/lint.txt
cp tools/locked/package{,-lock}.json build/lint
build/lint/bin/npm --loglevel error --prefix build/lint ci
echo "$wanted" > build/lint/installed
