# SPDX-License-Identifier: BSD-3-Clause
"""Marks a class: what a person sets is kept apart from what was measured."""

import csv
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
CONTRACT = spec.read(SPEC_FILE)


def written(folder, text, encoding="utf-8"):
    file = folder / "hand.csv"
    file.write_bytes(text.encode(encoding))
    return file


def test_a_person_s_marks_stand_apart_from_what_was_measured(tmp_path):
    for name in ("anna", "berta", "zoe"):
        hand_in(tmp_path / "class", name)
    room, most = Room(tmp_path / "class"), class_table.most(CONTRACT)
    file = written(tmp_path, BY_HAND.replace("berta", "\nberta"), "utf-8-sig")
    found = by_hand.read(file, [entry.name for entry in room.entries], most)
    results = room.check()
    for result in results:
        result.by_hand = found.get(result.name)
    rows = list(csv.DictReader(class_table.csv_text(results, CONTRACT).splitlines()))
    assert {row["submission"]: float(row["mark"]) for row in rows} == {
        "anna": 33.5,
        "berta": 30,
        "zoe": most - 2,
    }
    assert {float(row["points"]) for row in rows} == {most - 2}
    expected = ["33.5 (2 days late)", "30 (She showed it, in the lab.)", ""]
    assert [row["by_hand"] for row in rows] == expected
    page = Tags(class_table.html_text(results, CONTRACT, tmp_path))
    assert page.tags.count("td") == len(results) * (5 + len(ASKED))
    assert {*rows[1].values()} & {*page.texts} >= {rows[1]["by_hand"], "30"}
    text = class_table.text(results, CONTRACT)
    assert f"anna: mark 33.5 of {most}, by hand: 33.5 (2 days late)" in text
    assert "zoe: mark" not in text


HEAD = "student,points,reason\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (f"{HEAD}ana,3,x\n", r":2: there's no submission 'ana'\. Did you mean 'anna'\?"),
        (f"{HEAD}anna,3,x\n,3,x\n", r":3: there's no submission ''\."),
        (f"{HEAD}anna,3,x\nberta,3,x\nanna,3,x\n", r":4: 'anna' appears twice\."),
        (f"{HEAD}anna,two,x\n", r":2: points: expected a number .* found 'two'\."),
        (f"{HEAD}anna,nan,x\n", r":2: points: expected a number .* found 'nan'\."),
        (f"{HEAD}anna,41,x\n", r":2: points: expected a number from 0 to 40; found"),
        (f"{HEAD}\nanna,'7,x\n", r":3: points: .* found ''7'\."),
        (f"{HEAD}anna,3\n", r":2: points are set to 3, but no reason is given\."),
        (f"{HEAD}anna,3,a,b\n", r":2: expected 3 cells; found more\."),
        ("student;points\nanna;3\n", r":1: there's no column 'student;points'"),
        ("student,pionts\n", r":1: there's no column 'pionts'.* Did you mean 'points'\?"),
        ("points,reason\n3,x\n", r":1: expected the columns: .* 'student' is missing\."),
        (f'{HEAD}anna,3,"x\ny"\n"berta\n', r": below line 3, this isn't valid CSV"),
        (f"{HEAD}j\xfcrgen,3,x\n", r": expected UTF-8 text"),
        ("", r":1: expected the columns: student, points, reason"),
    ],
)
def test_a_line_that_cannot_be_used_is_an_error(tmp_path, text, says):
    file = written(tmp_path, text, "latin-1")
    with pytest.raises(errors.CannotCheck) as error:
        by_hand.read(file, ["anna", "berta"], 40)
    assert str(error.value).startswith(str(file))
    assert re.search(says, str(error.value)), error.value
    assert "\n" not in str(error.value)


def test_nothing_is_checked_before_the_file_can_be_used(tmp_path, monkeypatch, capsys):
    hand_in(tmp_path / "class", "anna")
    file = written(tmp_path, f"{HEAD}anna,1,\n")
    monkeypatch.setattr(classroom.Classroom, "check", lambda room: pytest.fail("it checks"))
    with pytest.raises(SystemExit) as end:
        check_command.main(["--class", str(tmp_path / "class"), "--by-hand", str(file)])
    assert end.value.code == 2
    assert f"{file}:2: points are set to 1, but no reason" in capsys.readouterr().err


def test_a_name_may_be_composed_in_two_ways(tmp_path):
    file = written(tmp_path, f"{HEAD}J\u00fcrgen,3,x\n")
    assert by_hand.read(file, ["Ju\u0308rgen"], 40)["Ju\u0308rgen"].points == 3
