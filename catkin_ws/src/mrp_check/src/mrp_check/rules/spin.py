# SPDX-License-Identifier: BSD-3-Clause
"""Each node waits for callbacks."""

from __future__ import annotations

import re

from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.running import evidence
from mrp_check.sources.node import each_node


def _of(node):
    waits = node.places("loop", "sleep")
    spins = node.places("spin")
    if spins and {place.text for place in spins} == {"spinOnce"}:
        if not waits:
            yield node.finding(
                "spin",
                "ros::spinOnce() calls the callbacks of what has arrived, and returns at once:"
                " the program then comes to its end.",
                spins[0],
                expected="ros::spin() at the end of main",
                fix="Write ros::spin() for ros::spinOnce().",
                change=("spinOnce", "spin"),
            )
        return
    if spins:
        yield from _made_too_late(node, spins)
        return
    called_back = node.places("subscriber") + (
        []
        if node.is_python
        else [
            p
            for p in node.places("timer")
            if p.values.get("oneshot") is not True and not _is_rate(node, p)
        ]
    )
    if node.is_python and waits or not node.is_python and waits and not called_back:
        return
    if not called_back and not node.places("timer", "publisher"):
        return
    call = "rospy.spin()" if node.is_python else "ros::spin()"
    yield node.finding(
        "spin",
        f"{node.main} never calls {call}: "
        + (
            "the program loops, and no callback is ever called."
            if waits
            else "the program comes to its end at once."
        ),
        node.facts.end_of_main(node.name) or (node.main, _last_line(node)),
        expected=f"{call} at the end of main",
        seen="no such call",
        fix=f"Add {call}{'' if node.is_python else ';'} at the end of main.",
    )


def _last_line(node):
    """Return the last line of the main source in which something stands."""
    lines = node.package.lines(node.main)
    return max((n for n, text in enumerate(lines, 1) if text.strip()), default=1)


def _made_too_late(node, spins):
    """Yield a finding if the node's parts are made below a spin() of the same function."""
    classes = {
        name
        for file in node.files
        for line in node.package.lines(file)
        for name in re.findall(r"^\s*(?:class|struct) (\w+)", line)
    }
    for spin in spins:
        ends = [f.values["end"] for f in node.places("function") if f.is_around(spin)]
        if spin.text not in (None, "spin", "waitForShutdown") or not ends:
            continue
        made = {p.line for p in node.places("publisher", "subscriber") if p.file == spin.file}
        for number in range(spin.line + 1, min(ends) + 1):
            line = node.package.lines(spin.file)[number - 1]
            if number in made or classes & set(re.findall(r"\w+", line)):
                call = "rospy.spin()" if node.is_python else "ros::spin()"
                yield node.finding(
                    "spin",
                    f"{call} returns only when the node is to end: what stands below it, in"
                    f" line {number}, is made too late.",
                    spin,
                    expected=f"{call} below all that the node is made of",
                    fix=f"Move it below line {number}.",
                )
                return


def _is_rate(node, place):
    return "Rate" in node.package.lines(place.file)[place.line - 1]


RULE = Rule(
    stage="static",
    order=50,
    needs=("facts",),
    findings=each_node(_of),
    requirements={"spin": Requirement("Each node waits for callbacks", "publisher", evidence.read)},
)
