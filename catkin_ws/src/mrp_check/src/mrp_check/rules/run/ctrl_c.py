# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends a node: nothing waits for the keyboard, and no loop goes on.

The handlers of rospy and roscpp only ask the node to end. input() and std::cin wait on, and so does
a loop that never asks. Neither Rate.sleep() nor Duration.sleep() stops, unless time is simulated.
https://wiki.ros.org/roscpp/Overview/Initialization%20and%20Shutdown
"""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind, Place
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    for name in case.facts.sources:
        direct = case.nodes[name].direct if name in case.nodes else None
        if direct and direct.asked is not None and direct.stopped_in is None:
            continue  # another finding says that it did not end
        if case.facts.of(name, Kind.SIGNAL):
            continue  # its own handler may end it in another way
        first = {place.file: place for place in case.facts.of(name, Kind.KEYBOARD)[::-1]}
        for place in (*case.facts.of(name, Kind.LOOP), *first.values()):
            for message, expected, fix in _of(case, name, place):
                seen = case.package.line(place.file, place.line)
                at = place.file, place.line, HABIT
                yield Finding("exit", message, *at, expected, seen, fix, node=name)


def _of(case: Case, node: str, place: Place) -> Iterator[tuple[str, str, str]]:
    """Yield what is wrong with a loop or a line that reads the keyboard, if anything is."""
    is_python = case.package.kind(place.file) == "python"
    asks = "rospy.is_shutdown()" if is_python else "ros::ok()"
    if place.kind is Kind.KEYBOARD:
        inits = [one for one in case.facts.of(node, Kind.INIT) if one.file == place.file]
        if not is_python and (not inits or place.offset < inits[0].offset):
            return  # before ros::init(), Ctrl-C ends the program at once
        yield (
            "Ctrl-C doesn't end the node while it waits for the keyboard: somebody has to press"
            " Enter first.",
            "a parameter or a topic instead of the keyboard",
            "Give rospy.init_node() disable_signals=True; or take a parameter."
            if is_python
            else "Give ros::init() ros::init_options::NoSigintHandler; or take a parameter.",
        )
    elif place.text == "endless":
        right = f"while not {asks}:" if is_python else f"while ({asks})"
        said = f"This loop never ends: it doesn't check {asks}, so Ctrl-C doesn't end the node."
        yield said, right, f"Write {right}"
    elif isinstance(place.period, (int, float)) and place.period > case.spec.shutdown.seconds:
        yield (
            f"This loop doesn't check {asks}, so after Ctrl-C it runs to its end, which takes up"
            f" to {place.period:.0f} s.",
            f"{asks} in the loop",
            f"Check {asks} in each turn, and leave the loop then.",
        )


RULE = Rule("stop", ("nodes",), _findings, also=("exit",), only=ANY)
