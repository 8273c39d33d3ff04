# SPDX-License-Identifier: BSD-3-Clause
"""CONTRIBUTING.md: its examples work in a copy of the workspace, in as many files as it says."""

import json
import re
import shutil
import subprocess
import sys

import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

ROOT = WORKSPACE.parent
TEXT = (ROOT / ".github" / "CONTRIBUTING.md").read_text()

# The budget: files touched to add each.
FILES = {
    "A rule of the checker": 3,
    "An exercise": 1,
    "A lab": 3,
    "A sentence of a page": 1,
    "A case of the benchmark": 3,
}


def section(title):
    return re.search(rf"^## {title}\n(.*?)(?=^## |\Z)", TEXT, re.MULTILINE | re.DOTALL).group(1)


def examples(text):
    """Return path -> content of the files whose content is shown."""
    return dict(re.findall(r"^`(\S+)`:\n\n```\w+\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))


@pytest.mark.parametrize("title", FILES)
def test_number_of_files(title):
    assert len(re.findall(r"^\d\. ", section(title), re.MULTILINE)) == FILES[title]


def test_every_way_is_held():
    about_all = ["Where things are", "Commands"]
    assert re.findall(r"^## (.*)$", TEXT, re.MULTILINE) == [*about_all, *FILES]


@pytest.fixture
def copy(tmp_path):
    """The checker and the tutorial in a folder of their own, with the example."""
    ignore = shutil.ignore_patterns("__pycache__", "doc", "test")
    for folder in ("src/mrp_check", "src/mrp"):
        shutil.copytree(WORKSPACE / folder, tmp_path / "catkin_ws" / folder, ignore=ignore)
    for path, content in examples(section("A rule of the checker")).items():
        assert not (tmp_path / path).exists(), path
        (tmp_path / path).write_text(content)
    rules = tmp_path / "catkin_ws" / "src" / "mrp_check" / "src" / "mrp_check" / "rules"
    text = (rules / "__init__.py").read_text()
    assert text.count("    definitions,\n") == 2
    text = text.replace("    definitions,\n", "    definitions,\n    described,\n")
    (rules / "__init__.py").write_text(text)
    return tmp_path / "catkin_ws"


def check(copy):
    """Return the findings of the new rule about the tutorial in the copy."""
    report = copy / "report.json"
    subprocess.run(
        [
            *(sys.executable, copy / "src" / "mrp_check" / "scripts" / "check"),
            *(copy / "src" / "mrp", "--only", "described", "--json", report),
        ],
        env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(copy / "src" / "mrp_check" / "src")},
        check=False,
        stdout=subprocess.DEVNULL,
    )
    return json.loads(report.read_text())["findings"]


def test_a_new_rule_finds_its_defect_and_nothing_else(copy):
    assert check(copy) == []
    patch = copy / "src" / "mrp_check" / "defects" / "manifest_not_described.patch"
    fields = dict(re.findall(r"^(\w+): (.*)$", patch.read_text(), re.MULTILINE))
    subprocess.run(
        ["patch", "-p1", "--fuzz=0", "--silent", f"--input={patch}"],
        cwd=copy / "src" / "mrp",
        check=True,
    )
    (found,) = check(copy)
    file, pattern = fields["In"].split(": ")
    line = (copy / "src" / "mrp" / file).read_text().splitlines()[found["line"] - 1]
    assert (found["id"], found["file"]) == (fields["Finds"], file)
    assert re.search(pattern, line) and re.search(fields["Tells"], found["message"])


@pytest.mark.parametrize("path", re.findall(r"`(catkin_ws/[\w./]+)`", TEXT))
def test_path_exists(path):
    """NAME stands for a new one: the model in the text has it already."""
    for name, model in (("NAME", "latch"), ("PAGE", "latch")):
        path = path.replace(name, model)
    assert (ROOT / path).exists() or path in examples(TEXT)
