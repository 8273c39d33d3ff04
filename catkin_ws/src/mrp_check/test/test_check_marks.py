# SPDX-License-Identifier: BSD-3-Clause
"""Marks a class: what a person sets is kept apart from what was measured."""

import csv
import dataclasses
import pathlib
import re

import pytest
from check_rules import ASKED, Tags, hand_in
from mrp_check.classroom import by_hand, class_table, classroom
from mrp_check.cli import check as check_command
from mrp_check.contract import errors, spec
from test_check_class import SPEC_FILE, Room

pytestmark = pytest.mark.quick


# The page shows it.
BY_HAND = pathlib.Path(__file__).with_name("by_hand.csv").read_text()
LATE = dataclasses.replace(spec.read(SPEC_FILE), late=spec.Late(points=2))


def written(folder, text, encoding="utf-8"):
    file = folder / "hand.csv"
    file.write_bytes(text.encode(encoding))
    return file


def test_a_person_s_marks_stand_apart_from_what_was_measured(tmp_path):
    for name in ("anna", "berta", "carl", "dora", "zoe"):
        hand_in(tmp_path / "class", name)
    room, most = Room(tmp_path / "class"), class_table.most(LATE)
    file = written(tmp_path, BY_HAND.replace("carl", "\ncarl"), "utf-8-sig")
    found = by_hand.read(file, [entry.name for entry in room.entries], most, LATE.late)
    results = room.check()
    for one in results:
        one.by_hand = found.get(one.name, one.by_hand)
    measured = most - 2
    marks = {"anna": measured - 4, "berta": 30, "carl": 20, "dora": 0, "zoe": measured}
    rows = list(csv.DictReader(class_table.csv_text(results, LATE).splitlines()))
    assert {row["submission"]: float(row["mark"]) for row in rows} == marks
    assert {float(row["points"]) for row in rows} == {measured}
    assert [row["by_hand"] for row in rows] == [
        "2 days late: -4",
        "points set to 35.5; 1 day late: -2; at most 30 (B. Roe: She showed it, in the lab.)",
        "at most 20",
        "30 days late: -60",
        "",
    ]
    page = Tags(class_table.html_text(results, LATE, tmp_path))
    assert page.tags.count("td") == len(results) * (5 + len(ASKED))
    assert {*rows[1].values()} & {*page.texts} >= {rows[1]["by_hand"], "30"}
    said = class_table.text(results, LATE)
    assert f"anna: mark {marks['anna']} of {most}, by hand: 2 days late: -4" in said
    assert "zoe: mark" not in said


def test_late_days_take_points_or_percent():
    assert spec.Late(points=1.5).off(2, 40) == 3
    assert spec.Late(percent=10).off(2, 40) == 8


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("student\nanna\nana\n", r":3: there's no submission 'ana'\. Did you mean 'anna'\?"),
        ("student,by\nanna,\n,B. Roe\n", r":3: there's no submission ''\."),
        ("student\nanna\nberta\nanna\n", r":4: 'anna' appears twice\."),
        ("student,late_days\nanna,two\n", r":2: late_days: expected a number .* found 'two'\."),
        ("student,late_days\nanna,0.5\n", r":2: late_days: expected whole days; found 0\.5\."),
        ("student,maximum\nanna,nan\n", r":2: maximum: expected a number .* found 'nan'\."),
        ("student,maximum\nanna,41\n", r":2: maximum: expected a number from 0 to 40; found"),
        ("student,override\nanna,3\n", r":2: override is 3, but no reason is given\."),
        ("student,override,reason\n\nanna,'7,x\n", r":3: override: .* found ''7'\."),
        ("student,reason\nanna,a,b\n", r":2: expected 2 cells; found more\."),
        ("student;maximum\nanna;3\n", r":1: there's no column 'student;maximum'"),
        ("student,maximun\n", r":1: there's no column 'maximun'.* Did you mean 'maximum'\?"),
        ("by\nanna\n", r":1: expected the columns: .* 'student' is missing\."),
        ('student,reason\nanna,"x\ny"\n"berta\n', r": below line 3, this isn't valid CSV"),
        ("student\nj\xfcrgen\n", r": expected UTF-8 text"),
        ("", r":1: expected the columns: student, late_days"),
    ],
)
def test_a_line_that_cannot_be_used_is_an_error(tmp_path, text, says):
    file = written(tmp_path, text, "latin-1")
    with pytest.raises(errors.CannotCheck) as error:
        by_hand.read(file, ["anna", "berta"], 40, spec.Late(percent=10))
    assert str(error.value).startswith(str(file))
    assert re.search(says, str(error.value)), error.value
    assert "\n" not in str(error.value)


def test_nothing_is_checked_before_the_file_can_be_used(tmp_path, monkeypatch, capsys):
    hand_in(tmp_path / "class", "anna")
    file = written(tmp_path, "student,late_days\nanna,1\n")
    monkeypatch.setattr(classroom.Classroom, "check", lambda room: pytest.fail("it checks"))
    with pytest.raises(SystemExit) as end:
        check_command.main(["--class", str(tmp_path / "class"), "--by-hand", str(file)])
    assert end.value.code == 2
    assert f"{file}:2: late_days is 1, but the contract doesn't say" in capsys.readouterr().err


def test_a_name_may_be_composed_in_two_ways(tmp_path):
    file = written(tmp_path, "student,maximum\nJ\u00fcrgen,3\n")
    assert by_hand.read(file, ["Ju\u0308rgen"], 40, None)["Ju\u0308rgen"].maximum == 3
