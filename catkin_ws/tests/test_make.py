# SPDX-License-Identifier: BSD-3-Clause
"""Uses the Makefile in a copy of the repository with one package, in which nothing is built yet."""

import json
import pathlib
import re
import shutil

import pytest
import test_summary
from front_door import make, with_other_python
from mrp_testing import compiler_cache
from mrp_testing.workspace import ROOT, copy_repository

# One worker of pytest builds for all of these tests.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("make")]


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the repository, built while another python3 is first on PATH."""
    root = tmp_path_factory.mktemp("copy") / "mrp"
    copy_repository(root, "mrp_[!t]*")
    path = with_other_python(tmp_path_factory.mktemp("bin"))
    done = make("build", root=root, PATH=path, **compiler_cache.variables(root))
    assert done.returncode == 0, done.stdout
    return root


def test_other_python_first_on_path_does_no_harm(copy):
    script = copy / "catkin_ws/devel/lib/mrp/publisher_py_node.py"
    assert script.read_text().startswith("#!/usr/bin/python3\n")
    # It runs the very file that the user changes.
    assert f"'{copy}/catkin_ws/src/mrp/src/publisher_py_node.py'" in script.read_text()


def test_second_build_does_nothing(copy):
    done = make("build", root=copy)
    assert (done.returncode, done.stdout) == (0, "")


def test_build_tells_editors_how_each_file_is_compiled(copy):
    commands = json.loads((copy / "catkin_ws/compile_commands.json").read_text())
    sources = (copy / "catkin_ws/src/mrp/src").glob("*.cpp")
    assert {str(path) for path in sources} <= {command["file"] for command in commands}


def test_run_builds_the_tutorial_and_a_whole_workspace_stays_whole(copy):
    """It only says what it would do: one option decides what is built."""
    tutorial = "-DCATKIN_WHITELIST_PACKAGES=mrp "
    devel = copy / "catkin_ws/devel"
    marks = [devel / ".built_whole", devel / ".built_labs"]
    changed = ("--what-if", "catkin_ws/src/mrp/src/publisher_cpp_node.cpp")
    assert tutorial not in make("run", "--dry-run", *changed, root=copy).stdout
    assert "this time only" not in make("lab", "--dry-run", *changed, root=copy).stdout
    for mark in marks:
        mark.rename(copy / mark.name)
    assert tutorial in make("run", "--dry-run", *changed, root=copy).stdout
    assert "this time only" in make("lab", "--dry-run", *changed, root=copy).stdout
    for mark in marks:
        (copy / mark.name).rename(mark)


def replace_tests(copy, text):
    """Replace the workspace's tests by one file, and run it; the packages' tests are left out."""
    tests = copy / "catkin_ws/tests"
    shutil.rmtree(tests)
    tests.mkdir()
    (copy / "catkin_ws/build/CTestTestfile.cmake").write_text("")  # no rostests
    (tests / "test_one.py").write_text(f"import pytest\n\n{text}")
    return make("test", root=copy)


def test_a_failing_test_fails_make_test(copy):
    done = replace_tests(copy, "@pytest.mark.quick\ndef test_one():\n    assert 1 == 2\n")
    assert done.returncode == 2, done.stdout
    assert "0 passed, 1 failed\n" in done.stdout


@pytest.mark.quick
@pytest.mark.parametrize(
    ("case", "code", "says"),
    [
        ("<testcase name='a'/>", 0, "1 passed, 0 failed\n"),
        ("<testcase name='a'><skipped/></testcase>", 1, "0 passed, 0 failed, 1 skipped\n"),
        ("", 1, "no test ran\n0 passed, 0 failed\n"),
    ],
)
def test_a_skipped_test_or_none_is_a_failure(case, code, says, tmp_path, capsys):
    (tmp_path / "pytest.xml").write_text(f"<testsuite>{case}</testsuite>")
    assert test_summary.main(tmp_path) == code
    assert capsys.readouterr().out.endswith(says)


def test_a_passing_test_passes_make_test(copy):
    done = replace_tests(copy, "@pytest.mark.quick\ndef test_one():\n    pass\n")
    assert done.returncode == 0, done.stdout
    assert "1 passed, 0 failed\n" in done.stdout


@pytest.mark.quick
@pytest.mark.parametrize("distribution", ["one", "noetic"])
def test_ros_in_opt_is_sourced(distribution, tmp_path):
    """A made-up setup.bash, which ends what sources it: nothing is built."""
    (tmp_path / distribution).mkdir()
    (tmp_path / distribution / "setup.bash").write_text("echo I am $BASH_SOURCE; exit 7\n")
    done = make("docs", f"SITE={tmp_path}/site", MRP_OPT_ROS=str(tmp_path))
    assert f"I am {tmp_path}/{distribution}/setup.bash" in done.stdout
    assert done.returncode != 0


@pytest.mark.quick
@pytest.mark.parametrize(
    ("says", "fix"),
    [
        ("Cannot connect to the Docker daemon at unix:///x. Is it running?", True),
        ("failed to connect to the docker API at unix:///var/run/docker.sock", True),
        ("Error response from daemon: client version 1.41 is too old.", False),
        ("permission denied while trying to connect to the Docker daemon socket", False),
    ],
)
def test_what_docker_says_reaches_the_user(says, fix, tmp_path):
    docker = tmp_path / "docker"
    docker.write_text(f"#!/bin/sh\necho '{says}' >&2\necho more >&2\nexit 1\n")
    docker.chmod(0o755)
    printed = make("need-docker", PATH=f"{tmp_path}:/usr/bin:/bin").stdout.splitlines()
    assert printed[0] == f"error: 'docker ps' says: {says}"
    assert ("fix: start Docker's engine" in printed) == fix


@pytest.mark.quick
def test_docker_check_is_in_bounds():
    """It only says what it would do: where there is Docker, `make docker-harm` tests the bounds."""
    printed = make("docker-check", "--dry-run", f"PKG={ROOT}/catkin_ws/src/mrp").stdout
    command = re.search(r"^docker run (?:.*\\\n)*.* /package$", printed, re.MULTILINE).group()
    for bound in ("--network none", "--memory ", "--pids-limit ", "src/mrp:/package:ro"):
        assert bound in command
    assert "--user" not in command


@pytest.mark.quick
def test_check_installs_what_is_missing_and_checks():
    printed = make("check", "--dry-run", "PKG=a_package").stdout
    installs = r"install_packages\.sh [^\n]*catkin_ws/apt/check\.txt\n"
    checks = r'mrp_check/scripts/check "a_package"'
    assert re.search(rf"{installs}(.*\n)*.*{checks}", printed), printed


@pytest.mark.quick
def test_view_builds_the_tutorial_and_no_pages():
    printed = make("view", "--dry-run", "--always-make").stdout
    assert "-DCATKIN_WHITELIST_PACKAGES" in printed
    assert "sphinx" not in printed and "apt/build.txt" not in printed


@pytest.mark.quick
def test_scripts_are_executable():
    first_lines = {
        path: path.open(errors="replace").readline()
        for folder in ("catkin_ws/src", "catkin_ws/tools", ".ci")
        for path in pathlib.Path(ROOT / folder).rglob("*")
        if path.is_file() and path.suffix in ("", ".py", ".sh") and not path.is_symlink()
    }
    scripts = [path for path, line in first_lines.items() if line.startswith("#!")]
    assert len(scripts) >= 10
    assert [str(path) for path in scripts if not path.stat().st_mode & 0o111] == []
