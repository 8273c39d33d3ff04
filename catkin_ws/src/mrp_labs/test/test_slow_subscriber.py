#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Publishes to a fast and a slow subscriber: with a queue for each, or no limit, or no queue."""

import contextlib
import os
import pathlib
import re
import signal
import unittest

import rospy
import rostest
from mrp_testing.clock import TurnedClock
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import connections_of, program
from mrp_testing.process import Process
from mrp_testing.waiting import wait_until, within
from std_msgs.msg import String

COUNT = 20  # messages that each publisher publishes
QUEUE = 5
MEGABYTES = 4  # of each message
# Seconds of the simulated clock: a turn brings a message, however the sums are rounded.
PERIOD = 0.95
TURN = 1.0
BLOCKED = 1.0  # seconds: much longer than a message takes


class TestSlowSubscriber(unittest.TestCase):
    """A publisher with two subscribers: this test is one, and the other one stands still.

    This test is the publisher's clock, too: it lets it publish when the message before is here.
    """

    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_slow_subscriber")

    def start(self, executable, name, *parameters):
        names = (f"__name:={self.topic}_{name}", f"_topic:=/{self.topic}")
        process = Process(program(PACKAGE, executable), *names, *parameters)
        return self.stack.enter_context(process)

    @contextlib.contextmanager
    def publisher(self, executable, queue_size):
        """Start a publisher and both its subscribers; the slow one stands still."""
        self.topic = executable.split(".")[0] + str(queue_size)
        self.numbers = []  # that this test has received
        subscriber = rospy.Subscriber(f"/{self.topic}", String, self.receive)
        with contextlib.ExitStack() as self.stack:
            self.stack.callback(subscriber.unregister)
            self.clock = self.stack.enter_context(TurnedClock())
            values = {"size": f"{MEGABYTES}000000", "count": COUNT, "queue_size": queue_size}
            values.update(period=PERIOD, wait_for_subscribers=2)
            options = [f"_{name}:={value}" for name, value in values.items()]
            self.fair = self.start(executable, "fair", *options)
            self.slow = self.start("lab_subscriber_py_node.py", "slow", "_type:=std_msgs/String")
            fair, slow, this = f"/{self.topic}_fair", f"/{self.topic}_slow", rospy.get_name()
            self.fair.wait_for(lambda: connected(fair, self.topic) >= {slow, this}, "the topic")
            self.clock.begin(self.fair, 2, TURN, lambda: self.numbers)
            self.before = megabytes(self.fair.pid)
            os.kill(self.slow.pid, signal.SIGSTOP)
            self.stack.callback(os.kill, self.slow.pid, signal.SIGCONT)
            yield

    def receive(self, msg):
        self.numbers.append(int(msg.data))

    def more(self):
        """Let the publisher publish once more; return whether its number comes."""
        before = len(self.numbers)
        self.clock.turn(TURN)
        return within(BLOCKED, lambda: len(self.numbers) > before)

    def receive_all(self):
        """Let the publisher publish until this test has all numbers."""

        def step():
            self.more()
            return len(self.numbers) >= COUNT

        wait_until(step, lambda: f"{COUNT} numbers, not only {self.numbers}")

    def received_by_slow(self):
        """Return all that the slow subscriber has received, once it has the last number."""

        def numbers():
            found = re.findall(r'received "(\d+)"', "\n".join(self.slow.lines))
            return list(map(int, found))

        self.slow.wait_for(lambda: COUNT in numbers(), lambda: f"{COUNT} in {numbers()}")
        return numbers()

    def check_only_the_slow_one_loses(self, executable):
        with self.publisher(executable, QUEUE):
            self.receive_all()
            self.assertEqual(self.numbers, list(range(1, COUNT + 1)))
            os.kill(self.slow.pid, signal.SIGCONT)
            self.assertLess(len(self.received_by_slow()), COUNT)

    def test_slow_subscriber_does_not_hold_up_the_other_cpp(self):
        self.check_only_the_slow_one_loses("lab_publisher_cpp_node")

    def test_slow_subscriber_does_not_hold_up_the_other_py(self):
        self.check_only_the_slow_one_loses("lab_publisher_py_node.py")

    def check_unlimited(self, executable):
        with self.publisher(executable, 0):
            self.receive_all()
            # Most of them wait in the publisher's memory. A queue of 5 makes it grow by 40 MB.
            grown = megabytes(self.fair.pid) - self.before
            self.assertGreater(grown, 12 * MEGABYTES)
            os.kill(self.slow.pid, signal.SIGCONT)
            self.assertEqual(self.received_by_slow(), list(range(1, COUNT + 1)))

    def test_queue_without_a_limit_takes_memory_and_drops_nothing_cpp(self):
        self.check_unlimited("lab_publisher_cpp_node")

    def test_queue_without_a_limit_takes_memory_and_drops_nothing_py(self):
        self.check_unlimited("lab_publisher_py_node.py")

    def test_without_a_queue_the_slow_subscriber_holds_up_the_other_py(self):
        with self.publisher("lab_publisher_py_node.py", "none"):
            while self.more() or self.more():
                pass
            self.assertLess(len(self.numbers), COUNT)
            os.kill(self.slow.pid, signal.SIGCONT)
            self.receive_all()
            self.assertEqual(self.received_by_slow(), list(range(1, COUNT + 1)))
            self.assertEqual(self.numbers, list(range(1, COUNT + 1)))


def megabytes(pid):
    """Return what a process takes of the machine's memory (resident set: see proc(5))."""
    resident_pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1])
    return resident_pages * os.sysconf("SC_PAGESIZE") // 1000000


def connected(node, topic):
    """Return the nodes to which a node sends a topic."""
    return {to for _, to, way, _, name, *_ in connections_of(node) if way == "o" and topic in name}


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "slow_subscriber", TestSlowSubscriber)
