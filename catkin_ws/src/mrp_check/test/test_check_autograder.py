# SPDX-License-Identifier: BSD-3-Clause
"""Unpacks and runs autograder.zip as Gradescope does, without the rest of the workspace.

https://gradescope-autograders.readthedocs.io/en/latest/specs/#file-hierarchy
"""

import json
import shutil
import subprocess
import zipfile

import pytest
from check_rules import ASKED
from mrp_check.contract import spec
from mrp_testing.workspace import WORKSPACE

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("open_folders")]

MAKE = WORKSPACE / "tools" / "make_autograder.py"
HIDDEN = ["values", "wrap"]


@pytest.fixture
def autograder(tmp_path):
    """The folder /autograder, set up, with a contract that hides two requirements."""
    contract = tmp_path / "contract.yaml"
    contract.write_text(spec.find("pub_sub").read_text() + f"\nhidden: {HIDDEN}\n")
    made = subprocess.run([MAKE, tmp_path / "autograder.zip", contract], check=True, text=True)
    assert made.stdout is None
    folder = tmp_path / "autograder"
    for name in ("source", "submission", "results"):
        (folder / name).mkdir(parents=True)
    with zipfile.ZipFile(tmp_path / "autograder.zip") as archive:
        archive.extractall(folder / "source")  # which makes none of them executable
    shutil.copy(folder / "source" / "run_autograder", folder)
    run("bash", folder / "source" / "setup.sh", folder=folder / "source")
    return folder


def run(*command, folder):
    subprocess.run(command, cwd=folder, env={"PATH": "/usr/bin:/bin:/usr/sbin:/sbin"}, check=True)


def results(folder):
    run("bash", folder / "run_autograder", folder=folder)
    return json.loads((folder / "results" / "results.json").read_text())


def test_it_marks_a_package_that_meets_the_contract(autograder):
    shutil.copytree(WORKSPACE / "src" / "mrp", autograder / "submission" / "my work" / "mrp")
    found = results(autograder)
    tests = {test["name"].rpartition("(")[2][:-1]: test for test in found["tests"]}
    assert list(tests) == [*ASKED]
    assert [id_ for id_, test in tests.items() if test["score"] != test["max_score"]] == [], found
    assert {id_ for id_, test in tests.items() if test["visibility"] == "hidden"} == {*HIDDEN}
    count = len(ASKED) - len(HIDDEN)
    verdict = f"All public requirements are met: {count} of {count}."
    assert found["output"].splitlines()[0] == verdict


def test_a_checker_that_is_killed_leaves_a_score_of_0(autograder):
    killed = "import os\nos.kill(os.getpid(), 9)\n"
    (autograder / "source" / "mrp_check" / "scripts" / "check").write_text(killed)
    assert results(autograder) == {"score": 0, "output": "The check was stopped before its end."}


def test_a_contract_that_is_not_there_is_said(tmp_path):
    command = [MAKE, tmp_path / "autograder.zip", tmp_path / "none.yaml"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"error: expected the file of a contract; there is no file {command[2]}\n"
