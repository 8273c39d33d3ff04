# SPDX-License-Identifier: BSD-3-Clause
"""The checker's reports, and its command line: exit codes and messages."""

import html.parser
import json
import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree

import check_rules
import jsonschema
import pytest
import scratch
from mrp_check import causes, check
from mrp_check.case import Case
from mrp_check.cli import classroom
from mrp_check.contract import resources
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.report import console, json_, junit
from mrp_check.report import html as html_report
from mrp_check.rules import REQUIREMENTS, RULES
from mrp_check.sources.facts import Facts

pytestmark = pytest.mark.quick

CHECK = scratch.WORKSPACE / "src" / "mrp_check" / "scripts" / "check"
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


def report_schema():
    return json.loads((resources.folder("schema") / "report.json").read_text())


@pytest.mark.parametrize("one", REPORTS, ids=lambda one: one.verdict)
def test_json_is_as_its_schema_says(one):
    jsonschema.validate(json.loads(json_.text(one)), report_schema())


def test_schema_refuses_what_is_no_report():
    schema = report_schema()
    data = json.loads(json_.text(report(CAUSE)))
    data["findings"][0]["line"] = 0
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(data, schema)


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


@pytest.mark.parametrize("one", REPORTS, ids=lambda one: one.verdict)
def test_page_needs_nothing_else(one):
    page = Reader(html_report.text(one))
    names = {tag for tag, _ in page.tags}
    assert not names & {"script", "link", "img", "iframe"}
    for finding in one.findings:
        assert finding.message in page.text
    assert one.reason in page.text


def test_page_shows_what_a_package_says_as_text():
    page = Reader(html_report.text(report(Finding("console", "<script>alert(1)</script>"))))
    assert "<script>alert(1)</script>" in page.text


def test_console_shows_verdicts_causes_first_and_pages():
    text = console.text(report(NOTE, RESULT, CAUSE))
    assert "  [FAIL] Each node waits for callbacks (spin)" in text
    assert "  [--]   Publishers publish the right values (values)" in text
    assert text.index("src/a.py:3: error:") < text.index("src/a.py:9: error:")
    assert text.index("src/a.py:9: error:") < text.index("src/a.py:4: note:")
    assert "  page:     pages/publisher.html" in text
    assert text.endswith("1 of 37 requirements are not met; 1 could not be checked.")


def test_console_has_colours_only_where_asked():
    assert "\x1b" not in console.text(report(CAUSE))
    assert "\x1b[31m" in console.text(report(CAUSE), colours=True)
    assert "\x1b" not in console.text(report(Finding("console", "It printed \x1b[2J.")))


def facts():
    found = Facts()
    found.sources = {"a": ["src/a.py"], "b": ["src/b.py"]}
    return found


def findings(*entries):
    return [
        Finding(id_, "It is so.", file, line, stage=stage, node=node)
        for id_, file, line, stage, node in entries
    ]


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        # What one node does wrong, it does wrong when it runs; another is sent values all the same.
        ([("spin", "src/a.py", 1, "static", "a"), ("starts", "src/a.py", 1, "run", "a")], ["spin"]),
        (
            [
                ("python-syntax", "src/a.py", 1, "static", None),
                ("values", "src/a.py", 5, "run", "a"),
            ],
            ["python-syntax"],
        ),
        (
            [
                ("python-syntax", "src/a.py", 1, "static", None),
                ("received", "src/b.py", 5, "run", "b"),
            ],
            [None],
        ),
        (
            [
                ("python-names", "src/a.py", 5, "static", None),
                ("spin", "src/a.py", 5, "static", "a"),
            ],
            ["python-names"],
        ),
        # Another node's own fault is its own.
        ([("spin", "src/a.py", 1, "static", "a"), ("exit", "src/b.py", 5, "stop", "b")], [None]),
        ([("queue", "src/a.py", 1, "static", "a"), ("values", "src/a.py", 5, "run", "a")], [None]),
        # What keeps all from being built.
        (
            [("configure", "CMakeLists.txt", 1, "build", None), ("starts", None, None, "run", "b")],
            ["configure"],
        ),
        (
            [
                ("targets", "CMakeLists.txt", 4, "files", None),
                ("configure", "CMakeLists.txt", 4, "build", None),
            ],
            ["targets"],
        ),
        # Two faults of the same kind in two sources are two.
        (
            [
                ("compile", "src/a.cpp", 4, "build", None),
                ("compile", "src/b.cpp", 4, "build", None),
            ],
            [None],
        ),
        # Without the launch file, the checker starts the nodes by its own.
        ([("launch-file", None, None, "files", None), ("rate", "src/a.py", 5, "run", "a")], [None]),
        # A script that is no node of the exercise keeps no node from anything.
        (
            [
                ("python-names", "src/c.py", 5, "static", None),
                ("rate", "src/a.py", 5, "run", "a"),
            ],
            [None],
        ),
        # A second instance of a defect is another defect.
        ([("wrap", "src/a.py", 5, "static", "a"), ("wrap", "src/a.py", 9, "static", "a")], [None]),
        (
            [
                ("targets", "CMakeLists.txt", 4, "static", "a"),
                ("launch-nodes", "a.launch", 9, "static", "b"),
            ],
            [None],
        ),
    ],
    ids=range(13),
)
def test_consequences(entries, expected):
    told = causes.told_once(findings(*entries), facts())
    assert [finding.consequence_of for finding in told] == [None, *expected]


