#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Where a topic's name leads: into the group's namespace, a global one, or the node's own."""

import unittest

import rospy
import rostest
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from std_msgs.msg import UInt32

GROUPS = ("/by_code", "/by_remap")
GLOBAL = "/my_global_namespace/great_topic"
ENOUGH = 3  # values that show that a publisher is heard by now, or would be


class TestNamespaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_namespaces")

    def test_group(self):
        with Lab("namespaces_group.launch") as lab:
            self.check_flow(lab, {group: nodes("publisher", [group]) for group in GROUPS})
            for group, asked in (("/by_code", "great_topic"), ("/by_remap", GLOBAL)):
                for node in nodes("publisher", [group]) + nodes("subscriber", [group]):
                    self.check_names(lab, node, group + "/great_topic", asked)

    def test_global(self):
        with Lab("namespaces_global.launch") as lab:
            self.check_flow(lab, {group: nodes("publisher") for group in GROUPS})
            for group, asked in (("/by_code", GLOBAL), ("/by_remap", "great_topic")):
                for node in nodes("publisher", [group]) + nodes("subscriber", [group]):
                    self.check_names(lab, node, GLOBAL, asked)

    def test_private(self):
        with Lab("namespaces_private.launch") as lab:
            publishers, subscribers = nodes("publisher"), nodes("subscriber")
            # Each publisher is heard on its own topic.
            heard = {publisher: [] for publisher in publishers}
            listeners = [
                rospy.Subscriber(node + "/great_topic", UInt32, lambda msg: store(msg, heard))
                for node in publishers
            ]
            for publisher in publishers:
                lab.wait_for(
                    lambda: len(heard[publisher]) >= ENOUGH,
                    lambda: f"{ENOUGH} values of {publisher} in {heard}",
                )
            for listener in listeners:
                listener.unregister()

            # The subscribers are there, and hear who publishes on their own topics; but have
            # heard nobody else, though each publisher has published for a while.
            speakers = [
                rospy.Publisher(node + "/great_topic", UInt32, queue_size=1, latch=True)
                for node in subscribers
            ]
            for number, (subscriber, speaker) in enumerate(zip(subscribers, speakers), 1001):
                speaker.publish(number)
                lab.wait_until_received(subscriber, number)
                received = [(one.value, one.publisher) for one in lab.received(subscriber)]
                self.assertEqual(received, [(str(number), rospy.get_name())], subscriber)
                speaker.unregister()

            # What nobody publishes and subscribes to at once, nobody hears.
            graph = Graph()
            for ends, wanted in ((graph.publishers, publishers), (graph.subscribers, subscribers)):
                found = {name: ends[name] for name in ends if name.endswith("/great_topic")}
                self.assertEqual(found, {node + "/great_topic": [node] for node in wanted})

            for node in publishers + subscribers:
                asked = "~great_topic" if node.startswith("/by_code/") else "great_topic"
                self.check_names(lab, node, node + "/great_topic", asked)

    def check_flow(self, lab, expected):
        """Check that the subscribers of each group hear these publishers, and no others."""
        for group, publishers in expected.items():
            for subscriber in nodes("subscriber", [group]):
                for publisher in publishers:
                    lab.wait_for_count(subscriber, ENOUGH, publisher)
        # Only now, when every publisher is heard by whoever hears it.
        for group, publishers in expected.items():
            for subscriber in nodes("subscriber", [group]):
                heard = {one.publisher for one in lab.received(subscriber)}
                self.assertEqual(sorted(heard), sorted(publishers), subscriber)

    def check_names(self, lab, node, topic, asked):
        """Check what a node prints about its namespaces, and where its topic's name leads."""
        group = node[: node.rindex("/")]
        if node.endswith("_cpp"):
            namespaces = f'{group} (ros::NodeHandle()); its own is {node} (ros::NodeHandle("~"))'
        else:
            namespaces = f"{group}/ (rospy.get_namespace()); its own is {node} (rospy.get_name())"
        if "publisher" in node:
            resolved = f"publishes std_msgs/UInt32 on {topic}"
        else:
            resolved = f"subscribes to {topic}, expects std_msgs/UInt32"
        # roscpp refuses a name that begins with "~": its handle has the "~".
        if node.endswith("_cpp") and asked[0] == "~":
            asked = f'asked ros::NodeHandle("~") for "{asked[1:]}"'
        else:
            asked = f'asked for "{asked}"'
        self.assertEqual(
            lab.logged(node)[:2], [f"is in the namespace {namespaces}", f"{resolved} ({asked})"]
        )


def nodes(kind, groups=GROUPS):
    return [f"{group}/{kind}_{language}" for group in groups for language in ("cpp", "py")]


def store(msg, heard):
    heard[msg._connection_header["callerid"]].append(msg.data)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "namespaces", TestNamespaces)
