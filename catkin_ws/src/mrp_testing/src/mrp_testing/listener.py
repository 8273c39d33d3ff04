# SPDX-License-Identifier: BSD-3-Clause
"""What the subscriber nodes under a namespace say that they received, heard on /rosout."""

import rospy
from rosgraph_msgs.msg import Log

from mrp_testing import contract
from mrp_testing.waiting import wait_until


class Listener:
    """Collects what the nodes under a namespace log.

    logs: (node name, level, text), in the order of arrival
    """

    def __init__(self, namespace):
        self.namespace = namespace
        self.logs = []
        self._subscriber = rospy.Subscriber(
            "/rosout", Log, lambda msg: self.logs.append((msg.name, msg.level, msg.msg))
        )

    def close(self):
        self._subscriber.unregister()

    def full_name(self, node):
        return self.namespace + "/" + node.name

    def received(self, subscriber, publisher):
        """Return the values of a publisher that a subscriber node says it received."""
        name = self.full_name(subscriber)
        values = [
            contract.received_value(subscriber, text)
            for node, _, text in list(self.logs)
            if node == name
        ]
        return [v for v in values if v is not None and contract.publisher_of(v) == publisher]

    def all_received(self):
        """Return (subscriber, publisher) -> values."""
        return {
            (subscriber, publisher): self.received(subscriber, publisher)
            for subscriber in contract.SUBSCRIBERS
            for publisher in contract.PUBLISHERS
        }

    def wait_until_each_received(self, count):
        """Wait until each subscriber node received `count` values of each publisher."""
        wait_until(
            lambda: all(len(values) >= count for values in self.all_received().values()),
            lambda: f"{count} values of each publisher: {describe(self.all_received())}",
        )


def describe(received):
    """Return "publisher -> subscriber": values, to be read in a message."""
    return {"{1.name} -> {0.name}".format(*pair): values for pair, values in received.items()}
