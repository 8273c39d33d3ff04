#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""After one value that rospy refuses, Python subscribers hear no more of that publisher.

rospy leaves four bytes of the refused message in its buffer, a message of length 0, and sends them
with the next one. A rospy subscriber drops its connection for that, and fails to make another one;
a roscpp subscriber logs an error, and goes on.
"""

import unittest

import rosgraph
import rostest
from mrp_testing.lab import PACKAGE, Lab


class TestRefusedValue(unittest.TestCase):
    def test_refused(self):
        with Lab("refused_value.launch") as lab:
            # To the second value that is refused, and past it.
            wait_for_values(lab, "/refused/subscriber_cpp", "1", "2", "4", "5", "1", "2", "4")
            self.assertEqual(lab.values("/refused/subscriber_py"), ["1", "2"])
            self.assertEqual(
                lab.logged("/refused/publisher_py", levels=["ERROR"])[:2],
                [
                    "cannot publish 256: ROSSerializationException: "
                    "field data exceeds specified width [uint8]"
                ]
                * 2,
            )
            # An error comes through another pipe than what the callback prints.
            lab.wait_for(lambda: len(overruns(lab)) >= 2, "two errors of the C++ subscriber")
            self.assertEqual(
                overruns(lab)[:2],
                [
                    "Exception thrown when deserializing message of length [0] "
                    "from [/refused/publisher_py]: Buffer Overrun"
                ]
                * 2,
            )

    def test_nothing_refused(self):
        with Lab("refused_value.launch", "third:=3") as lab:
            for subscriber in ("/refused/subscriber_cpp", "/refused/subscriber_py"):
                wait_for_values(lab, subscriber, "1", "2", "3", "4", "5", "1")
            self.assertEqual(lab.logged("/refused/publisher_py", levels=["ERROR"]), [])
        # What comes next at its address is no business of the master's.
        with self.assertRaises(rosgraph.MasterError):
            rosgraph.Master("/test").lookupNode("/refused/subscriber_py")


def overruns(lab):
    return [line.split("]: ", 1)[1] for line in list(lab.lines) if "Buffer Overrun" in line]


def wait_for_values(lab, subscriber, *wanted):
    """Wait until what a subscriber has received begins with these values."""
    lab.wait_for(
        lambda: lab.values(subscriber)[: len(wanted)] == list(wanted),
        lambda: f"{wanted} at {subscriber}, not {lab.values(subscriber)}",
    )


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "refused_value", TestRefusedValue)
