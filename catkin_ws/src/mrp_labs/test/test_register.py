#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Watches nodes register with their master: addresses, ports, waiting, and leaving."""

import os
import pathlib
import signal
import subprocess
import unittest
import urllib.parse
import xmlrpc.client

import rosgraph
import rostest
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.lab import PACKAGE, Lab
from mrp_testing.master import uri_of
from mrp_testing.nodes import program
from mrp_testing.ports import free_port, ports_of
from mrp_testing.process import LIVE, Process

ADDRESS = "127.0.0.2"  # of this machine, and not that of localhost
ADDRESSES = ("ROS_HOSTNAME", "ROS_IP")


def uri_of_node(name, master_uri=None):
    """Return the URI with which a node has registered."""
    return rosgraph.Master("/test", master_uri=master_uri).lookupNode(name)


class TestRegister(unittest.TestCase):
    def start(self, node, **addresses):
        """Return a node of the tutorial once it is registered.

        addresses: ROS_HOSTNAME and ROS_IP: that of this machine alone, if not given
        """
        env = {name: value for name, value in os.environ.items() if name not in ADDRESSES}
        env.update(addresses or {"ROS_HOSTNAME": "localhost"})
        process = Process(program(contract.PACKAGE, node.executable), env=env)
        self.addCleanup(process.__exit__)
        process.wait_for(lambda: self.publishes(node), node.name + " is registered")
        process.wait_until_it_sleeps()
        return process

    @staticmethod
    def publishes(node):
        return "/" + node.name in Graph().publishers.get("/" + contract.TOPIC, [])

    def check_ros_hostname_wins(self, node):
        for variables, host in (
            ({"ROS_HOSTNAME": "localhost", "ROS_IP": ADDRESS}, "localhost"),
            ({"ROS_IP": ADDRESS}, ADDRESS),
        ):
            process = self.start(node, **variables)
            uri = uri_of_node("/" + node.name)
            self.assertEqual(urllib.parse.urlparse(uri).hostname, host, variables)
            self.assertEqual(process.stop(), 0, str(process))

    def test_ros_hostname_wins_over_ros_ip_cpp(self):
        self.check_ros_hostname_wins(contract.PUBLISHER_CPP)

    def test_ros_hostname_wins_over_ros_ip_py(self):
        self.check_ros_hostname_wins(contract.PUBLISHER_PY)

    def check_two_ports(self, node):
        process = self.start(node)
        uri = uri_of_node("/" + node.name)
        _, _, (_, _, tcpros) = xmlrpc.client.ServerProxy(uri).requestTopic(
            "/test", "/" + contract.TOPIC, [["TCPROS"]]
        )
        self.assertEqual(ports_of(process.pid), sorted([urllib.parse.urlparse(uri).port, tcpros]))
        # From these the system chooses: see ip(7).
        first, last = pathlib.Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()
        for port in ports_of(process.pid):
            self.assertTrue(int(first) <= port <= int(last), port)

    def test_listens_on_two_ports_cpp(self):
        self.check_two_ports(contract.PUBLISHER_CPP)

    def test_listens_on_two_ports_py(self):
        self.check_two_ports(contract.PUBLISHER_PY)

    def test_roslaunch_starts_a_master_if_none_runs(self):
        uri = uri_of(free_port())
        self.assertFalse(rosgraph.is_master_online(uri))
        with Lab("look.launch", extra_env={"ROS_MASTER_URI": uri}) as lab:
            lab.wait_for_count("/look/subscriber_py", 1)
            self.assertTrue(rosgraph.is_master_online(uri))
        self.assertTrue(any("auto-starting new master" in line for line in lab.lines), str(lab))
        # It ends it with itself.
        self.assertFalse(rosgraph.is_master_online(uri))

    def test_roslaunch_with_wait_waits_for_a_master(self):
        port = free_port()
        uri = uri_of(port)
        with Lab("look.launch", "--wait", extra_env={**LIVE, "ROS_MASTER_URI": uri}) as lab:
            lab.wait_for(
                lambda: any("will wait for it to start" in line for line in list(lab.lines)),
                "roslaunch waits",
            )
            self.assertFalse(rosgraph.is_master_online(uri))
            # It waits for roscore, which sets the parameter /run_id, too.
            with Process("roscore", "-p", str(port)):
                lab.wait_for_count("/look/subscriber_py", 1)
                lab.stop()
                # The master is not roslaunch's: it goes on.
                self.assertTrue(rosgraph.is_master_online(uri))

    def test_rosnode_cleanup_takes_a_dead_node_off_the_list(self):
        dead = self.start(contract.PUBLISHER_CPP)
        alive = self.start(contract.PUBLISHER_PY)
        self.assertEqual(dead.stop(signal.SIGKILL), -signal.SIGKILL)
        self.assertTrue(self.publishes(contract.PUBLISHER_CPP))
        cleanup = subprocess.run(
            ["rosnode", "cleanup"], input="y\n", capture_output=True, text=True, env=os.environ
        )
        self.assertEqual(cleanup.returncode, 0, cleanup.stdout + cleanup.stderr)
        self.assertFalse(self.publishes(contract.PUBLISHER_CPP))
        self.assertTrue(self.publishes(contract.PUBLISHER_PY))
        self.assertIsNone(alive.code)


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "register", TestRegister)
