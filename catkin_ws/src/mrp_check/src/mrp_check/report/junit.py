# SPDX-License-Identifier: BSD-3-Clause
"""The report as JUnit XML: a test case for each requirement, in a class for each stage."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

from mrp_check.contract.finding import ERROR
from mrp_check.contract.verdict import BROKEN, UNCHECKED
from mrp_check.report import terminal
from mrp_check.rules import REQUIREMENTS

# What the suite counts -> the element of a case that is counted.
_COUNTED = {"tests": "testcase", "failures": "failure", "errors": "error", "skipped": "skipped"}


def text(report):
    name = terminal.plain(f"mrp_check.{report.package or 'check'}")
    suite = ElementTree.Element("testsuite", name=name)
    if report.isolation:
        _add(_add(suite, "properties"), "property", name="isolation", value=report.isolation)
    for id_, verdict in report.requirements.items():
        case = _case(suite, f"mrp_check.{REQUIREMENTS[id_].stage}", id_)
        findings = [finding for finding in report.findings if finding.id == id_]
        texts = ["\n".join(terminal.finding_lines(f, report)) for f in findings]
        texts += [terminal.suppressed_line(f, report) for f in report.suppressed if f.id == id_]
        lines = "\n\n".join(texts)
        if verdict == BROKEN:
            errors = [f for f in findings if f.severity == ERROR and not f.consequence_of]
            _add(case, "failure", lines, message=errors[0].message)
        elif verdict == UNCHECKED:
            _add(case, "skipped", message=report.unseen.get(id_, "couldn't be checked"))
        elif lines:
            _add(case, "system-out", lines)
    if report.verdict == UNCHECKED:
        _add(_case(suite, "mrp_check", "check"), "error", message=report.reason)
    for name, tag in _COUNTED.items():
        suite.set(name, str(len(list(suite.iter(tag)))))
    body = ElementTree.tostring(suite, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


def _case(suite, class_name, name):
    return _add(suite, "testcase", classname=class_name, name=name, time="0")


def _add(parent, tag, text=None, **attributes):
    """Add an element, without the characters that XML cannot hold; return it."""
    fit = {name: terminal.plain(value) for name, value in attributes.items()}
    element = ElementTree.SubElement(parent, tag, fit)
    element.text = text and terminal.plain(text)
    return element
