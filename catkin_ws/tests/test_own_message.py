# SPDX-License-Identifier: BSD-3-Clause
"""The message type of mrp_labs in a second package, which depends on mrp_labs and on nothing else.

The second package is beside mrp_labs in one workspace, where the message must be generated first;
or it has an install space of mrp_labs under it, of which the sources exist no more.
"""

import shutil
import subprocess

import pytest
from catkin_pkg.package import parse_package
from mrp_testing import compiler_cache, scratch
from mrp_testing.workspace import WORKSPACE

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("own_message")]

USER = "tests/count_user"
LABS = "src/mrp_labs"


def run(folder, setup, *command):
    """Return what a command prints where the file `setup` is sourced."""
    done = subprocess.run(
        scratch.sourced(setup, *command),
        cwd=folder,
        # What a build uses lies in this folder, or beside it.
        env={**scratch.environment(), **compiler_cache.variables(folder.parent)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def check_user(folder):
    setup = folder / "devel" / "setup.bash"
    cpp = run(folder, setup, folder / "devel" / "lib" / "count_user" / "count_user")
    py = run(folder, setup, "/usr/bin/python3", folder / "src/count_user/src/count_user.py")
    assert cpp.startswith("counter: 7\nlanguage: any\nmd5sum: ")
    assert py == cpp


def test_beside_mrp_labs(tmp_path):
    scratch.make(tmp_path, LABS, USER)
    # Of mrp_labs nothing but the message is built: what the second package says that it needs.
    scratch.catkin_make(tmp_path, "count_user")
    check_user(tmp_path)
    assert not (tmp_path / "devel" / "lib" / "mrp_labs" / "lab_publisher_cpp_node").exists()


@pytest.fixture(scope="module")
def install(tmp_path_factory):
    folder = tmp_path_factory.mktemp("labs")
    scratch.make(folder, LABS)
    # As `make build` does: what that has compiled for another test is in the cache.
    options = ("-DCATKIN_ENABLE_TESTING=OFF", "-DCMAKE_BUILD_TYPE=RelWithDebInfo")
    scratch.catkin_make(folder, "install", *options)
    for name in ("src", "build", "devel"):
        shutil.rmtree(folder / name)
    return folder / "install"


def test_over_an_install_space(install, tmp_path):
    scratch.make(tmp_path, USER)
    run(tmp_path, install / "setup.bash", "catkin_make", "-DPYTHON_EXECUTABLE=/usr/bin/python3")
    check_user(tmp_path)


def test_lab_and_message_are_installed(install):
    files = run(
        install, install / "setup.bash", "roslaunch", "--files", "mrp_labs", "own_message.launch"
    )
    assert files.strip() == str(install / "share/mrp_labs/launch/own_message.launch")
    shown = run(install, install / "setup.bash", "rosmsg", "show", "mrp_labs/Count")
    assert shown.split("\n")[-4:] == ["uint32 counter", "string language", "", ""]


@pytest.mark.quick
def test_dependencies_for_the_message():
    """On Debian all packages share one folder of headers: a build alone would not miss these."""
    package = parse_package(str(WORKSPACE / LABS))

    def kinds(name):
        fields = ("build", "buildtool", "build_export", "exec", "test")
        return [f for f in fields if name in [d.name for d in package[f + "_depends"]]]

    assert kinds("message_generation") == ["build"]
    assert kinds("message_runtime") == ["build_export", "exec"]