SOUND = check_rules.CMAKE
RUNNING = """#!/usr/bin/env python
import rospy
rospy.init_node("publisher_py_node")
rospy.spin()
"""


def examined(folder, rules, monkeypatch, only=(), **files):
    """Return the Report of a package of Python nodes, by these rules alone."""
    monkeypatch.setattr(check, "RULES", rules)
    package = check_rules.make(folder / "some_pkg", **files)
    return check.check(package.root, check_rules.PUB_SUB, only, timeout=300)


def rule(*found, ids=("text",), fails=None, stage="files"):
    def findings(case):
        yield from found
        if fails:
            raise fails

    return Rule(stage, 1, (), findings, also=ids)


@pytest.mark.parametrize(
    ("fails", "says"),
    [
        (TypeError("no number"), "The checker itself failed, in findings().*TypeError: no number"),
        (CannotCheck("The machine is too busy."), "The machine is too busy."),
    ],
    ids=["fault", "busy"],
)
def test_a_rule_that_fails_costs_its_own_requirements_alone(fails, says, tmp_path, monkeypatch):
    wrong = Finding("cmake", "It is wrong.", "CMakeLists.txt", 1)
    rules = [
        rule(fails=fails),
        rule(wrong, ids=("cmake",)),
        rule(ids=("manifest",), stage="static"),
    ]
    one = examined(tmp_path, rules, monkeypatch, only=("text", "cmake", "manifest"))
    assert one.verdict == check.UNCHECKED
    assert one.requirements == {
        "manifest": check.MET,
        "cmake": check.BROKEN,
        "text": check.UNCHECKED,
    }
    assert [finding.message for finding in one.findings] == ["It is wrong."]
    assert re.search(says, one.reason) and re.search(says, one.unseen["text"])
    jsonschema.validate(json.loads(json_.text(one)), report_schema())
    for text in (console.text(one), junit.text(one), html_report.text(one)):
        assert str(fails) in text


def test_a_rule_reports_no_other_requirement_than_it_says(tmp_path, monkeypatch):
    other = rule(Finding("spin", "It never spins."), ids=("text",))
    one = examined(tmp_path, [other], monkeypatch, only=("text",))
    assert (one.verdict, one.findings) == (check.UNCHECKED, [])
    assert "a rule reports spin, and does not say so" in one.reason


def test_what_failed_once_is_not_tried_again(tmp_path, monkeypatch):
    tried = []

    def model(case):
        tried.append(case)
        raise CannotCheck("CMake did not end.")

    monkeypatch.setattr(Case, "model", property(model))
    rules = [
        Rule("files", 1, ("model",), list, also=("text",)),
        Rule("files", 2, ("facts",), list, also=("cmake",)),
    ]
    one = examined(tmp_path, rules, monkeypatch, only=("text", "cmake"))
    assert (one.reason, len(tried)) == ("CMake did not end.", 1)
    assert {*one.requirements.values()} == {check.UNCHECKED}


STATIC = [rule for rule in RULES if rule.stage in ("files", "static")]
STATIC_IDS = [id_ for rule in STATIC for id_ in rule.requirements]


@pytest.mark.parametrize("id_", ["wrap", "launch-nodes"])
def test_one_requirement_alone_is_checked_as_among_all(id_):
    """--only runs what the rules need that can report the requirement, in whichever stage."""
    rules = [rule for rule in RULES if id_ in rule.ids]
    assert len(rules) > 1
    needs = check._needs([id_])
    assert "launch" in needs and "facts" in needs
    assert all(needs >= {*rule.needs} for rule in rules)


