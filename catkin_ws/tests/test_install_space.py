# SPDX-License-Identifier: BSD-3-Clause
"""The tutorial from an install space alone: what catkin_make install gives is complete."""

import shutil

import pytest
from mrp_testing import contract, scratch
from mrp_testing.console import check_console

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


def test_by_package_and_file(install):
    launch(install, contract.PACKAGE, contract.LAUNCH_FILE)


def test_by_absolute_path(install):
    launch(install, install / "share" / contract.PACKAGE / "launch" / contract.LAUNCH_FILE)
