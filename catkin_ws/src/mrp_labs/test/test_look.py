#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Looks at a running graph with the very commands that a student types."""

import os
import re
import shlex
import signal
import unittest
import urllib.parse

import rosgraph
import rostest
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.nodes import pid_of
from mrp_testing.process import LIVE, Process

PUBLISHERS = ("/look/publisher_cpp", "/look/publisher_py")
SUBSCRIBERS = ("/look/subscriber_cpp", "/look/subscriber_py")
TOPIC = "/look/great_topic"


def start(command):
    return Process(*shlex.split(command), extra_env=LIVE)


def typed(*commands):
    """Run commands side by side; return what each has printed, without empty lines."""
    result = []
    processes = [start(command) for command in commands]
    for process in processes:
        with process:
            code = process.wait()
            assert code == 0, f"exit code {code} of {process}"
            result.append([line.strip() for line in process.lines if line.strip()])
    return result


def average(process):
    """Return the last average that rostopic hz or bw has printed, or 0."""
    found = re.findall(r"average(?: rate)?: ([\d.]+)", "\n".join(process.lines))
    return float(found[-1]) if found else 0


def is_near(value, expected):
    return 0.8 * expected < value < 1.2 * expected


def without_address(lines):
    """Return the lines, each without the address of a node or of a connection."""
    return [re.sub(r" \(.*", "", line) for line in lines]


def wait_until_connected(running):
    for subscriber in SUBSCRIBERS:
        for publisher in PUBLISHERS:
            running.wait_for(
                lambda: running.values(subscriber, publisher), f"{publisher} to {subscriber}"
            )


class TestLook(unittest.TestCase):
    def test_commands(self):
        with Lab("look.launch") as running:
            wait_until_connected(running)
            self.check_commands_that_end()
            self.check_commands_until_ctrl_c()
            self.check_roswtf(running)

    def check_commands_that_end(self):
        nodes, ping, publisher, subscriber, *of_topics = typed(
            "rosnode list",
            "rosnode ping -c 1 /look/publisher_py",
            "rosnode info /look/publisher_cpp",
            "rosnode info /look/subscriber_py",
            "rostopic list",
            "rostopic list -v",
            f"rostopic info {TOPIC}",
            f"rostopic type {TOPIC}",
            f"rostopic echo -n 6 {TOPIC}",
        )
        self.assertEqual([node for node in nodes if "/look/" in node], [*PUBLISHERS, *SUBSCRIBERS])
        self.assertIn("xmlrpc reply from", ping[-1])
        # The connections: to each subscriber, from each publisher.
        text = "\n".join(without_address(publisher))
        self.assertIn(f"Publications:\n* {TOPIC} [std_msgs/UInt32]\n", text)
        self.assertIn("Subscriptions: None", text)
        for name in SUBSCRIBERS:
            self.assertIn(f"* topic: {TOPIC}\n* to: {name}\n* direction: outbound", text)
        text = "\n".join(without_address(subscriber))
        self.assertIn(f"Subscriptions:\n* {TOPIC} [std_msgs/UInt32]\n", text)
        for name in PUBLISHERS:
            self.assertIn(f"* topic: {TOPIC}\n* to: {name}\n* direction: inbound", text)
        self.check_topics(*of_topics)
        # The port at which a C++ node is called listens to all machines, that of a Python one not.
        listening = [
            connection.split()[1]
            for connection in open("/proc/net/tcp")
            if connection.split()[3] == "0A"
        ]
        for name, address in zip(PUBLISHERS, ("00000000", "0100007F")):
            port = urllib.parse.urlparse(rosgraph.Master("/test_look").lookupNode(name)).port
            self.assertIn(f"{address}:{port:04X}", listening, name)

    def check_topics(self, topics, verbose, info, type_, echo):
        self.assertIn(TOPIC, topics)
        self.assertIn(f"* {TOPIC} [std_msgs/UInt32] 2 publishers", verbose)
        self.assertTrue(any(line.startswith(f"* {TOPIC} [std_msgs/UInt32] ") for line in verbose))
        self.assertEqual(type_, ["std_msgs/UInt32"])
        self.assertEqual(
            [line for line in without_address(info) if "rostopic" not in line],
            ["Type: std_msgs/UInt32", "Publishers:"]
            + [f"* {publisher}" for publisher in PUBLISHERS]
            + ["Subscribers:"]
            + [f"* {subscriber}" for subscriber in SUBSCRIBERS],
        )
        # Both counts, each without a gap.
        values = [int(line[len("data: ") :]) for line in echo if line.startswith("data: ")]
        self.assertEqual(len(values), 6)
        for parity in (0, 1):
            count = [value for value in values if value % 2 == parity]
            self.assertTrue(count, values)
            self.assertEqual(count, list(range(count[0], count[-1] + 1, 2)))

    def check_commands_until_ctrl_c(self):
        with start(f"rostopic hz {TOPIC}") as hz, start(f"rostopic bw {TOPIC}") as bw, start(
            "rosgraph"
        ) as graph:
            # Two publishers, two messages a second each, four bytes a message.
            hz.wait_for(lambda: is_near(average(hz), 4), "4 messages a second")
            bw.wait_for(lambda: is_near(average(bw), 16), "16 bytes a second")
            self.assertIn("mean: 4.00B min: 4.00B max: 4.00B", "\n".join(bw.lines))
            graph.wait_for(lambda: "Services:" in graph.lines, "the graph")
            text = "\n".join(graph.lines)
            for publisher in PUBLISHERS:
                self.assertRegex(text, rf"  {publisher} :\n    Inbound:\n    Outbound:\n")
            for subscriber in SUBSCRIBERS:
                inbound = re.search(rf"  {subscriber} :\n    Inbound:\n(.*\n.*)\n    Out", text)
                self.assertEqual(sorted(inbound[1].split()), list(PUBLISHERS))
            for process in (hz, bw, graph):
                self.assertEqual(process.stop(), 0, str(process))

    def check_roswtf(self, running):
        # About Debian it has something to say too, but about a healthy graph nothing.
        (healthy,) = typed("roswtf")
        self.assertEqual(healthy[-2:], ["Online checks summary:", "No errors or warnings"])

        pid = pid_of("/look/publisher_py")
        os.kill(pid, signal.SIGKILL)
        running.wait_for(
            lambda: any(f"has died [pid {pid}" in line for line in list(running.lines)),
            "roslaunch says that it has died",
        )
        wtf, nodes = typed("roswtf", "rosnode list")
        online = wtf[wtf.index("Online checks summary:") :]
        place = online.index("ERROR Could not contact the following nodes:")
        self.assertEqual(online[place + 1], "* /look/publisher_py")
        # It is dead, and still on the list.
        self.assertIn("/look/publisher_py", nodes)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "look", TestLook)
