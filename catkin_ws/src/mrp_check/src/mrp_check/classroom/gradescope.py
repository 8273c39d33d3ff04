# SPDX-License-Identifier: BSD-3-Clause
"""The report as Gradescope's results.json: a test for each requirement.

Its fields: https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format
"""

from __future__ import annotations

import json

from mrp_check.contract.verdict import MET, UNCHECKED, public
from mrp_check.report import terminal
from mrp_check.rules import REQUIREMENTS


def text(report, spec):
    """Return the results; what could not be checked at all has a score of 0, and says why."""
    if not report.requirements:
        result = {"score": 0, "output": terminal.plain(report.reason), "output_format": "text"}
    else:
        result = _result(report, spec)
    return json.dumps(result, indent=2, ensure_ascii=False) + "\n"


def _result(report, spec):
    shown = public(report, spec.hidden)
    texts = [terminal.summary(shown), report.reason, report.isolation]
    return {
        "output": terminal.plain("\n".join(filter(None, texts))),
        "output_format": "text",
        "test_output_format": "text",
        "tests": [
            _test(id_, report if id_ in spec.hidden else shown, spec) for id_ in report.requirements
        ],
    }


def _test(id_, report, spec):
    verdict = report.requirements[id_]
    texts = ["\n".join(terminal.finding_lines(f, report)) for f in report.findings if f.id == id_]
    if verdict == UNCHECKED:
        texts.insert(0, f"It couldn't be checked{terminal.why_not(report, id_)}")
    return {
        "name": f"{REQUIREMENTS[id_].title} ({id_})",
        "score": spec.points_of(id_) if verdict == MET else 0,
        "max_score": spec.points_of(id_),
        "status": "passed" if verdict == MET else "failed",
        "output": terminal.plain("\n\n".join(texts)),
        "visibility": "hidden" if id_ in spec.hidden else "visible",
    }
