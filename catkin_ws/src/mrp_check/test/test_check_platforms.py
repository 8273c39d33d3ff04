# SPDX-License-Identifier: BSD-3-Clause
"""Writes the files for Gradescope and Moodle: no student sees a hidden requirement."""

import csv
import dataclasses
import io
import json

import pytest
from check_rules import ASKED, hand_in
from mrp_check.classroom import class_table, gradescope, mail, moodle
from mrp_check.classroom.by_hand import ByHand
from mrp_check.cli import check as check_command
from mrp_check.contract import spec
from mrp_check.contract.finding import SEEN, Finding
from mrp_check.contract.verdict import BROKEN, FINDINGS, MET, UNCHECKED, Report, public, unchecked
from mrp_check.report import html, json_, terminal

pytestmark = pytest.mark.quick

# The fields of https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format.
RESULTS = {"score", "execution_time", "output", "output_format", "test_output_format"}
RESULTS |= {"test_name_format", "visibility", "stdout_visibility", "extra_data", "tests"}
TEST = {"score", "max_score", "status", "name", "name_format", "number", "output", "output_format"}
TEST |= {"tags", "visibility", "extra_data"}
VISIBILITY = {"hidden", "after_due_date", "after_published", "visible", None}


def assert_gradescope_takes(found):
    assert found.keys() <= RESULTS and found.keys() & {"score", "tests"}
    for row in (found, *found.get("tests", ())):
        assert isinstance(row.get("score", 0), (int, float)) and row.get("visibility") in VISIBILITY
    for test in found.get("tests", ()):
        assert {"score"} <= test.keys() <= TEST and test["status"] in ("passed", "failed")


CONTRACT = dataclasses.replace(
    spec.read(spec.find("pub_sub")), points={"values": 5, "spin": 2.5}, hidden=("spin", "wrap")
)
SPIN = Finding("spin", "It never spins.", "src/a.py", 3, SEEN, severity="error")
WRAP = Finding("wrap", "It ends at 2^32.", "src/a.py", 7, SEEN, severity="error")
VALUES = Finding("values", "It publishes <2>.", "src/a.py", 9, SEEN, severity="error")
SILENT = Finding(
    "received", "Nothing came.", "src/b.py", 2, consequence_of="spin", severity="error"
)


def report(*findings, reason=""):
    verdicts = dict.fromkeys(ASKED, MET)
    verdicts.update({f.id: UNCHECKED if f.consequence_of else BROKEN for f in findings})
    unseen = {f.id: f"it follows from {f.consequence_of}" for f in findings if f.consequence_of}
    verdict = UNCHECKED if reason else FINDINGS if findings else MET
    return Report("a_pkg", "An exercise", verdict, list(findings), verdicts, reason, unseen)


def results(report_, contract=CONTRACT):
    found = json.loads(gradescope.text(report_, contract))
    assert_gradescope_takes(found)
    return found


def submission(name, report_):
    return class_table.Submission(name, json_.data(report_))


@pytest.mark.parametrize(
    "report_",
    [
        report(),
        report(SPIN, SILENT, VALUES),
        report(Finding("text", "\x1b[2J", "\udcff", severity="error"), reason="No time was left."),
        unchecked("There's no folder x."),
    ],
    ids=range(4),
)
def test_results_have_the_fields_that_gradescope_names(report_):
    text = gradescope.text(report_, CONTRACT)
    results(report_)
    assert "\x1b" not in text and text.encode()


def test_each_requirement_is_a_test_with_its_points():
    tests = results(report(SPIN, VALUES))["tests"]
    by_id = {test["name"].split("(")[-1][:-1]: test for test in tests}
    assert list(by_id) == list(ASKED)
    most = class_table.most(CONTRACT)
    assert sum(test["max_score"] for test in tests) == most == len(ASKED) + 4 + 1.5
    assert sum(test["score"] for test in tests) == most - 5 - 2.5
    assert {id_ for id_, test in by_id.items() if test["visibility"] == "hidden"} == {
        "spin",
        "wrap",
    }
    assert (by_id["values"]["status"], by_id["topic"]["status"]) == ("failed", "passed")
    assert "src/a.py:9: error: It publishes <2>." in by_id["values"]["output"]
    assert "It never spins." in by_id["spin"]["output"]


def test_what_could_not_be_checked_says_why_and_earns_nothing():
    report_ = report(reason="No time was left.")
    report_.requirements.update(dict.fromkeys(ASKED, UNCHECKED))
    report_.unseen.update(dict.fromkeys(ASKED, "No time was left."))
    found = results(report_)
    assert sum(test["score"] for test in found["tests"]) == 0
    assert found["output"].endswith("\nNo time was left.")
    assert "couldn't be checked: No time was left." in found["tests"][0]["output"]


def shown_by_gradescope(report_):
    found = results(report_)
    return found["output"], [t for t in found["tests"] if t["visibility"] == "visible"]


# What a student is shown of a report.
SHOWN = {
    "gradescope": shown_by_gradescope,
    "console": lambda report_: terminal.text(public(report_, CONTRACT.hidden)),
    "page": lambda report_: html.text(public(report_, CONTRACT.hidden)),
    "json": lambda report_: json_.text(public(report_, CONTRACT.hidden)),
    # Without the line of the mark: what is hidden counts.
    "mail": lambda report_: mail.text(submission("anna", report_), CONTRACT).split("\n", 2)[2],
    "moodle": lambda report_: moodle.text([submission(NAMED, report_)], CONTRACT).split("\n", 3)[3],
}
NAMED = "Anna Lee_12345_assignsubmission_file_"


