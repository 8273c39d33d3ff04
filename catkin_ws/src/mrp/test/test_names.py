#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Starts the nodes with plain rosrun: under their own names, and under names a user chooses."""

import contextlib
import unittest

import rostest
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.nodes import rosrun, run


class TestNames(unittest.TestCase):
    def check(self, start, arguments, namespace, topic):
        """Start all four nodes; expect their names, one topic, and all values."""
        with contextlib.ExitStack() as stack:
            processes = {
                node: stack.enter_context(start(node, *arguments)) for node in contract.NODES
            }
            for subscriber in contract.SUBSCRIBERS:
                for publisher in contract.PUBLISHERS:
                    process = processes[subscriber]
                    process.wait_for(
                        lambda: publisher in self.heard(subscriber, process),
                        f"{subscriber.name} hears {publisher.name}",
                    )
            for node, process in processes.items():
                name = namespace + node.name
                self.assertEqual(
                    contract.logged_text(process.lines[0]), node.start_line.format(name)
                )
                self.assertEqual(process.errors, [], str(process))

            graph = Graph()
            publishers = sorted(namespace + node.name for node in contract.PUBLISHERS)
            subscribers = sorted(namespace + node.name for node in contract.SUBSCRIBERS)
            graph.publishers.pop("/rosout")
            self.assertEqual(graph.publishers, {topic: publishers})
            self.assertEqual(graph.subscribers, {topic: subscribers})

    @staticmethod
    def heard(subscriber, process):
        texts = [contract.logged_text(line) for line in list(process.lines)]
        values = [contract.received_value(subscriber, text) for text in texts if text]
        return {contract.publisher_of(value) for value in values if value is not None}

    def test_bare_rosrun_is_in_the_root_namespace(self):
        self.check(rosrun, [], "/", "/" + contract.TOPIC)

    def test_ns_moves_the_nodes_and_their_topic(self):
        self.check(run, ["__ns:=/robot1"], "/robot1/", "/robot1/" + contract.TOPIC)

    def test_remap_moves_the_topic_only(self):
        remap = contract.TOPIC + ":=/elsewhere/small_topic"
        self.check(run, [remap], "/", "/elsewhere/small_topic")


if __name__ == "__main__":
    rostest.rosrun(contract.PACKAGE, "names", TestNames)
