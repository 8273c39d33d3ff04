# SPDX-License-Identifier: BSD-3-Clause
"""The tests of the tests: each broken variant of the package must fail, for the right reason.

A variant is a patch in mrp_check/defects/. Its lines Fails and Says name the test case of a
rostest, and what it says about the variant.
"""

import concurrent.futures
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree

import pytest
from mrp_check.contract import defects
from mrp_testing import compiler_cache, scratch

# One worker of pytest runs them.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("broken")]

VARIANTS = [defect for defect in defects.read_all() if defect.fails]
# Seconds that a test waits for what a broken variant never does. Before it comes to that, it may
# wait for what each variant does, such as ten values, which take 6 s.
DEADLINE = "25"


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


@pytest.fixture(scope="module")
def outcomes(request, tmp_path_factory):
    """Return the name of each chosen variant -> what its rostest said: see run_rostest.

    Those that are compiled run beside those that are not: they wait more than they work. And what
    is compiled stays broken until the next one is built.
    """
    chosen = [
        item.callspec.params["variant"]
        for item in request.session.items
        if item.path == request.path and "variant" in getattr(item, "fixturenames", ())
    ]

    def run_all(kind, folder):
        scratch.make(folder, *scratch.TESTED)
        scratch.catkin_make(folder)
        return {patch.name: outcome(patch, folder) for patch in chosen if kind_of(patch) == kind}

    with concurrent.futures.ThreadPoolExecutor() as pool:
        running = [
            pool.submit(run_all, kind, tmp_path_factory.mktemp(kind))
            for kind in sorted({kind_of(variant) for variant in chosen})
        ]
    return {name: found for future in running for name, found in future.result().items()}


def outcome(variant, workspace):
    """Break the package, run the rostest, and take the patch back; return what failed."""

    def run_patch(*options):
        command = ["patch", "-p1", "--fuzz=0", f"--input={variant.path}", *options]
        subprocess.run(command, cwd=workspace / "src" / "mrp", check=True)

    run_patch()
    try:
        build(workspace, variant)
        return run_rostest(workspace, *variant.fails)
    except AssertionError as error:  # it's this variant's alone
        return {"": str(error)}
    finally:
        run_patch("--reverse")


def build(workspace, variant):
    """Build what a patch has changed, or what was changed back after the last one: make knows.

    A rostest's own C++ program, if it has one, is no part of what make builds unasked.
    """
    program = "test_" + variant.fails[0].removesuffix(".test")
    targets = ["all"] if kind_of(variant) == "compiled" else []
    if (workspace / f"src/mrp/test/{program}.cpp").exists():
        targets.append(program)
    if not targets:
        return
    done = subprocess.run(
        ["make", "-C", workspace / "build", *targets],
        env={**scratch.environment(), **compiler_cache.variables(workspace)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, done.stdout


def kind_of(variant):
    """Say whether a patch changes what is compiled, or only what runs from its sources."""
    compiled = re.search(
        r"^\+\+\+ .*(\.cpp|CMakeLists\.txt)$", variant.path.read_text(), re.MULTILINE
    )
    return "compiled" if compiled else "interpreted"


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.name)
def test_broken_variant_fails(variant, outcomes):
    failures = outcomes[variant.name]
    case = variant.fails[1]
    assert case in failures, f"failed: {failures}"
    assert re.search(variant.says, failures[case]), failures[case]


def test_there_are_broken_variants():
    assert VARIANTS
