#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""pub_sub.launch as a whole: who talks to whom, and that every value gets through."""

import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.listener import Listener
from mrp_testing.proves import proves
from mrp_testing.waiting import wait_until
from rosgraph_msgs.msg import Log
from std_msgs.msg import UInt32

TOPIC = contract.GROUP + "/" + contract.TOPIC
ENOUGH = 10  # values of each publisher


class TestPubSub(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_pub_sub")
        cls.listener = Listener(contract.GROUP)
        cls.messages = []  # (sender, type, content) of what is published, whatever it is
        rospy.Subscriber(TOPIC, rospy.AnyMsg, cls.store)

    @classmethod
    def store(cls, msg):
        header = msg._connection_header
        cls.messages.append((header["callerid"], header["type"], msg._buff))

    def full_names(self, nodes):
        return sorted(self.listener.full_name(node) for node in nodes)

    def sent(self, publisher):
        """Return what came from the publisher, by the name that it connected with."""
        name = self.listener.full_name(publisher)
        return [message for message in list(self.messages) if message[0] == name]

    @proves(
        "ROS calls a function of the node, the callback, with each message that arrives.",
        "So messages flow along four paths.",
        "Each subscriber prints the numbers of both publishers, with none missing in between.",
        "To create a subscriber you name its topic, its type, a queue size and a callback.",
        "A subscriber is created with a topic, a type, a queue size and a callback.",
        "publish sends the message to all subscribers of the topic.",
        "ROS calls the callback once for each message of either publisher.",
        "A subscriber's callback is called with each message.",
        "Each subscriber receives the values of both publishers.",
        "Here it is a member, and receives every value.",
        "And four nodes on one topic make four paths: each subscriber receives every value of "
        "both publishers.",
        "Each subscriber hears both.",
    )
    def test_subscribers_receive_every_value_of_both_publishers(self):
        self.listener.wait_until_each_received(ENOUGH)
        for (subscriber, publisher), values in self.listener.all_received().items():
            pair = f"{subscriber.name} from {publisher.name}"
            self.assertIsNone(contract.first_fault(values), pair)

    @proves(
        "Every odd number comes from the Python publisher, and every even number from the C++ "
        "publisher.",
        "Here, a number is even or odd by the language of its publisher.",
        "The Python publisher, /mrp/publisher_py_node, because 7 is odd.",
        "publish sends a message.",
        "The even numbers come from C++, and the odd ones from Python.",
        "Even numbers come from C++, odd numbers from Python.",
    )
    def test_each_publisher_sends_its_own_sequence(self):
        wait_until(
            lambda: all(len(self.sent(p)) >= ENOUGH for p in contract.PUBLISHERS),
            lambda: f"{ENOUGH} values of each publisher: {self.messages}",
        )
        for publisher in contract.PUBLISHERS:
            values = []
            for _, type_, content in self.sent(publisher):
                self.assertEqual(type_, contract.TYPE, "type from " + publisher.name)
                values.append(UInt32().deserialize(content).data)
            self.assertIsNone(contract.first_fault(values), publisher.name)
            for value in values:
                self.assertEqual(
                    contract.publisher_of(value).name, publisher.name, f"sender of {value}"
                )

    @proves("What a node logs also goes out on the topic /rosout.")
    def test_nodes_log_what_the_contract_says_and_nothing_else(self):
        self.listener.wait_until_each_received(1)
        nodes = {self.listener.full_name(node): node for node in contract.NODES}
        for name, level, text in list(self.listener.logs):
            if name in nodes and text != nodes[name].start_line.format(name):
                self.assertEqual(level, Log.INFO, f"{name}: {text}")
                self.assertIn(nodes[name], contract.SUBSCRIBERS, text)
                self.assertIsNotNone(contract.received_value(nodes[name], text), text)

    @proves(
        "Two of them publish numbers, and two receive them: one of each in Python, one of each in "
        "C++.",
        "Follow this one to see that all four nodes meet on one topic.",
        "Here two publishers and two subscribers meet on one topic.",
        "To create a publisher you name its topic, its type and a queue size.",
        "To create a subscriber you name its topic, its type, a queue size and a callback.",
        "It is a program that knows which node publishes and subscribes to which topic.",
        "Nodes exchange messages of one type on a named topic.",
        "A publisher is created with a topic, a type and a queue size.",
        "A subscriber is created with a topic, a type, a queue size and a callback.",
        "rospy.Publisher takes the topic, the type and the queue size.",
        "advertise makes the publisher: the type stands in angle brackets, then follow the topic "
        "and the queue size.",
        "A publisher needs a topic, a type and a queue size.",
        "The group's namespace goes in front of every relative name: those of the four nodes, and "
        "that of their topic.",
        "The publishers are on /mrp/great_topic, so it prints no number.",
        "The four nodes do not notice: they use /mrp/great_topic.",
        "The second is right: the topic is in the group's namespace.",
        "Two publishers and two subscribers, one of each in Python and one of each in C++, talk "
        "over one topic.",
    )
    def test_graph_is_the_four_nodes_on_one_topic(self):
        graph = wait_until(self.complete_graph, "each node has its topic")
        self.assertEqual(sorted(graph.nodes), self.full_names(contract.NODES))
        self.assertEqual(graph.publishers, {TOPIC: self.full_names(contract.PUBLISHERS)})
        self.assertEqual(graph.subscribers, {TOPIC: self.full_names(contract.SUBSCRIBERS)})
        self.assertEqual(graph.types[TOPIC], contract.TYPE)

    def complete_graph(self):
        """Return the graph, if each node publishes or subscribes something besides its log."""
        graph = Graph(ignore=[rospy.get_name()])
        graph.publishers.pop("/rosout", None)
        topics = list(graph.publishers.values()) + list(graph.subscribers.values())
        complete = {name for names in topics for name in names}
        return graph if complete >= set(self.full_names(contract.NODES)) else None


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "pub_sub", TestPubSub)
