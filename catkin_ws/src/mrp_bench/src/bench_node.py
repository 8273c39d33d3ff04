#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""The measured node in Python: a publisher or a subscriber. Its queues are unlimited. Arguments:

publish=N     publishes as soon as N subscribers are there
subscribe=1   subscribes
timer_slack=N what rospy's time.sleep(0) after each message may take longer; nanoseconds
unqueued=1    publishes with queue_size=None: in the thread that calls publish
no_delay=1    asks the publisher for TCP_NODELAY
buff_size=N   of the subscriber; bytes
serialised=1  publishes bytes that are a message already
batch=N       messages of 8 bytes go N at a time, in one message
"""

import ctypes
import io
import struct
import time

import rospy
from mrp_bench.msg import Batch, Stamped
from mrp_bench.program import Answers, Samples, obey, options
from std_msgs.msg import UInt64

PR_SET_TIMERSLACK = 29  # of prctl(2)
OVERHEAD = 12  # of Stamped: the stamp, and the length of its data
STAMP_AND_LENGTH = struct.Struct("<QI")


class SerialisedStamped(Stamped):
    """A Stamped that is made of its bytes, which publish() sends as they are."""

    def __init__(self, size):
        self.bytes = bytearray(size)
        STAMP_AND_LENGTH.pack_into(self.bytes, 0, 0, size - OVERHEAD)

    def serialize(self, buff: io.BytesIO):
        buff.write(self.bytes)


class NodeSender:
    def __init__(self, options):
        self.serialised = options.get("serialised")
        self.batch_size = options.get("batch")
        queue = None if options.get("unqueued") else 0
        self.batch = []
        self.small = rospy.Publisher("small", UInt64, queue_size=queue)
        self.large = rospy.Publisher("large", Stamped, queue_size=queue)
        self.batches = rospy.Publisher("batches", Batch, queue_size=queue)

    def wait_for_subscribers(self, count):
        for publisher in (self.small, self.large, self.batches):
            while publisher.get_num_connections() < count and not rospy.is_shutdown():
                time.sleep(0.01)

    def resize(self, size):
        self.size = size
        if size > 8 and self.serialised:
            self.message = SerialisedStamped(size)
        elif size > 8:
            self.message = Stamped(data=bytes(size - OVERHEAD))

    def send(self, stamp):
        if self.size > 8 and self.serialised:
            struct.pack_into("<Q", self.message.bytes, 0, stamp)
            self.large.publish(self.message)
        elif self.size > 8:
            self.message.stamp = stamp
            self.large.publish(self.message)
        elif self.batch_size:
            self.batch.append(stamp)
            if stamp == 0 or len(self.batch) == self.batch_size:
                self.batches.publish(self.batch)
                self.batch = []
        else:
            self.small.publish(UInt64(stamp))


class NodeReceiver:
    def __init__(self, options, answers):
        self.samples = Samples(answers)
        settings = {
            "queue_size": None,
            "tcp_nodelay": bool(options.get("no_delay")),
            "buff_size": options.get("buff_size", 65536),
        }
        self.small = rospy.Subscriber("small", UInt64, self.small_callback, **settings)
        self.others = [
            rospy.Subscriber("large", Stamped, self.large_callback, **settings),
            rospy.Subscriber("batches", Batch, self.batch_callback, **settings),
        ]

    def small_callback(self, msg):
        self.samples.add(msg.data, time.monotonic_ns())

    def large_callback(self, msg):
        self.samples.add(msg.stamp, time.monotonic_ns())

    def batch_callback(self, msg):
        arrival = time.monotonic_ns()
        for stamp in msg.stamps:
            self.samples.add(stamp, arrival)


def main():
    answers = Answers()
    rospy.init_node("bench_node", anonymous=True)
    if options().get("subscribe"):
        receiver = NodeReceiver(options(), answers)
        answers.write("subscribed")
        rospy.spin()
        return
    if options().get("timer_slack"):
        # Of this thread, which calls publish().
        ctypes.CDLL(None).prctl(PR_SET_TIMERSLACK, options()["timer_slack"])
    sender = NodeSender(options())
    sender.wait_for_subscribers(options()["publish"])
    answers.write("ready")
    obey(sender, answers)


if __name__ == "__main__":
    main()
