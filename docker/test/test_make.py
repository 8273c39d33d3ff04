# SPDX-License-Identifier: BSD-3-Clause
"""Calls the Makefile's targets for containers, as a user does.

What they start has fixed names, so these tests run one after the other, in one worker.
"""

import json
import os
import shutil
import signal
import urllib.request

import pytest
from containers import ROOT, docker, enough, run
from mrp_testing import contract
from mrp_testing.process import Process

ADDRESS = "http://127.0.0.1:8765/"

# A browser's side of the page's WebSocket, which runs in the page's own container: that has a
# client. It prints the states of all nodes, and the publishers, once both have been heard.
BROWSER = """
import asyncio, json
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

TOPIC = "%s"

async def main():
    headers = {"Origin": "http://127.0.0.1:8765"}
    socket = await websocket_connect(HTTPRequest("ws://127.0.0.1:8765/socket", headers=headers))
    nodes, rows = [], {}
    while True:
        message = json.loads(await socket.read_message())
        if message["t"] == "graph":
            nodes = message["graph"]["nodes"]
        else:
            rows.update({(row["topic"], row["from"]): row["count"] for row in message["rows"]})
        senders = [name for (topic, name), count in rows.items() if topic == TOPIC and count > 2]
        if len(senders) == 2:
            print(json.dumps([{node["name"]: node["state"] for node in nodes}, sorted(senders)]))
            return

asyncio.run(asyncio.wait_for(main(), 60))
"""


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
    """Run make docker-build where these are the only programs; return its errors, and fixes."""
    for program in programs:
        (folder / program).symlink_to(shutil.which(program))
    path = f"PATH={folder}"
    done = run("make", "-C", ROOT, "docker-build", path, check=False)
    assert done.returncode == 2
    return [line for line in done.stdout.splitlines() if line.startswith(("error:", "fix:"))]


def test_without_docker(tmp_path):
    assert make_docker_build(tmp_path, "bash") == [
        "error: this needs Docker, which is not installed on this machine"
    ]


def test_without_engine(tmp_path, monkeypatch):
    monkeypatch.setenv("DOCKER_HOST", f"unix://{tmp_path}/no-socket")
    error, fix = make_docker_build(tmp_path, "bash", "docker")
    assert error.startswith("error: 'docker ps' says: ") and "no-socket" in error
    assert fix == "fix: start Docker's engine"


def test_docker_view_shows_the_four_nodes():
    run("make", "-C", ROOT, "docker-build-view")
    try:
        with Process("make", "-C", str(ROOT), "docker-view") as process:
            process.wait_for(
                lambda: any("Open http://127.0.0.1:8765/" in line for line in process.lines),
                "the address",
            )
            with urllib.request.urlopen(ADDRESS) as answer:
                page = answer.read().decode()
                policy = answer.headers["Content-Security-Policy"]
            assert "<title>" in page and "unsafe-inline" not in policy
            (name,) = docker(
                "ps",
                "--format={{.Names}}",
                "--filter=label=com.docker.compose.project=mrp",
                "--filter=label=com.docker.compose.service=view",
            ).split()
            program = BROWSER % f"{contract.GROUP}/{contract.TOPIC}"
            nodes, senders = json.loads(docker("exec", name, "python3", "-c", program))
            os.killpg(process.pid, signal.SIGINT)
            process.wait()
    finally:
        run("make", "-C", ROOT, "docker-down")
    ours = {f"{contract.GROUP}/{node.name}": "alive" for node in contract.NODES}
    assert ours.items() <= nodes.items()
    assert senders == sorted(f"{contract.GROUP}/{node.name}" for node in contract.PUBLISHERS)
