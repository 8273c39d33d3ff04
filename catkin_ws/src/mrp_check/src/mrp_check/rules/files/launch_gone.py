# SPDX-License-Identifier: BSD-3-Clause
"""A launch file uses nothing that Noetic has not any more.

https://wiki.ros.org/noetic/Migration
"""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.contract.finding import CERTAIN, HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of

# What stands in the file -> what to say of it, how severe it is, what to write for it, and which
# word the file has, too.
_GONE = {
    r"\btype\s*=\s*\"(state_publisher)\"": (
        "robot_state_publisher has no executable state_publisher any more: roslaunch cannot start"
        " it",
        CERTAIN,
        "robot_state_publisher",
        "",
    ),
    r"\(find xacro\)/(xacro\.py)\b": (
        "xacro has no xacro.py any more: roslaunch cannot load the file",
        CERTAIN,
        "xacro",
        "",
    ),
    r"\bname\s*=\s*\"(use_gui)\"": (
        "joint_state_publisher does not read use_gui any more: no window with sliders comes",
        HABIT,
        "a node of type joint_state_publisher_gui",
        "joint_state_publisher",
    ),
}


def _findings(case: Case) -> Iterator[Finding]:
    for file in case.package.of_kind("launch"):
        text = uses.code(case.package, file)
        for shape, (said, certainty, instead, beside) in _GONE.items():
            for match in re.finditer(shape, text) if beside in text else ():
                yield Finding(
                    "launch-nodes",
                    f"{said} (it went with Noetic).",
                    file,
                    line_of(match, 1),
                    certainty,
                    expected=instead,
                    seen=match[1],
                    fix=f"Write {instead} for {match[1]}.",
                )


RULE = Rule("files", ("launch",), _findings, also=("launch-nodes",), only=ANY)