def test_what_was_never_seen_is_neither_met_nor_paid(tmp_path, monkeypatch):
    """A package without sources: nobody can say anything of its nodes."""
    one = examined(tmp_path, STATIC, monkeypatch, only=STATIC_IDS)
    never = {"dependencies", "python-syntax", "node-start", "spin", "lifetime", "queue"}
    assert {id_ for id_ in never if one.requirements[id_] != check.UNCHECKED} == set()
    assert one.unseen["spin"] == "no source of publisher_cpp_node was found"
    assert "[--]   Each node waits for callbacks (spin): no source of" in console.text(one)
    assert "no source of publisher_cpp_node" in html_report.text(one)
    assert "no source of publisher_cpp_node" in junit.text(one)
    assert json.loads(json_.text(one))["unseen"] == one.unseen
    assert one.requirements["manifest"] == check.MET
    submission = classroom.Submission("anna", json_.data(one))
    met = [id_ for id_, verdict in one.requirements.items() if verdict == check.MET]
    assert submission.points(check_rules.PUB_SUB) == len(met) < 8


def test_many_findings_outside_the_exercise_are_one_line(tmp_path, monkeypatch):
    files = {f"scripts__tool{n}_DOT_py": "#!/usr/bin/python3\nfoo()\n" for n in range(9)}
    files["src__publisher_py_node_DOT_py"] = RUNNING + "bar()\n"
    one = examined(tmp_path, STATIC, monkeypatch, only=STATIC_IDS, **files)
    names = [finding for finding in one.findings if finding.id == "python-names"]
    assert [finding.file for finding in names] == ["scripts/tool0.py", "src/publisher_py_node.py"]
    assert names[0].message.startswith("9 such faults in files that are no node of the exercise")


class Ran:
    """What was seen of a node that runs."""

    is_up = True

    def has_rate(self):
        return True


@pytest.mark.parametrize(
    ("cause", "result"),
    [
        (("configure", "CMakeLists.txt", 1, "build", None), ("rate", "src/a.py", 5, "run", "a")),
        (("python-names", "src/a.py", 5, "static", None), ("rate", "src/a.py", 5, "run", "a")),
    ],
    ids=range(2),
)
def test_what_was_seen_all_the_same_is_no_consequence(cause, result):
    assert causes.told_once(findings(cause, result), facts())[1].consequence_of == cause[0]
    seen = causes.told_once(findings(cause, result), facts(), {"a": Ran()})
    assert seen[1].consequence_of is None


def test_the_same_is_told_once():
    entry = ("spin", "src/a.py", 1, "static", "a")
    assert len(causes.told_once(findings(entry, entry), facts())) == 1
    of_no_node = ("spin", "src/a.py", 1, "static", None)
    assert len(causes.told_once(findings(of_no_node, entry), facts())) == 1
    of_another = ("spin", "src/a.py", 1, "static", "b")
    assert len(causes.told_once(findings(entry, of_another), facts())) == 2


def run(*arguments, **variables):
    env = {**scratch.environment(), "PYTHONPATH": str(CHECK.parents[1] / "src"), **variables}
    return subprocess.run(
        ["/usr/bin/python3", str(CHECK), *map(str, arguments)],
        env={**env, "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
    )


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["no_such_folder"], "check: There is no folder no_such_folder.\n"),
        ([os.devnull], "check: /dev/null is no folder; expected the folder of a package.\n"),
        ([".", "--spec", "none.yaml"], "check: none.yaml: the spec cannot be read: No such file"),
    ],
    ids=range(3),
)
def test_what_cannot_be_checked_is_exit_code_2(arguments, says):
    done = run(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(says)
    assert done.stderr.count("\n") == 1


def test_folder_without_manifest_names_the_package_in_it(tmp_path):
    (tmp_path / "src" / "a").mkdir(parents=True)
    (tmp_path / "src" / "a" / "package.xml").write_text("<package/>")
    done = run(tmp_path, "--json", tmp_path / "report.json")
    assert done.returncode == 2
    assert f"Did you mean {tmp_path}/src/a?" in done.stderr
    data = json.loads((tmp_path / "report.json").read_text())
    assert (data["verdict"], data["findings"]) == ("unchecked", [])


def test_wrong_option_is_exit_code_2():
    done = run(".", "--only", "valuse")
    assert done.returncode == 2
    assert "valuse" in done.stderr
