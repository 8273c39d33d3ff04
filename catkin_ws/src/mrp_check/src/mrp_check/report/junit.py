# SPDX-License-Identifier: BSD-3-Clause
"""The report as JUnit XML: a test case for each requirement, in a class for each stage."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

from mrp_check.contract.finding import ERROR
from mrp_check.contract.verdict import BROKEN, UNCHECKED
from mrp_check.report import console
from mrp_check.rules import REQUIREMENTS

# What XML 1.0 cannot hold: a student's program may print it.
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def text(report):
    suite = ElementTree.Element("testsuite", name=_xml(f"mrp_check.{report.package or 'check'}"))
    counts = {"tests": 0, "failures": 0, "errors": 0, "skipped": 0}
    for id_, verdict in report.requirements.items():
        counts["tests"] += 1
        case = ElementTree.SubElement(
            suite, "testcase", classname=f"mrp_check.{REQUIREMENTS[id_].stage}", name=id_, time="0"
        )
        findings = [finding for finding in report.findings if finding.id == id_]
        told = "\n\n".join("\n".join(console.finding_lines(f, report)) for f in findings)
        if verdict == BROKEN:
            counts["failures"] += 1
            errors = [f for f in findings if f.severity == ERROR and not f.consequence_of]
            failure = ElementTree.SubElement(case, "failure", message=_xml(errors[0].message))
            failure.text = _xml(told)
        elif verdict == UNCHECKED:
            counts["skipped"] += 1
            reason = report.unseen.get(id_, "could not be checked")
            ElementTree.SubElement(case, "skipped", message=_xml(reason))
        elif told:
            ElementTree.SubElement(case, "system-out").text = _xml(told)
    if report.verdict == UNCHECKED:
        counts["tests"] += 1
        counts["errors"] += 1
        case = ElementTree.SubElement(
            suite, "testcase", classname="mrp_check", name="check", time="0"
        )
        ElementTree.SubElement(case, "error", message=_xml(report.reason))
    for name, count in counts.items():
        suite.set(name, str(count))
    body = ElementTree.tostring(suite, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


def _xml(text):
    return _NOT_XML.sub("\ufffd", text)
