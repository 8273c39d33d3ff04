# SPDX-License-Identifier: BSD-3-Clause
"""An action server looks whether its goal has been cancelled, and starts when it is ready.

https://wiki.ros.org/actionlib/DetailedDescription; both libraries warn of auto_start themselves.
"""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import in_both
from mrp_check.code.python_facts import argument
from mrp_check.code.python_source import Source
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of

_SERVER = re.compile(r"\bSimpleActionServer\s*<")
_STARTED = re.compile(r"\bSimpleActionServer\s*<[^;{}]*>\s*\w+\s*\([^;{}]*,\s*true\s*\)")
_ASKS = re.compile(r"isPreemptRequested|setPreempted|registerPreemptCallback")
_FUNCTION = re.compile(r"\bvoid\s+[\w:]+\s*\([^)]*\)")
_LOOP = re.compile(r"\b(?:for|while)\s*\(")
_LASTS = re.compile(r"\bpublishFeedback\s*\(|\bsleep\s*\(")
_OK = re.compile(r"\b(?:ok|isShuttingDown)\s*\(")
_LASTING = {"sleep", "publish_feedback"}
_LONG = 2  # seconds
_SLEEPS = re.compile(r"\bsleep\s*\(")


def _findings(case: Case) -> Iterator[Finding]:
    for one in in_both.each(case):
        loop, deaf, started = _in_python(one.python) if one.python else _in_cpp(one.code)
        asked = "is_preempt_requested()" if one.python else "isPreemptRequested()"
        if loop:
            shutdown = "rospy.is_shutdown()" if one.python else "ros::ok()"
            more = f" nor {shutdown}: it goes on, after Ctrl-C, too." if deaf else ": it goes on."
            what = "sleep()" if _SLEEPS.search(case.package.line(one.file, loop)) else "loop"
            said = f"This {what} does not ask whether its goal has been cancelled{more}"
            fix = f"Ask {asked} in each turn, and end the goal as preempted."
            yield one.finding("callbacks", said, loop, f"{asked} in the loop", fix)
        if one.python and _never_started(one.python):
            yield one.finding(
                "callbacks",
                "The action server is made with auto_start=False, and nothing calls its start():"
                " no goal ever reaches it.",
                _never_started(one.python),
                "start(), when all else is made",
                "Call start() on it.",
            )
        if started:
            said = "The action server starts when it is made: a goal may come too early."
            wanted = "auto_start=False" if one.python else "false as the last argument"
            fix = f"Give it {wanted}, and call its start() when all else is made."
            yield one.finding("callbacks", said, started, f"{wanted}, and start()", fix)


def _in_cpp(text: str) -> tuple[int, bool, int]:
    """Return the line of a loop that should ask, whether it goes on after Ctrl-C, and the line of a
    server that starts at once; 0 for what is not there."""
    if not _SERVER.search(text):
        return 0, False, 0
    started, end = _STARTED.search(text), text.find("setSucceeded")
    functions = [*_FUNCTION.finditer(text, 0, max(end, 0))]
    begin = functions[-1].end() if functions else 0
    loop = _LOOP.search(text, begin, max(end, 0))
    asks = _ASKS.search(text) or not loop or not _LASTS.search(text, loop.end(), end)
    begins = line_of(started) if started else 0
    if asks or not loop:
        return 0, False, begins
    deaf = loop[0].startswith("while") and not _OK.search(text, loop.start(), end)
    return line_of(loop), deaf, begins


def _in_python(source: Source) -> tuple[int, bool, int]:
    """Return the same of a source in Python."""
    started = 0
    found: ast.stmt | ast.expr | None = None
    for call in source.nodes(ast.Call):
        if source.dotted(call.func) != "actionlib.SimpleActionServer":
            continue
        at_once = argument(call, 3, "auto_start")
        if at_once is None or source.value(at_once) is True:
            started = call.lineno
        work = source.definition(argument(call, 2, "execute_cb"))
        if isinstance(work, ast.FunctionDef) and not _asks(source):
            lasting = (one for one in ast.walk(work) if isinstance(one, (ast.For, ast.While)))
            found = next((one for one in lasting if _LASTING & _attributes(one)), None)
            found = found or _long_sleep(source, work)
    deaf = isinstance(found, ast.While) and "is_shutdown" not in _attributes(found)
    return found.lineno if found else 0, deaf, started


def _never_started(source: Source) -> int:
    """Return the line of a server that waits for its start(), where none is called; or 0."""
    if "start" in _attributes(source.tree):
        return 0
    for call in source.nodes(ast.Call):
        if source.dotted(call.func) == "actionlib.SimpleActionServer":
            if source.value(argument(call, 3, "auto_start")) is False:
                return call.lineno
    return 0


def _asks(source: Source) -> bool:
    return bool({"is_preempt_requested", "set_preempted"} & _attributes(source.tree))


def _long_sleep(source: Source, work: ast.FunctionDef) -> ast.Call | None:
    """Return a sleep in a function that is long, or as long as the goal says."""
    within = [work, *source.called([work])]
    for call in (one for part in within for one in ast.walk(part) if isinstance(one, ast.Call)):
        if source.dotted(call.func) in ("time.sleep", "rospy.sleep") and call.args:
            seconds = source.value(call.args[0])
            if not isinstance(seconds, (int, float)) or seconds >= _LONG:
                return call
    return None


def _attributes(within: ast.AST) -> set[str]:
    return {node.attr for node in ast.walk(within) if isinstance(node, ast.Attribute)}


RULE = Rule("static", ("facts",), _findings, also=("callbacks",), only=ANY)
