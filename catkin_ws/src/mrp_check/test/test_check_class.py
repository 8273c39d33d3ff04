# SPDX-License-Identifier: BSD-3-Clause
"""Checks a class at once: one table, and a broken submission never stops the rest."""

import csv
import dataclasses
import os
import pathlib

import pytest
from check_rules import ASKED, Tags, hand_in
from mrp_check.classroom import class_table, classroom
from mrp_check.contract import errors, spec
from mrp_check.contract.verdict import unchecked
from mrp_check.package import package
from mrp_check.report import json_
from mrp_check.verdict import check

pytestmark = pytest.mark.quick

SPEC_FILE = spec.find("pub_sub")


class Room(classroom.Classroom):
    """A classroom in which a check is no more than a report."""

    def __init__(self, folder, **options):
        self.said, self.checked = [], []
        options = {"progress": lambda *line: self.said.append(line), **options}
        super().__init__(folder, SPEC_FILE, **options)

    def report_of(self, pkg, name):
        self.checked.append(name)
        finding = {
            "id": "values",
            "severity": "error",
            "file": "src/a.py",
            "line": 3,
            "message": "publishes <2>",
            "consequence_of": None,
        }
        verdicts = {id_: check.MET for id_ in ASKED}
        return {
            "verdict": check.FINDINGS,
            "package": "student_pkg",
            "spec": "s",
            "requirements": {**verdicts, "values": check.BROKEN, "rate": check.UNCHECKED},
            "findings": [finding],
        }

    def verdicts(self):
        return {result.name: result.report["verdict"] for result in self.check()}

    def reason(self, name):
        return {result.name: result.report.get("reason") for result in self.check()}[name]


def test_a_package_is_no_class(tmp_path):
    (tmp_path / "package.xml").touch()
    with pytest.raises(errors.PackageError, match="is a package: expected the folder above it"):
        Room(tmp_path)


def test_no_submission(tmp_path):
    (tmp_path / ".DS_Store").touch()
    with pytest.raises(errors.PackageError, match="one archive, for each student"):
        Room(tmp_path)


def test_each_folder_is_a_submission(tmp_path):
    hand_in(tmp_path / "class", "berta")
    hand_in(tmp_path / "class", "anna")
    room = Room(tmp_path / "class")
    assert room.verdicts() == {"anna": check.FINDINGS, "berta": check.FINDINGS}
    (_, *begun), *ended = room.said
    assert sorted(line for line, _, _ in ended) == [
        "anna: findings",
        "berta: findings",
    ]
    assert [begun, *(part for _, *part in ended)] == [[0, 2], [1, 2], [2, 2]]


def test_links_within_a_submission_lead_nowhere(tmp_path):
    """What a link in a submission leads to is neither read nor copied."""
    made = hand_in(tmp_path / "class", "anna")
    (tmp_path / "secret").write_text("secret")
    (made / "link").symlink_to(tmp_path / "secret")
    os.mkfifo(made / "pipe")
    assert package.Package(made).files == ["CMakeLists.txt", "package.xml"]


def test_what_has_not_changed_is_not_checked_again(tmp_path):
    made = hand_in(tmp_path / "class", "anna")
    hand_in(tmp_path / "class", "berta")
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "class").rglob("*")}
    assert sorted(run_of(tmp_path)) == ["anna", "berta"]
    assert any((tmp_path / "class.checked").iterdir())
    assert run_of(tmp_path) == []
    assert before == {path: path.stat().st_mtime_ns for path in (tmp_path / "class").rglob("*")}

    (made / "CMakeLists.txt").write_text("# another\n")
    assert run_of(tmp_path) == ["anna"]
    (made / "CMakeLists.txt").chmod(0o755)
    assert run_of(tmp_path) == ["anna"]
    (made / "new.py").touch()
    assert run_of(tmp_path) == ["anna"]
    assert run_of(tmp_path) == []


def run_of(tmp_path):
    room = Room(tmp_path / "class")
    assert {result.report["verdict"] for result in room.check()} == {check.FINDINGS}
    return room.checked


