# SPDX-License-Identifier: BSD-3-Clause
"""What comes before the node's start: nothing is logged yet, and the arguments are not its own yet.

roslaunch and remaps add arguments, such as __name:=talker, and ros::init() takes them out:
https://wiki.ros.org/roscpp/Overview/Initialization%20and%20Shutdown
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import NOTE, WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.sources import in_both
from mrp_check.sources.python_source import Source

_BEFORE = re.compile(r"\bint\s+main\s*\([^)]*\)(.*?)\bros::init\s*\(", re.DOTALL)
_COUNTS = re.compile(r"\bargc\s*[!=<>]|[!=<>]=?\s*argc\b")
_LOGS = re.compile(r"\bROS_(?:INFO|WARN|ERROR|FATAL)(?:_STREAM)?\s*\(")
# Python itself shows what is worse.
_OF_SERVICES = {"rospy.ServiceProxy", "rospy.wait_for_service"}
_LOGGED = {"rospy.logdebug", "rospy.loginfo"}


def _findings(case: Case) -> Iterator[Finding]:
    launched = {started.type for launch in case.launches for started in launch.nodes}
    for node, files in case.facts.sources.items():
        yield from _never(case, node, files)
    for one in in_both.each(case):
        yield from _asleep(one, one.python) if one.python else ()
        counted, logged = _in_python(one.python) if one.python else _in_cpp(one.code)
        start = "rospy.init_node()" if one.python else "ros::init()"
        if counted:
            own = "rospy.myargv()" if one.python else "argc after ros::init()"
            severity = WARNING if one.node in launched or not one.python else NOTE
            yield one.finding(
                "starts",
                f"{one.node} counts its arguments with those that are meant for ROS: roslaunch and"
                " a remap add some, and then the count is wrong.",
                counted,
                expected=own,
                fix=f"Count {own}.",
                severity=severity,
            )
        if logged:
            shown = "it is not shown" if one.python else "it does not come to /rosout"
            yield one.finding(
                "node-start",
                f"{one.node} logs this before {start}: {shown}.",
                logged,
                expected=f"{start} before the first line that is logged",
                fix=f"Move it to below {start}.",
            )


def _asleep(one: in_both.OfNode, source: Source) -> Iterator[Finding]:
    """Yield a warning about a program in Python that sleeps before it becomes a node."""
    calls = [(source.dotted(call.func), call) for call in source.nodes(ast.Call)]
    starts = [call for name, call in calls if name == "rospy.init_node"]
    # What starts the node, in the order of the program's own lines.
    started = {source.function(call) for call in starts}
    lines = [call.lineno for call in starts if source.function(call) is source.tree]
    lines += [call.lineno for _, call in calls if source.definition(call.func) in started]
    for name, call in calls:
        seconds = source.value(call.args[0]) if name == "time.sleep" and call.args else None
        is_main = source.function(call) is source.tree and lines and call.lineno < min(lines)
        if is_main and isinstance(seconds, (int, float)) and seconds >= 1:
            yield one.finding(
                "node-start",
                f"{one.node} sleeps before rospy.init_node(): it is no node yet, and Ctrl-C"
                " ends it with a traceback.",
                call.lineno,
                expected="rospy.init_node() first, and a wait for what is needed",
                fix="Start the node first; then wait for a message or a service.",
            )


def _never(case: Case, node: str, files: list[str]) -> Iterator[Finding]:
    """Yield a note about a Python program that calls services, and never becomes a node."""
    sources = [*filter(None, map(case.facts.python.get, files))]
    calls = [(one.dotted(call.func), one, call) for one in sources for call in one.nodes(ast.Call)]
    asks = [(one, call) for name, one, call in calls if name in _OF_SERVICES]
    if asks and not any(name == "rospy.init_node" for name, _, _ in calls):
        source, call = min(asks, key=lambda ask: ask[1].lineno)
        yield Finding(
            "node-start",
            f"{node} never calls rospy.init_node(): it is no node. rosnode does not list it, no"
            " remap reaches it, and what it logs does not come to /rosout.",
            source.file,
            call.lineno,
            NOTE,
            expected="rospy.init_node() first",
            seen=case.package.line(source.file, call.lineno),
            fix=f'Write rospy.init_node("{node.partition(".")[0]}", anonymous=True) before it.',
            node=node,
        )


def _in_cpp(text: str) -> tuple[int, int]:
    """Return the lines at which main() counts arguments, and logs, before ros::init(); or 0."""
    before = _BEFORE.search(text)
    found = [shape.search(text, *before.span(1)) if before else None for shape in (_COUNTS, _LOGS)]
    counted, logged = (line_of(match) if match else 0 for match in found)
    return counted, logged


def _in_python(source: Source) -> tuple[int, int]:
    """Return the lines at which the arguments of ROS are counted, too, and at which something is
    logged before rospy.init_node(); or 0."""
    calls = [(source.dotted(call.func), call) for call in source.nodes(ast.Call)]
    starts = [call for name, call in calls if name == "rospy.init_node"]
    counted = [
        call.lineno
        for call in source.nodes(ast.Call)
        if isinstance(call.func, ast.Name) and call.func.id == "len"
        if call.args and source.dotted(call.args[0]) == "sys.argv"
    ]
    is_own = any(name == "rospy.myargv" for name, _ in calls)
    logged = [
        call.lineno
        for name, call in calls
        if name in _LOGGED and len(starts) == 1 and _is_before(source, call, starts[0])
    ]
    return 0 if is_own else min(counted, default=0), min(logged, default=0)


def _is_before(source: Source, call: ast.Call, start: ast.Call) -> bool:
    """Return whether a call comes before the node's start in its function, or before the program
    calls that function."""
    function, main = source.function(start), source.function(call)
    if main is function:
        return call.lineno < start.lineno
    calls = [one for one in source.nodes(ast.Call) if source.definition(one.func) is function]
    return [source.function(one) for one in calls] == [main] and call.lineno < calls[0].lineno


RULE = Rule("static", 96, ("facts", "launch"), _findings, also=("starts", "node-start"), only=ANY)
