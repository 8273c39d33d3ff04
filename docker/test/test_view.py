# SPDX-License-Identifier: BSD-3-Clause
"""The live page in its container, as `make docker-view` brings it to this machine's browsers."""

import json
import os
import signal
import urllib.request

import contract
from containers import ROOT, docker, run
from process import Process

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
