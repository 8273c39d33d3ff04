#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""roslaunch mrp pub_sub.launch, through a pipe, in the ways in which a user may start it."""

import subprocess
import unittest

import rospkg
import rostest
from catkin.find_in_workspaces import find_in_workspaces
from mrp_testing import contract
from mrp_testing.console import check_console
from mrp_testing.proves import proves

LAUNCH = ("roslaunch", contract.PACKAGE, contract.LAUNCH_FILE)


class TestLaunch(unittest.TestCase):
    @proves(
        "Python is not compiled: catkin_install_python makes a script "
        "devel/lib/mrp/publisher_py_node.py that runs yours.",
        "With these two, each line appears at once, even when the output goes into a pipe.",
        'output="screen" shows what the node prints.',
        "Both subscribers print even and odd numbers, and none is missing between two of them.",
        "Here a test compares every line of the console.",
        "make run prints roslaunch's own lines, and each line of the nodes as it happens:",
    )
    def test_by_package_and_file(self):
        check_console(contract.GROUP, *LAUNCH)

    @proves(
        "The name is the same relative name as the publishers', so the four nodes meet wherever "
        "they are started together.",
        "<group> puts what it holds into the namespace ns.",
        "$(arg group) is the value of the argument.",
        "With group:=robot1 behind the command, the same file starts the nodes in the namespace "
        "/robot1.",
        "Each node logs its full name first.",
        "This name begins with the group's namespace.",
        "roslaunch mrp pub_sub.launch group:=robot1 puts the four nodes into another namespace.",
    )
    def test_group_is_an_argument(self):
        """By the file's path, which is the other way to name it."""
        path = rospkg.RosPack().get_path(contract.PACKAGE) + "/launch/" + contract.LAUNCH_FILE
        check_console("/robot1", "roslaunch", path, "group:=robot1")

    @proves(
        "Each of the four nodes has its place in CMakeLists.txt.",
        "Python is not compiled: catkin_install_python makes a script "
        "devel/lib/mrp/publisher_py_node.py that runs yours.",
        "Each of the four nodes has its place in this file.",
        "They start a script in devel that catkin_install_python made.",
    )
    def test_cmake_names_every_node(self):
        """rosrun would find a script in the sources, too, but not in an install space."""
        for node in contract.NODES:
            found = find_in_workspaces(["libexec"], contract.PACKAGE, node.executable)
            self.assertTrue(found, f"CMakeLists.txt makes no {node.executable}")

    def test_group_is_documented(self):
        arguments = subprocess.check_output([*LAUNCH, "--ros-args"], universal_newlines=True)
        self.assertRegex(arguments, r'group \(default "mrp"\): namespace of the four nodes')


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "launch", TestLaunch)
