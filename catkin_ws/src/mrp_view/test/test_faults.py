#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Breaks a graph in many ways: the page reports what's wrong, and what soon will be."""

import itertools
import os
import signal
import unittest
import unittest.mock

import rosgraph
import rostest
from mrp_testing.lab import Lab
from mrp_testing.master import master, uri_of
from mrp_testing.nodes import pid_of, program
from mrp_testing.ports import free_port
from mrp_testing.process import LIVE, Process
from mrp_testing.viewer import PUBLISHERS, SUBSCRIBERS, TOPIC, Client, PubSub, Viewer
from mrp_testing.waiting import wait_until


class TestFaults(unittest.TestCase):
    def setUp(self):
        """Give each test a master of its own: a killed node stays in the graph of its master."""
        port = free_port()
        environment = unittest.mock.patch.dict(os.environ, ROS_MASTER_URI=uri_of(port))
        environment.start()
        self.addCleanup(environment.stop)
        self.addCleanup(master(port).stop)

    def test_dropped_messages_are_counted_where_they_are_dropped(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            with Lab("subscriber_queue.launch"):
                topic, publisher = (
                    "/subscriber_queue/great_topic",
                    "/subscriber_queue/publisher_cpp",
                )

                def link(name):
                    return page.links.get((topic, publisher, f"/subscriber_queue/{name}"), {})

                # What the lab claims, and its own test shows: of 16, a queue of 1 keeps 2, and a
                # queue of 10 keeps 11.
                for name, lost in (("queue_of_1", 14), ("queue_of_10", 5), ("unlimited", 0)):
                    page.wait_for(
                        lambda: link(name + "_cpp").get("dropped") == lost,
                        f"{lost} dropped by {name}_cpp",
                    )
                    page.wait_for(
                        lambda: (
                            link(name + "_py").get("sent") == 16
                            and link(name + "_py").get("missing") == lost
                        ),
                        f"{lost} missing of 16 at {name}_py",
                    )
                for kind in ("dropped", "missing"):
                    page.wait_for_finding(kind)

    def test_other_type_is_told_with_its_reason(self):
        """The page gives the reason if it heard one; otherwise it says so, and doesn't guess."""
        topic = "/mismatch/great_topic"
        publishers = ("/mismatch/publisher_cpp", "/mismatch/publisher_py")
        other = "/mismatch/other_subscriber_cpp"
        late = (program("mrp_labs", "lab_subscriber_cpp_node"), "__name:=late", "__ns:=mismatch")
        with Lab("type_mismatch.launch") as lab:
            for publisher in publishers:
                lab.wait_for_count("/mismatch/subscriber_py", 1, publisher)
            refused = [f"'callerid': '{other}'", f"Client [{other}] wants topic"]
            lab.wait_for(
                lambda: all(any(r in line for line in list(lab.lines)) for r in refused),
                "both publishers refuse it",
            )
            with Viewer() as viewer, Client(viewer.address) as page:
                for publisher in publishers:
                    link = topic, publisher, other
                    page.wait_for(
                        lambda: page.link_states().get(link, [""])[0] == "none", "no connection"
                    )
                    self.assertIn("can't reach the publisher", page.link_states()[link][1])
                self.assertEqual(page.edges()[topic, other], "none")
                page.wait_for(
                    lambda: set(publishers) <= set(log_senders(page)), "both logs are heard"
                )
                with Process(*late, "_type:=std_msgs/Int32", extra_env=LIVE):
                    self.check_reason(page, topic, publishers)
                    page.wait_for_finding("mismatch")
                    self.assertEqual(page.edges()[topic, "/mismatch/subscriber_cpp"], "ok")

    def check_reason(self, page, topic, publishers):
        page.wait_for(
            lambda: page.edges().get((topic, "/mismatch/late")) == "mismatch", "a red edge"
        )
        for publisher in publishers:
            reason = (
                f"{publisher} refuses /mismatch/late: it publishes std_msgs/UInt32, and"
                " /mismatch/late expects std_msgs/Int32"
            )
            link = topic, publisher, "/mismatch/late"
            page.wait_for(lambda: page.link_states()[link] == ("mismatch", reason), "the reason")

    def test_private_names_are_islands(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            with Lab("namespaces.launch", "topic:=~great_topic"):
                page.wait_for(
                    lambda: sum("4 islands" in finding["text"] for finding in page.findings) == 2,
                    "four islands in each group",
                )
                wanted = {
                    (f"/{group}/publisher_{suffix}", f"/{group}/publisher_{suffix}/great_topic")
                    for group in ("by_code", "by_remap")
                    for suffix in ("cpp", "py")
                }
                wanted |= {
                    (f"/{group}/subscriber_{suffix}/great_topic", f"/{group}/subscriber_{suffix}")
                    for group in ("by_code", "by_remap")
                    for suffix in ("cpp", "py")
                }
                page.wait_for(lambda: set(page.edges()) == wanted, "each on its own topic alone")

    def test_latched_topic_is_told(self):
        with Viewer() as viewer, Client(viewer.address) as page:
            with Lab("latch.launch"):
                page.wait_for_finding("latched")
                wanted = ("/latch/great_topic", True)
                page.wait_for(
                    lambda: (
                        wanted in [(t["name"], t["latched"]) for t in page.graph["graph"]["topics"]]
                    ),
                    "the topic's label",
                )

    def test_killed_node_is_dead(self):
        """Kills a node, which can't sign off: going by the master, it would still be alive."""
        with PubSub(), Viewer() as viewer, Client(viewer.address) as page:
            for name in PUBLISHERS + SUBSCRIBERS:
                page.wait_for(lambda: page.states().get(name) == "alive", f"{name} alive")
            os.kill(pid_of(PUBLISHERS[0]), signal.SIGKILL)
            page.wait_for(lambda: page.states().get(PUBLISHERS[0]) == "dead", "a dead node")
            self.assertEqual(page.edges()[PUBLISHERS[0], TOPIC], "dead")
            self.assertNotEqual(page.states()[PUBLISHERS[1]], "dead")
            page.wait_for_finding("dead")

    def test_node_that_hangs_is_not_called_dead(self):
        with PubSub(), Viewer() as viewer, Client(viewer.address) as page:
            page.wait_for(lambda: page.states().get(SUBSCRIBERS[1]) == "alive", "a node")
            pid = pid_of(SUBSCRIBERS[1])
            os.kill(pid, signal.SIGSTOP)
            try:
                page.wait_for(lambda: page.states()[SUBSCRIBERS[1]] == "silent", "a silent node")
            finally:
                os.kill(pid, signal.SIGCONT)
            page.wait_for(lambda: page.states()[SUBSCRIBERS[1]] == "alive", "it answers again")

    def test_master_is_restarted(self):
        """Restarts the master: the page says so, and still hears old connections and new ones."""
        port = free_port()
        env = {"ROS_MASTER_URI": uri_of(port)}
        with Viewer("--settle", "0", extra_env=env) as viewer, Client(viewer.address) as page:
            page.wait_for(lambda: page.graph, "a page before there is a master")
            self.assertEqual(page.graph["master"]["state"], "never")
            with master(port):
                talker = publisher("old", env)
                with talker:
                    page.wait_for(lambda: ("/talk", "/old") in page.rows, "messages")
                    self.stop_master(page, port, env)
                    before = page.rows["/talk", "/old"]["count"]
                    page.wait_for(
                        lambda: page.rows["/talk", "/old"]["count"] > before + 3,
                        "messages without a master",
                    )
                    with master(port):
                        page.wait_for(lambda: page.graph["master"]["state"] == "here", "it is back")
                        with publisher("new", env):
                            page.wait_for(lambda: ("/talk", "/new") in page.rows, "the new node")
                            count = page.rows["/talk", "/old"]["count"]
                            page.wait_for(
                                lambda: page.rows["/talk", "/old"]["count"] > count, "and the old"
                            )
                            self.assertEqual(page.rows["/talk", "/old"]["missing"], [0, 0])
                            page.wait_for_finding("forgotten")
            self.assertEqual(viewer.stop(), 0, str(viewer))

    def test_whole_system_has_ended(self):
        """After Ctrl-C on roslaunch nothing is called dead, restarted, or still publishing."""
        env = {"ROS_MASTER_URI": uri_of(free_port())}
        with Viewer("--settle", "0", extra_env=env) as viewer, Client(viewer.address) as page:
            with PubSub(extra_env=env) as launched:
                # rospy hangs, and dies, if Ctrl-C comes while it registers: see Process.
                for link in itertools.product([TOPIC], PUBLISHERS, SUBSCRIBERS):
                    page.wait_for(lambda: (page.links.get(link, {}).get("sent") or 0) > 1, link)
                page.told.clear()
                self.assertEqual(launched.stop(), 0)
            page.wait_for(lambda: page.graph["master"]["state"] == "ended", "the end")
            self.assertEqual(page.states(), {})
            self.assertFalse({"dead", "forgotten"} & {kind for kind, _ in page.told}, page.told)
            with PubSub(extra_env=env):
                page.wait_for(lambda: page.states().get(PUBLISHERS[0]) == "alive", "a new start")

    def stop_master(self, page, port, env):
        uri = env["ROS_MASTER_URI"]
        pid = rosgraph.Master("/test_faults", master_uri=uri).getPid()
        os.kill(pid, signal.SIGKILL)
        wait_until(lambda: not rosgraph.is_master_online(uri), "the master has gone")
        page.wait_for(lambda: page.graph["master"]["state"] == "gone", "the page says so")
        self.assertIn("/old", page.states(), "what was known stays")


def log_senders(page):
    return [publisher for topic, publisher in page.rows if topic == "/rosout"]


def publisher(name, env):
    return Process(
        program("mrp_labs", "lab_publisher_py_node.py"),
        *(f"__name:={name}", "_topic:=talk", "_period:=0.1"),
        extra_env={**LIVE, **env},
    )


if __name__ == "__main__":
    rostest.rosrun("mrp_view", "faults", TestFaults)
