# SPDX-License-Identifier: BSD-3-Clause
"""A program counts its arguments before it reads one."""

from __future__ import annotations

from typing import Iterator

from mrp_check.confined.places import Kind
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    for node in case.facts.sources:
        for place in case.facts.of(node, Kind.ARGUMENT)[:1]:
            is_python = case.package.kind(place.file) == "python"
            count = "len(rospy.myargv())" if is_python else "argc"
            ends = "raises an IndexError here" if is_python else "most likely crashes here"
            yield Finding(
                "starts",
                f"{node} reads argument {place.value} of its command line without checking that it"
                f" was given. Without it, the program {ends}.",
                place.file,
                place.line,
                HABIT,
                expected=f"{count} > {place.value} wherever the argument is read",
                seen=case.package.line(place.file, place.line),
                fix=f"Check {count} first, and print how to use the program.",
                node=node,
            )


RULE = Rule("static", ("facts",), _findings, also=("starts",), only=ANY)
