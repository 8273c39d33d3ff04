#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The publisher of the labs that no idiom can show: bursts, large messages, any type, any timer.

Its private parameters, in a lab's launch file, say what it publishes, and how.
"""

import contextlib
import os
import sys
import threading
import time

import rospy
from mrp_labs.message_text import MESSAGE_TYPES, from_text, pad_to
from mrp_labs.parameters import Parameters
from mrp_labs.start import print_namespaces, work


class LabPublisher:
    def __init__(self, parameters):
        self.type = parameters.choice("type", list(MESSAGE_TYPES))
        self.topic = parameters.get("topic", "great_topic")
        self.queue_size = parameters.number_or_none("queue_size", 10)  # 0: unlimited
        self.latch = parameters.get("latch", False)
        self.timer_type = parameters.choice(
            "timer", ["ros", "ros-reset", "steady", "rate", "sleep"]
        )
        self.period = parameters.get("period", 0.5)
        self.work = parameters.get("work", 0.0)  # seconds that each turn takes, by the ROS clock
        self.burst = parameters.get("burst", 1)  # messages in each period
        self.first_burst = parameters.get("first_burst", self.burst)
        self.count = parameters.get("count", 0)  # messages in all, 0: no end
        self.start_value = parameters.get("start", 1)
        self.step = parameters.get("step", 1)
        self.values = [str(value) for value in parameters.get("values", [])]
        self.size = parameters.get("size", 0)  # bytes, to which a String is filled up
        self.wait_for_subscribers = parameters.get("wait_for_subscribers", 0)
        self.show_memory = parameters.get("show_memory", False)
        self.show_namespaces = parameters.get("show_namespaces", False)
        self.shown_type = self.type + " " if parameters.get("show_type", False) else ""
        parameters.no_others()
        for value in self.values:
            self.message(value)  # an error, if the text does not fit the type
        self.sent = 0

    def start(self):
        if self.show_namespaces:
            print_namespaces()

        self.publisher = rospy.Publisher(
            self.topic,
            MESSAGE_TYPES[self.type],
            latch=self.latch,
            queue_size=self.queue_size,
        )
        rospy.loginfo(
            f"{rospy.get_name()} publishes {self.type} on {self.publisher.resolved_name}"
            f' (asked for "{self.topic}")'
        )

        if self.timer_type in ("rate", "sleep"):
            self.timer = threading.Thread(target=self.loop, daemon=True)
            self.timer.start()
        elif self.timer_type != "steady":
            # Without reset, the timer ends when the ROS clock jumps back.
            self.timer = rospy.Timer(
                rospy.Duration(self.period),
                self.timer_callback,
                reset=self.timer_type == "ros-reset",
            )
        else:
            # rospy has no timer but the one that follows the ROS clock.
            self.timer = threading.Thread(target=self.steady_timer, daemon=True)
            self.timer.start()

    def steady_timer(self):
        due = time.monotonic()
        while not rospy.is_shutdown():
            due += self.period
            time.sleep(max(0, due - time.monotonic()))
            self.timer_callback(None)

    def loop(self):
        """Publish in a loop, in place of a timer."""
        rate = rospy.Rate(1 / self.period)
        with contextlib.suppress(rospy.ROSInterruptException):  # at Ctrl-C
            while not rospy.is_shutdown():
                self.timer_callback(None)
                if self.timer_type == "rate":
                    rate.sleep()
                else:
                    rospy.sleep(self.period)

    def timer_callback(self, event):
        if self.publisher.get_num_connections() < self.wait_for_subscribers:
            return
        self.wait_for_subscribers = 0

        first = self.sent
        refused = 0
        burst = self.first_burst if self.sent == 0 else self.burst
        while self.sent < first + burst and (self.count == 0 or self.sent < self.count):
            refused += not self.publish(self.value_text(self.sent))
            self.sent += 1
        if self.sent == first + refused:
            return
        line = f"{rospy.get_name()} published {self.shown_type}{self.value_text(first)}"
        if self.sent - first > 1:
            line += f" to {self.value_text(self.sent - 1)}"
        if self.show_memory:
            line += f", memory: {megabytes()} MB"
        rospy.loginfo(line)
        work(self.work)

    def publish(self, value):
        """Publish a message, and return whether rospy took it."""
        try:
            self.publisher.publish(self.message(value))
        except (rospy.ROSSerializationException, OverflowError) as error:  # the latter: of a float
            rospy.logerr(
                f"{rospy.get_name()} cannot publish {self.shown_type}{value}:"
                f" {type(error).__name__}: {error}"
            )
            return False
        return True

    def value_text(self, index):
        """Return the text of the message with that index: the values in turn; or start, start +
        step, ..."""
        if self.values:
            return self.values[index % len(self.values)]
        return str(self.start_value + index * self.step)

    def message(self, text):
        msg = MESSAGE_TYPES[self.type]()
        from_text(text, msg)
        pad_to(self.size, msg)
        return msg


def megabytes():
    """Return what this process takes of the machine's memory (resident set: see proc(5))."""
    with open("/proc/self/statm") as statm:
        resident_pages = int(statm.read().split()[1])
    return resident_pages * os.sysconf("SC_PAGESIZE") // 1000000


def main():
    sys.stdout.reconfigure(line_buffering=True)  # print each line at once, also into a pipe
    rospy.init_node("lab_publisher_py_node")

    try:
        publishers = [LabPublisher(parameters) for parameters in Parameters().of_each_topic()]
        for publisher in publishers:
            publisher.start()
    except (ValueError, TypeError) as error:
        rospy.logfatal(f"{rospy.get_name()}: {error}")
        sys.exit(1)
    rospy.spin()


if __name__ == "__main__":
    main()
