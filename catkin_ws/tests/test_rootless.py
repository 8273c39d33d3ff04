# SPDX-License-Identifier: BSD-3-Clause
"""Runs make run ROOTLESS=1 with stand-ins for what a machine has: which route does it take?"""

import shutil
import subprocess

import pytest
from front_door import make
from mrp_testing.workspace import WORKSPACE

pytestmark = [pytest.mark.quick, pytest.mark.place]

NEEDED = ("bash", "dirname", "realpath", "mkdir", "ln", "sed", "tar", "touch", "rm")


def rootless(folder, *lists, **programs):
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
        ["/bin/bash", tool, *lists],
        env={"PATH": str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )


def test_make_calls_it_with_the_lists_and_does_not_install():
    printed = make("run", "ROOTLESS=1", "--dry-run").stdout
    assert printed.endswith("tools/rootless.sh catkin_ws/apt/run.txt catkin_ws/apt/tools.txt\n")
    assert "install_packages" not in printed


@pytest.mark.parametrize("engine", ["docker", "podman"])
def test_an_engine_that_answers_is_used_as_docker(tmp_path, engine):
    script = f'[ "$1" = info ] || echo "{engine}: $*"\n'
    done = rootless(tmp_path, **{engine: script}, make='echo "make $*"; docker run\n')
    assert (done.returncode, done.stdout) == (0, f"make docker-run\n{engine}: run\n")


APT_GET = """
echo "$*" >> "$0.log"
for word; do
  case $word in Dir::Cache=*) touch "${word#*=}/archives/one.deb" ;; esac
done
"""


def test_packages_are_unpacked_in_the_folder_that_is_built_in(tmp_path):
    """The last program of all puts what was unpacked on top of the system."""
    (tmp_path / "list").write_text("# to run\nroslaunch\npython3 | python\n")
    (tmp_path / "share").mkdir()
    unpacked = tmp_path / "catkin_ws" / "build" / "rootless" / "root"
    programs = {
        "apt-get": APT_GET,
        "dpkg-deb": f"tar -c -C {tmp_path} share",
        "unshare": '[ "${@: -1}" = true ] || echo "${@: -1}"',
    }
    done = rootless(tmp_path, tmp_path / "list", **programs)
    assert (done.returncode, done.stdout.splitlines()[-1:]) == (0, [str(unpacked)]), done.stderr
    assert (unpacked / "share").is_dir()
    asked = (tmp_path / "apt-get.log").read_text()
    assert asked.endswith(" --download-only roslaunch python3\n")
    assert "rm -rf catkin_ws/build " in make("clean", "--dry-run").stdout


@pytest.mark.parametrize(
    ("programs", "reason"),
    [
        ({}, "it has no apt-get, and neither of them answers"),
        (
            {
                "docker": "printf 'too old\\nnext\\n' >&2; exit 1\n",
                "apt-get": "",
                "unshare": "echo 'not permitted' >&2; exit 1\n",
            },
            "it lets no user make a namespace\n'unshare' says: not permitted\n"
            "'docker info' says: too old",
        ),
    ],
    ids=["no_apt_get", "no_namespace"],
)
def test_where_nothing_works_it_says_why(tmp_path, programs, reason):
    done = rootless(tmp_path, **programs)
    expected = f"error: without root, this system needs Docker or podman: {reason}\n"
    assert (done.returncode, done.stdout, done.stderr) == (1, "", expected)
