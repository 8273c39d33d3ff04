#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The measured node in Python: a publisher or a subscriber. Its queues are unlimited.

Private parameters:
publish      publishes as soon as there are so many subscribers; without it, subscribes
size, rate, count: bytes of a message, messages per second (0: as fast as it goes), how many
timer_slack  how much later rospy's time.sleep(0) after each message may end; nanoseconds
unqueued     true: publishes with queue_size=None, in the thread that calls publish
batch        so many stamps go in one message
"""

import ctypes
import sys
import threading
import time

import rospy
from mrp_bench.msg import Batch, Stamped
from std_msgs.msg import UInt64

PR_SET_TIMERSLACK = 29  # of prctl(2)
OVERHEAD = 12  # of Stamped: the stamp, and the length of its data


def parameter(name, default=0):
    return rospy.get_param(f"~{name}", default)


def message_type():
    if parameter("batch"):
        return Batch
    return Stamped if parameter("size") > OVERHEAD else UInt64


class Sender:
    """Call it with the stamp of a message to publish that."""

    def __init__(self, publisher):
        self.publisher = publisher
        self.batch = parameter("batch")
        self.stamps = []
        self.data = bytes(max(0, parameter("size") - OVERHEAD))

    def __call__(self, stamp):
        if self.batch:
            self.stamps.append(stamp)
            if len(self.stamps) == self.batch:
                self.publisher.publish(self.stamps)
                self.stamps = []
        elif self.data:
            self.publisher.publish(stamp, self.data)
        else:
            self.publisher.publish(stamp)


def publish():
    queue_size = None if parameter("unqueued") else 0
    publisher = rospy.Publisher("messages", message_type(), queue_size=queue_size)
    send, rate, count = Sender(publisher), parameter("rate"), parameter("count")
    while publisher.get_num_connections() < parameter("publish") and not rospy.is_shutdown():
        time.sleep(0.01)
    if parameter("timer_slack"):
        # Of this thread, which calls publish().
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, parameter("timer_slack"))
    cpu = time.process_time_ns()
    start = time.monotonic_ns()
    for i in range(count):
        if rate:
            time.sleep(max(0, start + i * 1e9 / rate - time.monotonic_ns()) / 1e9)
        send(time.monotonic_ns())
    sys.stdin.read()  # it is closed when the receivers have all messages
    print(time.process_time_ns() - cpu)


def subscribe():
    count = parameter("count")
    samples, cpus, full = [], [], threading.Event()

    def callback(msg):
        arrival = time.monotonic_ns()
        if not samples:
            cpus.append(time.process_time_ns())
        for stamp in batch_of(msg):
            samples.append((stamp, arrival))
        if len(samples) >= count:
            cpus.append(time.process_time_ns())
            full.set()

    kind = message_type()
    batch_of = {
        Batch: lambda msg: msg.stamps,
        Stamped: lambda msg: (msg.stamp,),
        UInt64: lambda msg: (msg.data,),
    }[kind]
    subscriber = rospy.Subscriber("messages", kind, callback)
    rospy.on_shutdown(full.set)
    full.wait()
    print(cpus[-1] - cpus[0])
    for sample in samples:
        print(*sample)


def main():
    rospy.init_node("bench_node", anonymous=True)
    if parameter("publish"):
        publish()
    else:
        subscribe()


if __name__ == "__main__":
    main()
