# SPDX-License-Identifier: BSD-3-Clause
"""Where the time goes when four nodes are started and stopped: ours, others', in a container."""

import json
import os
import pathlib
import socket
import subprocess
import tempfile
import typing

from mrp_bench import cold, container
from mrp_bench.launched import Launched, exits
from mrp_bench.programs import ProgramError


class Variant(typing.NamedTuple):
    """name: as tables and plots say it. command, env: what starts the nodes, and its environment.

    in_container: the nodes' processes are not this machine's to look at
    """

    name: str
    command: typing.List[str]
    env: typing.Dict[str, str]
    in_container: bool = False


def ours():
    """Return the tutorial's launch file as a Variant."""
    return Variant("mrp", ["roslaunch", "mrp", "pub_sub.launch"], dict(os.environ))


def beside(workspace):
    """Return the one launch file of another workspace, which has been built, as a Variant.

    Raises ProgramError if there is none, or several.
    """
    files = list((workspace / "src").glob("*/launch/*.launch"))
    if len(files) != 1:
        raise ProgramError(
            f"expected one launch file of one package in {workspace}/src, found {len(files)}"
        )
    printed = subprocess.run(
        [str(workspace / "devel" / "env.sh"), "env", "-0"], check=True, stdout=subprocess.PIPE
    ).stdout.decode()
    env = dict(line.split("=", 1) for line in printed.split("\0") if line)
    package = files[0].parent.parent.name
    return Variant(package, ["roslaunch", package, files[0].name], env)


def in_container():
    """Return the tutorial's container as a Variant."""
    return Variant(container.IMAGE, container.COMMAND, dict(os.environ), in_container=True)


def measure(variant, is_cold):
    """Start the nodes, wait for their first messages, and end them; return what happened.

    Times are in seconds since the call. Raises ProgramError if they do not come up, or do not end.
    """
    with tempfile.TemporaryDirectory() as logs:
        env = {**variant.env, "ROS_LOG_DIR": logs, "ROS_MASTER_URI": _free_uri()}
        files = cold.forget(cold.folders(env)) if is_cold else {}
        read = cold.read_megabytes()
        with Launched(variant.command, env) as launched:
            launched.wait_until_up(4)
            watched = {} if variant.in_container else launched.console.pids
            kept = cold.kept(files, launched.pids()) if is_cold else None
            stop, ended, end = launched.stop(watched)
        text = "".join(path.read_text() for path in pathlib.Path(logs).glob("*/roslaunch-*.log"))
    return {
        "variant": variant.name,
        "cold": is_cold,
        "events": launched.console.events,
        "stop": stop,
        "ended": ended,
        "end": end,
        "exits": exits(text),
        "read": cold.read_megabytes() - read,
        "kept": kept,
        "in_container": variant.in_container,
    }


def _free_uri():
    """Return an address at which roslaunch can start a master of its own, as a student's does."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return f"http://localhost:{probe.getsockname()[1]}"


def run(variants, rounds, results, say, missing=None, cold_too=True):
    """Measure each variant that often, cold (if so) and then warm; keep it in the results' folder.

    missing: name -> why it is not measured, for the report
    """
    folder = results.folder / "starts"
    folder.mkdir(exist_ok=True)
    # What a run that is resumed has measured is there.
    missing = {
        name: why for name, why in (missing or {}).items() if not any(folder.glob(f"{name}_*"))
    }
    (folder / "missing.json").write_text(json.dumps(missing))
    for number in range(rounds):
        for variant in variants:
            # An image's files are the engine's. After a cold start they are warm.
            for is_cold in (True, False) if cold_too and not variant.in_container else (False,):
                heat = "cold" if is_cold else "warm"
                path = folder / f"{variant.name}_{heat}_{number}.json"
                line = f"start and stop: {variant.name}, {heat}, round {number + 1} of {rounds}"
                results.once(path, lambda: measure(variant, is_cold), say, line)


def load(results):
    """Return all that run() has kept, and its `missing`."""
    folder = results.folder / "starts"
    if not folder.exists():
        return [], {}
    starts = [json.loads(path.read_text()) for path in sorted(folder.glob("*_*_*.json"))]
    return starts, json.loads((folder / "missing.json").read_text())
