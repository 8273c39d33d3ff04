#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Which lines does a node show, and where? And when are there too many log files?"""

import os
import pathlib
import re
import signal
import sys
import tempfile
import unittest

import rosgraph
import rospkg
import rostest
from mrp_testing import log_line
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import within

DECIMALS = {"py": 6, "cpp": 9}  # of the time in a line: so each shows its language
LOGGERS = {"py": "rosout", "cpp": "ros.mrp_labs"}
ALWAYS = {"INFO", "WARN", "ERROR", "FATAL"}
PREFIXES = {
    "py": [{"[INFO]", "[WARN]", "[ERROR]", "[FATAL]"}],
    "cpp": [{"[ INFO]", "[ WARN]", "[ERROR]", "[FATAL]"}],
}
PREFIXES["cpp"] += PREFIXES["py"]  # from Debian 14 on
GIGABYTE = 2**30
STILL = 1.0  # seconds
IN_A_PIPE = 2000  # lines: more than wait to be read
LOGS = (
    "import rospy; rospy.init_node('logs')\nwhile not rospy.is_shutdown(): rospy.loginfo('a line')"
)


def of_language(lines, language):
    """Return the lines that the node of a language has logged."""
    begin = re.compile(rf"\[[ A-Z]+\] \[\d+\.\d{{{DECIMALS[language]}}}\]: ")
    return [line for line in list(lines) if begin.match(line)]


def levels(lines, language):
    """Return the levels of what the node of a language has logged."""
    return {log_line.parse(line).level for line in of_language(lines, language)}


def prefixes(lines, language):
    return {line[: line.index("]") + 1] for line in of_language(lines, language)}


def run(*command, env=None):
    with Process(*command, extra_env=env) as process:
        return process.wait()


def still(process):
    """Return whether a process prints nothing for a while."""
    count = len(process.lines)
    return not within(STILL, lambda: len(process.lines) > count)


class TestLog(unittest.TestCase):
    def check(self, language):
        node = f"/log_levels/levels_{language}"
        with Lab("log_levels.launch") as lab:
            lab.wait_for(lambda: levels(lab.lines, language) >= ALWAYS, "each level but one")
            self.assertEqual(levels(lab.lines, language), ALWAYS)
            self.assertIn(prefixes(lab.lines, language), PREFIXES[language])
            self.assertEqual(levels(lab.errors, language), ALWAYS - {"INFO"})
            setting = (f"{node}/set_logger_level", LOGGERS[language], "debug")
            self.assertEqual(run("rosservice", "call", *setting), 0)
            lab.wait_for(lambda: "DEBUG" in levels(lab.lines, language), "a debug line")
            self.assertNotIn("DEBUG", levels(lab.errors, language))
            count = sum("a debug line" in line for line in list(lab.lines))
            lab.wait_for(
                lambda: sum("a debug line" in line for line in list(lab.lines)) > count, "another"
            )
            for text in ("once", "at most once an hour"):
                found = [line for line in log_line.texts(lab.lines) if line == text]
                self.assertEqual(len(found), len(LOGGERS), str(lab))

    def test_levels_py(self):
        self.check("py")

    def test_levels_cpp(self):
        self.check("cpp")

    def test_log_files(self):
        with tempfile.TemporaryDirectory() as folder:
            env = {"ROS_LOG_DIR": folder}
            with open(os.path.join(folder, "old.log"), "w") as file:
                file.truncate(2 * GIGABYTE)  # it takes no space
            with Lab("log_levels.launch", extra_env=env) as lab:
                warning = f"WARNING: disk usage in log directory [{folder}] is over 1GB."
                lab.wait_for(lambda: warning in lab.lines, warning)
                for language in LOGGERS:
                    lab.wait_for(lambda: levels(lab.lines, language), "the nodes run")
            written = " ".join(path.name for path in pathlib.Path(folder).glob("*/*.log"))
            self.assertRegex(written, r"\blog_levels-levels_py-.*")
            self.assertRegex(written, r"\broslaunch-.*")
            self.assertTrue(os.path.exists(os.path.join(folder, "old.log")))
            self.assertEqual(rospkg.get_log_dir(env={}), os.path.expanduser("~/.ros/log"))
            self.assertEqual(run("rosclean", "purge", "-y", env=env), 0)
            self.assertFalse(os.path.exists(os.path.join(folder, "old.log")))

    def test_ctrl_c_in_a_log_call(self):
        self.press_ctrl_c(LOGS, asks_each_time=True, ends=False)
        self.press_ctrl_c(LOGS, asks_each_time=False, ends=True)
        in_callbacks = LOGS.replace("while not rospy.is_shutdown(): ", "def log(_): ")
        in_callbacks += "\nrospy.Timer(rospy.Duration(0.01), log); rospy.spin()"
        self.press_ctrl_c(in_callbacks, asks_each_time=True, ends=True)

    def press_ctrl_c(self, program, asks_each_time, ends):
        """Press Ctrl-C while a line of log may wait for the master, and see whether it ends."""
        port = free_port()
        env = {**LIVE, "ROS_MASTER_URI": uri_of(port)}
        with master(port) as core:
            if not asks_each_time:
                name = "/rosout_disable_topics_generation"
                rosgraph.Master("/test", uri_of(port)).setParam(name, False)
            with Process(sys.executable, "-c", program, extra_env=env) as node:
                node.wait_for(lambda: len(node.lines) > 2, "lines")
                os.kill(core.pid, signal.SIGSTOP)
                if asks_each_time:
                    # What it has written before is read first.
                    node.wait_for(lambda: still(node), "a line waits for the master")
                else:
                    more = len(node.lines) + IN_A_PIPE
                    node.wait_for(lambda: len(node.lines) > more, "no line waits for the master")
                os.kill(node.pid, signal.SIGINT)
                os.kill(core.pid, signal.SIGCONT)
                if ends:
                    self.assertEqual(node.wait(), 0)
                    return
                for again in (signal.SIGINT, signal.SIGKILL):
                    self.assertFalse(within(STILL, lambda: node.code is not None), str(node))
                    os.kill(node.pid, again)
                node.wait()


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "log", TestLog)
