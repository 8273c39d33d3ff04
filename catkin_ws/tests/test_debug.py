# SPDX-License-Identifier: BSD-3-Clause
"""Runs make debug at a terminal: gdb and pdb stop in a callback, and leave nothing behind."""

import re

import pexpect
import pytest
from front_door import environment, make
from mrp_testing import contract
from mrp_testing.graph import Graph
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.process import processes_with
from mrp_testing.waiting import DEADLINE
from mrp_testing.workspace import ROOT, WORKSPACE

pytestmark = pytest.mark.slow


@pytest.fixture
def port(monkeypatch):
    port = free_port()
    monkeypatch.setenv("ROS_MASTER_URI", uri_of(port))
    with master(port):
        yield port


def debug(node, port, *dialogue):
    """Type each line of the dialogue at the debugger's prompt; return what it said, then quit."""
    printed = []
    env = environment(ROS_MASTER_URI=uri_of(port), TERM="dumb")
    arguments = ["-C", str(ROOT), "--no-print-directory", "debug", f"NODE={node}"]
    child = pexpect.spawn("make", arguments, env=env, encoding="utf-8", timeout=DEADLINE)
    try:
        child.expect(r"\((gdb|Pdb)\) ")
        for line in dialogue:
            child.sendline(line)
            child.expect(r"\((gdb|Pdb)\) ")
            printed.append(child.before)
        child.sendline("quit")
        child.expect(pexpect.EOF)
    finally:
        child.close(force=True)
    assert f"{contract.GROUP}/{node}" not in Graph().nodes
    assert [command for command in processes_with(uri_of(port)).values() if node in command] == []
    return printed


def test_gdb_stops_in_the_callback(port):
    commands = ("break PublisherCppNode::timerCallback", "run", "print counter_", "continue")
    _, stopped, value, _ = debug("publisher_cpp_node", port, *commands)
    assert "Breakpoint 1, PublisherCppNode::timerCallback" in stopped
    assert "namespace of nh = /mrp/publisher_cpp_node" in stopped
    assert "$1 = 2" in value


def test_pdb_stops_in_the_callback(port):
    lines = (WORKSPACE / "src/mrp/src/publisher_py_node.py").read_text().splitlines()
    number = 1 + next(i for i, line in enumerate(lines) if "msg.data =" in line)
    commands = (f"break {number}", "continue", "p self.counter", "continue", "p self.counter")
    _, stopped, first, _, second = debug("publisher_py_node", port, *commands)
    assert f"publisher_py_node.py({number})timer_callback()" in stopped
    assert "namespace of node = /mrp/publisher_py_node" in stopped
    assert [re.findall(r"^\d+", printed, re.MULTILINE) for printed in (first, second)] == [
        ["1"],
        ["3"],
    ]


def test_without_a_master_or_a_node_it_says_what_to_do():
    printed = make("debug", "NODE=publisher_py_node").stdout
    assert re.search(
        "^error: no master answers at .*: start the nodes .*: make run$", printed, re.M
    )
    printed = make("debug", "NODE=no_node").stdout
    names = ", ".join(sorted(node.name for node in contract.NODES))
    assert f"error: expected NODE=NAME, one of: {names}\n" in printed
