#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sets parameters: which node gets which, when does it read them, and how long do they stay?"""

import pathlib
import signal
import tempfile
import unittest

import rosgraph
import rostest
from mrp_testing import log_line
from mrp_testing.lab import PACKAGE, path_of
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process

PROGRAMS = {"py": "read_parameters.py", "cpp": "read_parameters"}


def last_of(process, node):
    """Return what a node logged last: the robot, the first speed and the present one; or None."""
    texts = [text for text in log_line.texts(process.lines) if text.startswith(node + " ")]
    return texts[-1][len(node) + 1 :] if texts else None


def says(robot, first, now):
    return f"{robot}: at first {first}, now {now}"


class TestParam(unittest.TestCase):
    master = rosgraph.Master("/test_param")

    def set(self, name, value):
        self.master.setParam(name, value)
        self.addCleanup(self.master.deleteParam, name)

    def check(self, process, node, *expected):
        process.wait_for(
            lambda: last_of(process, node) == says(*expected), f"{node}: {says(*expected)}"
        )

    def test_type_is_double(self):
        path = pathlib.Path(path_of("param_type.launch"))
        text = path.read_text().replace('value="fast"', 'value="fast" type="double"')
        with tempfile.NamedTemporaryFile("w", suffix=".launch") as file:
            file.write(text)
            file.flush()
            with Process("roslaunch", file.name) as roslaunch:
                self.assertEqual(roslaunch.wait(), 1)
        self.assertIn("could not convert string to float: 'fast'", str(roslaunch))

    def run_once(self, name, *arguments):
        """Run the node, and check the speed that it reads: the last of the arguments."""
        *arguments, speed = arguments
        with Process(program(PACKAGE, name), *arguments, extra_env=LIVE) as node:
            self.check(node, "/read_parameters", "nobody", speed, speed)
            self.assertEqual(node.stop(), 0, str(node))

    def test_command_line(self):
        self.set("/read_parameters/speed", 1.5)
        for name in PROGRAMS.values():
            self.run_once(name, "_speed:=4.0", 4.0)
            self.run_once(name, 4.0)
            self.master.setParam("/read_parameters/speed", 1.5)

    def test_without_underscore_py(self):
        self.run_once(PROGRAMS["py"], "speed:=4.0", 1.0)

    def test_without_underscore_cpp(self):
        with Process(program(PACKAGE, PROGRAMS["cpp"]), "speed:=4.0") as node:
            self.assertEqual(node.wait(), -signal.SIGABRT)
        self.assertIn(
            "  what():  Character [4] is not valid as the first character in Graph Resource Name "
            "[4.0].  Valid characters are a-z, A-Z, / and in some cases ~.",
            node.lines,
        )

    def test_missing_py(self):
        code = "import rospy; rospy.init_node('reader'); rospy.get_param('~speed')"
        with Process("/usr/bin/python3", "-c", code) as node:
            self.assertEqual(node.wait(), 1)
        self.assertEqual(node.lines[-1], "KeyError: '~speed'")


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "param", TestParam)
