# SPDX-License-Identifier: BSD-3-Clause
"""The report as JSON: see schema/report.json."""

from __future__ import annotations

import json

from mrp_check.rules import REQUIREMENTS

FIELDS = ("id stage severity file line message expected seen fix section consequence_of").split()


def data(report):
    """Return what is written, as plain Python."""
    result = {
        "verdict": report.verdict,
        "package": report.package,
        "spec": report.spec,
        "requirements": report.requirements,
        "unseen": report.unseen,
        "findings": [finding_data(finding) for finding in report.findings],
    }
    if report.reason:
        result["reason"] = report.reason
    return result


def finding_data(finding):
    """Return one finding, with the page that explains it."""
    section = REQUIREMENTS[finding.id].section
    return {field: section if field == "section" else getattr(finding, field) for field in FIELDS}


def text(report):
    return json.dumps(data(report), indent=2, ensure_ascii=False) + "\n"
