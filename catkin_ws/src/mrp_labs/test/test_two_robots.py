#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Groups keep two robots apart; a hard-coded global name mixes them."""

import unittest

import rostest
from lab import PACKAGE, Lab

ROBOTS = ("/robot1", "/robot2")
LANGUAGES = ("cpp", "py")
PUBLISHERS = [f"{robot}/publisher_{language}" for robot in ROBOTS for language in LANGUAGES]
SUBSCRIBERS = [f"{robot}/subscriber_{language}" for robot in ROBOTS for language in LANGUAGES]


class TestTwoRobots(unittest.TestCase):
    def check(self, lab, expected_publishers):
        """Check whom each subscriber hears, once it has heard the sixth value of each of them."""
        for subscriber in SUBSCRIBERS:
            expected = expected_publishers(subscriber)
            for publisher in expected:
                values = lab.wait_until_received(subscriber, 6, publisher=publisher)
                # The first ones may be lost, none between them.
                numbers = list(map(int, values))
                self.assertEqual(numbers, list(range(numbers[0], numbers[-1] + 1)), subscriber)
            heard = {received.publisher for received in lab.received(subscriber)}
            self.assertEqual(sorted(heard), sorted(expected), subscriber)

    def test_groups_keep_the_robots_apart(self):
        with Lab("two_robots.launch") as lab:
            self.check(lab, lambda subscriber: robot_of(subscriber, PUBLISHERS))

    def test_a_hard_coded_global_name_mixes_them(self):
        with Lab("two_robots.launch", "topic:=/great_topic") as lab:
            self.check(lab, lambda subscriber: PUBLISHERS)


def robot_of(node, others):
    """Return those of the others that are the same robot's as the node."""
    return [other for other in others if other.split("/")[1] == node.split("/")[1]]


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "two_robots", TestTwoRobots)
