# SPDX-License-Identifier: BSD-3-Clause
"""Turn the certainty of findings into severities."""

from __future__ import annotations

from typing import Iterable

from mrp_check.contract.finding import CERTAIN, ERROR, HINT, NOTE, READ, SEEN, WARNING, Finding


def severity(certainty: str, has_contract: bool) -> str:
    """Return the severity of what a rule is that sure of.

    has_contract: whether a contract says what the package must do
    """
    if certainty in (SEEN, CERTAIN) or certainty == READ and has_contract:
        return ERROR
    return NOTE if certainty == HINT else WARNING


def weigh(findings: Iterable[Finding], has_contract: bool) -> None:
    """Set the severity of each finding, and drop consequences whose cause is no error."""
    findings = list(findings)
    # What was only read is seen, too, if the same fails in the same file. verdict/causes.py says so
    # of what was seen to fail because of it.
    seen = {(finding.id, finding.file) for finding in findings if finding.certainty == SEEN}
    for finding in findings:
        if finding.certainty == READ and (finding.id, finding.file) in seen:
            finding.certainty = SEEN
        finding.severity = severity(finding.certainty, has_contract)
    errors = {
        finding.id
        for finding in findings
        if finding.severity == ERROR and finding.consequence_of != finding.id
    }
    for finding in findings:
        if finding.severity != ERROR or finding.consequence_of not in errors:
            finding.consequence_of = None
