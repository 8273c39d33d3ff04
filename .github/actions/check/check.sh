#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks CHECK_PATH of the repository in GITHUB_WORKSPACE: prints annotations, and writes the job's summary and
# a folder of SARIF files. Exit code: 0 passed; 1 findings at CHECK_FAIL_LEVEL; 2 it could not check.
set -uo pipefail

case $CHECK_FAIL_LEVEL in
  error | warning | never) ;;
  *) echo "::error::fail-level: expected error, warning or never; found: $CHECK_FAIL_LEVEL"; exit 2 ;;
esac

# A release's image has the release's version; a branch has the newest.
owner=${CHECK_REPOSITORY%%/*} tag=latest
[[ ! $CHECK_REF =~ ^v?([0-9]+(\.[0-9]+)*)$ ]] || tag=${BASH_REMATCH[1]}
image=${CHECK_IMAGE:-ghcr.io/${owner,,}/mrp-check:$tag}

reports=$(mktemp -d "${RUNNER_TEMP:-/tmp}/mrp_check.XXXXXX")
options=(--github --sarif /reports/check.sarif)
[ -z "$CHECK_CONTRACT" ] || options+=(--spec "$CHECK_CONTRACT")
docker run --rm --init --network none --hostname localhost --workdir /repository \
  --volume "$GITHUB_WORKSPACE:/repository:ro" --volume "$reports:/reports" \
  "$image" "${options[@]}" -- "$CHECK_PATH" | tee "$reports/console"
code=${PIPESTATUS[0]}

# Without what is meant for GitHub alone.
{
  echo "## ROS 1 packages"
  echo "~~~~~~"
  grep -v '^::' "$reports/console"
  echo "~~~~~~"
} >> "$GITHUB_STEP_SUMMARY"
! compgen -G "$reports/*.sarif" > /dev/null || echo "sarif=$reports" >> "$GITHUB_OUTPUT"

[ "$code" -le 1 ] || exit "$code"
case $CHECK_FAIL_LEVEL in
  never) exit 0 ;;
  warning) ! grep -q '^::warning ' "$reports/console" || exit 1 ;;
esac
exit "$code"
