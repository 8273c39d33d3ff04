# SPDX-License-Identifier: BSD-3-Clause
"""Nodes under test: started with rosrun or without it, and found by their names."""

import xmlrpc.client

import rosgraph
import roslib.packages

from mrp_testing import contract
from mrp_testing.process import LIVE, Process


def rosrun(node, *arguments):
    """Start a node of the contract with rosrun."""
    return Process("rosrun", contract.PACKAGE, node.executable, *arguments, extra_env=LIVE)


def program(package, executable):
    """Return the path of a package's program. It starts sooner by it than by rosrun."""
    return roslib.packages.find_node(package, executable)[0]


def run(node, *arguments):
    """Start a node of the contract without rosrun, which takes longer than the node itself."""
    return Process(program(contract.PACKAGE, node.executable), *arguments, extra_env=LIVE)


def pid_of(name, master_uri=None):
    """Return the process id of a running node, or None if the master or the node does not answer.

    master_uri: if not the test's own
    """
    return _answer(name, "getPid", master_uri)


def connections_of(name):
    """Return a running node's connections, as it tells of them (getBusInfo); none if it does not
    answer, as it is still starting."""
    return _answer(name, "getBusInfo") or []


def receivers_of(name, topic):
    """Return the nodes to which a running node sends what it publishes on a topic.

    A subscriber knows of a connection before the publisher does, which until then sends nothing.
    """
    return sorted(
        to
        for _, to, direction, _, connected, *_ in connections_of(name)
        if (direction, connected) == ("o", topic)
    )


def _answer(name, question, master_uri=None):
    try:
        uri = rosgraph.Master("/test", master_uri=master_uri).lookupNode(name)
        _, _, answer = getattr(xmlrpc.client.ServerProxy(uri), question)("/test")
        return answer
    except (rosgraph.MasterException, OSError):
        return None
