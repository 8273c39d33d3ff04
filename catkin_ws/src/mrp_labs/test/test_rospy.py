#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Asks rospy itself what it does. test_roscpp.cpp asks roscpp the same."""

import contextlib
import gc
import io
import sys
import textwrap
import unittest
import weakref

import genpy
import rospy
import rostest
from mrp_labs.msg import Count
from mrp_testing import log_line
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until, within
from rosgraph_msgs.msg import Log
from std_msgs.msg import Char, UInt8MultiArray, UInt32

LONG_SLEEP = 0.5  # seconds: much longer than what is asked for, 1 ms
SUBSCRIBER, PUBLISHER = "/of_subscriber", "/of_publisher"

LOG = """
    import rospy, sys
    rospy.init_node("logs", log_level=getattr(rospy, sys.argv[1]))
    rospy.logdebug("line of debug")
    rospy.loginfo("line of info")
    rospy.logwarn("line of warn")
    rospy.logerr("line of error")
    rospy.logfatal("line of fatal")
"""
LOG_BY_DEFAULT = LOG.replace(", log_level=getattr(rospy, sys.argv[1])", "")


def run(text, *arguments):
    """Run a program in Python, whose text it is."""
    return Process(sys.executable, "-c", textwrap.dedent(text), *arguments, extra_env=LIVE)


def ended(text, *arguments):
    """Run a program in Python to its end; return its Process."""
    with run(text, *arguments) as process:
        assert process.wait() == 0, str(process)
    return process


def levels(lines):
    """Return the level of each line of LOG."""
    logged = filter(None, map(log_line.parse, lines))
    return [line.text[len("line of ") :] for line in logged]


