#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The last message of each latching publisher awaits late subscribers, for as long as it runs."""

import unittest

import rospy
import rostest
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab, path_of
from mrp_testing.process import Process
from std_msgs.msg import UInt32

SUBSCRIBERS = ("subscriber_cpp", "subscriber_py")
PUBLISHERS = ("publisher_cpp", "publisher_py")


class TestLatch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_latch")

    def test_latch(self):
        with Lab(
            "latch.launch", path_of("latch_restart.launch"), path_of("latch_end.launch")
        ) as lab:
            # Whatever a subscriber has received: 1 and 101 are of the lab, 1000 of this test.
            self.expect(lab, "latch_restart", [1, 101])
            self.expect(lab, "latch_end", [1, 101])

            # Subscribers are restarted; publishers end for good.
            kill(latch_restart=SUBSCRIBERS, latch_end=PUBLISHERS)
            self.expect(lab, "latch_restart", [1, 1, 101, 101])
            topic = "/latch_end/great_topic"
            lab.wait_for(lambda: topic not in Graph().publishers, "the publishers have ended")

            # Publishers are restarted. A new one, there, brings what is behind those that ended.
            other = rospy.Publisher(topic, UInt32, latch=True, queue_size=1)
            other.publish(1000)
            self.expect(lab, "latch_end", [1, 101, 1000])
            kill(latch_restart=PUBLISHERS, latch_end=SUBSCRIBERS)
            self.expect(lab, "latch_restart", [1, 1, 1, 101, 101, 101])
            self.expect(lab, "latch_end", [1, 101, 1000, 1000])

            for subscriber in SUBSCRIBERS:
                for language in ("cpp", "py"):
                    # The last one of three: two publishers latch, so there are two of them.
                    first = self.first(lab, subscriber, f"/latch/latched_{language}")
                    self.assertEqual(first % 3, 0, f"{subscriber} begins with {first}")
                    # The first one of the next three: nothing that was published before.
                    first = self.first(lab, subscriber, f"/latch/unlatched_{language}")
                    self.assertEqual(first % 3, 1, f"{subscriber} begins with {first}")
                    self.assertGreaterEqual(first, 4, subscriber)

    def expect(self, lab, group, values):
        """Wait until each subscriber of a group has received so many values, and check them."""
        for subscriber in SUBSCRIBERS:
            node = f"/{group}/{subscriber}"
            lab.wait_for(
                lambda node=node: len(lab.values(node)) >= len(values),
                lambda node=node: f"{node} received {values}, not {lab.values(node)}",
            )
            self.assertEqual(sorted(map(int, lab.values(node))), values, f"{node}\n{lab}")

    def first(self, lab, subscriber, publisher):
        """Return the value with which a subscriber begins. Checks that the next ones follow it."""
        node = f"/latch/{subscriber}"

        def values():
            return [int(value) for value in lab.values(node, publisher)]

        lab.wait_for(lambda: len(values()) >= 4, f"{node} has four values of {publisher}")
        first = values()[0]
        self.assertEqual(values()[:4], list(range(first, first + 4)), f"{publisher} to {node}")
        return first


def kill(**groups):
    """End nodes of several groups as a student does: by rosnode."""
    nodes = [f"/{group}/{name}" for group, names in groups.items() for name in names]
    with Process("rosnode", "kill", *nodes) as rosnode:
        code = rosnode.wait()
    assert code == 0, f"exit code {code} of {rosnode}"


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "latch", TestLatch)
