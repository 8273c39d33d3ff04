#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Follows a node's lines: into roslaunch's log file, onto its console, or late into a pipe."""

import pathlib
import re
import tempfile
import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE
from mrp_testing.process import LIVE, Process
from std_msgs.msg import UInt32

LAUNCH = """
<launch>
  <node pkg="mrp" type="publisher_cpp_node" name="shown_cpp" output="screen"/>
  <node pkg="mrp" type="publisher_py_node.py" name="shown_py" output="screen"/>
  <node pkg="mrp" type="publisher_cpp_node" name="hidden_cpp"/>
  <node pkg="mrp" type="publisher_py_node.py" name="hidden_py"/>

  <!-- These log an error. -->
  <node pkg="mrp_labs" type="log_levels" name="wrong_cpp"/>
  <node pkg="mrp_labs" type="log_levels.py" name="wrong_py"/>
</launch>
"""
# How a line of each language begins: its time has more digits in C++.
ERRORS = {"cpp": r"\[ERROR\] \[\d+\.\d{9}\]: an error", "py": r"\[ERROR\] \[\d+\.\d{6}\]: an error"}
NODES = {f"/{kind}_{language}" for kind in ("shown", "hidden") for language in ("cpp", "py")}


class TestLaunched(unittest.TestCase):
    """One run of roslaunch, which all test cases look at.

    console: its Process
    logged: the text of all files that it has made of what nodes print
    nodes: the nodes of the tutorial, as the master knew them
    """

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "output.launch").write_text(LAUNCH)
            env = {**LIVE, "ROS_LOG_DIR": folder}
            with Process("roslaunch", str(path / "output.launch"), extra_env=env) as cls.console:
                cls.console.wait_for(lambda: cls.tutorial() >= NODES, "the nodes")
                for error in ERRORS.values():
                    cls.console.wait_for(lambda: re.search(error, str(cls.console)), error)
                cls.nodes = cls.tutorial()
                assert cls.console.stop() == 0, str(cls.console)
            cls.logged = "\n".join(path_.read_text() for path_ in path.rglob("*-stdout.log"))

    @staticmethod
    def tutorial():
        return set(Graph().publishers.get("/" + contract.TOPIC, []))

    @classmethod
    def has(cls, text):
        """Return whether a text is on the console."""
        return any(text in line for line in list(cls.console.lines))

    def check(self, node, language):
        """Check where the first line of the shown and of the hidden node is."""
        shown, hidden = (
            node.start_line.format(f"/{kind}_{language}") for kind in ("shown", "hidden")
        )
        self.assertTrue(self.has(shown), str(self.console))
        self.assertNotIn(shown, self.logged)
        self.assertFalse(self.has(hidden), str(self.console))
        self.assertIn(hidden, self.logged)

    def test_without_screen_lines_go_into_a_log_file_cpp(self):
        self.check(contract.PUBLISHER_CPP, "cpp")

    def test_without_screen_lines_go_into_a_log_file_py(self):
        self.check(contract.PUBLISHER_PY, "py")

    def test_without_screen_errors_are_on_the_console_all_the_same(self):
        for error in ERRORS.values():
            self.assertRegex(str(self.console), error)
        self.assertFalse(self.has("an info line"), str(self.console))

    def test_name_in_the_launch_file_replaces_that_in_the_code(self):
        self.assertEqual(self.nodes, NODES)


class TestPipe(unittest.TestCase):
    """rosrun, whose output goes into a pipe, without the two variables that make it live."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_output")

    def check(self, node):
        values = []
        subscriber = rospy.Subscriber(contract.TOPIC, UInt32, values.append)
        self.addCleanup(subscriber.unregister)
        with Process("rosrun", contract.PACKAGE, node.executable) as process:
            process.wait_for(lambda: len(values) >= 2, "two values")
            self.assertEqual(process.lines, [])
            self.assertEqual(process.stop(), 0, str(process))
        texts = list(map(contract.logged_text, process.lines))
        self.assertEqual(texts, [node.start_line.format("/" + node.name)])

    def test_lines_wait_in_the_buffer_of_a_pipe_cpp(self):
        self.check(contract.PUBLISHER_CPP)

    def test_lines_wait_in_the_buffer_of_a_pipe_py(self):
        self.check(contract.PUBLISHER_PY)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "output", __name__)
