# SPDX-License-Identifier: BSD-3-Clause
"""The checker's reports: JSON, JUnit, a page, and the console."""

import html.parser
import json
import re
import xml.etree.ElementTree as ElementTree

import jsonschema
import pytest
from mrp_check import check
from mrp_check.cli import check as check_command
from mrp_check.contract.finding import Finding
from mrp_check.report import console, json_, junit
from mrp_check.report import html as html_report
from mrp_check.rules import REQUIREMENTS
from mrp_testing.proves import proves
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

CHECK = WORKSPACE / "src" / "mrp_check"

CAUSE = Finding(
    "spin",
    "It never spins.",
    "src/a.py",
    3,
    expected="rospy.spin()",
    seen="<nothing & more>",
    fix="Add\n+rospy.spin()",
    stage="static",
)
RESULT = Finding("values", "No value came.", "src/a.py", 9, consequence_of="spin", stage="run")
NOTE = Finding("lifetime", "It is not kept.", "src/a.py", 4, severity="note", stage="static")


def report(*findings, reason=""):
    verdicts = {id_: check.MET for id_ in REQUIREMENTS}
    verdicts.update({f.id: check.BROKEN for f in findings if f.severity == "error"})
    verdicts.update({f.id: check.UNCHECKED for f in findings if f.consequence_of})
    broken = any(f.severity == "error" for f in findings)
    verdict = check.UNCHECKED if reason else check.FINDINGS if broken else check.MET
    return check.Report("a_pkg", "An exercise", verdict, list(findings), verdicts, reason)


REPORTS = [report(), report(CAUSE, RESULT, NOTE), report(reason="There is no folder x.")]


@pytest.mark.parametrize("one", REPORTS, ids=lambda one: one.verdict)
def test_json_is_as_its_schema_says(one, report_schema):
    jsonschema.validate(json.loads(json_.text(one)), report_schema)


def test_schema_refuses_what_is_no_report(report_schema):
    data = json.loads(json_.text(report(CAUSE)))
    data["findings"][0]["line"] = 0
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(data, report_schema)


def test_junit_counts():
    suite = ElementTree.fromstring(junit.text(report(CAUSE, RESULT, NOTE)))
    counts = {name: int(suite.get(name)) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": len(REQUIREMENTS), "failures": 1, "errors": 0, "skipped": 1}
    (failure,) = suite.iter("failure")
    assert failure.get("message") == CAUSE.message
    assert ElementTree.fromstring(junit.text(REPORTS[2])).get("errors") == "1"


def test_junit_is_xml_whatever_was_printed():
    text = junit.text(report(Finding("console", "It printed \x1b[2J\x00.", seen="\ufffe")))
    assert "\x1b" not in text
    ElementTree.fromstring(text)


class Reader(html.parser.HTMLParser):
    """Collects a page's text and tags, and fails where one is not closed."""

    VOID = {"meta", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.text = [], [], ""
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


@proves(
    "It reports which requirement the package does not meet, where, why, and which page explains "
    "it.",
)
@pytest.mark.parametrize("one", REPORTS, ids=lambda one: one.verdict)
def test_page_needs_nothing_else(one):
    page = Reader(html_report.text(one))
    names = {tag for tag, _ in page.tags}
    assert not names & {"script", "link", "img", "iframe"}
    for finding in one.findings:
        assert finding.message in page.text
    assert one.reason in page.text


def test_each_folder_that_the_checker_reads_is_installed():
    sources = "".join(path.read_text() for path in (CHECK / "src").rglob("*.py"))
    installs = re.findall(r"install\(DIRECTORY (.+)", (CHECK / "CMakeLists.txt").read_text())
    installed = {path.split("/")[-1] for line in installs for path in line.split()}
    read = {*re.findall(r'resources\.folder\("(\w+)"\)', sources)}
    assert read and read - installed == set()


@pytest.mark.parametrize("text", [json_.text, junit.text, html_report.text])
def test_report_on_a_file_whose_name_is_no_utf8(text, tmp_path):
    check_command.write(tmp_path / "report", lambda: text(report(Finding("text", "It.", "\udcff"))))
    assert (tmp_path / "report").read_text()


def test_page_shows_what_a_package_says_as_text():
    page = Reader(html_report.text(report(Finding("console", "<script>alert(1)</script>"))))
    assert "<script>alert(1)</script>" in page.text


@proves(
    "It reports what is wrong, where, and which page explains it.",
    "It reports which requirement the package does not meet, where, why, and which page explains "
    "it.",
)
def test_console_shows_verdicts_causes_first_and_pages():
    text = console.text(report(NOTE, RESULT, CAUSE))
    assert "  [FAIL] Each node waits for callbacks (spin)" in text
    assert "  [--]   Publishers publish the right values (values)" in text
    assert text.index("src/a.py:3: error:") < text.index("src/a.py:9: error:")
    assert text.index("src/a.py:9: error:") < text.index("src/a.py:4: note:")
    assert "  page:     pages/publisher.html" in text
    count = len(REQUIREMENTS)
    assert text.endswith(f"1 of {count} requirements are not met; 1 could not be checked.")


def test_console_and_page_name_the_text_that_a_tool_prints():
    one = report(Finding("text", "It.", "a.py", 1, why="script-crlf"))
    assert "\n  why:      pages/why.html#script-crlf\n" in console.text(one)
    assert "pages/why.html#script-crlf" in Reader(html_report.text(one)).text


def test_console_has_colours_only_where_asked():
    assert "\x1b" not in console.text(report(CAUSE))
    assert "\x1b[31m" in console.text(report(CAUSE), colours=True)
    assert "\x1b" not in console.text(report(Finding("console", "It printed \x1b[2J.")))
