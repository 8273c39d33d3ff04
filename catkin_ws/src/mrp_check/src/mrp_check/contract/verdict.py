# SPDX-License-Identifier: BSD-3-Clause
"""What comes of a check."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Collection

from mrp_check.contract.finding import ERROR, Finding

MET, FINDINGS, UNCHECKED = "met", "findings", "unchecked"
BROKEN = "broken"
WORDS = {MET: "met", BROKEN: "not met", UNCHECKED: "not checked"}  # for a reader


@dataclasses.dataclass
class Report:
    """What came of a check.

    verdict: MET, FINDINGS or UNCHECKED
    findings: in the order in which the stages found them
    requirements: id -> MET, BROKEN or UNCHECKED
    reason: why it is UNCHECKED, in one sentence
    left_out: the ids of what was not asked, as the package has no contract
    unseen: id -> why nobody can say whether it is met, of those that are UNCHECKED
    console: the lines that roslaunch and its nodes printed, as far as they ran
    tools: the lines that CMake, or make and g++, printed when they failed
    is_public: whether hidden requirements have been left out
    suppressed: the findings that a comment in the package suppresses
    isolation: how far the package was kept apart as it ran
    folder: the package's, as an absolute path without links; None if there is none
    """

    package: str
    spec: str
    verdict: str
    findings: list[Finding]
    requirements: dict[str, str]
    reason: str = ""
    unseen: dict[str, str] = dataclasses.field(default_factory=dict)
    left_out: list[str] = dataclasses.field(default_factory=list)
    console: list[str] = dataclasses.field(default_factory=list)
    tools: list[str] = dataclasses.field(default_factory=list)
    is_public: bool = False
    suppressed: list[Finding] = dataclasses.field(default_factory=list)
    isolation: str = ""
    folder: pathlib.Path | None = None


def unchecked(reason: str) -> Report:
    """Return the Report of a package that nothing could be checked of: why, in one sentence."""
    return Report("", "", UNCHECKED, [], {}, reason)


def public(report: Report, hidden: Collection[str]) -> Report:
    """Return what a student may see of a Report: nothing of a hidden requirement."""
    if not hidden:
        return report
    findings = [
        dataclasses.replace(f, consequence_of=None) if f.consequence_of in hidden else f
        for f in report.findings
        if f.id not in hidden
    ]
    follow = {finding.id for finding in report.findings if finding.consequence_of in hidden}
    unseen = {
        id_: "its cause is not shown" if id_ in follow else why
        for id_, why in report.unseen.items()
        if id_ not in hidden
    }
    is_met = not any(finding.severity == ERROR for finding in findings)
    return dataclasses.replace(
        report,
        verdict=FINDINGS if not is_met else UNCHECKED if report.reason else MET,
        findings=findings,
        requirements={id_: v for id_, v in report.requirements.items() if id_ not in hidden},
        unseen=unseen,
        is_public=True,
        suppressed=[finding for finding in report.suppressed if finding.id not in hidden],
    )
