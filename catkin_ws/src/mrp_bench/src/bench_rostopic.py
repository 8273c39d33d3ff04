#!/usr/bin/env python
# SPDX-License-Identifier: BSD-3-Clause
"""rostopic as a measured program: publish=1 is `rostopic pub`, subscribe=1 is `rostopic echo`."""

import array
import fcntl
import re
import subprocess
import termios
import time
import xmlrpc.client

import rosgraph
from mrp_bench.processes import with_parent
from mrp_bench.program import Answers, Samples, obey, options

TOPIC = "small"


class RostopicSender:
    """`rostopic pub` publishes what it reads as YAML."""

    def __init__(self):
        # Its own rate is 10 Hz; this one is as good as none.
        command = ["rostopic", "pub", "--rate", "1000000", TOPIC, "std_msgs/UInt64"]
        self.rostopic = subprocess.Popen(with_parent(command), stdin=subprocess.PIPE)

    def resize(self, size):
        pass

    def send(self, stamp):
        # In two pieces: of two lines that come at once, it sees the second only when more comes.
        self.write(f"data: {stamp}\n")
        self.write("---\n")

    def write(self, text):
        self.rostopic.stdin.write(text.encode())
        self.rostopic.stdin.flush()
        unread = array.array("i", [1])
        while unread[0]:
            fcntl.ioctl(self.rostopic.stdin, termios.FIONREAD, unread)


def wait_for_connection():
    """Wait until a publisher of the topic is connected with a subscriber."""
    master = rosgraph.Master("/bench_rostopic")
    topic = rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(), TOPIC)
    while True:
        publishers, _, _ = master.getSystemState()
        for name in dict(publishers).get(topic, []):
            node = xmlrpc.client.ServerProxy(master.lookupNode(name))
            connections = node.getBusInfo("/bench_rostopic")[2]
            if any(direction == "o" and topic in rest for _, _, direction, *rest in connections):
                return
        time.sleep(0.05)


def receive(answers):
    samples = Samples(answers)
    command = ["rostopic", "echo", TOPIC]
    rostopic = subprocess.Popen(with_parent(command), stdout=subprocess.PIPE, text=True)
    answers.write("subscribed")
    for line in rostopic.stdout:
        arrival = time.monotonic_ns()
        match = re.fullmatch(r"data: (\d+)\n", line)
        if match:
            samples.add(int(match.group(1)), arrival)


def main():
    answers = Answers()
    if options().get("subscribe"):
        receive(answers)
        return
    sender = RostopicSender()
    wait_for_connection()
    answers.write("ready")
    obey(sender, answers)


if __name__ == "__main__":
    main()
