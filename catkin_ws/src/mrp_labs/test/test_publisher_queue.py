#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fills a publisher's queue: 5 drops the oldest message, None waits."""

import unittest

import rostest
from mrp_testing.lab import PACKAGE, Lab, path_of

LANGUAGES = ("cpp", "py")
COUNT = 20  # messages that each publisher publishes
QUEUE = 5
MOST_KEPT = {"cpp": QUEUE + 1, "py": 2 * QUEUE}
MEGABYTES = 4  # of each message
# Messages that a connection may hold: far more than were ever seen in one, which is 3.
IN_CONNECTION = 10


class TestPublisherQueue(unittest.TestCase):
    def numbers(self, lab, group, language):
        """Wait for the last value of a publisher; return all that have arrived, as numbers."""
        values = lab.wait_until_received(
            f"/{group}/subscriber_py", text_of(COUNT), publisher=f"/{group}/publisher_{language}"
        )
        numbers = [int(value.split('"')[1]) for value in values]
        self.assertEqual(values, list(map(text_of, numbers)))
        return numbers

    def test_publisher_queue(self):
        with Lab(
            "publisher_queue.launch",
            path_of("publisher_queue_none.launch"),
        ) as lab:
            for language in LANGUAGES:
                self.check_overflow(lab, language)
            self.check_none(lab)

    def check_overflow(self, lab, language):
        numbers = self.numbers(lab, "publisher_queue", language)
        self.assertEqual(numbers, sorted(set(numbers)), language)
        lost = set(range(1, COUNT + 1)) - set(numbers)
        self.assertTrue(lost, language)
        # What comes behind the last loss was in the queue: the newest five. On a busy machine, some
        # more were being sent: in roscpp one, in rospy all that its sending thread took at once.
        kept = COUNT - max(lost)
        self.assertGreaterEqual(kept, QUEUE, f"{language}: {numbers}")
        self.assertLessEqual(kept, MOST_KEPT[language], f"{language}: {numbers}")

    def check_none(self, lab):
        numbers = self.numbers(lab, "publisher_queue_none", "py")
        self.assertEqual(numbers, list(range(1, COUNT + 1)))

        # It published only as fast as the subscriber received.
        received = 0
        published = 0
        for line in list(lab.lines):
            if "/publisher_queue_none/subscriber_py received" in line:
                received += 1
            elif "/publisher_queue_none/publisher_py published" in line:
                published += 1
                self.assertLessEqual(published, received + IN_CONNECTION, str(lab))
        self.assertEqual(published, COUNT)


def text_of(number):
    return f'"{number}" ({MEGABYTES}000000 bytes)'


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "publisher_queue", TestPublisherQueue)
