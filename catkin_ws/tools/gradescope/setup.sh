#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Gradescope runs it once, as root in /autograder/source, when it makes the image of the checks.
set -euo pipefail
cd "$(dirname "$0")"

# A package's programs run as another user: they cannot read which requirements are hidden.
chmod 600 spec.yaml
bash install_packages.sh apt/*.txt