class TestRospy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_rospy")

    def publisher(self, topic, type_, subscribers=1):
        """Return a publisher once it has its subscribers."""
        publisher = rospy.Publisher(topic, type_, queue_size=10)
        self.addCleanup(publisher.unregister)
        wait_until(
            lambda: publisher.get_num_connections() == subscribers,
            f"{subscribers} subscribers of {topic}",
        )
        return publisher

    def drop_subscriber(self, values):
        """Make a subscriber that keeps what it receives, and let its object go."""
        subscriber = rospy.Subscriber(SUBSCRIBER, UInt32, lambda msg: values.append(msg.data))
        gone = weakref.ref(subscriber)
        del subscriber
        gc.collect()
        self.assertIsNone(gone())

    def test_subscriber_goes_on_without_its_object_py(self):
        values = []
        self.drop_subscriber(values)
        publisher = self.publisher(SUBSCRIBER, UInt32)
        publisher.publish(7)
        wait_until(lambda: values == [7], lambda: f"7, not {values}")
        self.assertIn(rospy.get_name(), Graph().subscribers[SUBSCRIBER])

    def test_unregister_ends_a_subscriber_py(self):
        values = []
        subscriber = rospy.Subscriber("/ended", UInt32, lambda msg: values.append(msg.data))
        publisher = self.publisher("/ended", UInt32)
        publisher.publish(7)
        wait_until(lambda: values == [7], lambda: f"7, not {values}")
        subscriber.unregister()
        wait_until(lambda: publisher.get_num_connections() == 0, "the subscriber's end")
        publisher.publish(8)
        self.assertNotIn("/ended", Graph().subscribers)
        self.assertEqual(values, [7])

    def test_publisher_stays_without_its_object_until_the_node_ends_py(self):
        with run("""
            import gc, rospy, weakref
            from std_msgs.msg import UInt32
            rospy.init_node("drops")
            publisher = rospy.Publisher("/of_publisher", UInt32, queue_size=10)
            gone = weakref.ref(publisher)
            del publisher
            gc.collect()
            print(gone(), flush=True)
            rospy.spin()
        """) as process:
            process.wait_for(lambda: "None" in process.lines, "the object is gone")
            self.assertEqual(Graph().publishers[PUBLISHER], ["/drops"])
            self.assertEqual(process.stop(), 0, str(process))
        self.assertNotIn(PUBLISHER, Graph().publishers)

    def test_unregister_ends_a_publisher_py(self):
        publisher = rospy.Publisher(PUBLISHER, UInt32, queue_size=10)
        self.assertEqual(Graph().publishers[PUBLISHER], [rospy.get_name()])
        publisher.unregister()
        self.assertNotIn(PUBLISHER, Graph().publishers)

    def test_publisher_without_queue_size_is_warned_of_py(self):
        process = ended("""
            import rospy, sys
            from std_msgs.msg import UInt32
            rospy.init_node("warned")
            rospy.Publisher("/with", UInt32, queue_size=10)
            print("with", file=sys.stderr)
            rospy.Publisher("/without", UInt32)
        """)
        place = process.errors.index("with")
        warning = "should be created with an explicit keyword argument 'queue_size'"
        self.assertNotIn(warning, "\n".join(process.errors[:place]))
        self.assertIn(warning, "\n".join(process.errors[place:]))

    def test_on_shutdown_comes_before_the_publishers_are_closed_py(self):
        values = []
        subscriber = rospy.Subscriber("/last_words", UInt32, lambda msg: values.append(msg.data))
        self.addCleanup(subscriber.unregister)
        with run("""
            import rospy, time
            from std_msgs.msg import UInt32
            rospy.init_node("speaks_last")
            publisher = rospy.Publisher("/last_words", UInt32, queue_size=None)
            rospy.on_shutdown(lambda: publisher.publish(7))
            while not publisher.get_num_connections():
                time.sleep(0.01)
            print("connected", flush=True)
            rospy.spin()
        """) as process:
            process.wait_for(lambda: "connected" in process.lines, "it is connected")
            self.assertEqual(process.stop(), 0, str(process))
        wait_until(lambda: values == [7], lambda: f"7, not {values}: {process}")

    def test_uint8_multi_array_arrives_as_bytes_py(self):
        arrays = []
        subscriber = rospy.Subscriber("/array", UInt8MultiArray, arrays.append)
        self.addCleanup(subscriber.unregister)
        self.publisher("/array", UInt8MultiArray).publish(data=[1, 2, 255])
        wait_until(lambda: arrays, "an array")
        self.assertIsInstance(arrays[0].data, bytes)
        self.assertEqual(arrays[0].data, b"\x01\x02\xff")
        self.assertEqual(arrays[0].data[2], 255)

    def test_char_is_a_number_py(self):
        Char(255).serialize(io.BytesIO())
        for wrong in (256, -1, "a"):
            with self.assertRaises(genpy.SerializationError):
                Char(wrong).serialize(io.BytesIO())

    def headers_on(self, topic):
        """Return a list, to which each header is added that somebody publishes on a topic."""
        headers = []
        subscriber = rospy.Subscriber(topic, Count, lambda msg: headers.append(msg.header))
        self.addCleanup(subscriber.unregister)
        return headers

    def test_seq_is_overwritten_and_stamp_is_not_py(self):
        headers = self.headers_on("/stamped")
        publisher = self.publisher("/stamped", Count)
        for _ in range(3):
            msg = Count()
            msg.header.seq = 77
            publisher.publish(msg)
        wait_until(lambda: len(headers) == 3, lambda: f"three, not {headers}")
        self.assertEqual([header.seq for header in headers], [1, 2, 3])
        self.assertEqual([header.stamp for header in headers], [rospy.Time(0)] * 3)

    def test_seq_is_counted_and_stamp_is_what_was_set_cpp(self):
        headers = self.headers_on("/count")
        with Process(program(PACKAGE, "stamped_talker"), extra_env=LIVE):
            wait_until(lambda: len(headers) >= 3, lambda: f"three, not {headers}")
        numbers = [header.seq for header in headers]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))))
        self.assertNotIn(rospy.Time(0), [header.stamp for header in headers])

    def test_debug_is_not_shown_unless_asked_for_py(self):
        self.assertNotIn("debug", levels(ended(LOG_BY_DEFAULT).lines))
        self.assertIn("debug", levels(ended(LOG, "DEBUG").lines))

    def test_print_is_no_log_py(self):
        texts = []
        subscriber = rospy.Subscriber("/rosout", Log, lambda msg: texts.append(msg.msg))
        self.addCleanup(subscriber.unregister)
        with run("""
            import rospy
            rospy.init_node("prints")
            while not rospy.is_shutdown():
                print("printed")
                rospy.loginfo("logged")
                rospy.sleep(0.05)
        """) as process:
            wait_until(lambda: texts.count("logged") >= 2, lambda: f"lines: {texts}")
            self.assertIn("printed", process.lines)
            self.assertNotIn("logged", process.lines)
        self.assertNotIn("printed", " ".join(texts))

    def test_ctrl_c_does_not_wake_a_sleep_py(self):
        with run("""
            import rospy, time
            rospy.init_node("sleeps_on")
            while not rospy.is_shutdown():
                begin = time.monotonic()
                print("sleeps")
                rospy.Rate(1).sleep()
            print("whole" if time.monotonic() - begin >= 0.9 else "cut short")
        """) as process:
            process.wait_for(lambda: "sleeps" in process.lines, "it sleeps")
            self.assertEqual(process.stop(), 0, str(process))
        self.assertEqual(process.lines[-1], "whole")

    def check_sleeps_until_there_is_a_clock(self, sleep):
        with contextlib.ExitStack() as stack:
            rospy.set_param("/use_sim_time", True)
            stack.callback(rospy.delete_param, "/use_sim_time")
            text = f"import rospy; rospy.init_node('sleeps'); print('sleeps'); {sleep}; print('up')"
            process = stack.enter_context(run(text))
            process.wait_for(lambda: "sleeps" in process.lines, "it sleeps")
            self.assertFalse(within(LONG_SLEEP, lambda: "up" in process.lines), str(process))
            stack.enter_context(Process(program(PACKAGE, "lab_clock_py_node.py")))
            process.wait_for(lambda: "up" in process.lines, "it is up again")

    def test_sleep_does_not_return_without_a_clock_py(self):
        self.check_sleeps_until_there_is_a_clock("rospy.sleep(0.001)")

    def test_rate_sleep_does_not_return_without_a_clock_py(self):
        self.check_sleeps_until_there_is_a_clock("rospy.Rate(1000).sleep()")


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "rospy", TestRospy)
