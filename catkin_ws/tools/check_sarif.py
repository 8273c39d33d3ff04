#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the checker's SARIF against the schema of SARIF 2.1.0, which no Debian package has.

A report with a line of -1 must not fit, else the schema has not been asked.
"""

import json
import pathlib
import sys

import jsonschema

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
SARIF = WORKSPACE / "build/lint/node_modules/@microsoft/sarif-multitool-ts"
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract.finding import ERROR, NOTE, WARNING, Finding  # noqa: E402
from mrp_check.contract.verdict import BROKEN, MET, UNCHECKED, Report, unchecked  # noqa: E402
from mrp_check.report import sarif  # noqa: E402
from mrp_check.rules import REQUIREMENTS  # noqa: E402

SCHEMA = json.loads((SARIF / "assets" / "sarif-2.1.0.schema.json").read_text())


def errors(report):
    validator = jsonschema.validators.validator_for(SCHEMA)(SCHEMA)
    return [error.message for error in validator.iter_errors(json.loads(sarif.text(report)))]


def reports():
    """Return a report with all that a finding can have, and one of no package."""
    findings = [
        Finding("spin", "It never spins.", "src/a.py", 3, fix="Add it.", severity=ERROR),
        Finding("queue", "It is 1.", "src/a b.py", 3, change=("1", "10"), column=7, severity=ERROR),
        Finding("values", "It is not seen.", consequence_of="spin", severity=WARNING),
    ]
    kept = Finding(
        "text", "It is as it is.", "CMakeLists.txt", suppressed="It works.", severity=NOTE
    )
    verdicts = dict.fromkeys(REQUIREMENTS, MET)
    verdicts["spin"] = BROKEN
    whole = Report("a", "", UNCHECKED, findings, verdicts, "It is busy.", folder=WORKSPACE)
    whole.suppressed.append(kept)
    return [whole, unchecked("There is no folder x.")]


wrong = reports()[0]
wrong.findings[0].line = -1
found = [error for report in reports() for error in errors(report)]
if not errors(wrong):
    found.append("a line of -1 fits the schema")
sys.exit("\n".join(found) or 0)
