#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs roslaunch mrp pub_sub.launch through a pipe, in the ways a user may start it."""

import subprocess
import unittest

import rospkg
import rostest
from catkin.find_in_workspaces import find_in_workspaces
from mrp_testing import contract
from mrp_testing.console import check_console

LAUNCH = ("roslaunch", contract.PACKAGE, contract.LAUNCH_FILE)


class TestLaunch(unittest.TestCase):
    def test_by_package_and_file(self):
        check_console(contract.GROUP, *LAUNCH)

    def test_group_is_an_argument(self):
        """Starts the file by its path, as you also can, with another group."""
        path = rospkg.RosPack().get_path(contract.PACKAGE) + "/launch/" + contract.LAUNCH_FILE
        check_console("/robot1", "roslaunch", path, "group:=robot1")

    def test_cmake_names_every_node(self):
        """Looks where CMake puts programs: rosrun would find a script in the sources, too."""
        for node in contract.NODES:
            found = find_in_workspaces(["libexec"], contract.PACKAGE, node.executable)
            self.assertTrue(found, f"CMakeLists.txt makes no {node.executable}")

    def test_group_is_documented(self):
        arguments = subprocess.check_output([*LAUNCH, "--ros-args"], universal_newlines=True)
        self.assertRegex(arguments, r'group \(default "mrp"\): namespace of the four nodes')


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "launch", TestLaunch)
