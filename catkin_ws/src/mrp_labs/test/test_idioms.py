#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs each idiom, in C++ and in Python: both do what the first lines of the file say.

They run in the namespace /robot1. Where an idiom needs a clock, the test moves it.
"""

import contextlib
import itertools
import os
import re
import signal
import sys
import threading
import unittest

import rospy
import rostest
from mrp_testing import log_line
from mrp_testing.clock import TurnedClock
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import program, receivers_of
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import DEADLINE, wait_until, within
from rosgraph_msgs.msg import Log
from std_msgs.msg import String, UInt32

LANGUAGES = ("cpp", "py")
BURST = 200  # messages
# Runs a Python program in which each line of the log takes a moment, some longer than others. So
# two threads without a lock get in each other's way.
SLOW_LOG = (
    sys.executable,
    "-c",
    "import random, runpy, rospy, sys, time; loginfo = rospy.loginfo;"
    "rospy.loginfo = lambda *args: (time.sleep(random.random() / 500), loginfo(*args));"
    "del sys.argv[0]; runpy.run_path(sys.argv[0], run_name='__main__')",
)
STILL = 1.0  # seconds of the machine's clock: two periods of the talker
LEAP = 10.0  # seconds: many periods of each loop

# Idiom: the topics that it publishes, and those that it subscribes to.
TOPICS = {
    "latch": (["/robot1/great_topic"], []),
    "loop_listener": ([], ["/robot1/chatter"]),
    "loop_talker": (["/robot1/chatter"], []),
    "loop_with_callbacks": (["/robot1/newest"], ["/robot1/number"]),
    "name_global": ([], ["/great_topic"]),
    "name_in_namespace": ([], ["/robot1/arm/great_topic"]),
    "name_private": ([], ["/robot1/name_private/great_topic"]),
    "name_relative": ([], ["/robot1/great_topic"]),
    "publish_anywhere": (["/robot1/doubled"], ["/robot1/number"]),
    "publish_on_connect": (["/robot1/great_topic"], []),
    "queue_for_a_burst": (["/robot1/great_topic"], []),
    "queue_of_one": ([], ["/robot1/great_topic"]),
    "several_threads": ([], ["/robot1/first", "/robot1/second"]),
    "wait_for_subscribers": (["/robot1/great_topic"], []),
}


class Idiom(Process):
    """An idiom that runs.

    before: the command that runs its program, if it does not run by itself

    Use it in a `with`: on leaving without an error, it must have its topics and no others, and end
    cleanly at Ctrl-C.
    """

    def __init__(self, idiom, language, before=()):
        self.name = "/robot1/" + idiom
        path = program(PACKAGE, idiom + (".py" if language == "py" else ""))
        super().__init__(*before, path, "__ns:=/robot1", extra_env=LIVE)

    def __exit__(self, *exception):
        try:
            if exception[0] is None:
                self.wait_for(self._has_its_topics, lambda: f"{self.name} has its topics")
                code = self.stop()
                assert (code, self.errors) == (0, []), f"exit code {code} of {self}"
                assert self.name not in Graph().nodes, f"{self.name} is still registered"
        finally:
            super().__exit__(*exception)

    def _has_its_topics(self):
        graph = Graph()
        found = tuple(
            sorted(
                topic
                for topic, nodes in topics.items()
                if self.name in nodes and topic not in ("/rosout", "/clock")
            )
            for topics in (graph.publishers, graph.subscribers)
        )
        return found == TOPICS[self.name.split("/")[-1]]

    def wait_until_in_its_loop(self):
        """Wait until the idiom has its topics, and then sleeps again and again."""
        self.wait_for(self._has_its_topics, lambda: f"{self.name} has its topics")
        self.wait_until_it_sleeps()

    def wait_until_logged(self, *texts):
        """Wait until the idiom has logged so many lines, and check that they are these."""

        def logged():
            return log_line.texts(self.lines)

        self.wait_for(lambda: len(logged()) >= len(texts), f"it logged {texts}")
        assert logged() == list(texts), f"expected {texts}, found {self}"

    def wait_for_receivers(self, topic, *nodes):
        """Wait until the idiom sends what it publishes on a topic to these nodes, and no others."""
        self.wait_for(
            lambda: receivers_of(self.name, topic) == sorted(nodes), f"{self.name} sends to {nodes}"
        )


class Subscriber:
    """What the test receives on a topic.

    value_of: returns the value in a message
    values: those of all messages so far
    senders: the names of their publishers
    latched: whether these are latched
    """

    def __init__(self, topic, message_type, value_of=lambda msg: msg.data):
        self.values, self.senders, self.latched = [], set(), set()
        self._value_of = value_of
        self._subscriber = rospy.Subscriber(topic, message_type, self._callback)
        self.close = self._subscriber.unregister

    def _callback(self, msg):
        self.senders.add(msg._connection_header["callerid"])
        self.latched.add(msg._connection_header["latching"] == "1")
        self.values.append(self._value_of(msg))

    def wait_for(self, *values):
        """Wait until so many values have come, and check that they are these."""
        wait_until(lambda: len(self.values) >= len(values), lambda: f"{values}: {self.values}")
        assert self.values == list(values), f"expected {values}, found {self.values}"


class LabSubscriber(Process):
    """A subscriber of the labs: several in one process would share a connection."""

    def __init__(self, name):
        self.name = "/robot1/" + name
        path = program(PACKAGE, "lab_subscriber_cpp_node")
        super().__init__(path, "__ns:=/robot1", "__name:=" + name, extra_env=LIVE)

    def wait_for_values(self, idiom, *values):
        """Wait until it received so many values, and check that they are these, of an idiom."""
        expected = [f"{self.name} received {value} from {idiom.name}" for value in values]

        def received():
            return [text for text in log_line.texts(self.lines) if " received " in text]

        self.wait_for(lambda: len(received()) >= len(values), lambda: f"{expected}")
        assert received() == expected, f"expected {expected}, found {self}"


@contextlib.contextmanager
def publisher_to(idiom, topic):
    """Yield a publisher that is connected to an idiom, and returns when the message is sent."""
    publisher = rospy.Publisher(topic, UInt32, queue_size=None)
    try:
        idiom.wait_for(publisher.get_num_connections, f"{idiom.name} is connected to {topic}")
        yield publisher
    finally:
        publisher.unregister()


class TestIdioms(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_idioms")

    def test_names(self):
        names = [idiom for idiom in TOPICS if idiom.startswith("name_")]
        for idiom, language in itertools.product(names, LANGUAGES):
            _, (topic,) = TOPICS[idiom]
            with Idiom(idiom, language) as running, publisher_to(running, topic) as publisher:
                publisher.publish(7)
                running.wait_until_logged(f"subscribes to {topic}", "received 7")

    def test_latch(self):
        for language in LANGUAGES:
            with Idiom("latch", language) as idiom:
                idiom.wait_until_logged("published 42")
                for _ in range(2):
                    with contextlib.closing(Subscriber("/robot1/great_topic", UInt32)) as late:
                        late.wait_for(42)
                    self.assertEqual((late.senders, late.latched), ({idiom.name}, {True}))

    def test_publish_on_connect(self):
        for language in LANGUAGES:
            with Idiom("publish_on_connect", language) as idiom, LabSubscriber("one") as one:
                one.wait_for_values(idiom, 1)
                with LabSubscriber("two") as two:
                    two.wait_for_values(idiom, 2)
                    with LabSubscriber("three") as three:
                        three.wait_for_values(idiom, 3)
                        # These have received no more than they had.
                        two.wait_for_values(idiom, 2)
                        one.wait_for_values(idiom, 1)

    def test_wait_for_subscribers(self):
        for language in LANGUAGES:
            with Idiom("wait_for_subscribers", language) as idiom, LabSubscriber("one") as one:
                idiom.wait_for_receivers("/robot1/great_topic", one.name)
                with LabSubscriber("two") as two:
                    one.wait_for_values(idiom, 1, 2, 3)
                    two.wait_for_values(idiom, 1, 2, 3)

    def test_ctrl_c_ends_what_waits(self):
        for idiom, language in itertools.product(
            ("wait_for_subscribers", "queue_for_a_burst"), LANGUAGES
        ):
            with Idiom(idiom, language) as waiting:
                waiting.wait_until_in_its_loop()

    def test_several_threads(self):
        for language in LANGUAGES:
            before = SLOW_LOG if language == "py" else ()
            with Idiom("several_threads", language, before) as idiom, publisher_to(
                idiom, "/robot1/first"
            ) as first, publisher_to(idiom, "/robot1/second") as second:

                def counted():
                    found = re.findall(
                        r": total (\d+) in thread (\S+)$", "\n".join(idiom.lines), re.M
                    )
                    return [int(total) for total, _ in found], {thread for _, thread in found}

                def enough():
                    for _ in range(BURST):
                        first.publish(1)
                        second.publish(1000)
                    totals, threads = counted()
                    return len(totals) >= 2 * BURST and len(threads) == 2

                idiom.wait_for(enough, lambda: f"two threads, not {counted()[1]}, counted")
                totals, _ = counted()
                steps = {after - before for before, after in zip([0, *totals], totals)}
                self.assertEqual(steps, {1, 1000}, "each value is added, one after the other")

    def test_queue_of_one(self):
        for language in LANGUAGES:
            with Idiom("queue_of_one", language) as idiom, publisher_to(
                idiom, "/robot1/great_topic"
            ) as publisher:
                # It finds nine messages on going on. In C++ one of them keeps the callback busy,
                # while the others come in; in Python all come in at once.
                os.kill(idiom.pid, signal.SIGSTOP)
                os.waitid(os.P_PID, idiom.pid, os.WSTOPPED | os.WNOWAIT)
                for value in range(1, 10):
                    publisher.publish(value)
                os.kill(idiom.pid, signal.SIGCONT)
                idiom.wait_for(lambda: "received 9" in log_line.texts(idiom.lines), "the newest")
                received = log_line.texts(idiom.lines)
                self.assertLessEqual(len(received), {"cpp": 2, "py": 1}[language], received)

    def test_queue_for_a_burst(self):
        for language in LANGUAGES:
            published = threading.Event()

            def value_of(msg):
                published.wait(DEADLINE)
                return int(msg.data)

            with Idiom("queue_for_a_burst", language) as idiom, contextlib.closing(
                Subscriber("/robot1/great_topic", String, value_of)
            ) as subscriber:
                idiom.wait_until_logged("published 20")
                published.set()
                subscriber.wait_for(*range(1, 21))

    def test_publish_anywhere(self):
        for language in LANGUAGES:
            with Idiom("publish_anywhere", language) as idiom, contextlib.closing(
                Subscriber("/robot1/doubled", UInt32)
            ) as subscriber, publisher_to(idiom, "/robot1/number") as publisher:
                idiom.wait_for_receivers("/robot1/doubled", rospy.get_name())
                for value in (1, 20, 300):
                    publisher.publish(value)
                subscriber.wait_for(2, 40, 600)
                self.assertEqual(subscriber.senders, {idiom.name})

    def test_loop_talker(self):
        for language in LANGUAGES:
            with TurnedClock() as clock, contextlib.closing(
                Subscriber("/robot1/chatter", String)
            ) as subscriber, Idiom("loop_talker", language) as idiom:
                idiom.wait_for_receivers("/robot1/chatter", rospy.get_name())
                values = subscriber.values
                clock.begin(idiom, 1, LEAP, lambda: "hello 3" in values)
                for _ in range(8):
                    count = len(values)
                    clock.turn(0.5)
                    idiom.wait_for(lambda: len(values) > count, f"one more than {values}")
                    self.assertEqual(len(values), count + 1, str(idiom))
                # By no other clock.
                self.assertFalse(within(STILL, lambda: len(values) > count + 1), str(idiom))
                first = int(values[0].split()[1])
                self.assertEqual(values, [f"hello {first + i}" for i in range(len(values))])

    def test_loop_talker_and_listener(self):
        for language, other in (LANGUAGES, LANGUAGES[::-1]):
            with Idiom("loop_listener", language) as listener, contextlib.closing(
                Subscriber("/rosout", Log, lambda msg: msg.msg)
            ) as log, Idiom("loop_talker", other):

                def heard():
                    return log_line.texts(listener.lines)

                def printed():
                    return [text for text in log.values if text.startswith("said")]

                listener.wait_for(lambda: len(heard()) >= 3, "three messages")
                first = int(heard()[0].split()[-1][:-1])
                self.assertEqual(heard()[:3], [f'heard "hello {first + i}"' for i in range(3)])
                # Ctrl-C while rospy logs may never end it: press it in the sleep that comes then.
                count = len(printed())
                wait_until(lambda: len(printed()) > count, lambda: f"one more line: {printed()}")

    def test_loop_with_callbacks(self):
        for language in LANGUAGES:
            with TurnedClock() as clock, contextlib.closing(
                Subscriber("/robot1/newest", UInt32)
            ) as subscriber, Idiom("loop_with_callbacks", language) as idiom, publisher_to(
                idiom, "/robot1/number"
            ) as publisher:
                idiom.wait_for_receivers("/robot1/newest", rospy.get_name())
                values = subscriber.values
                clock.begin(idiom, 1, LEAP, lambda: len(values) >= 2)
                most = len(values) + 1  # one of the beginning may still be on its way

                def newest():
                    """Return the newest value after one more period, which brings one."""
                    nonlocal most
                    most += 1
                    count = len(values)
                    clock.turn(0.1)
                    wait_until(lambda: len(values) > count, lambda: f"one more than {values}")
                    self.assertLessEqual(len(values), most, values)
                    return values[-1]

                for value in (5, 4):
                    publisher.publish(value)
                    wait_until(lambda: newest() == value, f"{value} is the newest")
                self.assertEqual(list(dict.fromkeys(values)), [0, 5, 4])
                for _ in range(8):
                    newest()


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "idioms", TestIdioms)
