# SPDX-License-Identifier: BSD-3-Clause
"""The tests of the tests: each broken variant of the package must fail, for the right reason.

A variant is a patch in mrp_check/defects/. Its lines Fails and Says name the test case of a
rostest, and what it says about the variant.
"""

import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree

import pytest
from mrp_check.contract import defects
from mrp_testing import compiler_cache, scratch

pytestmark = pytest.mark.slow

VARIANTS = [defect for defect in defects.read_all() if defect.fails]
DEADLINE = "10"  # seconds that a test waits for what a broken variant never does


def run_rostest(folder, name, case):
    """Run a test case of a rostest of the scratch workspace; return its message if it failed: a
    dictionary of test cases."""
    package = folder / "src" / "mrp"
    results = folder / "results"
    shutil.rmtree(results, ignore_errors=True)
    env = {
        **scratch.environment(),
        "MRP_TEST_DEADLINE": DEADLINE,
        "MRP_TEST_CASE": case,
        "GTEST_FILTER": "*." + case,
    }
    command = scratch.sourced(
        folder / "devel" / "setup.bash",
        "rostest",
        "--pkgdir=" + str(package),
        "--package=mrp",
        "--results-base-dir=" + str(results),
        package / "test" / name,
    )
    done = subprocess.run(
        command, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    files = list(results.rglob("rosunit-*.xml"))
    assert files, done.stdout
    return {
        case.get("name"): failure.text
        for file in files
        for case in ElementTree.parse(file).iter("testcase")
        for failure in [*case.iter("failure"), *case.iter("error")]
    }


@pytest.fixture(scope="session")
def workspace(tmp_path_factory):
    """A workspace that is built once for each of pytest's workers.

    Each test breaks its package, and then takes the patch back.
    """
    folder = tmp_path_factory.mktemp("workspace")
    scratch.make(folder, *scratch.TESTED)
    scratch.catkin_make(folder)
    return folder


def rebuild(workspace, rostest):
    """Build what a patch has changed, or what was changed back after the last one: make knows.

    A rostest's own C++ program, if it has one, is no part of what make builds unasked.
    """
    program = "test_" + rostest[: -len(".test")]
    own = [program] if (workspace / f"src/mrp/test/{program}.cpp").exists() else []
    done = subprocess.run(
        ["make", "-C", workspace / "build", "all", *own],
        env={**scratch.environment(), **compiler_cache.variables(workspace)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout


# At most two of pytest's workers build the workspace.
@pytest.mark.parametrize(
    "variant",
    [
        pytest.param(one, id=one.name, marks=pytest.mark.xdist_group(f"broken_{number % 2}"))
        for number, one in enumerate(VARIANTS)
    ],
)
def test_broken_variant_fails(variant, workspace):
    def run_patch(*options):
        command = ["patch", "-p1", "--fuzz=0", f"--input={variant.path}", *options]
        subprocess.run(command, cwd=workspace / "src" / "mrp", check=True)

    run_patch()
    try:
        rostest, case = variant.fails
        rebuild(workspace, rostest)
        failures = run_rostest(workspace, rostest, case)
    finally:
        run_patch("--reverse")
    assert case in failures, f"failed: {failures}"
    assert re.search(variant.says, failures[case]), failures[case]


def test_there_are_broken_variants():
    assert VARIANTS
