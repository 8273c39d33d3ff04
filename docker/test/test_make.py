# SPDX-License-Identifier: BSD-3-Clause
"""The Makefile's targets for containers, as a user calls them."""

import os
import shutil
import signal

import pytest
from containers import ROOT, docker, enough, run
from process import Process


@pytest.fixture
def built():
    """The image is that of these sources, so that no target has to build it first."""
    run("make", "-C", ROOT, "docker-build")


def test_docker_run_ends_on_ctrl_c_and_leaves_no_container(built):
    with Process("make", "-C", str(ROOT), "docker-run") as process:
        process.wait_for(lambda: enough(process.lines), "values at both subscribers")
        # Ctrl-C reaches make and all that it runs.
        os.killpg(process.pid, signal.SIGINT)
        process.wait()
    assert docker("ps", "--all", "--quiet", "--filter", "name=^mrp$") == ""
    assert "done" in process.lines, str(process)


def test_docker_up_shows_all_and_docker_down_takes_it_away(built):
    def printed():
        """Return what the nodes printed: docker compose puts the container's name before it."""
        return [line.partition("| ")[2] for line in list(process.lines)]

    label = "label=com.docker.compose.project=mrp"
    try:
        with Process("make", "-C", str(ROOT), "docker-up") as process:
            process.wait_for(lambda: enough(printed()), "values at both subscribers")
            os.killpg(process.pid, signal.SIGINT)
            process.wait()
        assert docker("ps", "--quiet", "--filter", label) == "", str(process)
    finally:
        run("make", "-C", ROOT, "docker-down")
    assert docker("ps", "--all", "--quiet", "--filter", label) == ""
    assert docker("network", "ls", "--quiet", "--filter", label) == ""


def make_docker_build(folder, *programs):
    """Run make docker-build where these are the only programs; return what it says."""
    for program in programs:
        (folder / program).symlink_to(shutil.which(program))
    path = f"PATH={folder}"
    done = run("make", "-C", ROOT, "docker-build", path, check=False)
    assert done.returncode == 2
    return [line for line in done.stdout.splitlines() if line.startswith("error:")]


def test_without_docker(tmp_path):
    assert make_docker_build(tmp_path, "bash") == [
        "error: this needs Docker, which is not installed on this machine"
    ]


def test_without_engine(tmp_path, monkeypatch):
    monkeypatch.setenv("DOCKER_HOST", f"unix://{tmp_path}/no-socket")
    assert make_docker_build(tmp_path, "bash", "docker") == [
        "error: Docker's engine does not answer: start it; 'docker info' says more"
    ]
