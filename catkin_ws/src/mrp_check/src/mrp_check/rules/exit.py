# SPDX-License-Identifier: BSD-3-Clause
"""Each node ends cleanly on Ctrl-C."""

from __future__ import annotations

import re
import signal

from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.running.node import Node
from mrp_check.running.words import code_text, last_words

# What rospy itself may say when a message is published at the very moment of the end.
_AT_THE_END = ("closed topic", "ROSInterruptException: rospy shutdown")


def findings(case):
    """Yield a Finding for each node that does not end as the spec says."""
    for name in case.spec.nodes:
        direct = case.observed.alone(name)
        if direct and direct.get("asked") is not None:
            yield from _exit_findings(name, direct, case.spec, case.package, case.places)


def _exit_findings(name, direct, spec, package, places):
    shutdown = spec.shutdown
    asked = direct["asked"]
    lines = [
        text for time, stream, text in direct["lines"] if stream == "err" and time >= asked - 0.1
    ]
    expected = f"exit code {shutdown.exit_code} within {shutdown.seconds:g} s of {shutdown.signal}"

    def finding(message, place, seen, fix=""):
        return Finding("exit", message, *place, expected=expected, seen=seen, fix=fix, node=name)

    if direct["stopped_in"] is None and not _needs_force(name, places.observed.launch):
        return  # one of two: the machine was too busy
    if direct["stopped_in"] is None:
        place = places.stack(lines) or _waits(name, package, places)
        yield finding(
            f"{name} does not end on Ctrl-C: it was still there after {shutdown.seconds:g} s.",
            place,
            "it goes on",
            "Let loops end when rospy.is_shutdown() is true or ros::ok() is false, and let no"
            " thread outlive main().",
        )
        return
    code = direct["code"]
    traceback = places.traceback(lines)
    if code != shutdown.exit_code:
        if "lock_error" in "\n".join(lines):
            # A publisher at file scope does no harm; a timer does.
            globals_ = places.facts_of(name, "global", "owner")
            globals_.sort(key=lambda p: "ros::Timer" not in (p.text, *p.values.get("holds", ())))
            what, place = "a ROS object", places.of(name, "timer", "handle")
            if globals_:
                what = f"{globals_[0].text} {globals_[0].values['name']}"
                place = globals_[0].file, globals_[0].line
            yield finding(
                f"{name} aborts when it ends: {what}, which lives as long as the program, is"
                " destroyed after ROS itself.",
                place,
                f"{code_text(code)}, boost::lock_error",
                "Let an object in main() own it.",
            )
            return
        exits = [e for e in direct["events"] if e["event"] == "exit" and e.get("file")]
        if exits:
            place, why = (exits[-1]["file"], exits[-1]["line"]), ""
        elif traceback and code == 1:  # of another thread than main's, it does not set the code
            place, why = traceback[0], f" {traceback[1]}: {traceback[2]}"
        else:
            place = _leaves(name, package, places, code)
            why = f" Its last words: {last_words(lines)}" if last_words(lines) else ""
        yield finding(
            f"On {shutdown.signal}, {name} ends {code_text(code)}, not with exit code"
            f" {shutdown.exit_code}.{why}",
            place,
            code_text(code),
        )
    elif traceback and not any(words in line for words in _AT_THE_END for line in lines):
        place, kind, text = traceback
        yield finding(f"{name} ends with an error: {kind}: {text}", place, f"{kind}: {text}")
    elif direct["still_registered"] and shutdown.signal == "SIGINT":
        yield finding(
            f"{name} ends without telling the master, which still lists it.",
            places.of(name, "signal", "init"),
            "still registered",
        )


def _needs_force(name, launch):
    """Return whether roslaunch, too, needed more than Ctrl-C to end a node, or did not run it."""
    if not launch:
        return True
    lines = [text for _, _, text in launch["lines"]]
    started = any(re.search(rf"\bprocess\[(\S+/)?{name}-\d+\]: started", text) for text in lines)
    forced = any(re.search(rf"[\[/]{name}-\d+\] escalating", text) for text in lines)
    return forced or not started or launch["stopped_in"] is None


def _waits(name, package, places):
    """Return the place of what may keep a C++ node from ending: a handler of its own, or a loop."""
    handler = r"\bSIG_IGN\b|\bsignal\s*\(|\bsigaction\s*\("
    endless = r"\bwhile\s*\(\s*(true|1)\s*\)|\bfor\s*\(\s*;\s*;|\bwhile True"
    files = places.sources(name)
    return (
        package.first_match(files, handler)
        or package.first_match(files, endless)
        or places.of(name, "loop", "spin", "init")
    )


def _leaves(name, package, places, code):
    """Return the place at which a node says its exit code, or may break."""
    ends = rf"\b(return|exit|_exit|SystemExit)\b\s*\(?\s*{code}\b|EXIT_FAILURE"
    breaks = r"\bstd::thread\b|\bboost::thread\b|\babort\s*\("
    if code == -signal.SIGINT:
        breaks = r"\bNoSigintHandler\b|\bSIG_DFL\b"
    files = places.sources(name)
    return (
        package.first_match(files, ends)
        or (code < 0 and package.first_match(files, breaks))
        or places.of(name, "spin", "init")
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
