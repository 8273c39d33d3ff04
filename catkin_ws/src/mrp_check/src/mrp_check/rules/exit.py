# SPDX-License-Identifier: BSD-3-Clause
"""Each node ends cleanly on Ctrl-C."""

from __future__ import annotations

import re
import signal

from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.running.node import Node
from mrp_check.running.words import code_text, last_words

# What rospy itself may say when a message is published at the very moment of the end.
_AT_THE_END = ("closed topic", "ROSInterruptException: rospy shutdown")


def findings(case):
    """Yield a Finding for each node that does not end as the spec says."""
    for node in case.nodes.values():
        if node.direct and node.direct.get("asked") is not None:
            yield from _of(node, case.spec.shutdown)


def _of(node, shutdown):
    direct, places = node.direct, node.places
    since = direct["asked"] - 0.1
    lines = [text for time, stream, text in direct["lines"] if stream == "err" and time >= since]
    expected = f"exit code {shutdown.exit_code} within {shutdown.seconds:g} s of {shutdown.signal}"

    def finding(message, place, seen, fix=""):
        return node.finding("exit", message, place, expected=expected, seen=seen, fix=fix)

    code, traceback = direct["code"], places.traceback(lines)
    if direct["stopped_in"] is None:
        # If roslaunch could end it, the machine was too busy.
        if _needs_force(node.name, places.observed.launch):
            yield finding(
                f"{node.name} does not end on Ctrl-C: it was still there after"
                f" {shutdown.seconds:g} s.",
                places.stack(lines) or _waits(node),
                "it goes on",
                "Let loops end when rospy.is_shutdown() is true or ros::ok() is false, and let no"
                " thread outlive main().",
            )
    elif code != shutdown.exit_code and "lock_error" in "\n".join(lines):
        yield finding(*_outlives(node, code), "Let an object in main() own it.")
    elif code != shutdown.exit_code:
        place, why = _cause(node, code, lines, traceback)
        yield finding(
            f"On {shutdown.signal}, {node.name} ends {code_text(code)}, not with exit code"
            f" {shutdown.exit_code}.{why}",
            place,
            code_text(code),
        )
    elif traceback and not any(words in line for words in _AT_THE_END for line in lines):
        place, kind, text = traceback
        yield finding(f"{node.name} ends with an error: {kind}: {text}", place, f"{kind}: {text}")
    elif direct["still_registered"] and shutdown.signal == "SIGINT":
        yield finding(
            f"{node.name} ends without telling the master, which still lists it.",
            places.of(node.name, "signal", "init"),
            "still registered",
        )


def _outlives(node, code):
    """Return (message, place, what was seen) of an object that is destroyed after ROS itself."""
    # A publisher at file scope does no harm; a timer does.
    globals_ = node.places.facts_of(node.name, "global", "owner")
    globals_.sort(key=lambda p: "ros::Timer" not in (p.text, *p.values.get("holds", ())))
    what, place = "a ROS object", node.places.of(node.name, "timer", "handle")
    if globals_:
        what = f"{globals_[0].text} {globals_[0].values['name']}"
        place = globals_[0].file, globals_[0].line
    message = (
        f"{node.name} aborts when it ends: {what}, which lives as long as the program, is destroyed"
        " after ROS itself."
    )
    return message, place, f"{code_text(code)}, boost::lock_error"


def _cause(node, code, lines, traceback):
    """Return (place, what more to say) of what gives a node another exit code."""
    exits = [e for e in node.direct["events"] if e["event"] == "exit" and e.get("file")]
    if exits:
        return (exits[-1]["file"], exits[-1]["line"]), ""
    if traceback and code == 1:  # of another thread than main's, it does not set the code
        return traceback[0], f" {traceback[1]}: {traceback[2]}"
    said = last_words(lines)
    return _leaves(node, code), f" Its last words: {said}" if said else ""


def _needs_force(name, launch):
    """Return whether roslaunch, too, needed more than Ctrl-C to end a node, or did not run it."""
    if not launch:
        return True
    lines = [text for _, _, text in launch["lines"]]
    started = any(re.search(rf"\bprocess\[(\S+/)?{name}-\d+\]: started", text) for text in lines)
    forced = any(re.search(rf"[\[/]{name}-\d+\] escalating", text) for text in lines)
    return forced or not started or launch["stopped_in"] is None


def _waits(node):
    """Return the place of what may keep a C++ node from ending: a handler of its own, or a loop."""
    handler = r"\bSIG_IGN\b|\bsignal\s*\(|\bsigaction\s*\("
    endless = r"\bwhile\s*\(\s*(true|1)\s*\)|\bfor\s*\(\s*;\s*;|\bwhile True"
    files = node.places.sources(node.name)
    return (
        node.package.first_match(files, handler)
        or node.package.first_match(files, endless)
        or node.places.of(node.name, "loop", "spin", "init")
    )


def _leaves(node, code):
    """Return the place at which a node says its exit code, or may break."""
    ends = rf"\b(return|exit|_exit|SystemExit)\b\s*\(?\s*{code}\b|EXIT_FAILURE"
    breaks = r"\bstd::thread\b|\bboost::thread\b|\babort\s*\("
    if code == -signal.SIGINT:
        breaks = r"\bNoSigintHandler\b|\bSIG_DFL\b"
    files = node.places.sources(node.name)
    return (
        node.package.first_match(files, ends)
        or (code < 0 and node.package.first_match(files, breaks))
        or node.places.of(node.name, "spin", "init")
    )


RULE = Rule(
    stage="stop",
    order=10,
    needs=("nodes",),
    findings=findings,
    requirements={
        "exit": Requirement(
            "Each node ends cleanly on Ctrl-C",
            "launching",
            evidence.when(Node.has_ended, "was not seen to end"),
        )
    },
)
