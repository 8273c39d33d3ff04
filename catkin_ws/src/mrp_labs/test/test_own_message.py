#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""mrp_labs/Count from each language to each, and what its header's stamp tells."""

import re
import unittest

import rospy
import rostest
from mrp_labs.msg import Count
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.waiting import DEADLINE

SUBSCRIBERS = ("/own_message/subscriber_cpp", "/own_message/subscriber_py")
LANGUAGES = {"/own_message/publisher_cpp": "C++", "/own_message/publisher_py": "Python"}
ENOUGH = 5  # messages of each publisher
AGE = 1000.0  # seconds: of a message that nothing but its stamp can make so old


def parts(value):
    """Return counter, language and latency in milliseconds of what a subscriber has printed."""
    match = re.fullmatch(r"(\d+), counted in (\S+), sent (-?\d+\.\d) ms ago", value)
    return int(match[1]), match[2], float(match[3])


class TestOwnMessage(unittest.TestCase):
    def test_from_each_language_to_each(self):
        with Lab("own_message.launch") as lab:
            for subscriber in SUBSCRIBERS:
                for publisher, language in LANGUAGES.items():
                    lab.wait_for(
                        lambda: len(lab.values(subscriber, publisher)) >= ENOUGH,
                        f"{ENOUGH} messages of {publisher} at {subscriber}",
                    )
                    messages = [parts(value) for value in lab.values(subscriber, publisher)]
                    counters = [counter for counter, _, _ in messages]
                    # The first ones may be lost, none between them.
                    first = counters[0]
                    self.assertEqual(counters, list(range(first, first + len(counters))))
                    self.assertEqual({language for _, language, _ in messages}, {language})
                    for _, _, latency in messages:
                        self.assertTrue(0 <= latency <= DEADLINE * 1000, latency)

            rospy.init_node("test_own_message")
            publisher = rospy.Publisher("/own_message/count", Count, queue_size=1)
            lab.wait_for(
                lambda: publisher.get_num_connections() == len(SUBSCRIBERS), "both are connected"
            )
            old = Count(counter=2**32 - 1, language="none")
            old.header.stamp = rospy.Time.now() - rospy.Duration(AGE)
            publisher.publish(old)
            for subscriber in SUBSCRIBERS:
                lab.wait_for(
                    lambda: lab.values(subscriber, rospy.get_name()), f"it is at {subscriber}"
                )
                (value,) = lab.values(subscriber, rospy.get_name())
                counter, language, latency = parts(value)
                self.assertEqual((counter, language), (2**32 - 1, "none"), subscriber)
                self.assertGreaterEqual(latency, AGE * 1000)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "own_message", TestOwnMessage)
