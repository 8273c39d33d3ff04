# SPDX-License-Identifier: BSD-3-Clause
"""What class_scale.py makes a class of, and what it has recorded."""

import csv
import re

import class_scale
import pytest
from mrp_check.contract import packages
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

RECORDED = WORKSPACE / "src" / "mrp" / "doc" / "recorded" / "class_scale.csv"


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_class_has_correct_packages_and_broken_ones(tmp_path, monkeypatch):
    """And a smaller class is the beginning of a larger one."""
    laid_out, broken = [], []
    lay_out, break_ = packages.lay_out, packages.break_
    monkeypatch.setattr(packages, "lay_out", lambda *a: [laid_out.append(a[1].name), lay_out(*a)])
    monkeypatch.setattr(packages, "break_", lambda *a: [broken.append(a[0].name), break_(*a)])
    class_scale.make_class(tmp_path / "large", 5)
    laid_out = [*dict.fromkeys(laid_out)]  # each base is laid out, too
    assert (laid_out, broken) == ([f"0000{n}" for n in range(5)], ["00001", "00002", "00004"])
    class_scale.make_class(tmp_path / "small", 3)
    for name in laid_out[:3]:
        assert contents(tmp_path / "small" / name) == contents(tmp_path / "large" / name)
    assert contents(tmp_path / "large" / "00001") != contents(tmp_path / "large" / "00002")


def test_recorded_marks_are_the_same():
    rows = list(csv.DictReader(RECORDED.read_text().splitlines()))
    assert [row["workers"] for row in rows] == ["1", "2", "4"]
    assert {row["marks"] for row in rows} == {"the same"}
    assert rows[0]["efficiency"] == "1.00"


def test_memory_is_not_what_is_short_first():
    for row in csv.DictReader(RECORDED.read_text().splitlines()):
        then = [float(value) for name, value in row.items() if re.match("MB of .* then", name)]
        assert len(then) == 2 and max(then) < 1000
        assert float(row["processor hours then"]) > 20


def test_line_through_what_was_seen_leads_to_ten_thousand():
    assert class_scale.at_many([(1, 12.0), (2, 14.0), (3, 16.0)]) == pytest.approx(20_010)
