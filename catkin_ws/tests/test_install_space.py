# SPDX-License-Identifier: BSD-3-Clause
"""The tutorial from an install space alone: what catkin_make install gives is complete."""

import shutil

import pytest
from mrp_testing import contract, scratch
from mrp_testing.console import check_console
from mrp_testing.proves import proves

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("install_space")]


@pytest.fixture(scope="module")
def install(tmp_path_factory):
    """An install space of which neither the sources nor the build exist any more."""
    folder = tmp_path_factory.mktemp("workspace")
    scratch.make(folder, "src/mrp")
    scratch.catkin_make(folder, "install", "-DCATKIN_ENABLE_TESTING=OFF")
    for name in ("src", "build", "devel"):
        shutil.rmtree(folder / name)
    return folder / "install"


def launch(install, *target):
    env = scratch.environment()
    port = env["ROS_MASTER_URI"].rsplit(":", 1)[1]
    command = scratch.sourced(install / "setup.bash", "roslaunch", "-p", port, *target)
    check_console(contract.GROUP, *command, env=env)


@proves(
    "install says what catkin_make install copies: the programs, the scripts and the launch files.",
    "The nodes run from this copy even when the source files are gone.",
    "roslaunch starts a master if no master runs.",
    "roslaunch starts a master and all nodes of a launch file.",
    "Ctrl-C in terminal 1 ends everything that roslaunch has started there.",
    "A master that roslaunch has started ends with it.",
    "roslaunch starts a master if no master runs, and stops it when it ends itself.",
    "Cause: no master runs: it ends with the roslaunch that started it.",
    "roslaunch starts them, and a master if no master runs.",
    "The nodes run from the install space alone.",
    "Here the nodes run from the install space alone.",
    "roslaunch starts a master by itself.",
    "To be built and run, it needs nothing else from this repository.",
)
def test_by_package_and_file(install):
    launch(install, contract.PACKAGE, contract.LAUNCH_FILE)


def test_by_absolute_path(install):
    launch(install, install / "share" / contract.PACKAGE / "launch" / contract.LAUNCH_FILE)
