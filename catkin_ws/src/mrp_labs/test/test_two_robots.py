#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Groups keep two robots apart; a hard-coded global name mixes them."""

import unittest

import rostest
from mrp_testing.lab import PACKAGE, Lab

ROBOTS = ("/robot1", "/robot2")
LANGUAGES = ("cpp", "py")
PUBLISHERS = [f"{robot}/publisher_{language}" for robot in ROBOTS for language in LANGUAGES]
SUBSCRIBERS = [f"{robot}/subscriber_{language}" for robot in ROBOTS for language in LANGUAGES]

ENOUGH = 3  # values that show that a publisher is heard by now, or would be


class TestTwoRobots(unittest.TestCase):
    def check(self, lab, asked, resolved, publishers_of):
        """Check what each robot's nodes print about their topic, and whom each subscriber hears.

        asked: the topic's name that the nodes ask for, the same for both robots
        resolved: robot -> the topic's full name
        publishers_of: subscriber -> the publishers that it hears
        """
        for subscriber in SUBSCRIBERS:
            for publisher in publishers_of(subscriber):
                values = lab.wait_for_count(subscriber, ENOUGH, publisher)
                # The first ones may be lost, none between them.
                numbers = list(map(int, values))
                self.assertEqual(numbers, list(range(numbers[0], numbers[-1] + 1)), subscriber)
        # Only now does each publisher publish to all who hear it.
        for subscriber in SUBSCRIBERS:
            heard = {received.publisher for received in lab.received(subscriber)}
            self.assertEqual(sorted(heard), sorted(publishers_of(subscriber)), subscriber)

        for robot in ROBOTS:
            for node in robot_of(robot, PUBLISHERS + SUBSCRIBERS):
                topic = f"on {resolved(robot)}"
                if node in SUBSCRIBERS:
                    topic = f"to {resolved(robot)}, expects std_msgs/UInt32"
                text = lab.logged(node)[0]
                self.assertTrue(text.endswith(f'{topic} (asked for "{asked}")'), text)

    def test_groups_keep_the_robots_apart(self):
        with Lab("two_robots.launch") as lab:
            self.check(
                lab,
                "great_topic",
                lambda robot: robot + "/great_topic",
                lambda subscriber: robot_of(subscriber, PUBLISHERS),
            )

    def test_a_hard_coded_global_name_mixes_them(self):
        with Lab("two_robots.launch", "topic:=/great_topic") as lab:
            self.check(
                lab, "/great_topic", lambda robot: "/great_topic", lambda subscriber: PUBLISHERS
            )


def robot_of(node, others):
    """Return those of the others that are the same robot's as the node, or that robot's."""
    return [other for other in others if other.split("/")[1] == node.split("/")[1]]


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "two_robots", TestTwoRobots)