@pytest.mark.parametrize(
    ("old", "new", "checked"),
    [
        ("nodes:", "# a comment\nnodes:", []),
        ("nodes:", "points: {wrap: 0}\nhidden: [spin]\nnodes:", []),
        ("queue: 10", "queue: 11", ["anna"]),
    ],
)
def test_only_another_contract_is_another_check(tmp_path, old, new, checked):
    hand_in(tmp_path / "class", "anna")
    own = tmp_path / "own.yaml"
    own.write_text(pathlib.Path(SPEC_FILE).read_text())
    room = Room(tmp_path / "class")
    room.spec_file = own
    room.check()
    own.write_text(own.read_text().replace(old, new))
    again = Room(tmp_path / "class")
    again.spec_file = own
    again.check()
    assert (room.checked, again.checked) == (["anna"], checked)


def test_what_could_not_be_checked_is_checked_again(tmp_path, monkeypatch):
    hand_in(tmp_path / "class", "anna")
    report = json_.data(unchecked("no master"))
    monkeypatch.setattr(Room, "report_of", lambda self, *_: report)
    assert Room(tmp_path / "class").verdicts() == {"anna": check.UNCHECKED}
    monkeypatch.undo()
    assert Room(tmp_path / "class").verdicts() == {"anna": check.FINDINGS}


def test_an_error_of_the_checker_is_one_submission_s(tmp_path, monkeypatch):
    hand_in(tmp_path / "class", "anna")
    hand_in(tmp_path / "class", "berta")
    original = Room.report_of

    def fail(self, folder, name):
        if name == "anna":
            raise ZeroDivisionError("in the checker")
        return original(self, folder, name)

    monkeypatch.setattr(Room, "report_of", fail)
    room = Room(tmp_path / "class")
    assert room.verdicts() == {"anna": check.UNCHECKED, "berta": check.FINDINGS}
    assert room.reason("anna") == "ZeroDivisionError: in the checker"


@pytest.fixture
def results(tmp_path):
    """The submissions of a class with a formula, and one with a tag, for a name."""
    for name in ("=1+1", "<b>anna"):
        hand_in(tmp_path / "class", name)
    (tmp_path / "class" / "empty").mkdir()
    return Room(tmp_path / "class").check()


def test_points_come_from_the_spec(results):
    contract = spec.read(SPEC_FILE)
    all_ids = len(ASKED)
    of_spec = dataclasses.replace(contract, points={"values": 5, "topic": 2.5})
    by_name = {result.name: result for result in results}
    assert class_table.most(contract) == all_ids
    assert class_table.most(of_spec) == all_ids + 4 + 1.5
    assert by_name["<b>anna"].points(contract) == all_ids - 2
    assert by_name["<b>anna"].points(of_spec) == all_ids - 2 + 1.5
    assert by_name["empty"].points(contract) == 0


def test_what_is_not_asked_earns_no_points_and_has_no_column(results, tmp_path):
    contract = spec.read(SPEC_FILE)
    less = dataclasses.replace(contract, launch=spec.LaunchSpec(), not_asked=("wrap",))
    asked = [id_ for id_ in ASKED if id_ != "wrap" and not id_.startswith("launch-")]
    assert class_table.most(less) == len(asked) < class_table.most(contract) - 3
    (header, *_) = csv.reader(class_table.csv_text(results, less).splitlines())
    assert header[7:-2] == asked
    page = Tags(class_table.html_text(results, less, tmp_path))
    assert page.tags.count("td") == len(results) * (3 + len(asked))


def test_csv(results):
    rows = list(csv.DictReader(class_table.csv_text(results, spec.read(SPEC_FILE)).splitlines()))
    assert [row["submission"] for row in rows] == ["<b>anna", "'=1+1", "empty"]
    anna, _, empty = rows
    assert (anna["values"], anna["rate"], anna["topic"]) == ("broken", "unchecked", "met")
    assert anna["why"] == "src/a.py:3: publishes <2>"
    assert int(anna["points"]) == int(anna["of"]) - 2
    assert (empty["verdict"], empty["points"], empty["topic"]) == ("unchecked", "0", "unchecked")
    assert "no package.xml" in empty["why"]


def test_html(results, tmp_path):
    page = Tags(class_table.html_text(results, spec.read(SPEC_FILE), tmp_path))
    assert page.tags.count("tr") == 1 + len(results)
    assert page.tags.count("td") == len(results) * (3 + len(ASKED))
    assert "b" not in page.tags
    assert "<b>anna" in page.texts
    assert "src/a.py:3: publishes <2>" in page.texts
    assert page.texts.count("✗") == 2
    assert page.texts.count("2 of 3") == 1
    assert [id_ for id_, _ in class_table.broken_in(results)] == ["values"]
    assert ASKED["values"].title in map(str.strip, page.texts)
