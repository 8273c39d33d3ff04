# SPDX-License-Identifier: BSD-3-Clause
"""Checks what becomes of each requirement: met, not met, or unknown, and why."""

import dataclasses
import json
import re

import check_rules
import jsonschema
import pytest
from mrp_check.classroom import class_table
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import SEEN, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.report import html as html_report
from mrp_check.report import json_, junit, terminal
from mrp_check.rules import RULES
from mrp_check.run.case import Case
from mrp_check.verdict import check, suppression
from mrp_check.verdict.severity import weigh

pytestmark = pytest.mark.quick


def examined(folder, rules, monkeypatch, only=(), **files):
    """Return the Report of a package of Python nodes, by these rules alone."""
    monkeypatch.setattr(check, "RULES", rules)
    package = check_rules.make(folder / "some_pkg", **files)
    return check.check(package, check_rules.PUB_SUB, only, timeout=300)


def rule(*found, ids=("text",), fails=None, stage="files"):
    def findings(case):
        yield from found
        if fails:
            raise fails

    return Rule(stage, (), findings, also=ids)


@pytest.mark.parametrize(
    ("fails", "says"),
    [
        (TypeError("no number"), "The checker itself failed, in findings().*TypeError: no number"),
        (CannotCheck("The machine is too busy."), "The machine is too busy."),
    ],
    ids=["fault", "busy"],
)
def test_a_rule_that_fails_costs_its_own_requirements_alone(
    fails, says, tmp_path, monkeypatch, report_schema
):
    wrong = Finding("cmake", "It is wrong.", "CMakeLists.txt", 1)
    rules = [
        rule(fails=fails),
        rule(wrong, ids=("cmake",)),
        rule(ids=("manifest",), stage="static"),
    ]
    report = examined(tmp_path, rules, monkeypatch, only=("text", "cmake", "manifest"))
    assert report.verdict == check.FINDINGS
    assert report.requirements == {
        "manifest": check.MET,
        "cmake": check.BROKEN,
        "text": check.UNCHECKED,
    }
    assert [finding.message for finding in report.findings] == ["It is wrong."]
    assert re.search(says, report.reason) and re.search(says, report.unseen["text"])
    jsonschema.validate(json.loads(json_.text(report)), report_schema)
    for text in (terminal.text(report), junit.text(report), html_report.text(report)):
        assert str(fails) in text


def test_a_rule_reports_no_other_requirement_than_it_says(tmp_path, monkeypatch):
    other = rule(Finding("spin", "It never spins."), ids=("text",))
    report = examined(tmp_path, [other], monkeypatch, only=("text",))
    assert (report.verdict, report.findings) == (check.UNCHECKED, [])
    assert "a rule reports spin, and does not say so" in report.reason


@pytest.mark.slow
def test_what_failed_once_is_not_tried_again(tmp_path, monkeypatch):
    tried = []

    def model(case):
        tried.append(case)
        raise CannotCheck("CMake did not end.")

    monkeypatch.setattr(Case, "model", property(model))
    rules = [
        Rule("files", ("model",), list, also=("text",)),
        Rule("files", ("facts",), list, also=("cmake",)),
    ]
    report = examined(tmp_path, rules, monkeypatch, only=("text", "cmake"))
    assert (report.reason, len(tried)) == ("CMake did not end.", 1)
    assert {*report.requirements.values()} == {check.UNCHECKED}


STATIC = [rule for rule in RULES if rule.stage in ("files", "static")]
STATIC_IDS = [id_ for rule in STATIC for id_ in rule.requirements]


@pytest.mark.parametrize("id_", ["wrap", "launch-nodes"])
def test_one_requirement_alone_is_checked_as_among_all(id_):
    """--only runs what the rules need that can report the requirement, in whichever stage."""
    rules = [rule for rule in RULES if id_ in rule.ids]
    assert len(rules) > 1
    needs = check.needs_of([id_])
    assert "launch" in needs and "facts" in needs
    assert all(needs >= {*rule.needs} for rule in rules)


