#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Keeps a callback busy: what stays in its queue, and from whom?"""

import unittest

import rospy
import rostest
from mrp_testing.lab import PACKAGE, Lab, path_of
from std_msgs.msg import UInt32

LANGUAGES = ("cpp", "py")


class TestSubscriberQueue(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_subscriber_queue")

    def test_subscriber_queue(self):
        with Lab(
            "subscriber_queue.launch",
            path_of("subscriber_queue_shared.launch"),
            path_of("subscriber_queue_buff_size.launch"),
        ) as lab:
            self.check_shared(lab)
            self.check_buff_size(lab)
            for language in LANGUAGES:
                self.check(lab, f"queue_of_1_{language}", [1, 16])
                self.check(lab, f"queue_of_10_{language}", [1, *range(7, 17)])
                self.check(lab, f"unlimited_{language}", list(range(1, 17)))

    def check(self, lab, subscriber, numbers):
        """Check what a subscriber has received, with the last value that there is."""
        values = lab.wait_until_received(f"/subscriber_queue/{subscriber}", 16)
        self.assertEqual(values, list(map(str, numbers)), subscriber)

    def check_shared(self, lab):
        subscriber_cpp, subscriber_py = [
            f"/subscriber_queue_shared/subscriber_{language}" for language in LANGUAGES
        ]
        # rospy: a queue for each publisher, and in each there was room.
        lab.wait_until_received(subscriber_py, 2, 102)
        of_cpp, of_py = [
            lab.values(subscriber_py, f"/subscriber_queue_shared/publisher_{language}")
            for language in LANGUAGES
        ]
        self.assertEqual((of_cpp, of_py), (["1", "2"], ["101", "102"]))

        # roscpp: the value that kept the callback busy, and of the three others the last one.
        lab.wait_for(
            lambda: len(lab.values(subscriber_cpp)) >= 2, f"{subscriber_cpp} has two values"
        )
        publisher = rospy.Publisher("/subscriber_queue_shared/great_topic", UInt32, queue_size=None)
        lab.wait_for(lambda: publisher.get_num_connections() == 2, "the subscribers are connected")
        publisher.publish(1000)  # and this one comes behind all that there was
        first, second, *others = lab.wait_until_received(subscriber_cpp, 1000)
        self.assertIn(first, ("1", "101"))
        self.assertIn(second, ("2", "102"))
        self.assertEqual(others, ["1000"])

    def check_buff_size(self, lab):
        numbers = {}
        for subscriber in ("subscriber_cpp", "default_py", "large_py"):
            values = lab.wait_until_received(
                f"/subscriber_queue_buff_size/{subscriber}", '"10" (100000 bytes)'
            )
            numbers[subscriber] = [int(value.split('"')[1]) for value in values]
        self.assertEqual(numbers["subscriber_cpp"], [1, 10])
        self.assertEqual(numbers["default_py"], list(range(1, 11)))
        # How many one read finds, the kernel decides: not one, but not all of them either.
        large = numbers["large_py"]
        self.assertEqual(large, sorted(set(large)))
        self.assertLess(len(large), 10, large)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "subscriber_queue", TestSubscriberQueue)
