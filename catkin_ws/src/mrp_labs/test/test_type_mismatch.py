#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Subscribes with another type: the publishers refuse it, and the others keep running."""

import re
import unittest

import rospy
import rostest
from mrp_testing.lab import PACKAGE, Lab
from std_msgs.msg import Int32

PUBLISHERS = ("/mismatch/publisher_cpp", "/mismatch/publisher_py")
SUBSCRIBERS = ("/mismatch/subscriber_cpp", "/mismatch/subscriber_py")
OTHERS = ("/mismatch/other_subscriber_cpp", "/mismatch/other_subscriber_py")
TOPIC = "/mismatch/great_topic"

INT32 = "std_msgs/Int32/da5909fbe378aeaf85e547e830cc1bb7"
UINT32 = "std_msgs/UInt32/304a39449588c7f8ce2df6e8001c5fce"


class TestTypeMismatch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_type_mismatch")

    def test_other_type(self):
        with Lab("type_mismatch.launch") as lab:
            for other in OTHERS:
                for refusals in (cpp_refusals, py_refusals):
                    lab.wait_for(lambda: refusals(lab, other), f"{refusals.__name__} of {other}")
            self.check_flow(lab, SUBSCRIBERS, 7)
            for other in OTHERS:
                self.assertEqual(lab.received(other), [])
                # Not repeated as time goes by: a subscriber only tries again when the publishers
                # of the topic change, here as the second one of the two comes.
                self.assertLessEqual(len(cpp_refusals(lab, other)), 2, str(lab))
                self.assertLessEqual(len(py_refusals(lab, other)), 2, str(lab))

            # Nobody but the publishers says so.
            printed = {line for line in list(lab.lines) if re.match(r"\[ ?(WARN|ERROR)\]", line)}
            refused = (cpp_refusals(lab, other) + py_refusals(lab, other) for other in OTHERS)
            self.assertLessEqual(printed, set().union(*refused))

            # A publisher of the other type, on the same topic: those who expect it hear it, so they
            # were there all the time, and nobody else does.
            before = len(cpp_refusals(lab, OTHERS[0]))
            publisher = rospy.Publisher(TOPIC, Int32, queue_size=1, latch=True)
            publisher.publish(-7)
            for other in OTHERS:
                lab.wait_until_received(other, -7)
                received = [(message.value, message.publisher) for message in lab.received(other)]
                self.assertEqual(received, [("-7", rospy.get_name())], other)
            lab.wait_for(
                lambda: len(cpp_refusals(lab, OTHERS[0])) > before,
                f"as the publishers have changed, {OTHERS[0]} tries again, and is refused again",
            )
            most = max(len(lab.values(s, p)) for s in SUBSCRIBERS for p in PUBLISHERS)
            self.check_flow(lab, SUBSCRIBERS, most + 3)
            publisher.unregister()

    def check_flow(self, lab, subscribers, count):
        """Check that each subscriber hears that many values of both publishers without a gap, and
        nobody else."""
        for subscriber in subscribers:
            for publisher in PUBLISHERS:
                values = lab.wait_for_count(subscriber, count, publisher)
                # The first ones may be lost, none between them.
                numbers = list(map(int, values))
                self.assertEqual(numbers, list(range(numbers[0], numbers[-1] + 1)), subscriber)
            heard = {received.publisher for received in lab.received(subscriber)}
            self.assertEqual(sorted(heard), sorted(PUBLISHERS), subscriber)


def cpp_refusals(lab, subscriber):
    """Return the lines in which roscpp's publisher refuses a subscriber."""
    text = (
        f"Client [{subscriber}] wants topic {TOPIC} to have datatype/md5sum [{INT32}], "
        f"but our version has [{UINT32}]. Dropping connection."
    )
    return [line for line in list(lab.lines) if line.startswith("[ERROR]") and text in line]


def py_refusals(lab, subscriber):
    """Return the lines in which rospy's publisher refuses a subscriber."""
    text = (
        "Could not process inbound connection: "
        "topic types do not match: [std_msgs/Int32] vs. [std_msgs/UInt32]"
    )
    return [
        line
        for line in list(lab.lines)
        if line.startswith("[WARN]") and text in line and f"'callerid': '{subscriber}'" in line
    ]


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "type_mismatch", TestTypeMismatch)
