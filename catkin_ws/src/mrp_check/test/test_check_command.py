# SPDX-License-Identifier: BSD-3-Clause
"""Runs the command `check`: its exit codes and messages."""

import json
import os
import shutil
import subprocess

import pytest
from mrp_testing import scratch
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

CHECK = WORKSPACE / "src" / "mrp_check" / "scripts" / "check"
HERE = WORKSPACE / "src" / "mrp_check" / "test"


def run(*arguments, cwd=None, program=CHECK, **variables):
    env = {**scratch.environment(), "PYTHONPATH": str(CHECK.parents[1] / "src"), **variables}
    return subprocess.run(
        ["/usr/bin/python3", str(program), *map(str, arguments)],
        env={**env, "PYTHONDONTWRITEBYTECODE": "1"},
        cwd=cwd,
        capture_output=True,
        text=True,
    )


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["no_such_folder"], "check: There's no folder no_such_folder.\n"),
        ([f"{HERE}s"], f"check: There's no folder {HERE}s. Did you mean test?\n"),
        ([os.devnull], "check: /dev/null isn't a folder; expected the folder of a package.\n"),
        ([".", "--spec", "none.yaml"], "check: none.yaml: the contract can't be read: No such"),
        ([".", "--spec", __file__], f"check: {__file__}:"),
    ],
    ids=range(5),
)
def test_what_cannot_be_checked_is_exit_code_2(arguments, says):
    done = run(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(says)
    assert done.stderr.count("\n") == 1


def test_folder_without_manifest_names_the_packages_in_it(tmp_path):
    for name in ("a", "b"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text("<package/>")
    reports = {
        f"--{kind}": tmp_path / f"report.{kind}" for kind in ("json", "junit", "sarif", "html")
    }
    done = run("--github", tmp_path, *(word for option in reports.items() for word in option))
    assert done.returncode == 2
    assert all(path.read_text() for path in reports.values())
    assert f"Did you mean {tmp_path}/src/a or {tmp_path}/src/b?" in done.stderr
    assert done.stdout.startswith("::error title=mrp_check::") and "/src/b?" in done.stdout
    data = json.loads((tmp_path / "report.json").read_text())
    assert (data["verdict"], data["findings"]) == ("unchecked", [])


def test_a_package_without_the_contracts_nodes_may_need_no_contract(tmp_path):
    manifest = (WORKSPACE / "src" / "mrp" / "package.xml").read_text()
    (tmp_path / "package.xml").write_text(manifest.replace("<name>mrp<", "<name>laser_filter<"))
    other = run(tmp_path, "--only", "manifest")
    last = other.stderr.splitlines()[-1]
    assert last.startswith("check: laser_filter has none of the contract's nodes. If it's a")
    assert "contract's nodes" not in run(WORKSPACE / "src" / "mrp", "--only", "manifest").stderr


def test_mrp_check_finds_the_package_and_static_only_reads(tmp_path):
    package = shutil.copytree(WORKSPACE / "src" / "mrp", tmp_path / "src" / "mrp")
    node = package / "src" / "publisher_py_node.py"
    node.write_text(node.read_text().replace("def main(", "def main" + 9000 * "x"))
    (package / "launch" / "large.launch").write_text(f"<launch><!-- {1_000_000 * 'x'} --></launch>")
    report = tmp_path / "report.json"
    asked = (tmp_path, "--static", "--json", report)
    done = run(*asked, program=CHECK.with_name("mrp-check"))
    data = json.loads(report.read_text())
    found = [(f["id"], f["file"]) for f in data["findings"] if f["severity"] == "error"]
    assert found == [("python-syntax", "src/publisher_py_node.py")], done.stdout
    assert any("more than 1 MB: launch/large.launch" in f["message"] for f in data["findings"])
    assert len(done.stdout) < 9000
    assert not {"compile", "values"} & {*data["requirements"]}
    assert done.returncode == 1 and "The package ran" not in data["isolation"]
    assert "reading the sources" in done.stderr and "at the build" not in done.stderr


def test_a_contract_replaces_no_file(tmp_path):
    contract = tmp_path / "mrp.yaml"
    contract.write_text("mine")
    done = run("--write-contract", WORKSPACE / "src" / "mrp", cwd=tmp_path)
    assert (done.returncode, done.stdout, contract.read_text()) == (2, "", "mine")
    assert done.stderr == (
        "check: mrp.yaml already exists: rename it, or call check in another folder.\n"
    )


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--class", "/no/such/folder"), "There's no folder /no/such/folder"),
        (("--class", "/", "--json", "x"), "--json goes without --class"),
        (("/", "--csv", "x"), "--csv goes with --class"),
        (("--class", "/", "--spec", ""), "--class needs a contract"),
        ((".", "--only", "valuse"), "valuse"),
        ((".", "--any", "--gradescope", "x"), "--gradescope needs the points of a contract"),
    ],
    ids=range(6),
)
def test_a_wrong_option_is_exit_code_2(arguments, expected):
    done = run(*arguments)
    assert done.returncode == 2
    assert expected in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ("", "check '' --any --junit '/results/a/mrp_check.xml'"),
        ("SPEC relay", "check '' --spec 'relay' --junit '/results/a/mrp_check.xml'"),
        ("relay", "takes SPEC alone; found: relay"),
    ],
)
def test_the_macro_s_contract_is_the_command_s(arguments, expected, tmp_path):
    """In a catkin that does no more than print."""
    (tmp_path / "a.cmake").write_text(
        "set(CATKIN_TEST_RESULTS_DIR /results)\nset(PROJECT_NAME a)\n"
        'function(catkin_run_tests_target)\n  message("${ARGN}")\nendfunction()\n'
        f'include("{CHECK.parents[1]}/cmake/mrp_check-extras.cmake")\n'
        f"mrp_check_add_test({arguments})\n"
    )
    done = subprocess.run(["cmake", "-P", tmp_path / "a.cmake"], capture_output=True, text=True)
    assert expected in done.stderr.replace("\n", " ")
