# SPDX-License-Identifier: BSD-3-Clause
"""Each test has one kind, which says when it is run; a test with none or two fails the run."""

import shutil
import subprocess

import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

SLOW = "import pytest\n\npytestmark = pytest.mark.slow\n\n\ndef test_of_the_file():\n    pass\n"
QUICK = "\n\n@pytest.mark.quick\ndef test_of_its_own():\n    pass\n"


def run(folder, text, *options, mode=0o644):
    """Run pytest on a file of tests, with the conftest of these tests; return what it printed."""
    tests = folder / "tests"
    tests.mkdir()
    for name in ("conftest.py", "pyproject.toml"):
        shutil.copy(WORKSPACE / name, tests)
    (tests / "test_one.py").write_text(text)
    (tests / "test_one.py").chmod(mode)
    return subprocess.run(
        ["/usr/bin/python3", "-m", "pytest", "-p", "no:cacheprovider", "-v", *options, str(tests)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


@pytest.mark.parametrize(("kind", "name"), [("slow", "of_the_file"), ("quick", "of_its_own")])
def test_the_mark_of_a_test_wins_over_that_of_its_file(tmp_path, kind, name):
    done = run(tmp_path, SLOW + QUICK, "-m", kind)
    assert done.returncode == 0, done.stdout
    assert f"test_{name} PASSED" in done.stdout
    assert "1 passed, 1 deselected" in done.stdout


NONE = "def test_one():\n    pass\n"
TWO = SLOW + QUICK.replace("@pytest", "@pytest.mark.sets\n@pytest")
TWO_OF_THE_FILE = SLOW.replace("pytest.mark.slow", "[pytest.mark.slow, pytest.mark.quick]")


@pytest.mark.parametrize(
    ("text", "kind"),
    [(NONE, "quick"), (TWO, "slow"), (TWO_OF_THE_FILE, "sets")],
    ids=["none", "two", "two_of_the_file"],
)
def test_a_test_with_none_or_two_is_an_error_of_every_run(tmp_path, text, kind):
    done = run(tmp_path, text, "-m", kind)
    assert done.returncode == 1, done.stdout
    assert "expected one mark of quick, slow, sets; found none or more" in done.stdout
    assert "1 error" in done.stdout


def test_a_mark_that_is_misspelt_is_an_error(tmp_path):
    done = run(tmp_path, SLOW + QUICK.replace("quick", "quikc"), "-m", "slow")
    assert done.returncode != 0, done.stdout
    assert "'quikc' not found in `markers`" in done.stdout


def test_what_rostest_runs_is_left_to_it(tmp_path):
    done = run(tmp_path, SLOW, "-m", "slow", mode=0o755)
    assert "collected 0 items" in done.stdout
