#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The publisher of the labs: it counts. Its private parameters, in a lab's launch file, make it
latched, or make it publish in bursts, large messages, or only when subscribers are there."""

import sys

import rospy
from std_msgs.msg import String, UInt32


class LabPublisher:
    def __init__(self):
        self.start = rospy.get_param("~start", 1)
        self.step = rospy.get_param("~step", 1)
        self.count = rospy.get_param("~count", 0)  # messages in all, 0: no end
        self.burst = rospy.get_param("~burst", 1)  # messages in each period
        self.first_burst = rospy.get_param("~first_burst", self.burst)
        self.size = rospy.get_param("~size", 0)  # bytes of a String; 0: publish a UInt32
        self.wait_for_subscribers = rospy.get_param("~wait_for_subscribers", 0)
        self.sent = 0

        topic = rospy.get_param("~topic", "great_topic")
        queue_size = rospy.get_param("~queue_size", 10)
        self.publisher = rospy.Publisher(
            topic,
            String if self.size else UInt32,
            latch=rospy.get_param("~latch", False),
            queue_size=None if queue_size == "none" else queue_size,
        )
        rospy.loginfo(
            f"{rospy.get_name()} publishes {self.publisher.type} on"
            f' {self.publisher.resolved_name} (asked for "{topic}")'
        )
        period = rospy.Duration(rospy.get_param("~period", 0.5))
        self.timer = rospy.Timer(period, self.timer_callback)

    def timer_callback(self, event):
        if self.publisher.get_num_connections() < self.wait_for_subscribers:
            return
        self.wait_for_subscribers = 0

        burst = self.first_burst if self.sent == 0 else self.burst
        if self.count:
            burst = min(burst, self.count - self.sent)
        if burst == 0:
            return
        line = f"{rospy.get_name()} published {self.value()}"
        for _ in range(burst):
            self.publish()
        if burst > 1:
            line += f" to {self.value() - self.step}"
        rospy.loginfo(line)

    def value(self):
        return self.start + self.sent * self.step

    def publish(self):
        msg = self.publisher.data_class()
        msg.data = str(self.value()).ljust(self.size) if self.size else self.value()
        self.publisher.publish(msg)
        self.sent += 1


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_publisher_py_node")
    node = LabPublisher()
    rospy.spin()


if __name__ == "__main__":
    main()
