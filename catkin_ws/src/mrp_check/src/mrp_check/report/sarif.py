# SPDX-License-Identifier: BSD-3-Clause
"""The report as SARIF 2.1.0, which editors and GitHub's code scanning read."""

from __future__ import annotations

import json
import urllib.parse

from mrp_check.contract.finding import NOTE
from mrp_check.contract.verdict import UNCHECKED
from mrp_check.report import terminal
from mrp_check.report.annotation import base_of, path_of, says_of
from mrp_check.rules import REQUIREMENTS

_SCHEMA = (
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
)
_BASE = "SRCROOT"


def text(report):
    return json.dumps(data(report), indent=2, ensure_ascii=False) + "\n"


def data(report):
    """Return the report as plain Python, in SARIF's form."""
    rules = [*report.requirements]
    run = {
        "tool": {"driver": {"name": "mrp_check", "rules": [_rule(id_) for id_ in rules]}},
        "automationDetails": {"id": f"mrp_check/{report.package}/"},
        "invocations": [_invocation(report)],
        "results": [
            _result(finding, report, rules) for finding in report.findings + report.suppressed
        ],
    }
    if report.folder:
        run["originalUriBaseIds"] = {_BASE: {"uri": base_of(report.folder).as_uri() + "/"}}
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _rule(id_):
    requirement = REQUIREMENTS[id_]
    page = terminal.address_of(requirement.page)
    return {
        "id": id_,
        "shortDescription": {"text": requirement.title},
        "help": {"text": f"{requirement.title}: {page} explains it."},
    }


def _invocation(report):
    """Return whether all could be checked, why not, and under which isolation."""
    texts = [("error", report.reason), (NOTE, report.isolation)]
    notifications = [
        {"level": level, "message": {"text": terminal.plain(text)}} for level, text in texts if text
    ]
    return {
        "executionSuccessful": report.verdict != UNCHECKED,
        "toolExecutionNotifications": notifications,
    }


def _result(finding, report, rules):
    says = says_of(finding)
    if finding.consequence_of:
        says.append(f"This follows from {finding.consequence_of}.")
    reason = {"kind": "inSource", "justification": terminal.plain(finding.suppressed)}
    result = {
        "ruleId": finding.id,
        "ruleIndex": rules.index(finding.id),
        # A consequence of another error is not counted as an error.
        "level": NOTE if finding.consequence_of else finding.severity,
        "message": {"text": terminal.plain("\n".join(says))},
        "suppressions": [reason] if finding.suppressed else [],
    }
    if finding.file:
        name = path_of(finding, report).encode("utf-8", "surrogateescape")
        place = {"artifactLocation": {"uri": urllib.parse.quote(name), "uriBaseId": _BASE}}
        if finding.line:
            place["region"] = {"startLine": finding.line}
        result["locations"] = [{"physicalLocation": place}]
    return result
