# SPDX-License-Identifier: BSD-3-Clause
"""Runs the tutorial from an install space, without its sources: nothing is missing there."""

import shutil

import pytest
from mrp_testing import contract, scratch
from mrp_testing.console import check_console

pytestmark = pytest.mark.slow


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
