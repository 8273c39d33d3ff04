#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A subscriber's queue while its callback is busy: what is kept, for whom, and what 0 means."""

import unittest

import rospy
import rostest
from mrp_testing.lab import PACKAGE, Lab, path_of
from mrp_testing.proves import proves
from std_msgs.msg import UInt32

LANGUAGES = ("cpp", "py")


class TestSubscriberQueue(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_subscriber_queue")

    @proves(
        "The queue holds messages that arrive while the callback is still busy.",
        "In Python, a subscriber has a queue for each publisher of the topic.",
        "In C++, all publishers of the topic share one queue.",
        "A message can wait in two queues, and each has its own size: at the publisher until it "
        "is sent, and at the subscriber until the callback is free.",
        "When it is full, it drops the oldest message.",
        "In this lab one message keeps each callback busy while 15 more arrive.",
        "The lab's Python subscribers receive the same numbers.",
        "In C++ it is the size 0.",
        "In Python it is None, and 0 is an error.",
        "A C++ subscriber has one queue for all publishers of the topic: with a size of 1, a "
        "message of one publisher pushes out a message of the other.",
        "A Python subscriber has a queue for each publisher.",
        "The queue size counts only within one read.",
        "So when messages are larger, all the old ones arrive, too, even with a size of 1.",
        "When buff_size is larger than several messages, a queue of 1 drops old ones again.",
        "A full queue drops its oldest message.",
        "A C++ subscriber has one queue for all publishers; a Python subscriber has one for each.",
        "0 and None have special meanings.",
        "The size is 1: such a queue keeps only the newest message.",
        "In Python it is not enough for large pictures: buff_size must have room for several of "
        "them, too.",
        "The subscriber's queue of 10 keeps only the newest of that burst.",
        "The node's queue keeps 10 of them, and rostopic echo has a queue without a limit.",
        "With a queue of 10, the newest ten numbers of a publisher wait while the callback is "
        "busy.",
        "So it prints runs of up to 10 numbers of each publisher, with a gap before each run.",
        "With a queue of 1, it prints the newest number each time (queues).",
        "In roscpp, all publishers of a topic share the subscriber's one queue.",
        "A subscriber's queue of 0 has no limit in C++, and is an error in Python.",
        "This is not always true.",
        "In rospy each connection has a queue of its own.",
        "Old messages that do not fit into one read of buff_size bytes still arrive.",
        "While a callback is busy, a subscriber's queue keeps the newest messages: 1, 10, or all "
        "of them.",
        "In rospy, a queue of 1 drops only messages that came in the same read; a read takes up "
        "to buff_size bytes.",
        "A C++ subscriber has one queue for both publishers and loses messages; a Python "
        "subscriber has one queue for each.",
        "A subscriber's queue_size of 0 means no limit in C++, and is an error in Python.",
    )
    def test_subscriber_queue(self):
        with Lab(
            "subscriber_queue.launch",
            path_of("subscriber_queue_shared.launch"),
            path_of("subscriber_queue_buff_size.launch"),
            path_of("subscriber_queue_zero.launch"),
        ) as lab:
            self.check_shared(lab)
            self.check_buff_size(lab)
            self.check_zero(lab)
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

    def check_zero(self, lab):
        node = "/subscriber_queue_zero/subscriber_py"
        said = f"{node}: queue size may not be set to zero"
        lab.wait_for(lambda: lines_with(lab, said), f"{node} says what is wrong")
        died = "[subscriber_queue_zero/subscriber_py-"
        lab.wait_for(
            lambda: [line for line in lines_with(lab, died) if "exit code 1," in line],
            f"{node} ends with exit code 1",
        )
        self.assertEqual(lab.received(node), [])
        # The other one is as good as any.
        values = lab.wait_for_count("/subscriber_queue_zero/subscriber_cpp", 10)
        numbers = list(map(int, values))
        self.assertEqual(numbers, list(range(numbers[0], numbers[-1] + 1)))


def lines_with(lab, text):
    return [line for line in list(lab.lines) if text in line]


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "subscriber_queue", TestSubscriberQueue)
