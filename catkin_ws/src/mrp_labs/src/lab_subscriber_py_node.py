#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The subscriber of the labs: prints what it receives, from whom and, if asked, in which thread.

Its private parameters make it late, slow, or ready for another type.
"""

import sys
import threading
import time

import rosgraph
import rospy
from mrp_labs.message_text import MESSAGE_TYPES, to_text
from mrp_labs.parameters import Parameters
from mrp_labs.start import print_namespaces, wait


class LabSubscriber:
    def __init__(self, parameters):
        self.type = parameters.choice("type", list(MESSAGE_TYPES))
        self.topic = parameters.get("topic", "great_topic")
        self.other_topic = parameters.get("other_topic", "")
        self.queue_size = parameters.number_or_none("queue_size", 10)
        self.buff_size = parameters.get("buff_size", 65536)  # bytes
        self.callback_duration = parameters.get("callback_duration", 0.0)
        self.wait_for_publishers = parameters.get("wait_for_publishers", 0)
        self.delay = parameters.get("delay", 0.0)  # seconds from then on before it subscribes
        self.show_thread = parameters.get("show_thread", False)
        self.show_namespaces = parameters.get("show_namespaces", False)
        self.shown_type = self.type + " " if parameters.get("show_type", False) else ""
        parameters.no_others()

    def start(self):
        while (
            not rospy.is_shutdown()
            and self.wait_for_publishers > 0
            and self.publishers() < self.wait_for_publishers
        ):
            time.sleep(0.1)
        wait(self.delay)
        if self.show_namespaces:
            print_namespaces()

        self.subscriber = self.subscribe(self.topic)
        if self.other_topic:
            self.other_subscriber = self.subscribe(self.other_topic)

    def publishers(self):
        """Return how many publishers of the topic the master knows. Without a subscription, nobody
        else does."""
        publishers, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
        return len(dict(publishers).get(rospy.resolve_name(self.topic), []))

    def subscribe(self, topic):
        subscriber = rospy.Subscriber(
            topic,
            MESSAGE_TYPES[self.type],
            self.subscriber_callback,
            queue_size=self.queue_size,
            buff_size=self.buff_size,
        )
        rospy.loginfo(
            f"{rospy.get_name()} subscribes to {subscriber.resolved_name}, expects {self.type}"
            f' (asked for "{topic}")'
        )
        return subscriber

    def subscriber_callback(self, msg):
        value = self.shown_type + to_text(msg)
        where = f" in thread {threading.get_native_id()}" if self.show_thread else ""
        # The header of the connection says who is at its other end.
        publisher = msg._connection_header["callerid"]
        rospy.loginfo(f"{rospy.get_name()} received {value} from {publisher}{where}")
        if self.callback_duration > 0:
            time.sleep(self.callback_duration)
            if self.show_thread:
                rospy.loginfo(f"{rospy.get_name()} finished {value}{where}")


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_subscriber_py_node")

    try:
        subscribers = [LabSubscriber(parameters) for parameters in Parameters().of_each_topic()]
        for subscriber in subscribers:
            subscriber.start()
    except (ValueError, rospy.ROSException) as error:
        rospy.logfatal(f"{rospy.get_name()}: {error}")
        sys.exit(1)
    rospy.spin()


if __name__ == "__main__":
    main()
