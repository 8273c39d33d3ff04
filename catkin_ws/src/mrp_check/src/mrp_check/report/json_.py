# SPDX-License-Identifier: BSD-3-Clause
"""The report as JSON: see schema/report.json. And the files that keep what was said, as JSON."""

from __future__ import annotations

import dataclasses
import json

from mrp_check.contract.finding import Finding
from mrp_check.contract.verdict import Report
from mrp_check.rules import REQUIREMENTS

# What only the checker itself needs to know of a finding.
_INNER = ("node", "packages", "change", "suppressed")


def data(report):
    """Return the report as plain Python, without what it has none of."""
    result = dataclasses.asdict(report)
    for finding in result["suppressed"]:
        finding["reason"] = finding["suppressed"]
    for finding in result["findings"] + result["suppressed"]:
        for name in _INNER:
            del finding[name]
        finding["section"] = REQUIREMENTS[finding["id"]].section
    for name in ("console", "tools", "folder", "is_public"):
        del result[name]
    for name in ("reason", "left_out", "suppressed", "isolation"):
        if not result[name]:
            del result[name]
    return result


def report_of(data):
    """Return the Report that data() was made of, without what only the checker needs to know."""
    findings = [_finding(entry) for entry in data["findings"]]
    suppressed = [
        _finding({**entry, "suppressed": entry["reason"]}) for entry in data.get("suppressed", ())
    ]
    return Report(**{**data, "findings": findings, "suppressed": suppressed})


def _finding(data):
    known = {field.name for field in dataclasses.fields(Finding)}
    return Finding(**{name: value for name, value in data.items() if name in known})


def text(report):
    return json.dumps(data(report), indent=2, ensure_ascii=False) + "\n"


def keep(file, value):
    """Write a value into a file, whole or not at all."""
    keep_text(file, json.dumps(value))


def keep_text(file, text):
    """Write a text into a file, whole or not at all."""
    new = file.with_name(f"{file.name}.new")
    new.write_text(text, encoding="utf-8")
    new.rename(file)


def kept(file):
    """Return the value in a file; None if it has none that can be read."""
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
