# SPDX-License-Identifier: BSD-3-Clause
"""Where the time goes when the tutorial's four nodes are started and stopped."""

import json
import os
import pathlib
import socket
import tempfile

from mrp_bench.launched import Launched, exits


def measure():
    """Start the nodes, wait for their first messages, and end them; return what happened.

    Times are in seconds since the call. Raises ProgramError if they do not come up, or do not end.
    """
    with tempfile.TemporaryDirectory() as logs:
        env = {**os.environ, "ROS_LOG_DIR": logs, "ROS_MASTER_URI": _free_uri()}
        with Launched(["roslaunch", "mrp", "pub_sub.launch"], env) as launched:
            launched.wait_until_up(4)
            stop, ended, end = launched.stop(launched.console.pids)
        text = "".join(path.read_text() for path in pathlib.Path(logs).glob("*/roslaunch-*.log"))
    return {
        "events": launched.console.events,
        "stop": stop,
        "ended": ended,
        "end": end,
        "exits": exits(text),
    }


def _free_uri():
    """Return an address at which roslaunch can start a master of its own, as a student's does."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return f"http://localhost:{probe.getsockname()[1]}"


def run(rounds, results, say):
    """Measure that often; keep what is found in the results' folder."""
    folder = results.folder / "starts"
    folder.mkdir(exist_ok=True)
    for number in range(rounds):
        line = f"start and stop: round {number + 1} of {rounds}"
        results.once(folder / f"{number}.json", measure, say, line)


def load(results):
    """Return all that run() has kept."""
    paths = sorted((results.folder / "starts").glob("*.json"))
    return [json.loads(path.read_text()) for path in paths]
