#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finds out which thread runs each callback, and what a slow one holds up."""

import re
import unittest

import rostest
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import pid_of

CPP, PY = "/threads/publisher_cpp", "/threads/publisher_py"
PUBLISHERS = (CPP, PY)
POOLS = ("multi", "async")
ENOUGH = 4  # messages of each publisher


def threads(lab, subscriber, *publishers):
    """Return the threads in which a subscriber was called back for these publishers."""
    received = lab.received("/threads/subscriber_" + subscriber)
    return {int(message.thread) for message in received if message.publisher in publishers}


def overlaps(lab, subscriber):
    """Return who was in a subscriber's callback together, such as {("C++", "Python")}."""
    inside, result = {}, set()
    for text in lab.logged("/threads/subscriber_" + subscriber):
        match = re.fullmatch(r"(received|finished) (\d+)( from \S+)? in thread (\d+)", text)
        if match and match[1] == "received":
            # Even numbers are of C++, odd ones of Python.
            inside[match[4]] = "Python" if int(match[2]) % 2 else "C++"
            if len(inside) > 1:
                result.add(tuple(sorted(inside.values())))
        elif match:
            del inside[match[4]]  # a KeyError: what has finished in this thread did not begin in it
    return result


class TestThreads(unittest.TestCase):
    def test_in_which_thread(self):
        with Lab("threads.launch") as lab:
            for subscriber in ("py", "spin", *POOLS):
                for publisher in PUBLISHERS:
                    lab.wait_for_count("/threads/subscriber_" + subscriber, ENOUGH, publisher)
            main = {name: pid_of("/threads/subscriber_" + name) for name in ("py", "spin", *POOLS)}

        # rospy: a thread for each connection, and none of them the main one.
        of_each = [threads(lab, "py", publisher) for publisher in PUBLISHERS]
        self.assertEqual([len(numbers) for numbers in of_each], [1, 1], of_each)
        self.assertEqual(len({main["py"]}.union(*of_each)), 3, of_each)
        # spin: the main one for all.
        self.assertEqual(threads(lab, "spin", *PUBLISHERS), {main["spin"]})
        # The others: any of their two, of which none is the main one.
        for pool in POOLS:
            self.assertIn(len(threads(lab, pool, *PUBLISHERS)), (1, 2), pool)
            self.assertNotIn(main[pool], threads(lab, pool, *PUBLISHERS), pool)

    def check_overlaps(self, lab, expected):
        """Check who is in each subscriber's callback together, when each has received enough."""
        for subscriber, together in expected.items():
            for publisher in PUBLISHERS:
                lab.wait_for(
                    lambda: (
                        len(lab.values("/threads/subscriber_" + subscriber, publisher)) >= ENOUGH
                    ),
                    f"{ENOUGH} values of {publisher} at {subscriber}",
                )
            lab.wait_for(
                lambda: together <= overlaps(lab, subscriber), f"{together} in {subscriber}"
            )
        for subscriber, together in expected.items():
            self.assertEqual(overlaps(lab, subscriber), together, subscriber)

    def test_slow_callbacks_of_two_topics(self):
        both = {("C++", "Python")}
        with Lab("threads_blocking.launch") as lab:
            self.check_overlaps(lab, {"spin": set(), "multi": both, "async": both, "py": both})
            for pool in POOLS:
                self.assertEqual(len(threads(lab, pool, *PUBLISHERS)), 2, pool)

    def test_slow_callbacks_of_one_topic(self):
        both = {("C++", "Python")}
        with Lab("threads_blocking.launch", "second_topic:=great_topic") as lab:
            self.check_overlaps(lab, {"spin": set(), "multi": set(), "async": set(), "py": both})
            # Here two of one publisher may be there too, when the node is late.
            lab.wait_for(lambda: both <= overlaps(lab, "concurrent"), f"{both} in concurrent")


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "threads", TestThreads)
