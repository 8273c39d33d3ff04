# SPDX-License-Identifier: BSD-3-Clause
"""Makes and starts the Dev Container with its CLI, as editors and Codespaces do.

`make docker-dev` runs this; `make docker-containers` does not, as its image takes minutes.
"""

import json
import os
import shlex
import subprocess

import pytest
from containers import ROOT, enough, inspect, removed, run
from mrp_testing.process import Process

pytestmark = pytest.mark.dev

CLI = ROOT / "catkin_ws" / "build" / "lint" / "node_modules" / ".bin" / "devcontainer"


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A clone, in which the container's user may write."""
    folder = tmp_path_factory.mktemp("dev") / "mrp"
    run("git", "clone", "--quiet", ROOT, folder)
    file = folder / ".devcontainer" / "devcontainer.json"
    asked = json.loads(file.read_text())
    asked["build"]["options"] = shlex.split(os.environ.get("DOCKER_BUILD_OPTIONS", ""))
    file.write_text(json.dumps(asked))
    if os.geteuid() == 0:  # for every other user, the CLI gives ros that user's number
        run("chown", "--recursive", "1000:1000", folder)
    return folder


@pytest.fixture(scope="module")
def dev(checkout):
    """The words that run a command in the started container."""
    # Its log is on stderr, and one line of JSON on stdout.
    output = subprocess.run(
        [CLI, "up", "--workspace-folder", checkout], stdout=subprocess.PIPE, text=True
    ).stdout
    started = json.loads(output.splitlines()[-1])
    assert started["outcome"] == "success", output
    assert started["remoteUser"] == "ros"
    image = inspect(started["containerId"])["Config"]["Image"]
    with removed(started["containerId"]):
        yield [str(CLI), "exec", "--workspace-folder", str(checkout)]
    # Where the CLI changes the number of the user ros, it makes a second image, called NAME-uid.
    run("docker", "image", "rm", image)
    run("docker", "image", "rm", image.removesuffix("-uid"), check=False)


def test_four_nodes_run_in_it(dev):
    with Process(*dev, "make", "run") as process:
        process.wait_for(lambda: enough(process.lines), "values at both subscribers")
    assert not [line for line in process.lines if line.startswith("Installing")]


def test_first_exercise_is_solved_in_it(dev, checkout):
    assert run(*dev, "make", "exercise").stdout.startswith("Exercise 1 of ")
    checked = run(*dev, "make", "exercise", check=False).stdout
    assert "not yet" in checked and "'(' was never closed" in checked, checked

    (package,) = (checkout / "catkin_ws" / "exercises").glob("01_*")
    source = package / "src" / "subscriber_py_node.py"
    source.write_text(source.read_text().replace(", msg.data\n", ", msg.data)\n"))
    assert "a_parenthesis: passed" in run(*dev, "make", "exercise").stdout
