# SPDX-License-Identifier: BSD-3-Clause
"""CONTRIBUTING.md: what it shows how to add works in a copy of the workspace, in so many files."""

import json
import re
import shutil
import subprocess
import sys

import make_map
import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

ROOT = WORKSPACE.parent
TEXT = (ROOT / ".github" / "CONTRIBUTING.md").read_text()

# The budget: files touched to add each.
FILES = {
    "A lab": 2,
    "An error text": 1,
    "An exercise": 1,
    "A rule of the checker": 3,
    "A section of a page": 2,
}

LAB = """
  new_lab:
    look: received
    sum up: It was received.
"""
ERROR_TEXT = """
[the-frobnicator-is-out-of-gas]
Shows: The frobnicator has run out of gas at the corner
Why: It was not filled.
Fix: Fill the frobnicator.
Try: false
"""
EXERCISE = """Order: 9999
Kind: fix
Task:
    # A description

    The description says nothing.

    Read more: `package`.
Hint: Look at the first lines.
Learned: A package says what it is for.
"""
DESCRIPTION = "Publishers and subscribers in C++ and Python: the tutorial's four nodes."
DEFECT = f"""Breaks: the description is the one of the template
Finds: described
In: package.xml: <description>
Tells: description
Severity: warning

--- a/package.xml
+++ b/package.xml
@@ -6 +6 @@
-  <description>{DESCRIPTION}</description>
+  <description>The mrp package</description>
"""


def test_each_section_says_how_many_files_it_takes():
    titles = re.findall(r"^## (.*)$", TEXT, re.MULTILINE)
    assert titles == ["Where things are", "Commands", *FILES]
    for title, text in zip(titles, re.split(r"^## .*$", TEXT, flags=re.MULTILINE)[1:]):
        assert len(re.findall(r"^\d\. ", text, re.MULTILINE)) == FILES.get(title, 0), title


@pytest.mark.parametrize("path", sorted(set(re.findall(r"`(catkin_ws/[\w./]+)`", TEXT))))
def test_path_exists(path):
    """NAME and PAGE stand for new ones: others have such a place already."""
    name = {".patch": "latched", ".py": "manifest"}.get(path[path.rfind(".") :], "latch")
    assert (ROOT / path.replace("NAME", name).replace("PAGE", "latch")).exists()


def test_map_has_every_package_and_every_folder_of_the_checker():
    drawn = set(re.findall(r"\w+", make_map.PICTURE.search(TEXT).group()))
    packages = {path.parent.name for path in WORKSPACE.glob("src/*/package.xml")}
    assert packages | set(make_map.imports()) <= drawn


@pytest.fixture
def copy(tmp_path):
    """The checker, the labs, the tutorial and the tools in a folder of their own."""
    ignore = shutil.ignore_patterns("__pycache__", "pages", "recorded", "test")
    for folder in ("src/mrp", "src/mrp_check", "src/mrp_labs", "tools"):
        shutil.copytree(WORKSPACE / folder, tmp_path / "catkin_ws" / folder, ignore=ignore)
    return tmp_path / "catkin_ws"


def append(path, text):
    path.write_text(path.read_text() + text)


def run(*command):
    """Run a Python program without ROS; return its Popen, which has ended."""
    return subprocess.run([sys.executable, *command], capture_output=True, text=True)


def test_a_new_lab_is_in_the_list(copy):
    labs = copy / "src" / "mrp_labs"
    (labs / "launch" / "new_lab.launch").write_text("<!-- It is new. -->\n<launch/>\n")
    append(labs / "labs.yaml", LAB)
    printed = run(copy / "tools" / "lab.py", "--list", "--all").stdout
    assert printed.endswith("  It is new.\n    make lab NAME=new_lab\n\n")


def test_a_new_error_text_is_found(copy):
    append(copy / "src" / "mrp" / "doc" / "why" / "topics.txt", ERROR_TEXT)
    found = run(copy / "tools" / "why.py", "frobnicator: The frobnicator has run out of gas")
    assert "Fill the frobnicator." in found.stdout


def test_a_new_exercise_is_the_last_one(copy):
    checker = copy / "src" / "mrp_check"
    (checker / "defects" / "not_described.patch").write_text(EXERCISE + DEFECT)
    program = "from mrp_check.contract import defects; print(defects.exercises()[-1].name)"
    found = subprocess.run(
        [sys.executable, "-c", program], cwd=checker / "src", capture_output=True, text=True
    )
    assert found.stdout == "not_described\n", found.stderr
    section = TEXT[TEXT.index("## An exercise") : TEXT.index("## A rule")]
    assert {*re.findall(r"^\w+(?=:)", EXERCISE, re.MULTILINE)} <= {*re.findall(r"`(\w+)`", section)}


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
    rules = copy / "src" / "mrp_check" / "src" / "mrp_check" / "rules"
    shutil.copy(WORKSPACE / "tests" / "described_rule.py", rules / "files" / "described.py")
    text = (rules / "__init__.py").read_text()
    assert text.count("    manifest,\n") == 2
    text = text.replace("    manifest,\n", "    manifest,\n    described,\n")
    (rules / "__init__.py").write_text(text)
    assert check(copy) == []
    done = subprocess.run(
        ["patch", "-p1", "--fuzz=0", "--silent"], input=DEFECT, cwd=copy / "src" / "mrp", text=True
    )
    assert done.returncode == 0
    (found,) = check(copy)
    assert (found["id"], found["file"], found["line"]) == ("described", "package.xml", 6)
    assert "description" in found["message"]
