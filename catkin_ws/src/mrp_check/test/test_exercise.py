# SPDX-License-Identifier: BSD-3-Clause
"""What `make exercise` says, from the first exercise on; the check itself is not made here."""

import shutil

import pytest
from mrp_check import check
from mrp_check.cli import exercise
from mrp_check.contract.finding import WARNING, Finding
from mrp_testing.proves import proves

pytestmark = pytest.mark.quick

COUNT = len(exercise.exercises())
FIRST = "01_a_parenthesis"


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


@proves("The first call makes a broken copy of the tutorial's package, and prints your task.")
def test_first_call_shows_the_task_and_makes_the_package(tmp_path, capsys, checked):
    assert exercise.run(tmp_path / "mine") == exercise.PASSED
    printed = capsys.readouterr().out
    place = tmp_path / "mine" / FIRST
    assert f"Exercise 1 of {COUNT}\n\n# A parenthesis" in printed
    assert f"The package: {place}" in printed
    assert (place / "TASK.md").read_text() in printed
    assert (place / "package.xml").exists() and not (place / "doc").exists()
    assert checked.folders == []


@proves(
    "Then call make exercise again: it checks your copy.",
    "If not, it prints what is still wrong, and where.",
)
def test_not_yet_says_what_and_where_and_not_how(tmp_path, capsys, checked):
    exercise.run(tmp_path)
    capsys.readouterr()
    checked.append(Finding("spin", "It ends.", "src/a.py", 7, expected="spin", fix="Do this."))
    checked.append(Finding("exit", "It follows.", consequence_of="spin"))
    assert exercise.run(tmp_path) == exercise.NOT_YET
    printed = capsys.readouterr().out
    assert f"Exercise 1 of {COUNT}, {FIRST}: not yet." in printed
    assert "src/a.py:7: It ends.\n  expected: spin\n" in printed
    assert "Do this." not in printed and "It follows." not in printed
    assert str(tmp_path / FIRST / "TASK.md") in printed
    assert checked.folders == [tmp_path / FIRST]


@proves("If your copy meets the contract, without a warning, it goes on to the next exercise.")
def test_a_warning_is_not_passed(tmp_path, checked):
    exercise.run(tmp_path)
    checked.append(Finding("warnings", "It warns.", severity=WARNING))
    assert exercise.run(tmp_path) == exercise.NOT_YET


@proves(
    "If your copy meets the contract, without a warning, it goes on to the next exercise.",
    "Practise: make exercise gives you broken packages to fix, one after the other.",
)
def test_passed_goes_on_to_the_next_until_all_are_passed(tmp_path, capsys, checked):
    for number in range(1, COUNT + 1):
        exercise.run(tmp_path)
        printed = capsys.readouterr().out
        assert f"Exercise {number} of {COUNT}\n" in printed
    exercise.run(tmp_path)
    assert f"All {COUNT} exercises are passed." in capsys.readouterr().out
    assert [path.name for path in checked.folders] == [one.name for one in exercise.exercises()]


@proves(
    "make exercise HINT=1 gives a hint, and make exercise RESET=1 starts the exercise again.",
)
def test_hint(tmp_path, capsys, checked):
    exercise.run(tmp_path)
    capsys.readouterr()
    assert exercise.run(tmp_path, hint=True) == exercise.PASSED
    assert capsys.readouterr().out == exercise.exercises()[0].defect.hint + "\n"
    assert checked.folders == []


@proves(
    "make exercise HINT=1 gives a hint, and make exercise RESET=1 starts the exercise again.",
)
def test_reset_begins_anew(tmp_path, checked):
    exercise.run(tmp_path)
    script = tmp_path / FIRST / "src" / "subscriber_py_node.py"
    before = script.read_text()
    script.write_text("")
    exercise.run(tmp_path)
    (tmp_path / "passed.txt").unlink()
    exercise.run(tmp_path, reset=True)
    assert script.read_text() == before


def test_installed_without_sources_says_what_to_do(tmp_path, monkeypatch):
    installed = shutil.copytree(exercise.defects.resources.folder("defects"), tmp_path / "defects")
    monkeypatch.setattr(exercise.defects.resources, "folder", lambda name: installed)
    with pytest.raises(exercise.ExerciseError, match="in a clone of the repository"):
        exercise.run(tmp_path / "mine")
