#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks each publisher's first values and its period.

Uses a simulated clock, so nothing is published before everyone is connected. In real time, the
first message may be lost while publisher and subscriber still connect.
"""

import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.clock import TurnedClock
from mrp_testing.nodes import connections_of, run
from mrp_testing.waiting import within
from std_msgs.msg import UInt32

COUNT = 10  # values of each publisher

PATIENCE = 2.0  # seconds of the wall's clock


class TestValues(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_values")

    def subscribe(self, values):
        subscriber = rospy.Subscriber(contract.TOPIC, UInt32, lambda msg: values.append(msg.data))
        self.addCleanup(subscriber.unregister)
        return subscriber

    def check(self, publisher):
        values = []
        subscriber = self.subscribe(values)
        with TurnedClock() as clock, run(publisher) as process:
            process.wait_for(
                lambda: connections_to_test(publisher), "the test's subscriber is connected"
            )
            # The first turn may come before the node hears the clock at all.
            periods = 1
            clock.turn(contract.PERIOD)
            while not within(PATIENCE, lambda: values) and periods < COUNT:
                periods += 1
                clock.turn(contract.PERIOD)
            # From here on: one value a period, not more and not less.
            while len(values) < COUNT:
                count = len(values)
                self.assertLessEqual(count, periods, f"too many: {values}")
                periods += 1
                clock.turn(contract.PERIOD)
                process.wait_for(
                    lambda: len(values) > count,
                    lambda: f"one more value after a period: {values}",
                )
            # What the node makes up for, of the turns that it did not hear, is still to come.
            within(PATIENCE, lambda: len(values) >= periods)
            self.assertLessEqual(len(values), periods, f"too many: {values}")

            # Not latched: a late subscriber hears the next value first, not the last one again.
            late = self.hear_late(publisher, process, subscriber, clock)
        first = contract.FIRST_VALUE[publisher]
        self.assertEqual(values, [first + i * contract.STEP for i in range(len(values))])
        self.assertEqual(late, values[-1] + contract.STEP, "what the late subscriber hears")

    def hear_late(self, publisher, process, subscriber, clock):
        """Return the first value that is heard in one more period, in place of the subscriber."""
        before = connections_to_test(publisher)
        subscriber.unregister()
        late = []
        self.subscribe(late)
        process.wait_for(
            lambda: connections_to_test(publisher) - before, "the late subscriber is connected"
        )
        clock.turn(contract.PERIOD)
        process.wait_for(lambda: late, "the late subscriber hears a value")
        return late[0]

    def test_publisher_cpp(self):
        self.check(contract.PUBLISHER_CPP)

    def test_publisher_py(self):
        self.check(contract.PUBLISHER_PY)


def connections_to_test(publisher):
    """Return the ids of the publisher's own connections to the test's subscriber.

    The subscriber knows of a connection before the publisher does, which until then sends nothing.
    """
    return {
        number
        for number, to, direction, _, topic, *_ in connections_of("/" + publisher.name)
        if (to, direction, topic) == (rospy.get_name(), "o", "/" + contract.TOPIC)
    }


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "values", TestValues)
