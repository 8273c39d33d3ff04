#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The subscriber of the labs: prints what it receives, from whom and, if asked, in which thread.
Its private parameters make it late, slow, or ready for another type."""

import sys
import threading
import time

import rosgraph
import rospy
from std_msgs.msg import Int32, String, UInt32

TYPES = {type_._type: type_ for type_ in (Int32, String, UInt32)}


def shown(msg):
    # The spaces that make a message large are shown by its size.
    is_text = isinstance(msg.data, str)
    return f'"{msg.data.rstrip()}" ({len(msg.data)} bytes)' if is_text else str(msg.data)


class LabSubscriber:
    def __init__(self):
        self.topic = rospy.get_param("~topic", "great_topic")
        self.callback_duration = rospy.get_param("~callback_duration", 0.0)  # seconds
        self.show_thread = rospy.get_param("~show_thread", False)
        late_for = rospy.get_param("~late_for", 0)  # publishers, which come 3 s before it
        while not rospy.is_shutdown() and self.publishers() < late_for:
            time.sleep(0.1)
        time.sleep(3.0 if late_for else 0.0)
        self.subscriber = self.subscribe(self.topic)
        other_topic = rospy.get_param("~other_topic", "")
        if other_topic:
            self.other_subscriber = self.subscribe(other_topic)

    def publishers(self):
        """Return how many publishers of the topic the master knows. Without a subscription, nobody
        else does."""
        publishers, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
        return len(dict(publishers).get(rospy.resolve_name(self.topic), []))

    def subscribe(self, topic):
        type_ = rospy.get_param("~type", "std_msgs/UInt32")
        queue_size = rospy.get_param("~queue_size", 10)
        subscriber = rospy.Subscriber(
            topic,
            TYPES[type_],
            self.subscriber_callback,
            queue_size=None if queue_size == "none" else queue_size,
            buff_size=rospy.get_param("~buff_size", 65536),  # bytes
        )
        rospy.loginfo(
            f"{rospy.get_name()} subscribes to {subscriber.resolved_name}, expects {type_}"
            f' (asked for "{topic}")'
        )
        return subscriber

    def subscriber_callback(self, msg):
        where = f" in thread {threading.get_native_id()}" if self.show_thread else ""
        # The header of the connection says who is at its other end.
        publisher = msg._connection_header["callerid"]
        rospy.loginfo(f"{rospy.get_name()} received {shown(msg)} from {publisher}{where}")
        if self.callback_duration > 0:
            time.sleep(self.callback_duration)
            if self.show_thread:
                rospy.loginfo(f"{rospy.get_name()} finished {shown(msg)}{where}")


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_subscriber_py_node")
    node = LabSubscriber()
    rospy.spin()


if __name__ == "__main__":
    main()
