# SPDX-License-Identifier: BSD-3-Clause
"""The defects in mrp_check/defects/: each can be injected, and its head says who must find it.

test_broken.py and test_check_sets.py see whether it is found.
"""

import pathlib
import re

import check_sets
import pytest
from mrp_check.contract import defects
from mrp_check.rules import REQUIREMENTS
from mrp_testing import errata

pytestmark = pytest.mark.quick

ALL = defects.read_all()
TESTS = check_sets.TUTORIAL / "test"


@pytest.mark.parametrize("defect", ALL, ids=lambda one: one.name)
def test_defect_can_be_injected_and_taken_back(defect, tmp_path):
    check_sets.lay_out(defect.base, tmp_path)
    correct = contents(tmp_path)
    check_sets.break_(tmp_path, defect)
    assert contents(tmp_path) != correct
    # patch leaves one where a defect's lines are not at their place.
    assert list(tmp_path.rglob("*.orig")) == []
    for file, pattern in defect.places:
        lines = (tmp_path / file).read_bytes().decode("utf-8", "replace").splitlines()
        assert any(re.search(pattern, line) for line in lines), f"{file}: {pattern}"
    check_sets.break_(tmp_path, defect, "--reverse")
    assert contents(tmp_path) == correct


def contents(folder):
    """Return path -> (mode, bytes) of all files of a folder."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder): (path.stat().st_mode, path.read_bytes()) for path in files}


@pytest.mark.parametrize("defect", ALL, ids=lambda one: one.name)
def test_head_names_what_is_there(defect):
    assert defect.base in check_sets.STYLES
    assert [id_ for id_ in defect.finds.split("|") if id_ and id_ not in REQUIREMENTS] == []
    assert not defect.erratum or defect.erratum in errata.NUMBERS
    if defect.fails:
        rostest, case = defect.fails
        files = TESTS.glob(f"test_{rostest[: -len('.test')]}.*")
        assert (TESTS / rostest).exists()
        assert any(re.search(rf"\b{case}\b", path.read_text()) for path in files), case


def test_there_are_as_many_as_were_asked_for():
    assert len(check_sets.DEFECTS) >= 40
    assert len(check_sets.STYLES) >= 12


def test_exercises_are_a_path():
    exercises = defects.exercises()
    assert [one.order for one in exercises] == [*range(1, len(exercises) + 1)]
    kinds = [one.kind for one in exercises]
    assert {*kinds} == {*defects.KINDS} == {*kinds[20:], "read"} and kinds[0] == "read"
    endings = [pathlib.Path(file).suffix for one in exercises for file in changed(one)]
    assert abs(endings.count(".py") - endings.count(".cpp") - endings.count(".cc")) <= 2
    assert {*endings} == {".py", ".cpp", ".cc", ".launch", ".txt", ".xml"}


def changed(defect):
    """Return the files that a defect changes."""
    return re.findall(r"^\+\+\+ b/(\S+)", defect.path.read_text(), re.MULTILINE)


@pytest.mark.parametrize("exercise", defects.exercises(), ids=lambda one: one.name)
def test_exercise_has_a_page_and_a_short_hint(exercise):
    assert (check_sets.TUTORIAL / "doc" / "pages" / f"{exercise.page}.rst").exists()
    assert len(exercise.hint.split()) <= 160
    # What is to be completed is marked, and what the hint says stands in no comment of it.
    added = re.findall(r"^\+.*Complete this: ", exercise.path.read_text(), re.MULTILINE)
    assert len(added) == (exercise.kind == "complete")


HEAD = """\
Breaks: a colon
Erratum: E5
Fails: stop.test test_end
Says: != 0
Finds: python-syntax
In: src/a.py: def
In: src/b.py: x
Tells: colon
Order: 3
Kind: fix
Task:
    # A title

    A text,
      which goes on. The page: `queues`.
Hint: Look
    at it.
