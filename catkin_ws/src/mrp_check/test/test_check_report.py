# SPDX-License-Identifier: BSD-3-Clause
"""Reads the checker's reports: JSON, JUnit, a page, and the console."""

import dataclasses
import io
import json
import pathlib
import re
import xml.etree.ElementTree as ElementTree

import jsonschema
import pytest
from check_rules import Tags
from mrp_check.cli import check as check_command
from mrp_check.contract import resources
from mrp_check.contract.finding import Finding
from mrp_check.report import annotation, github, json_, junit, sarif, terminal
from mrp_check.report import html as html_report
from mrp_check.rules import REQUIREMENTS
from mrp_check.verdict import check
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
    severity="error",
)
RESULT = Finding("values", "No value came.", "src/a.py", 9, consequence_of="spin", stage="run")
RESULT.severity = "error"
HINTED = Finding("lifetime", "It is not kept.", "src/a.py", 4, severity="note", stage="static")
CHANGE = Finding("spin", "100% wrong,\nsee.", "src/b, c.py", 7, stage="static")
CHANGE.severity = "warning"
SUPPRESSED = dataclasses.replace(HINTED, certainty="hint", suppressed="It is kept elsewhere.")


def report(*findings, reason="", suppressed=()):
    for finding in findings:
        finding.severity = finding.severity or "error"
        finding.certainty = "seen"
    verdicts = {id_: check.MET for id_ in REQUIREMENTS}
    verdicts.update({f.id: check.BROKEN for f in findings if f.severity == "error"})
    verdicts.update({f.id: check.UNCHECKED for f in findings if f.consequence_of})
    broken = any(f.severity == "error" for f in findings)
    verdict = check.UNCHECKED if reason else check.FINDINGS if broken else check.MET
    return check.Report(
        *("a_pkg", "An exercise", verdict, list(findings), verdicts, reason),
        suppressed=list(suppressed),
        folder=pathlib.Path("/repo/src/a_pkg"),
    )


REPORTS = [
    report(suppressed=[SUPPRESSED]),
    report(CAUSE, RESULT, HINTED),
    report(reason="There's no folder x."),
]


@pytest.mark.parametrize("report_", REPORTS, ids=lambda report_: report_.verdict)
def test_json_is_as_its_schema_says(report_, report_schema):
    jsonschema.validate(json.loads(json_.text(report_)), report_schema)


def test_schema_refuses_what_is_no_report(report_schema):
    data = json.loads(json_.text(report(CAUSE)))
    data["findings"][0]["line"] = 0
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(data, report_schema)


