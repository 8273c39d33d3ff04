#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A late subscriber has lost the first messages; of the cures, only waiting for all is a full one.

Publishers publish three values at once, every two seconds. So the value with which a subscriber
begins says what it has lost: 1 is nothing, 4 or 7 is all that was published before it came, and
3 or 6 is all but the last one of it.
"""

import unittest

import rostest
from mrp_testing.lab import PACKAGE, Lab, path_of

LATE = ("late_cpp", "late_py")
PUBLISHERS = ("publisher_cpp", "publisher_py")


class TestFirstMessage(unittest.TestCase):
    def first(self, lab, group, subscriber):
        """Return the value with which a subscriber begins: [C++ publisher's, Python publisher's].

        Checks that from there on it has lost nothing.
        """
        node = f"/{group}/{subscriber}"
        result = []
        for publisher in PUBLISHERS:
            sender = f"/{group}/{publisher}"

            def values(sender=sender):
                return [int(value) for value in lab.values(node, sender)]

            lab.wait_for(
                lambda values=values: len(values()) >= 6,
                lambda values=values, sender=sender: f"{node} has six of {values()} of {sender}",
            )
            first = values()[0]
            self.assertEqual(values()[:6], list(range(first, first + 6)), f"{sender} to {node}")
            result.append(first)
        return result

    def check_all_lost(self, lab, group):
        for subscriber in LATE:
            for first in self.first(lab, group, subscriber):
                self.assertGreaterEqual(first, 4, f"{group}, {subscriber}")
                self.assertEqual(first % 3, 1, f"{group}, {subscriber} begins with {first}")

    def check_all_lost_but_one(self, lab, group):
        for subscriber in LATE:
            for first in self.first(lab, group, subscriber):
                self.assertEqual(first % 3, 0, f"{group}, {subscriber} begins with {first}")

    def check_bursts_of_three(self, lab, publisher):
        def bursts():
            return [text for text in lab.logged(publisher) if text.startswith("published ")]

        lab.wait_for(lambda: len(bursts()) >= 2, f"{publisher} publishes twice")
        self.assertEqual(bursts()[:2], ["published 1 to 3", "published 4 to 6"], publisher)

    def test_loss_and_cures(self):
        with Lab(
            "first_message_lost.launch",
            path_of("first_message_latch.launch"),
            path_of("first_message_connect.launch"),
            path_of("first_message_wait_for_one.launch"),
            path_of("first_message_wait_for_all.launch"),
        ) as lab:
            for publisher in PUBLISHERS:
                self.check_bursts_of_three(lab, f"/first_message_lost/{publisher}")
            self.check_all_lost(lab, "first_message_lost")
            self.check_all_lost_but_one(lab, "first_message_latch")
            self.check_all_lost_but_one(lab, "first_message_connect")
            self.check_all_lost(lab, "first_message_wait_for_one")
            self.assertEqual(self.first(lab, "first_message_wait_for_one", "early_cpp"), [1, 1])
            for subscriber in ("early_cpp", *LATE):
                first = self.first(lab, "first_message_wait_for_all", subscriber)
                self.assertEqual(first, [1, 1], subscriber)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "first_message", TestFirstMessage)