@pytest.mark.parametrize("kind", SHOWN)
def test_a_student_does_not_see_which_hidden_requirement_failed(kind):
    shown = SHOWN[kind]
    assert shown(report(SPIN)) == shown(report(WRAP)) == shown(report())
    if kind != "json":
        assert f"All public requirements are met: {len(ASKED) - 2}" in str(shown(report(SPIN)))


@pytest.mark.parametrize("kind", SHOWN)
def test_a_cause_that_is_hidden_is_not_named(kind):
    text = str(SHOWN[kind](report(SPIN, SILENT)))
    assert "spin" not in text and ASKED["spin"].title not in text


@pytest.mark.parametrize("kind", SHOWN)
def test_a_hidden_requirement_that_a_comment_suppresses_is_not_named(kind):
    report_ = report()
    report_.suppressed = [dataclasses.replace(f, suppressed="I know.") for f in (SPIN, VALUES)]
    text = str(SHOWN[kind](report_))
    assert "It never spins." not in text and "(spin)" not in text
    assert "suppressed: 1" in text or kind == "json"


def test_public_leaves_hidden_requirements_out(tmp_path, monkeypatch, capsys):
    contract, file = tmp_path / "contract.yaml", tmp_path / "report.json"
    contract.write_text(spec.find("pub_sub").read_text() + "hidden: [spin]\n")
    monkeypatch.setattr(check_command.check, "check", lambda *_, **__: report(SPIN))
    options = ["--spec", str(contract), "--json", str(file), str(hand_in(tmp_path, "anna"))]
    for option, code, ids in (([], 1, {"spin"}), (["--public"], 0, set())):
        with pytest.raises(SystemExit) as end:
            check_command.main([*option, *options])
        assert end.value.code == code
        assert {f["id"] for f in json.loads(file.read_text())["findings"]} == ids
        assert ("spin" in capsys.readouterr().out) == bool(ids)


def test_without_hidden_requirements_nothing_is_left_out():
    assert public(report(SPIN), ()) == report(SPIN)
    assert terminal.summary(public(report(), ())).startswith("All requirements are met")


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda folder: (folder / "work.tar.gz").touch(), "it is an empty file"),
        (lambda folder: None, "no package.xml"),
        (lambda folder: folder.rmdir(), "There's no submission"),
        (lambda folder: (folder / "package.xml").mkdir(), "no package.xml"),
    ],
    ids=["archive", "empty", "none", "folder"],
)
def test_what_cannot_be_checked_has_a_score_of_0_and_one_sentence(make, says, tmp_path):
    made, file = tmp_path / "submission", tmp_path / "results.json"
    made.mkdir()
    make(made)
    with pytest.raises(SystemExit) as end:
        check_command.main(["--gradescope", str(file), str(made)])
    assert end.value.code == 2
    found = json.loads(file.read_text())
    assert_gradescope_takes(found)
    assert found["score"] == 0 and says in found["output"]
    assert found["output"].count("\n") == 0


CLASS = [
    submission(NAMED, report(SPIN, VALUES)),
    submission("Bea O'Neil_777_assignsubmission_file", unchecked("It has no package.xml.")),
    submission("carl", report()),
    submission("Dee_5_assignsubmission_file_a.zip", report()),
    submission("Dee_5_assignsubmission_file_b.zip", report()),
]


def test_worksheet_has_what_moodle_reads(monkeypatch):
    """Moodle finds a column by its name, and the student by the number after "Participant "."""
    monkeypatch.setattr(terminal.resources, "site", lambda: "file:///home/pages")
    rows = list(csv.DictReader(io.StringIO(moodle.text(CLASS, CONTRACT), newline="")))
    # assignfeedback_offline_grade_importer::init() needs the first three.
    assert {"Identifier", "Grade", "Last modified (grade)", "Feedback comments"} <= rows[0].keys()
    assert [row["Identifier"] for row in rows] == ["Participant 12345", "Participant 777"]
    anna, bea = rows
    assert float(anna["Maximum Grade"]) == class_table.most(CONTRACT)
    assert float(anna["Grade"]) == class_table.most(CONTRACT) - 7.5
    assert "src/a.py:9: error: It publishes &lt;2&gt;." in anna["Feedback comments"]
    assert "spin" not in anna["Feedback comments"] and "file:" not in anna["Feedback comments"]
    assert (bea["Full name"], bea["Grade"]) == ("Bea O'Neil", "0")
    assert "It has no package.xml." in bea["Feedback comments"]


def test_text_for_a_mail(tmp_path):
    results = [*CLASS[:2], submission("n" * 252, report())]
    (failed,) = mail.write(tmp_path, results, CONTRACT)
    assert failed.endswith("nn.txt can't be written: File name too long.")
    anna, bea = ((tmp_path / f"{result.name}.txt").read_text() for result in CLASS[:2])
    most = class_table.most(CONTRACT)
    assert f"{NAMED}: mark {most - 7.5:g} of {most:g}\n" in anna
    assert "src/a.py:9: error: It publishes <2>." in anna and "spin" not in anna
    assert bea.endswith("It has no package.xml.\nNothing could be checked.\n")


def test_worksheet_has_the_mark_with_what_was_set_by_hand():
    bea = dataclasses.replace(CLASS[1], by_hand=ByHand(7.5, "<b>"))
    (row,) = csv.DictReader(io.StringIO(moodle.text([bea], CONTRACT), newline=""))
    assert row["Grade"] == "7.5"
    feedback = f"mark 7.5 of {class_table.most(CONTRACT):g}, by hand: 7.5 (&lt;b&gt;)"
    assert feedback in row["Feedback comments"]


def test_a_name_without_a_number_is_not_guessed():
    assert moodle.left_out(CLASS) == [
        "carl",
        "Dee_5_assignsubmission_file_a.zip",
        "Dee_5_assignsubmission_file_b.zip",
    ]
