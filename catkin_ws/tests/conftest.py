# SPDX-License-Identifier: BSD-3-Clause
"""These tests use what the tutorial package's own tests are made of."""

import os
import pathlib
import sys

import pytest

WORKSPACE = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(WORKSPACE / "src" / "mrp" / "test"))
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

_DOCKER = """\
#!/bin/bash
echo "$@" >> "$0.calls"
case "$1" in
  info) exit $(cat "$0.engine") ;;
  image) exit $(cat "$0.image") ;;
esac
for node in {PUBLISHER,SUBSCRIBER}" "{CPP,PY}; do
  name=${node,,}
  echo "process[mrp/${name/ /_}_node-1]: started with pid [1]"
  echo "[$node NODE] namespace of nh = /mrp/${name/ /_}_node"
done
for language in CPP PY; do echo "[SUBSCRIBER $language NODE] received message with data = 2"; done
sleep infinity &
trap 'kill $!; exit' INT
wait
"""


@pytest.fixture
def fake_docker(tmp_path, monkeypatch):
    """A docker that prints what the container prints, to its SIGINT.

    Its exit codes are in the files docker.engine and docker.image, its calls in docker.calls.
    """
    path = tmp_path / "bin" / "docker"
    path.parent.mkdir()
    path.write_text(_DOCKER)
    path.chmod(0o755)
    for name in ("engine", "image"):
        path.with_suffix("." + name).write_text("0")
    monkeypatch.setenv("PATH", f"{path.parent}:{os.environ['PATH']}")
    return path
