#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the whole launch file: who talks to whom, and does every value arrive?"""

import unittest

import rospy
import rostest
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.listener import Listener
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

    def test_subscribers_receive_every_value_of_both_publishers(self):
        self.listener.wait_until_each_received(ENOUGH)
        for (subscriber, publisher), values in self.listener.all_received().items():
            pair = f"{subscriber.name} from {publisher.name}"
            self.assertIsNone(contract.first_fault(values), pair)

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

    def test_nodes_log_what_the_contract_says_and_nothing_else(self):
        self.listener.wait_until_each_received(1)
        nodes = {self.listener.full_name(node): node for node in contract.NODES}
        for name, level, text in list(self.listener.logs):
            if name in nodes and text != nodes[name].start_line.format(name):
                self.assertEqual(level, Log.INFO, f"{name}: {text}")
                self.assertIn(nodes[name], contract.SUBSCRIBERS, text)
                self.assertIsNotNone(contract.received_value(nodes[name], text), text)

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
