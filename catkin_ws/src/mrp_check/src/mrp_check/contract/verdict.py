# SPDX-License-Identifier: BSD-3-Clause
"""What comes of a check."""

from __future__ import annotations

import dataclasses

from mrp_check.contract.finding import Finding

MET, FINDINGS, UNCHECKED = "met", "findings", "unchecked"
BROKEN = "broken"


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


def unchecked(reason: str) -> Report:
    """Return the Report of a package that nothing could be checked of: why, in one sentence."""
    return Report("", "", UNCHECKED, [], {}, reason)
