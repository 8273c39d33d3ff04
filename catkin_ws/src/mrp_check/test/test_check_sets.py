# SPDX-License-Identifier: BSD-3-Clause
"""Checks packages whose defect is known (check_sets.py says where they are).

Each correct package must meet its contract, whatever its style. In each broken one, the checker
must find the one defect, at its place, and nothing else but its consequences.
"""

import json
import os
import subprocess

import check_sets
import pytest
from check_sets import shown
from mrp_check.contract import defects, spec
from mrp_testing import compiler_cache, scratch

pytestmark = pytest.mark.sets

# The checker's central tests, which `make test` runs: the tutorial, and one defect in it.
# One worker of pytest runs both: what is compiled for the first need not be for the second.
CENTRAL = ("mrp", "py_member_misspelt")


def parameters(values, name):
    """Return the values for parametrize; those whose name is in CENTRAL are marked."""
    marks = [pytest.mark.quick, pytest.mark.place, pytest.mark.xdist_group("central")]
    return [pytest.param(value, marks=marks if name(value) in CENTRAL else []) for value in values]


CHECK = check_sets.HERE.parent / "src" / "mrp_check"
EXERCISES = defects.exercises()


def called(folder, *options, cwd=None):
    """Call check about the package at a folder; return what came of it."""
    env = scratch.environment()
    env.update(
        PYTHONPATH=str(CHECK / "src"),
        PYTHONDONTWRITEBYTECODE="1",
        # Only what a style or a defect changes is compiled anew.
        PATH=f"/usr/lib/ccache:{os.environ['PATH']}",
        MRP_CHECK_CCACHE=str(compiler_cache.FOLDER.with_name("ccache_of_checks")),
    )
    command = ["/usr/bin/python3", CHECK / "scripts" / "check", folder, "--timeout", "900"]
    return subprocess.run(
        [*command, *options],
        env=env,
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


@pytest.fixture
def run_check(tmp_path):
    """Return a function that checks the package at a folder, and returns the report's data."""

    def run(folder, spec, *options):
        report = tmp_path / "report.json"
        done = called(folder, "--spec", CHECK / "contracts" / spec, "--json", report, *options)
        assert report.exists(), done.stdout
        data = json.loads(report.read_text())
        assert done.returncode == {"met": 0, "findings": 1}[data["verdict"]], done.stdout
        return data

    return run


@pytest.mark.parametrize("style", parameters(check_sets.STYLES, str))
def test_correct_package_is_met(style, tmp_path, run_check):
    folder = tmp_path / "package"
    check_sets.lay_out(style, folder)
    report = run_check(folder, check_sets.spec_of(style))
    warns = check_sets.fields_of(style).get("Warns", [])
    found = [finding for finding in report["findings"] if finding["severity"] != "note"]
    others = [finding for finding in found if finding["id"] not in warns]
    assert (report["verdict"], shown(others)) == ("met", "")
    assert {finding["id"] for finding in found} == set(warns)


@pytest.mark.parametrize(
    "defect",
    parameters(
        [defect for defect in check_sets.DEFECTS if not defect.order], lambda defect: defect.name
    ),
    ids=lambda defect: defect.name,
)
def test_defect_is_found(defect, tmp_path, run_check):
    folder = tmp_path / "package"
    check_sets.lay_out(defect.base, folder)
    check_sets.break_(folder, defect)
    report = run_check(folder, check_sets.spec_of(defect.base))
    # A rule that only warns breaks no requirement.
    assert report["verdict"] == ("met" if defect.severity == "warning" else "findings")
    assert_one_defect(report["findings"], defect, folder, (defect.severity,))
    assert_fixes_fit(report["findings"], folder)


def assert_fixes_fit(findings, folder):
    """Raise AssertionError unless each diff that a finding proposes can be applied."""
    for finding in findings:
        if "\n--- a/" in finding["fix"]:
            text = finding["fix"].partition("\n")[2] + "\n"
            patch = ["patch", "-p1", "--fuzz=0", "--dry-run"]
            subprocess.run(patch, cwd=folder, input=text, text=True, check=True)


def assert_one_defect(findings, defect, folder, severities=("error",)):
    """Raise AssertionError unless the defect is found, and nothing that does not follow from it."""
    causes = [f for f in findings if f["severity"] in severities and not f["consequence_of"]]
    matches = [cause for cause in causes if check_sets.is_found(cause, defect, folder)]
    assert matches, f"expected: {defect}\nfound:\n{shown(findings)}"
    if defect.why:
        assert {cause["why"] for cause in matches} == {defect.name.replace("_", "-")}
    others = [cause for cause in causes if cause not in matches]
    assert not others, f"besides the defect:\n{shown(others)}"


@pytest.mark.parametrize("exercise", EXERCISES, ids=lambda defect: defect.name)
def test_exercise_fails_for_its_own_reason_and_its_solution_passes(exercise, tmp_path, run_check):
    folder = tmp_path / "package"
    check_sets.lay_out(exercise.base, folder)
    check_sets.break_(folder, exercise)
    report = run_check(folder, check_sets.spec_of(exercise.base))
    assert_one_defect(report["findings"], exercise, folder, severities=("error", "warning"))
    assert_fixes_fit(report["findings"], folder)
    # The solution makes a correct package of it, which is met: see above.
    check_sets.break_(folder, exercise, "--reverse")
    check_sets.lay_out(exercise.base, tmp_path / "correct")
    assert check_sets.contents(folder) == check_sets.contents(tmp_path / "correct")


# A correct package -> a defect of it that the contract written from it must tell.
WRITTEN = {
    "mrp": "wrong_type",
    "talker_listener_py": "listener_topic",
    "relay": "message_field_type",
    "add_two_ints": "sum_py_offered_name",
}


@pytest.mark.parametrize("style", WRITTEN)
def test_a_contract_is_written_from_a_correct_package(style, tmp_path, run_check):
    """The correct package meets it, and the broken one fails for what the defect breaks."""
    folder = tmp_path / "package"
    check_sets.lay_out(style, folder)
    done = called(folder, "--write-contract", cwd=tmp_path)
    assert done.returncode == 0, done.stdout
    (path,) = tmp_path.glob("*.yaml")
    nodes = spec.read(path).nodes
    assert len(path.read_text().splitlines()) <= 15 * max(len(nodes), 2), path.read_text()
    report = run_check(folder, path)
    found = [finding for finding in report["findings"] if finding["severity"] != "note"]
    assert report["verdict"] == "met" and not found, f"{path.read_text()}\n{shown(found)}"

    (defect,) = [defect for defect in check_sets.DEFECTS if defect.name == WRITTEN[style]]
    check_sets.break_(folder, defect)
    report = run_check(folder, path)
    found = {finding["id"] for finding in report["findings"] if finding["severity"] == "error"}
    assert found & {*defect.finds.split("|")}, f"{path.read_text()}\n{shown(report['findings'])}"


ALONE = [
    ("mrp", "launch/pub_sub.launch", 'type="subscriber_py', 'type="publisher_py', "launch-nodes"),
    ("mrp", "src/publisher_cpp_node.cpp", "uint32_t counter_", "uint16_t counter_", "wrap"),
]


@pytest.mark.parametrize(
    ("style", "file", "old", "new", "id_"), ALONE, ids=["launch-nodes", "wrap"]
)
def test_one_requirement_alone_is_found_broken_too(style, file, old, new, id_, tmp_path, run_check):
    check_sets.lay_out(style, tmp_path / "package")
    broken = tmp_path / "package" / file
    assert old in broken.read_text()
    broken.write_text(broken.read_text().replace(old, new))
    report = run_check(tmp_path / "package", check_sets.spec_of(style), "--only", id_)
    assert report["requirements"] == {id_: "broken"}
