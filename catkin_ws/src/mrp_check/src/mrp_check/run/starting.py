# SPDX-License-Identifier: BSD-3-Clause
"""Why a node is not up soon after it is started."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.confined.places import Kind
from mrp_check.confined.seen import Alone
from mrp_check.contract.finding import HINT, SEEN, Finding, Where
from mrp_check.run.source_lines import Traceback
from mrp_check.run.traces import Traces
from mrp_check.run.words import code_text, last_words

_EXPECTED = "a node that runs until Ctrl-C"


def start_findings(node: Traces) -> Iterator[Finding]:
    """Yield a Finding if the node is not up soon after it is started."""
    direct = node.direct or Alone()
    code, registered = direct.code, node.is_registered
    died = node.died()
    if node.in_launch and registered and died is None:
        # Under its launch file it is well; by itself it may need what that gives it.
        return
    if node.in_launch and died is not None:
        code = died
    elif any(node.name in launched.kept_up() for launched in node.places.observed.launches):
        return  # the same, without a contract
    elif direct.ended_after is None:
        if node.in_launch and not registered and not node.own_name:
            yield _not_registered(node)
        return
    # By itself, it is answered as the contract says; beside others, as these do.
    if node.wanted.ends and 0 in (code, direct.code if direct.asked is None else None):
        return
    found = traceback_of(node)
    if found and code != 0:
        yield _raised(node, *found)
    elif code != 0:
        yield _failed(node, code, bool(registered or node.own_name))
    elif registered or node.own_name:
        yield _ended(node)
    else:
        yield node.finding(
            "node-start",
            f"{node.name} ends at once, without having started ROS.",
            node.places.of(node.name, Kind.INIT),
            expected=_EXPECTED,
            seen="it ended with exit code 0, and the master never heard of it",
            fix="Make sure that main() is called, and that it starts the node.",
        )


def traceback_of(node: Traces) -> Traceback | None:
    """Return the last traceback of the node: of its own run, or of what roslaunch shows."""
    found = node.places.traceback(node.errors())
    if found is None:
        # roslaunch shows the lines of all nodes together.
        found = node.places.traceback(node.console)
        if found and found[0][0] not in node.places.sources(node.name):
            found = None
    return found


def _raised(node: Traces, place: Where, kind: str, text: str) -> Finding:
    module = re.match(r"No module named '(\w+)", text)
    name = module.group(1).lstrip("_") if module else ""
    is_known = name in node.places.facts.absent(node.name)
    # What one of Python's or Debian's modules imports is named by no source.
    apart = not is_known and uses.is_of_debian(name)
    return node.finding(
        id_of_error(kind, text, "starts"),
        f"{node.name} ends as soon as it is started: {kind}: {text}"
        + (f" It isn't on this machine: {uses.absent(name, 'python')}." if apart else ""),
        place,
        HINT if is_known or apart or is_unanswered(kind, text) else SEEN,
        expected=_EXPECTED,
        seen=f"{kind}: {text}",
    )


def _ended(node: Traces) -> Finding:
    """Return the Finding about a node that started ROS, and came to its end."""
    exits = node.places.facts.exits(node.name)
    if exits and node.places.facts.of(node.name, Kind.SPIN):
        why = f", though it waits: most likely by its call of {exits[0].text}()."
        place: Where = exits[0].file, exits[0].line
        fix = "Remove the call, or make sure that it only runs at the end."
    else:
        why = ": nothing keeps it waiting for messages or for its timer."
        end = node.places.facts.end_of_main(node.name)
        place = end or node.places.of(node.name, Kind.INIT, Kind.SPIN)
        fix = "Call rospy.spin() or ros::spin() at the end of main()."
    return node.finding(
        "spin",
        f"{node.name} ends by itself soon after it has started{why}",
        place,
        expected=_EXPECTED,
        seen="it ended with exit code 0",
        fix=fix,
    )


def _failed(node: Traces, code: int | None, started_ros: bool) -> Finding:
    words = last_words(node.errors())
    is_too_early = "must call ros::init" in words
    kinds = (Kind.GLOBAL, Kind.HANDLE) if is_too_early else (Kind.INIT, Kind.HANDLE)
    return node.finding(
        "starts" if started_ros else _id_of_words(words),
        f"{node.name} ends soon after it is started, {code_text(code)}"
        + (f", with the words: {words}" if words else "."),
        node.places.of(node.name, *kinds),
        expected=_EXPECTED,
        seen=code_text(code),
        why="init-first" if is_too_early else "",
    )


def _not_registered(node: Traces) -> Finding:
    return node.finding(
        "node-start",
        f"{node.name} runs, but the master hasn't heard of it.",
        node.places.of(node.name, Kind.INIT, Kind.LOOP),
        expected=f"a node {node.path}",
        seen="no node of that name",
    )


def is_unanswered(kind: str, text: str) -> bool:
    """Return whether an error says that no other program, or no other machine, answers here."""
    return kind.endswith(("ConnectionRefusedError", "gaierror")) or "unreachable" in text


def id_of_error(kind: str, text: str, otherwise: str) -> str:
    """Return the requirement that an error's class belongs to."""
    # That a number has no such attribute says nothing of the name, but of what it is used on.
    built_in = re.match(
        r"'(int|float|str|bytes|bool|list|tuple|dict|NoneType|function)' object", text
    )
    names = "NameError AttributeError ImportError ModuleNotFoundError UnboundLocalError".split()
    if kind in names and not built_in:
        return "python-names"
    if kind in ("SyntaxError", "IndentationError", "TabError"):
        return "python-syntax"
    if "Serialization" in kind or "must be" in text and "field" in text:
        return "type"
    if kind == "ROSInitException" or "init_node" in text:
        return "node-start"
    return otherwise


def _id_of_words(text: str) -> str:
    words = ("ros::init", "must call", "Couldn't find an AF_INET", "init_node")
    if any(word in text for word in words):
        return "node-start"
    scripts = ("No such file or directory", "not found", "Permission denied", "Exec format")
    return "scripts" if any(word in text for word in scripts) else "starts"
