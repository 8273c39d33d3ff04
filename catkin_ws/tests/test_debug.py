# SPDX-License-Identifier: BSD-3-Clause
"""Debugs a node as the page "anywhere" says: gdb and pdb stop in a callback."""

import contextlib

import pexpect
import pytest
from front_door import environment
from mrp_testing import contract, scratch
from mrp_testing.master import master, uri_of
from mrp_testing.ports import free_port
from mrp_testing.waiting import DEADLINE
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.slow


@contextlib.contextmanager
def debugged(*command):
    """Start a node beside a master of its own; yield a function that types a line at the debugger's
    prompt, and returns what it answers."""
    port = free_port()
    env = environment(ROS_MASTER_URI=uri_of(port), TERM="dumb")
    sourced = scratch.sourced(WORKSPACE / "devel" / "setup.bash", *command)
    with master(port):
        child = pexpect.spawn(
            sourced[0],
            list(sourced[1:]),
            env=env,
            encoding="utf-8",
            timeout=DEADLINE,
            dimensions=(500, 500),
        )

        def type_(line):
            child.sendline(line)
            child.expect(r"\((gdb|Pdb)\) ")
            return child.before

        try:
            child.expect(r"\((gdb|Pdb)\) ")
            yield type_
        finally:
            child.close(force=True)


def test_gdb_stops_in_a_callback():
    node = contract.PUBLISHER_CPP.executable
    with debugged("rosrun", "--prefix", "gdb --args", "mrp", node) as type_:
        type_("break PublisherCppNode::timerCallback")
        assert "Breakpoint 1, PublisherCppNode::timerCallback" in type_("run")
        assert "$1 = 2" in type_("print counter_")


def test_breakpoint_stops_in_a_callback(tmp_path):
    text = (WORKSPACE / "src/mrp/src/publisher_py_node.py").read_text()
    line = "        msg = UInt32()\n"
    assert line in text
    node = tmp_path / "publisher_py_node.py"
    node.write_text(text.replace(line, "        breakpoint()\n" + line))
    with debugged("/usr/bin/python3", node) as type_:
        assert type_("p self.counter").split()[-1] == "1"
        type_("continue")
        assert type_("p self.counter").split()[-1] == "3"
