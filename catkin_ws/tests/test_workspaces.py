# SPDX-License-Identifier: BSD-3-Clause
"""Sources an install space without its sources, and two workspaces with a package of one name."""

import shutil
import subprocess

import pytest
from mrp_testing import contract, scratch
from mrp_testing.console import check_console

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("workspaces")]

PACKAGE = "same_name"
NAMES = ("first", "second")
CMAKE = f"""cmake_minimum_required(VERSION 3.10)
project({PACKAGE} NONE)
find_package(catkin REQUIRED)
catkin_package()
"""
MANIFEST = f"""<package format="3">
  <name>{PACKAGE}</name>
  <version>0.1.0</version>
  <description>A package without any program.</description>
  <maintainer email="maintainers@mrp.example">The mrp maintainers</maintainer>
  <license>BSD-3-Clause</license>
  <buildtool_depend>catkin</buildtool_depend>
</package>
"""


@pytest.fixture(scope="module")
def workspaces(tmp_path_factory):
    """The folder of two workspaces, each built in a terminal that has sourced no other one."""
    folder = tmp_path_factory.mktemp("workspaces")
    for name in NAMES:
        package = folder / name / "src" / PACKAGE
        package.mkdir(parents=True)
        (package / "CMakeLists.txt").write_text(CMAKE)
        (package / "package.xml").write_text(MANIFEST)
        scratch.catkin_make(folder / name)
    return folder


@pytest.mark.parametrize("order", [NAMES, NAMES[::-1]], ids=lambda order: f"{order[-1]}_is_last")
def test_the_one_whose_setup_was_sourced_last_is_used(workspaces, order):
    sources = " && ".join(f"source {workspaces / name}/devel/setup.bash" for name in order)
    found = subprocess.run(
        ["bash", "-c", f"{sources} && rospack find {PACKAGE} && printenv CMAKE_PREFIX_PATH"],
        env=scratch.environment(),
        capture_output=True,
        text=True,
    )
    package, prefixes = found.stdout.splitlines()
    assert package == str(workspaces / order[-1] / "src" / PACKAGE), found.stderr
    assert str(workspaces / order[-1]) in prefixes and str(workspaces / order[0]) not in prefixes


@pytest.fixture
def install(tmp_path):
    """An install space of which neither the sources nor the build exist any more."""
    scratch.make(tmp_path, "src/mrp")
    scratch.catkin_make(tmp_path, "install", "-DCATKIN_ENABLE_TESTING=OFF")
    for name in ("src", "build", "devel"):
        shutil.rmtree(tmp_path / name)
    return tmp_path / "install"


def test_by_package_and_file(install):
    env = scratch.environment()
    port = env["ROS_MASTER_URI"].rsplit(":", 1)[1]
    launch = ("roslaunch", "-p", port, contract.PACKAGE, contract.LAUNCH_FILE)
    command = scratch.sourced(install / "setup.bash", *launch)
    check_console(contract.GROUP, *command, env=env)
