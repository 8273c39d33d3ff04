# SPDX-License-Identifier: BSD-3-Clause
"""make run ROOTLESS=1: which way it takes. Programs stand in for what a machine has or has not."""

import shutil
import subprocess

import pytest
from front_door import make
from mrp_testing.proves import proves
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

NEEDED = ("bash", "dirname", "realpath", "mkdir", "ln")


def rootless(folder, **programs):
    """Run it where there are only a few programs, and these stand-ins; return the completed run."""
    for name in NEEDED:
        (folder / name).symlink_to(shutil.which(name))
    for name, script in programs.items():
        (folder / name).write_text("#!/bin/bash\n" + script)
        (folder / name).chmod(0o755)
    tool = folder / "catkin_ws" / "tools" / "rootless.sh"
    tool.parent.mkdir(parents=True)
    shutil.copy(WORKSPACE / "tools" / "rootless.sh", tool)
    return subprocess.run(
        ["/bin/bash", tool], env={"PATH": str(folder)}, capture_output=True, text=True, check=False
    )


def test_make_calls_it_with_the_lists_and_does_not_install():
    said = make("run", "ROOTLESS=1", "--dry-run").stdout
    assert said.endswith("tools/rootless.sh catkin_ws/apt/run.txt catkin_ws/apt/tools.txt\n")
    assert "install_packages" not in said


@proves("If Docker or podman answers, the nodes run in a container.")
@pytest.mark.parametrize("engine", ["docker", "podman"])
def test_an_engine_that_answers_is_used_as_docker(tmp_path, engine):
    script = f'[ "$1" = info ] || echo "{engine}: $*"\n'
    done = rootless(tmp_path, **{engine: script}, make='echo "make $*"; docker run\n')
    assert (done.returncode, done.stdout) == (0, f"make docker-run\n{engine}: run\n")


@proves("If neither works, it says why.")
@pytest.mark.parametrize(
    ("programs", "reason"),
    [
        ({}, "it has no apt-get, and neither of them answers"),
        (
            {"docker": "exit 1\n", "apt-get": "", "unshare": "exit 1\n"},
            "it lets no user make a namespace",
        ),
    ],
    ids=["no_apt_get", "no_namespace"],
)
def test_where_nothing_works_it_says_why(tmp_path, programs, reason):
    done = rootless(tmp_path, **programs)
    expected = f"error: without root, this system needs Docker or podman: {reason}\n"
    assert (done.returncode, done.stdout, done.stderr) == (1, "", expected)
