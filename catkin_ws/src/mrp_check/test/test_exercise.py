# SPDX-License-Identifier: BSD-3-Clause
"""Works through the exercises, and compares what they say; no package is checked here."""

import shutil
import subprocess
import threading

import check_sets
import pytest
from mrp_check.cli import learn
from mrp_check.contract import defects, packages
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.learning import opening, plain, tool_output, watch
from mrp_check.learning.exercise import Course
from mrp_check.verdict import check
from mrp_testing.waiting import DEADLINE, wait_until

pytestmark = pytest.mark.quick

EXERCISES = defects.exercises()
COUNT = 3  # of the exercises with which a course is made here
FIRST = "a_parenthesis"


@pytest.fixture(autouse=True)
def short(monkeypatch):
    """A course of the first few: all of them are in test_the_solution_is_a_diff_that_solves_it."""
    monkeypatch.setattr(defects, "exercises", lambda: EXERCISES[:COUNT])


@pytest.fixture
def checked(monkeypatch):
    """The findings that a check will have; and, as `checked.folders`, what was checked."""

    class Findings(list):
        folders = []

    findings = Findings()

    def fake(package, *_, **__):
        findings.folders.append(package.root)
        return check.Report("mrp", "", check.FINDINGS, list(findings), {})

    monkeypatch.setattr(check, "check", fake)
    findings.folders.clear()
    return findings


def test_first_call_shows_the_task_and_makes_the_package(tmp_path, capsys, checked):
    assert plain.run_once(tmp_path / "mine") == plain.PASSED
    printed = capsys.readouterr().out
    place = tmp_path / "mine" / f"01_{FIRST}"
    assert f"Exercise 1 of {COUNT}\n\n# A parenthesis" in printed
    assert f"  {place}/src/subscriber_py_node.py\n" in printed
    assert (place / "TASK.md").read_text() in printed
    assert (place / "package.xml").exists() and not (place / "doc").exists()
    assert checked.folders == []


def test_not_yet_says_what_and_where_and_not_how(tmp_path, capsys, checked, monkeypatch):
    monkeypatch.setattr(opening, "built_page", lambda name: tmp_path / f"{name}.html")
    plain.run_once(tmp_path)
    capsys.readouterr()
    checked.append(
        Finding("spin", "It ends.", "src/a.py", 7, expected="spin", fix="Do this.", why="x")
    )
    checked.append(Finding("exit", "It follows.", consequence_of="spin"))
    assert plain.run_once(tmp_path) == plain.NOT_YET
    printed = capsys.readouterr().out
    assert f"Exercise 1 of {COUNT}, {FIRST}: not yet." in printed
    assert "src/a.py:7: It ends.\n  expected: spin\n" in printed
    assert f"file://{tmp_path}/why.html#x\n            (make docs builds it)\n" in printed
    assert "Do this." not in printed and "It follows." not in printed
    assert str(tmp_path / f"01_{FIRST}" / "TASK.md") in printed
    assert checked.folders == [tmp_path / f"01_{FIRST}"]


def test_findings_about_the_same_line_are_shown_as_one(tmp_path, capsys, checked):
    plain.run_once(tmp_path)
    for number in range(6):
        checked.append(Finding("launch-nodes", f"Node {number} is missing.", "launch/a.launch", 7))
    checked.append(Finding("launch-nodes", "Another line.", "launch/a.launch", 8))
    capsys.readouterr()
    plain.run_once(tmp_path)
    printed = capsys.readouterr().out
    assert "Node 0 is missing." in printed and "Another line." in printed
    assert "Node 1 is missing." not in printed


@pytest.mark.parametrize(
    ("lines", "has_error"),
    [
        (
            ["Scanning", "/tmp/a/workspace/src/copy/src/a.cpp:3:1: error: expected ;", "  3 | int"],
            True,
        ),
        (["[100%] Built target a"], False),
    ],
)
def test_tools_own_words_name_the_students_file(tmp_path, lines, has_error):
    report = check.Report("mrp", "", check.FINDINGS, [], {}, tools=lines)
    expected = [f"{tmp_path}/src/a.cpp:3:1: error: expected ;", "  3 | int"] if has_error else []
    assert tool_output.lines_of(report, tmp_path) == expected


def test_own_words_of_a_node_are_its_traceback(tmp_path):
    console = [
        "[INFO] [1.0]: [PUBLISHER PY NODE] namespace of node = /mrp/publisher_py_node",
        "Traceback (most recent call last):",
        '  File "/tmp/a/workspace/devel/lib/mrp/a.py", line 15, in <module>',
        "    exec(compile(fh.read(), python_script, 'exec'), context)",
        '  File "/tmp/a/workspace/src/copy/src/a.py", line 3, in <module>',
        "    main()",
        "[ INFO] [1.1]: [SUBSCRIBER CPP NODE] received message with data = 2",
        "NameError: name 'main' is not defined",
    ]
    report = check.Report("mrp", "", check.FINDINGS, [], {}, console=console)
    assert tool_output.lines_of(report, tmp_path) == [
        "Traceback (most recent call last):",
        f'  File "{tmp_path}/src/a.py", line 3, in <module>',
        "    main()",
        "NameError: name 'main' is not defined",
    ]


def test_a_warning_is_not_passed(tmp_path, checked):
    plain.run_once(tmp_path)
    checked.append(Finding("warnings", "It warns.", severity=WARNING))
    assert plain.run_once(tmp_path) == plain.NOT_YET


