# SPDX-License-Identifier: BSD-3-Clause
"""Nodes that are to end by themselves, each a program of its own, or a fork of the test.

The fork has loaded rospy already, which is most of a Python node's time. What forks must not have
threads: so the output goes to a file, and nobody reads it before the end.
"""

import multiprocessing
import os
import runpy
import subprocess
import sys
import tempfile

import rospy
from mrp_testing.process import ESCAPES
from mrp_testing.waiting import wait_until


class Whole:
    """A node that is started as a program."""

    def __init__(self, *command):
        self._command = command
        self._output = tempfile.NamedTemporaryFile(mode="r")
        with open(self._output.name, "w") as output:
            self._start(output)

    def _start(self, output):
        self._popen = subprocess.Popen(
            self._command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT
        )
        self._code, self._kill = self._popen.poll, self._popen.kill

    def wait(self):
        """Wait for the end and return the exit code."""
        wait_until(lambda: self._code() is not None, lambda: f"the end of {self}")
        return self._code()

    def lines(self):
        self._output.seek(0)
        return ESCAPES.sub("", self._output.read()).splitlines()

    def close(self):
        if self._code() is None:
            self._kill()
        self._output.close()

    def __str__(self):
        return "--- {}:\n{}\n---".format(" ".join(self._command), "\n".join(self.lines()))


class Forked(Whole):
    """A Python node that is run by a fork of this process."""

    def _start(self, output):
        context = multiprocessing.get_context("fork")
        child = context.Process(target=_run, args=(output, self._command))
        child.start()
        self._code, self._kill = lambda: child.exitcode, child.kill


def _run(output, command):
    os.dup2(output.fileno(), 1)
    os.dup2(output.fileno(), 2)
    # rosunit has put others in their place.
    sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
    sys.argv = list(command)
    rospy.names.reload_mappings(sys.argv)  # rospy has read those of this process
    runpy.run_path(command[0], run_name="__main__")