def test_what_was_never_seen_is_neither_met_nor_paid(tmp_path, monkeypatch):
    """Checks a package without sources: nobody can know what its nodes do."""
    report = examined(tmp_path, STATIC, monkeypatch, only=STATIC_IDS)
    never = {"dependencies", "python-syntax", "node-start", "spin", "lifetime", "queue"}
    assert {id_ for id_ in never if report.requirements[id_] != check.UNCHECKED} == set()
    assert report.unseen["spin"] == "no source of publisher_cpp_node was found"
    assert "[--]   Each node waits for callbacks (spin): no source of" in terminal.text(report)
    assert "no source of publisher_cpp_node" in html_report.text(report)
    assert "no source of publisher_cpp_node" in junit.text(report)
    assert json.loads(json_.text(report))["unseen"] == report.unseen
    assert report.requirements["manifest"] == check.MET
    submission = class_table.Submission("anna", json_.data(report))
    met = [id_ for id_, verdict in report.requirements.items() if verdict == check.MET]
    assert submission.points(check_rules.PUB_SUB) == len(met) < 8


COMMENTED = """\
import rospy
# mrp_check: ignore spin: it sleeps in a loop of its own
rospy.init_node("a")
pub = 1  # mrp_check: ignore lifetime
# mrp_check: ignore spinn: it sleeps
# mrp_check: ignore queue: it is never full
"""
SPINS = Finding("spin", "It never spins.", "src/a.py", 3, stage="static")
FOLLOWS = Finding("values", "No value came.", "src/a.py", 3, consequence_of="spin", stage="run")
DROPPED = Finding("lifetime", "It is not kept.", "src/a.py", 4, stage="static")


def test_a_comment_with_a_reason_suppresses_a_finding(tmp_path):
    package = check_rules.make(tmp_path, src__a_DOT_py=COMMENTED)
    found = [dataclasses.replace(f, certainty=SEEN) for f in (SPINS, FOLLOWS, DROPPED)]
    stay, suppressed = suppression.applied(package, found, {"spin", "lifetime", "queue"}, False)
    weigh(stay, has_contract=True)
    assert [(finding.id, finding.suppressed) for finding in suppressed] == [
        ("spin", "it sleeps in a loop of its own")
    ]
    assert [(f.id, f.line, f.severity, f.consequence_of) for f in stay] == [
        ("values", 3, "error", None),
        ("lifetime", 4, "error", None),
        ("lifetime", 4, "warning", None),
        ("text", 5, "warning", None),
        ("queue", 6, "warning", None),
    ]
    says = ["gives no reason", "Did you mean 'spin'", "no such finding here"]
    assert all(word in finding.message for word, finding in zip(says, stay[2:]))


def test_what_could_not_be_checked_is_no_idle_comment(tmp_path):
    package = check_rules.make(tmp_path, src__a_DOT_py="# mrp_check: ignore queue: never full\n")
    assert suppression.applied(package, [], {"spin"}, False) == ([], [])


@pytest.mark.parametrize(
    ("file", "line"),
    [
        ("src__a_DOT_cpp", "int a;  // mrp_check: ignore spin: why"),
        ("CMakeLists_DOT_txt", "# mrp_check: ignore spin: why"),
        ("launch__a_DOT_launch", "<!-- mrp_check: ignore spin: why --> <launch/>"),
        ("package_DOT_xml", "<!-- mrp_check: ignore spin: why -->"),
        ("msg__A_DOT_msg", "int8 a # mrp_check: ignore spin: why"),
    ],
)
def test_a_comment_is_one_of_its_language(file, line, tmp_path):
    name = file.replace("__", "/").replace("_DOT_", ".")
    package = check_rules.make(tmp_path, **{file: line + "\n", "src__b_DOT_cpp": "# " + line})
    (comment,) = (entry for entry in suppression.comments(package) if entry.file != "src/b.cpp")
    assert comment == suppression.Comment(name, 1, "spin", "why")


def test_under_a_contract_a_comment_suppresses_nothing(tmp_path, monkeypatch):
    wrong = Finding("cmake", "It is wrong.", "CMakeLists.txt", 1)
    text = "# mrp_check: ignore cmake: it is as I want it\n"
    rules = [rule(wrong, ids=("cmake",))]
    report = examined(tmp_path, rules, monkeypatch, only=("cmake",), CMakeLists_DOT_txt=text)
    assert (report.requirements, report.suppressed) == ({"cmake": check.BROKEN}, [])
    assert [finding.severity for finding in report.findings] == ["error", "note"]
    assert "a contract says what counts" in report.findings[1].message
