# SPDX-License-Identifier: BSD-3-Clause
"""pub_sub.launch as a student sees it: roslaunch's console, from the start to Ctrl-C."""

import os
import re

from mrp_testing import contract
from mrp_testing.process import Process

# What roslaunch itself prints. Into a pipe it may come late; two threads may share a line. And what
# rospy prints, and goes on, where two nodes that start at once both make the link `latest`.
ROSLAUNCH_LINE = re.compile(
    r"\.\.\. logging to \S+|(Done c|C)hecking log (directory|file) .*|Press Ctrl-C to interrupt"
    r"|started roslaunch server \S+|SUMMARY|=+|PARAMETERS|NODES"
    r"| \* /\S+: .*|  /\S+/|    \w+ \(\S+\)|"
    r"auto-starting new master|ROS_MASTER_URI=\S+|setting /run_id to \S+"
    r"|process\[\S+\]: started with pid \[(?P<pid>\d+)\]|started core service \[/rosout\]"
    r"|(\[\S+\] killing on exit)*|(\.\.\. )?shutting down processing monitor\S*( complete)?|done"
    r"|INFO: cannot create a symlink to latest log directory.*"
)
_ENOUGH = 10  # values of a publisher: less than fill a buffer of 4096 characters
_LATE = 3  # values that one subscriber may be behind the other on a busy machine


def check_console(namespace, *roslaunch, env=None):
    """Run pub_sub.launch through a pipe and end it as Ctrl-C does.

    namespace: of the group, such as "/mrp"
    roslaunch: the command
    env: its environment, if not the test's own

    Raises AssertionError unless the console shows the four nodes' first lines, then at each
    subscriber the values of both publishers as they happen and without a gap, and nothing else;
    and unless the end is exit code 0 with no process left.
    """
    with Process(*roslaunch, env=env) as process:
        process.wait_for(
            lambda: any(len(values) >= _ENOUGH for values in received(process.lines).values()),
            lambda: f"{_ENOUGH} values in {received(process.lines)}",
        )
        check_live(received(process.lines))
        code = process.stop()
    assert code == 0, f"exit code {code} of {process}"

    start_lines, pids = [], []
    for line in process.lines:
        text = contract.logged_text(line)
        roslaunch_line = ROSLAUNCH_LINE.fullmatch(line)
        assert text or roslaunch_line, f"unexpected line {line!r} in {process}"
        if text and _value(text) is None:
            start_lines.append(text)
        if roslaunch_line and roslaunch_line["pid"]:
            pids.append(roslaunch_line["pid"])
    assert sorted(start_lines) == sorted(
        node.start_line.format(namespace + "/" + node.name) for node in contract.NODES
    ), str(process)
    assert len(pids) >= len(contract.NODES), str(process)
    left = [pid for pid in pids if os.path.exists("/proc/" + pid)]
    assert not left, f"processes {left} are left of {process}"
    for pair, values in received(process.lines).items():
        fault = contract.first_fault(values)
        assert fault is None, f"{pair}: {fault} in {process}"


def check_live(values):
    """Raise AssertionError if one subscriber's values are held back, behind those of the other.

    values: (subscriber's name, publisher's name) -> values, as of received()
    """
    for publisher in contract.PUBLISHERS:
        shown = [values[s.name, publisher.name][-1:] for s in contract.SUBSCRIBERS]
        assert all(shown) and abs(shown[0][0] - shown[1][0]) <= _LATE * contract.STEP, (
            f"lines are held back: last values of {publisher.name} are {shown}"
        )


def received(lines):
    """Return (subscriber's name, publisher's name) -> values, from console lines."""
    values = {(s.name, p.name): [] for s in contract.SUBSCRIBERS for p in contract.PUBLISHERS}
    for line in list(lines):
        subscriber_and_value = _value(contract.logged_text(line) or "")
        if subscriber_and_value:
            subscriber, value = subscriber_and_value
            values[subscriber.name, contract.publisher_of(value).name].append(value)
    return values


def _value(text):
    """Return (subscriber, value) of what a subscriber logs on receiving, or None."""
    for subscriber in contract.SUBSCRIBERS:
        value = contract.received_value(subscriber, text)
        if value is not None:
            return subscriber, value
    return None
