#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Where a topic's name leads: into the group's namespace, a global one, or the node's own."""

import unittest

import rospy
import rostest
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.proves import proves
from std_msgs.msg import UInt32

GROUPS = ("/by_code", "/by_remap")
GLOBAL = "/my_global_namespace/great_topic"
ENOUGH = 3  # values that show that a publisher is heard by now, or would be


class TestNamespaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_namespaces")

    @proves(
        "It stands in the namespace in which the node is started.",
        "great_topic does not begin with a slash, so it is relative.",
        "It stands in the node's own namespace, which is the node's full name.",
        "A group's namespace goes in front of relative names.",
        "In the group by_remap, they ask for another name, and a <remap> in the launch file "
        "replaces it by such a name.",
        "Each node prints its topic's full name, and in brackets the name that it asked for.",
        "A name without a slash or a ~ in front, such as great_topic, is relative: ROS puts the "
        "node's namespace in front of it.",
        "In a launch file, that namespace is the group's.",
        "Bad: nodes in different groups do not meet, unless you remap a name.",
        "A relative name follows the group.",
        "ROS puts the namespace in front of it (namespaces).",
        "Its attribute ns puts a namespace in front of all relative names in the group.",
        "A plain NodeHandle is in the group's namespace, and a NodeHandle for ~ is in the node's "
        "own.",
        "A relative name is in the group's namespace, in the code as in a remap.",
    )
    def test_group(self):
        with Lab("namespaces_group.launch") as lab:
            self.check_flow(lab, {group: nodes("publisher", [group]) for group in GROUPS})
            for group, asked in (("/by_code", "great_topic"), ("/by_remap", GLOBAL)):
                for node in nodes("publisher", [group]) + nodes("subscriber", [group]):
                    self.check_names(lab, node, group + "/great_topic", asked)

    @proves(
        "A name that begins with a slash stays as it is.",
        "In the group by_remap, they ask for another name, and a <remap> in the launch file "
        "replaces it by such a name.",
        "Bad: nodes in different groups do not meet, unless you remap a name.",
        "A name with a slash in front, such as /my_global_namespace/great_topic, is global: no "
        "group changes it.",
        "Good: the nodes of both groups meet on one topic.",
        "A global name is the same everywhere: no group can move it.",
        "A name with / in front is in no group's namespace: both groups share one topic.",
    )
    def test_global(self):
        with Lab("namespaces_global.launch") as lab:
            self.check_flow(lab, {group: nodes("publisher") for group in GROUPS})
            for group, asked in (("/by_code", GLOBAL), ("/by_remap", "great_topic")):
                for node in nodes("publisher", [group]) + nodes("subscriber", [group]):
                    self.check_names(lab, node, GLOBAL, asked)

    @proves(
        "This name is also the node's own namespace, for what belongs to this one node.",
        "In the group by_remap, they ask for another name, and a <remap> in the launch file "
        "replaces it by such a name.",
        "A private name is in the node's own namespace: the group's namespace and then the node's "
        "name.",
        "In Python it has a ~ in front, as in ~great_topic.",
        'In C++ you ask a handle for the node\'s namespace, ros::NodeHandle("~"), for great_topic.',
        "Here four nodes have four topics, and no subscriber receives anything from a publisher.",
        "Good: nodes do not meet by chance, even if all of them ask for the same name.",
        "Bad: to hear a publisher, another node must ask for the full name of its topic, such as "
        "/by_code/publisher_py/great_topic.",
        "A private name is in the namespace of one node.",
        "A name with ~ in front is in the node's own namespace: no node hears another.",
    )
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
