#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the viewer: its port, its name, its part in the graph; with any text, in any browser."""

import re
import unittest

import rospy
import rostest
from mrp_testing.graph import Graph
from mrp_testing.process import Process
from mrp_testing.viewer import TOPIC, Client, PubSub, Viewer
from mrp_testing.waiting import wait_until
from std_msgs.msg import Header, String


class TestProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_program")

    def test_viewer_publishes_nothing(self):
        with PubSub(), Viewer() as viewer, Client(viewer.address, viewer=True) as page:
            page.wait_for(lambda: (TOPIC, "/mrp_view") in page.edges(), "the viewer in the graph")
            starts = {start for start, _ in page.edges()}
            self.assertNotIn("/mrp_view", starts)

    def test_any_type_and_any_text(self):
        texts = ['<img src=x onerror="alert(1)">', "</script><b>&amp;", "\u2028 \x00 ümlaut"]
        string = rospy.Publisher("text", String, queue_size=10, latch=True)
        header = rospy.Publisher("stamped", Header, queue_size=10, latch=True)
        with Viewer("--settle", "0") as viewer, Client(viewer.address) as page:
            for text in texts:
                string.publish(text)
                page.wait_for(
                    lambda: page.rows.get(("/text", rospy.get_name()), {}).get("value") == text,
                    repr(text),
                )
            header.publish(Header(stamp=rospy.Time.now(), frame_id="<b>"))
            key = ("/stamped", rospy.get_name())
            page.wait_for(lambda: page.rows.get(key, {}).get("latency") is not None, "a latency")
            self.assertGreaterEqual(page.rows[key]["latency"], 0)
            self.assertIn("frame_id: <b>", page.rows[key]["value"])
            rospy.logwarn("<script>alert(2)</script>")
            page.wait_for(
                lambda: any(line["text"] == "<script>alert(2)</script>" for line in page.lines),
                "the log line",
            )
        string.unregister()
        header.unregister()

    def test_message_that_is_too_large_is_not_decoded(self):
        publisher = rospy.Publisher("large", String, queue_size=1)
        key = ("/large", rospy.get_name())
        with Viewer("--settle", "0") as viewer, Client(viewer.address) as page:
            wait_until(publisher.get_num_connections, viewer.__str__)
            publisher.publish("x" * 50_000_000)
            page.wait_for(lambda: page.rows.get(key, {}).get("value"), "the message")
            self.assertEqual(page.rows[key]["value"], "50 MB, not decoded")
            publisher.publish("small")
            page.wait_for(lambda: page.rows[key]["value"] == "small", "the next message")
            self.assertEqual(page.rows[key]["count"], 2)
        publisher.unregister()

    def test_printed_address_can_be_opened(self):
        for address, printed in (("[::1]", "[::1]"), ("::", "[::1]"), ("0.0.0.0", "127.0.0.1")):
            with Viewer("--address", address) as viewer, Client(viewer.address) as page:
                self.assertRegex(viewer.address, rf"^http://{re.escape(printed)}:\d+/$")
                page.wait_for(lambda: page.ticks, "a message")

    def test_browser_that_says_anything_is_closed(self):
        with Viewer() as viewer:
            for text in ("{", "[]", "x" * 200_000):
                with Client(viewer.address) as page:
                    page.wait_for(lambda: page.ticks, "the first message")
                    page.tell(text)
                    page.wait_for(lambda: page.closed, f"the end after {text[:10]}")
            with Client(viewer.address, hidden={"a": 1}, rankdir=[3]) as page:
                page.wait_for(lambda: page.graph, "an answer to the rest")
            self.assertEqual(viewer.stop(), 0)
            self.assertNotIn("Traceback", str(viewer))

    def test_port_that_is_taken(self):
        with Viewer() as viewer:
            port = viewer.address.rsplit(":")[-1].strip("/")
            with Process("rosrun", "mrp_view", "view_node.py", "--port", port) as second:
                self.assertEqual(second.wait(), 1)
            self.assertIn(f"error: cannot listen on 127.0.0.1 port {port}", second.lines[-1])

    def test_port_that_is_none(self):
        with Process("rosrun", "mrp_view", "view_node.py", "--port", "99999") as viewer:
            self.assertEqual(viewer.wait(), 2)
        self.assertIn("expected a number from 0 to 65535; found '99999'", viewer.lines[-1])

    def test_second_viewer_takes_the_name(self):
        with Viewer() as first, Client(first.address) as page:
            page.wait_for(lambda: page.graph, "the first one")
            first.wait_for(lambda: "/mrp_view" in Graph().nodes, "the first one's name")
            with Viewer() as second:
                self.assertEqual(first.wait(), 1)
                # rospy says in a line of its own that it was asked to end: before it or after it.
                self.assertIn("error: another node has taken the name /mrp_view", str(first))
                self.assertEqual(second.stop(), 0)


if __name__ == "__main__":
    rostest.rosrun("mrp_view", "program", TestProgram)