Learned: It works.
"""
DIFF = "\n--- a/src/a.py\n+++ b/src/a.py\n"


def write(folder, head, name="some.patch"):
    """Write a patch with this head; return its path."""
    path = folder / name
    path.write_text(head + DIFF)
    return path


def test_head_is_read(tmp_path):
    path = write(tmp_path, HEAD)
    assert defects.read_all(tmp_path) == [
        defects.Defect(
            path=path,
            breaks="a colon",
            erratum="E5",
            fails=("stop.test", "test_end"),
            says="!= 0",
            finds="python-syntax",
            places=(("src/a.py", "def"), ("src/b.py", "x")),
            tells="colon",
            order=3,
            kind="fix",
            task="# A title\n\nA text,\n  which goes on. The page: `queues`.",
            hint="Look\nat it.",
            learned="It works.",
        )
    ]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("Breaks:", "Break:", "there is no field Break: expected one of Base, Breaks, "),
        ("Breaks: a colon\n", "", "the field Breaks is missing"),
        ("Breaks: a colon", "Breaks:", "expected a value, in the field Breaks; found ''"),
        ("Tells:", "Tells: a\nTells:", "expected the field Tells once; found it 2 times"),
        (
            "Fails: stop.test test_end\nSays: != 0\nFinds: python-syntax\n",
            "",
            "nobody would find",
        ),
        ("Says: != 0\n", "", "the field Says is missing, as one of Fails, Says is there"),
        ("Tells: colon\n", "", "the field Tells is missing, as one of Finds, In, Tells is"),
        ("Hint: Look\n    at it.\n", "", "the field Hint is missing, as one of Order, Kind, Task"),
        (
            "Kind: fix\n",
            "",
            "the field Kind is missing, as one of Order, Kind, Task, Hint, Learned",
        ),
        ("Kind: fix", "Kind: guess", "expected one of read, fix, complete, write, in the field"),
        ("The page: `queues`.", "", "an empty line, a text, and 'The page: `queues`.', in the"),
        ("Erratum: E5", "Erratum: 5", "expected the number of an erratum, such as E5, in"),
        ("Fails: stop.test", "Fails: stop", "expected a rostest and a test case of it, in the"),
        ("In: src/a.py: def", "In: src/a.py", "expected a file, a colon, and a regular expression"),
        ("Tells: colon", "Tells: (colon", "found '(colon': missing ), unterminated subpattern"),
        ("In: src/a.py: def", "In: src/a.py: [", "found 'src/a.py: [': unterminated character set"),
        (
            "Order: 3",
            "Order: third",
            "expected a number from 1 on, in the field Order; found 'third'",
        ),
        (
            "    # A title\n\n",
            "",
            "expected a title such as '# A title', an empty line, a text, and",
        ),
        ("Breaks:", "Base: format1\nBreaks:", "Fails breaks mrp: expected no other Base"),
        ("Breaks: a", "a", "expected 'Field: value' or an indented line; found 'a colon'"),
    ],
)
def test_head_that_is_not_right_is_an_error_in_a_sentence(old, new, fault, tmp_path):
    assert old in HEAD
    write(tmp_path, HEAD.replace(old, new, 1))
    with pytest.raises(defects.DefectError) as error:
        defects.read_all(tmp_path)
    sentence = str(error.value)
    assert sentence.startswith("some.patch: ") and sentence.endswith(".")
    assert fault in sentence


def test_two_exercises_with_one_number_are_an_error(tmp_path):
    for name in ("a.patch", "b.patch"):
        write(tmp_path, HEAD, name)
    expected = "a.patch and b.patch are both exercise 3: expected one exercise for each number."
    with pytest.raises(defects.DefectError, match=f"^{re.escape(expected)}$"):
        defects.read_all(tmp_path)


def test_folder_without_defects_is_an_error(tmp_path):
    with pytest.raises(defects.DefectError, match=r"^Expected patches in .*; there is none\.$"):
        defects.read_all(tmp_path)