def test_junit_counts():
    suite = ElementTree.fromstring(junit.text(report(CAUSE, RESULT, HINTED)))
    counts = {name: int(suite.get(name)) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": len(REQUIREMENTS), "failures": 1, "errors": 0, "skipped": 1}
    (failure,) = suite.iter("failure")
    assert failure.get("message") == CAUSE.message
    assert ElementTree.fromstring(junit.text(REPORTS[2])).get("errors") == "1"


def test_junit_is_xml_whatever_was_printed():
    text = junit.text(report(Finding("console", "It printed \x1b[2J\x00.", seen="\ufffe")))
    assert "\x1b" not in text
    ElementTree.fromstring(text)


@pytest.mark.parametrize("report_", REPORTS, ids=lambda report_: report_.verdict)
def test_page_needs_nothing_else(report_):
    page = Tags(html_report.text(report_))
    assert not {*page.tags} & {"script", "link", "img", "iframe"}
    for finding in report_.findings:
        assert finding.message in page.text
    assert report_.reason in page.text


def test_each_folder_that_the_checker_reads_is_installed():
    sources = "".join(path.read_text() for path in (CHECK / "src").rglob("*.py"))
    installs = re.findall(r"install\(DIRECTORY (.+)", (CHECK / "CMakeLists.txt").read_text())
    installed = {path.split("/")[-1] for line in installs for path in line.split()}
    read = {*re.findall(r'resources\.folder\("(\w+)"\)', sources)}
    assert read and read - installed == set()


@pytest.mark.parametrize("text", [json_.text, junit.text, html_report.text, sarif.text])
def test_report_on_a_file_whose_name_is_no_utf8(text, tmp_path):
    check_command.write(tmp_path / "report", lambda: text(report(Finding("text", "It.", "\udcff"))))
    assert (tmp_path / "report").read_text()


def test_page_shows_what_a_package_says_as_text():
    page = Tags(html_report.text(report(Finding("console", "<script>alert(1)</script>"))))
    assert "<script>alert(1)</script>" in page.text


def test_console_shows_verdicts_causes_first_and_pages(monkeypatch):
    monkeypatch.setattr(resources, "site", lambda: "")
    text = terminal.text(report(HINTED, RESULT, CAUSE), everything=True)
    assert "  [FAIL] Each node waits for callbacks (spin)" in text
    assert "  [--]   Publishers publish the right values (values)" in text
    assert text.index("src/a.py:3: error:") < text.index("src/a.py:9: error:")
    assert text.index("src/a.py:9: error:") < text.index("src/a.py:4: note:")
    assert "  page:     “publisher” of the tutorial" in text
    count = len(REQUIREMENTS)
    assert text.endswith(f"1 of {count} requirements are not met; 1 couldn't be checked.")


def test_console_shows_one_cause_once_and_notes_on_request():
    others = [dataclasses.replace(CAUSE, file=f"src/{name}.py", severity="") for name in "bc"]
    report_ = report(CAUSE, *others, HINTED, RESULT)
    text = terminal.text(report_)
    assert text.count("It never spins.") == 1
    assert "  also at:  src/b.py:3, src/c.py:3\n" in text
    assert "It is not kept." not in text and "No value came." not in text
    report_.left_out = ["values"]
    assert "[OK]" not in terminal.text(report_)
    assert terminal.text(report_).endswith(
        "Errors: 3; warnings: 0 (2 more with --all; with make: ALL=1)."
    )
    assert "[OK]" in terminal.text(report_, everything=True)


def test_console_says_of_a_warning_without_a_contract_what_no_other_line_says():
    more = {"expected": "a.b()", "fix": "Write a.b().", "why": "script-crlf"}
    report_ = report(Finding("text", "It.", "a.py", 1, severity="warning", **more))
    lines = ["expected:", "fix:", "page:", "why:"]
    assert [word for word in lines if word in terminal.text(report_)] == lines
    report_.left_out = ["values"]
    assert [word for word in lines if word in terminal.text(report_)] == ["fix:", "why:"]


def test_console_and_page_name_the_text_that_a_tool_prints(monkeypatch):
    monkeypatch.setenv("MRP_PAGES", "https://a.example/mrp/")
    report_ = report(Finding("text", "It.", "a.py", 1, why="script-crlf"))
    address = "https://a.example/mrp/pages/why.html#script-crlf"
    assert f"\n  why:      {address}\n" in terminal.text(report_)
    assert "pages/why.html#script-crlf" in Tags(html_report.text(report_)).text


def test_console_has_colours_only_where_asked():
    assert "\x1b" not in terminal.text(report(CAUSE))
    assert "\x1b[31m" in terminal.text(report(CAUSE), colours=True)
    assert "\x1b" not in terminal.text(report(Finding("console", "It printed \x1b[2J.")))


@pytest.fixture
def repository(tmp_path):
    """A package's folder in a repository, which is not the working folder."""
    (tmp_path / "repo" / ".git").mkdir(parents=True)
    return tmp_path / "repo" / "src" / "a_pkg"


def test_sarif_has_each_finding_with_its_place(repository, monkeypatch):
    monkeypatch.setenv("MRP_PAGES", "https://a.example/mrp")
    report_ = dataclasses.replace(report(CAUSE, RESULT, CHANGE), folder=repository)
    (run,) = sarif.data(report_)["runs"]
    assert run["originalUriBaseIds"]["SRCROOT"]["uri"] == f"{repository.parents[1].as_uri()}/"
    rules = run["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == [*REQUIREMENTS]
    spin = rules[[*REQUIREMENTS].index("spin")]
    assert "https://a.example/mrp/pages/publisher.html" in spin["help"]["text"]
    for result, finding in zip(run["results"], report_.findings):
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"] == finding.id
        level = "note" if finding.consequence_of else finding.severity
        assert (result["level"], result["suppressions"]) == (level, [])
        (location,) = result["locations"]
        assert location["physicalLocation"]["region"] == {"startLine": finding.line}
    assert run["results"][1]["message"]["text"].endswith("This follows from spin.")
    assert location["physicalLocation"]["artifactLocation"]["uri"] == "src/a_pkg/src/b%2C%20c.py"


def test_sarif_says_why_it_could_not_be_checked():
    (run,) = sarif.data(REPORTS[2])["runs"]
    (invocation,) = run["invocations"]
    assert invocation["executionSuccessful"] is False
    (notification,) = invocation["toolExecutionNotifications"]
    assert notification["message"]["text"] == REPORTS[2].reason


def test_github_s_annotations_are_escaped_as_its_own_toolkit_does(repository):
    report_ = report(CAUSE, RESULT, CHANGE, HINTED, reason="No.")  # without the note
    report_ = dataclasses.replace(report_, folder=repository)
    lines = github.text(report_).split("\n")
    assert lines[0].startswith(
        "::error file=src/a_pkg/src/a.py,line=3,title=mrp_check%3A spin::"
        "It never spins.%0A  expected"
    )
    assert lines[1:] == [
        "::warning file=src/a_pkg/src/b%2C c.py,line=7,title=mrp_check%3A spin"
        "::100%25 wrong,%0Asee.",
        "::error title=mrp_check::No.",
    ]


def test_github_takes_no_command_from_what_a_package_printed():
    begin, printed, end = github.stopped("::add-mask::a").split("\n")
    assert (printed, end) == ("::add-mask::a", f"::{begin.rpartition('::')[2]}::")


@pytest.mark.parametrize(
    ("git", "working", "base"),
    [
        (True, "elsewhere", "repo"),
        (False, "repo", "repo"),
        (False, "elsewhere", "repo/src/a_pkg"),
    ],
    ids=["repository", "working_folder", "package"],
)
def test_a_reader_s_paths_begin_at(git, working, base, repository, tmp_path, monkeypatch):
    repository.mkdir(parents=True)
    if not git:
        (tmp_path / "repo" / ".git").rmdir()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / working)
    assert annotation.base_of(repository) == tmp_path / base


def test_what_is_suppressed_is_shown_with_its_reason():
    report_ = REPORTS[0]
    line = "src/a.py:4: suppressed (lifetime): It is kept elsewhere."
    assert line in terminal.text(report_) and line in Tags(html_report.text(report_)).text
    assert terminal.text(report_).endswith("; suppressed: 1.")
    assert f"<system-out>{line}</system-out>" in junit.text(report_)
    (shown,) = json.loads(json_.text(report_))["suppressed"]
    assert (shown["id"], shown["reason"]) == ("lifetime", "It is kept elsewhere.")
    (result,) = sarif.data(report_)["runs"][0]["results"]
    assert result["suppressions"] == [
        {"kind": "inSource", "justification": "It is kept elsewhere."}
    ]
    assert report_.verdict == check.MET


DIGITS = "0123456789abcdefghij"


def test_progress_is_one_line_of_a_terminal_and_whole_in_a_log(monkeypatch):
    monkeypatch.setenv("COLUMNS", "20")
    for is_terminal, line in ((True, "\r\x1b[Kcheck: 0123456789ab"), (False, f"check: {DIGITS}\n")):
        stream = io.StringIO()
        monkeypatch.setattr(stream, "isatty", lambda answer=is_terminal: answer)
        terminal.Progress(stream).show(DIGITS)
        assert stream.getvalue() == line


@pytest.mark.parametrize("encoding, half", [("utf-8", "██████████"), ("ascii", "##########")])
def test_progress_of_a_class_is_a_bar_on_a_terminal_and_a_number_in_a_log(encoding, half):
    for is_terminal, text in ((True, f"|{half}          | 3/6, 00:00 left"), (False, "3 of 6:")):
        file = io.BytesIO()
        stream = io.TextIOWrapper(file, encoding=encoding)
        stream.isatty = lambda answer=is_terminal: answer
        terminal.Progress(stream).show("anna: met", 3, 6)
        written = re.sub(r"\d\d:\d\d left", "00:00 left", file.getvalue().decode(encoding))
        assert f"check: {text} anna: met" in written