def test_passed_goes_on_to_the_next_until_all_are_passed(tmp_path, capsys, checked):
    for number in range(1, COUNT + 1):
        plain.run_once(tmp_path)
        printed = capsys.readouterr().out
        assert f"Exercise {number} of {COUNT}\n" in printed
    plain.run_once(tmp_path)
    assert f"You have finished all {COUNT}. Well done!" in capsys.readouterr().out
    assert checked.folders == [exercise.place for exercise in Course(tmp_path).exercises]


def test_another_number_changes_neither_the_progress_nor_the_copy(tmp_path, checked, monkeypatch):
    """Also what a version kept that wrote the number, too."""
    for _ in range(2):
        plain.run_once(tmp_path)
    passed, copied, _ = Course(tmp_path).exercises
    numbered = [EXERCISES[2], EXERCISES[1], EXERCISES[0]]
    monkeypatch.setattr(defects, "exercises", lambda: numbered)
    for kept in (f"{passed.name}\n", f"01_{passed.name}\n"):
        (tmp_path / "passed.txt").write_text(kept)
        course = Course(tmp_path)
        assert [course.is_passed(exercise) for exercise in course.exercises] == [False, False, True]
        assert [exercise.place for exercise in course.exercises[1:]] == [copied.place, passed.place]
        assert course.exercises[0].place.name.startswith("01_")


def test_hint(tmp_path, capsys, checked):
    plain.run_once(tmp_path)
    capsys.readouterr()
    assert plain.run_once(tmp_path, hint=True) == plain.PASSED
    assert capsys.readouterr().out == EXERCISES[0].hint + "\n"
    assert checked.folders == []


def test_reset_begins_anew(tmp_path, checked):
    plain.run_once(tmp_path)
    script = tmp_path / f"01_{FIRST}" / "src" / "subscriber_py_node.py"
    before = script.read_text()
    script.write_text("")
    plain.run_once(tmp_path)
    (tmp_path / "passed.txt").unlink()
    plain.run_once(tmp_path, reset=True)
    assert script.read_text() == before


def test_installed_without_sources_says_what_to_do(tmp_path, monkeypatch):
    installed = shutil.copytree(defects.resources.folder("defects"), tmp_path / "defects")
    monkeypatch.setattr(defects.resources, "folder", lambda name: installed)
    with pytest.raises(packages.PatchError, match="in a clone of the repository"):
        plain.run_once(tmp_path / "mine")


def test_each_save_is_checked_and_an_editors_own_files_are_not(tmp_path, checked):
    watched = watch.Watched(Course(tmp_path / "mine"), tmp_path / "scratch")

    def check_is_done():
        watched.look()
        return watched.check and watched.check.done and watched.check

    checked.append(Finding("spin", "It ends."))
    first = wait_until(check_is_done, "the check of what is there")
    assert [finding.message for finding in first.findings] == ["It ends."]
    place = watched.exercise.place
    for name in ("src/.a.py.swp", "src/a.py~", "#a.py#"):
        (place / name).write_text("")
    for _ in range(3):
        watched.look()
    assert watched.check is first
    checked.clear()
    (place / "src" / "subscriber_py_node.py").write_text("")
    wait_until(lambda: check_is_done() not in (None, False, first), "the next check")
    second = watched.check
    watched.look()
    assert second.passed and watched.course.is_passed(watched.exercise)
    assert [exercise.number for exercise in Course(tmp_path / "mine").open][:2] == [2, 3]
    watched.reset()
    assert (place / "src" / "subscriber_py_node.py").read_text() != ""


def test_what_is_found_early_is_known_early(tmp_path, monkeypatch):
    """The check goes on only after its first findings are known, and its verdict comes later."""
    known = threading.Event()

    def fake(package, *_, early, **__):
        found = [Finding("spin", "In the files.", "src/a.py", 7)]
        early(check.Report("mrp", "", check.FINDINGS, found, {}))
        assert known.wait(DEADLINE)
        return check.Report("mrp", "", check.FINDINGS, [*found, Finding("exit", "In a run.")], {})

    monkeypatch.setattr(check, "check", fake)
    watched = watch.Watched(Course(tmp_path), tmp_path / "scratch")

    def found():
        watched.look()
        return [finding.message for finding in watched.check.findings] if watched.check else []

    wait_until(lambda: found() == ["In the files."], "what is found first")
    assert not watched.check.done
    known.set()
    wait_until(lambda: watched.check.done, "the verdict")
    assert found() == ["In the files.", "In a run."]


def test_the_solution_is_a_diff_that_solves_it(tmp_path, monkeypatch):
    monkeypatch.setattr(defects, "exercises", lambda: EXERCISES)
    names = [exercise.name for exercise in Course(tmp_path).exercises]
    assert len({*names}) == len(names)
    for exercise in Course(tmp_path).exercises:
        correct = tmp_path / exercise.defect.base
        check_sets.lay_out(exercise.defect.base, correct)
        exercise.prepare()
        text = "\n".join([*exercise.solution(), ""])
        command = ["patch", "-p1", "--fuzz=0", "--silent"]
        subprocess.run(command, cwd=exercise.place, input=text, text=True, check=True)
        (exercise.place / "TASK.md").unlink()
        same = ["diff", "-r", exercise.place, correct]
        assert subprocess.run(same, capture_output=True, text=True).stdout == ""


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["passed.txt"], "passed.txt: File exists."),
        (["mine"], "this needs a terminal. Without one, go step by step: make exercise"),
        ([], "the following arguments are required"),
    ],
)
def test_what_cannot_be_used_is_an_error_in_a_sentence(tmp_path, capsys, arguments, expected):
    (tmp_path / "passed.txt").write_text("")
    with pytest.raises(SystemExit) as ended:
        learn.main([str(tmp_path / name) for name in arguments])
    assert ended.value.code == 2
    printed = capsys.readouterr().err
    assert expected in printed and "Traceback" not in printed
