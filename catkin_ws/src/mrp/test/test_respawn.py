#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills one node, which roslaunch restarts: between the others, no value is lost."""

import os
import signal
import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.listener import Listener, describe
from mrp_testing.nodes import pid_of
from mrp_testing.waiting import wait_until

ENOUGH = 5  # values of each publisher, before the kill and after the return


class TestRespawn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_respawn")

    def check(self, victim):
        listener = Listener(contract.GROUP)
        self.addCleanup(listener.close)
        listener.wait_until_each_received(ENOUGH)

        name = listener.full_name(victim)
        pid = pid_of(name)
        before = {pair: len(values) for pair, values in listener.all_received().items()}
        os.kill(pid, signal.SIGKILL)

        # A value that was under way when the node died may still come in after `before`;
        # one more than ENOUGH is therefore certain to have been received after the return.
        wait_until(lambda: pid_of(name) not in (None, pid), name + " is back")
        wait_until(
            lambda: all(
                len(values) > before[pair] + ENOUGH and len(contract.runs(values)[-1]) >= ENOUGH
                for pair, values in listener.all_received().items()
            ),
            lambda: f"values after the return: {describe(listener.all_received())}",
        )
        for pair, values in listener.all_received().items():
            runs = len(contract.runs(values))
            if victim in pair:
                self.assertLessEqual(runs, 2, describe({pair: values}))
            else:
                self.assertEqual(runs, 1, describe({pair: values}))

    def test_publisher_cpp(self):
        self.check(contract.PUBLISHER_CPP)

    def test_publisher_py(self):
        self.check(contract.PUBLISHER_PY)

    def test_subscriber_cpp(self):
        self.check(contract.SUBSCRIBER_CPP)

    def test_subscriber_py(self):
        self.check(contract.SUBSCRIBER_PY)


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "respawn", TestRespawn)
