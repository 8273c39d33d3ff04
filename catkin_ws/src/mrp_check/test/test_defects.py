# SPDX-License-Identifier: BSD-3-Clause
"""Reads the patches in mrp_check/defects/ and correct/: each applies, and its head is right.

test_broken.py and test_check_sets.py see whether a defect is found, and no correct package is.
"""

import pathlib
import re
import xml.etree.ElementTree as ElementTree

import check_sets
import pytest
from mrp_check.contract import defects, resources, spec
from mrp_check.rules import REQUIREMENTS
from mrp_testing import errata

pytestmark = pytest.mark.quick

ALL = defects.read_all()
TESTS = check_sets.TUTORIAL / "test"


@pytest.mark.parametrize("defect", ALL, ids=lambda defect: defect.name)
def test_defect_can_be_injected_and_taken_back(defect, tmp_path):
    check_sets.lay_out(defect.base, tmp_path)
    correct = check_sets.contents(tmp_path)
    check_sets.break_(tmp_path, defect)
    assert check_sets.contents(tmp_path) != correct
    # patch leaves one where a defect's lines are not at their place.
    assert list(tmp_path.rglob("*.orig")) == []
    for file, pattern in defect.places:
        lines = (tmp_path / file).read_bytes().decode("utf-8", "replace").splitlines()
        assert any(re.search(pattern, line) for line in lines), f"{file}: {pattern}"
    check_sets.break_(tmp_path, defect, "--reverse")
    assert check_sets.contents(tmp_path) == correct


EXERCISE = ("Order", "Kind", "Task", "Hint", "Learned")
# What has one of these fields has all, and the second ones.
TOGETHER = {("Fails", "Says"): (), ("Finds", "In", "Tells"): (), EXERCISE: ("Finds",)}


@pytest.mark.parametrize("defect", ALL, ids=lambda defect: defect.name)
def test_head_has_all_that_it_needs(defect):
    fields = defects.fields(defect.path)
    needed = set() if "Fails" in fields else {"Finds"}
    for group, others in TOGETHER.items():
        if fields.keys() & {*group}:
            needed |= {*group, *others}
    assert needed - fields.keys() == set(), "these fields are missing: see defects.py"
    assert [field for field, values in fields.items() if not all(values)] == []
    for value in (defect.says, defect.finds, defect.tells):
        re.compile(value)
    assert defect.severity in ("error", "warning")
    assert not defect.fails or defect.base == "mrp"


@pytest.mark.parametrize("defect", ALL, ids=lambda defect: defect.name)
def test_head_names_what_is_there(defect):
    assert defect.base in check_sets.STYLES
    assert [id_ for id_ in defect.finds.split("|") if id_ and id_ not in REQUIREMENTS] == []
    assert not defect.erratum or defect.erratum in errata.NUMBERS
    if defect.fails:
        rostest, case = defect.fails
        files = TESTS.glob(f"test_{rostest[: -len('.test')]}.*")
        assert (TESTS / rostest).exists()
        assert any(re.search(rf"\b{case}\b", path.read_text()) for path in files), case


def test_exercises_are_a_path():
    exercises = defects.exercises()
    assert [exercise.order for exercise in exercises] == [*range(1, len(exercises) + 1)]
    kinds = [exercise.kind for exercise in exercises]
    assert {*kinds} == {*defects.KINDS} == {*kinds[20:], "read"} and kinds[0] == "read"
    endings = [pathlib.Path(file).suffix for exercise in exercises for file in changed(exercise)]
    assert abs(endings.count(".py") - endings.count(".cpp") - endings.count(".cc")) <= 2
    assert {*endings} == {".py", ".cpp", ".cc", ".launch", ".txt", ".xml"}


def changed(defect):
    """Return the files that a defect changes."""
    return re.findall(r"^\+\+\+ b/(\S+)", defect.path.read_text(), re.MULTILINE)


@pytest.mark.parametrize("exercise", defects.exercises(), ids=lambda defect: defect.name)
def test_exercise_has_a_page_and_a_short_hint(exercise):
    assert (check_sets.TUTORIAL / "doc" / "pages" / f"{exercise.page}.rst").exists()
    assert exercise.task.startswith("# ")
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
      which goes on. Read more: `queues`.
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
            task="# A title\n\nA text,\n  which goes on. Read more: `queues`.",
            hint="Look\nat it.",
            learned="It works.",
        )
    ]


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("Breaks:", "Break:", "unexpected keyword argument 'break'"),
        ("Breaks: a colon\n", "", "missing 1 required positional argument: 'breaks'"),
        ("Tells:", "Tells: a\nTells:", "too many values"),
        ("Order: 3", "Order: third", "'third'"),
        ("Breaks: a", "a", "expected 'Field: value' or an indented line; found 'a colon'"),
    ],
)
def test_head_that_cannot_be_read_is_named(old, new, fault, tmp_path):
    assert old in HEAD
    write(tmp_path, HEAD.replace(old, new, 1))
    with pytest.raises(defects.DefectError, match=f"^some.patch: .*{fault}"):
        defects.read_all(tmp_path)


def test_folder_without_defects_is_an_error(tmp_path):
    with pytest.raises(defects.DefectError, match=r"^Expected patches in .*; there's none\.$"):
        defects.read_all(tmp_path)


OTHERS = check_sets.STYLES[1:]  # than the tutorial's

FIELDS = ("Base", "Without", "CRLF", "Spec", "Warns")


@pytest.mark.parametrize("style", OTHERS)
def test_style_makes_a_package(style, tmp_path):
    check_sets.lay_out(style, tmp_path)
    contract = spec.read(resources.folder("contracts") / check_sets.spec_of(style))
    expected = {"package", "launch"} if contract.launch.file else {"package"}
    xml = [path for path in tmp_path.rglob("*") if path.suffix in (".launch", ".xml")]
    assert {ElementTree.parse(path).getroot().tag for path in xml} >= expected


@pytest.mark.parametrize("style", OTHERS)
def test_head_of_a_style_names_what_is_there(style):
    fields = check_sets.fields_of(style)
    assert {*fields} <= {"SPDX-License-Identifier", "Style", *FIELDS}
    assert fields["Base"][0] in (*check_sets.STYLES, "nothing")
    assert (resources.folder("contracts") / check_sets.spec_of(style)).exists()
    assert [id_ for id_ in fields.get("Warns", []) if id_ not in REQUIREMENTS] == []
