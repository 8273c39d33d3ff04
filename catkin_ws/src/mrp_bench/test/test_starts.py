# SPDX-License-Identifier: BSD-3-Clause
"""make bench: the start and stop of the four nodes, cold and warm, and in a container."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import pytest
from mrp_bench import cold, container, plots, rounds, start_figures, starts, tables
from mrp_bench.launched import Console, exits
from mrp_bench.programs import ProgramError
from mrp_testing.proves import proves
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick

ROSLAUNCH_SAYS = """\
... logging to /tmp/some.log
\x1b[1mprocess[master]: started with pid [10]\x1b[0m
\x1b[1msetting /run_id to 7dab871e\x1b[0m
process[rosout-1]: started with pid [11]
\x1b[1mprocess[mrp/publisher_cpp_node-2]: started with pid [12]\x1b[0m
[ INFO] [1795222168.680630550]: [PUBLISHER CPP NODE] namespace of nh = /mrp/publisher_cpp_node
[ INFO] [1795222169.082939615]: [SUBSCRIBER CPP NODE] namespace of nh = /mrp/subscriber_cpp_node
[ INFO] [1795222169.182939615]: [SUBSCRIBER CPP NODE] received message with data = 2
[ INFO] [1795222169.682939615]: [SUBSCRIBER CPP NODE] received message with data = 4
[mrp/publisher_cpp_node-2] killing on exit[mrp/subscriber_cpp_node-4] killing on exit
[master] killing on exit
shutting down processing monitor...
"""


def console(lines):
    found = Console()
    for moment, line in enumerate(lines):
        found.add(moment, line)
    return found


def test_events_of_a_launch():
    found = console(ROSLAUNCH_SAYS.splitlines(keepends=True))
    assert found.events == [
        (0, "first line", ""),
        (1, "started", "master"),
        (2, "master", ""),
        (3, "started", "rosout"),
        (4, "started", "mrp/publisher_cpp_node"),
        (5, "ready", "mrp/publisher_cpp_node"),
        (6, "ready", "mrp/subscriber_cpp_node"),
        (7, "received", "SUBSCRIBER CPP NODE"),
        (9, "stopping", "mrp/publisher_cpp_node"),
        (9, "stopping", "mrp/subscriber_cpp_node"),
        (10, "stopping", "master"),
    ]
    assert found.pids == {"master": 10, "rosout": 11, "mrp/publisher_cpp_node": 12}


ORIGINAL_SAYS = """\
[ INFO] [1795222168.680630550]: [PUBLISHER CPP NODE] namespace of nh = /mrp/publisher_cpp_node
[ INFO] [1795222168.680630550]: [PUBLISHER CPP NODE] namespace of nh = /mrp/subscriber_cpp_node
[INFO] [1795222168.878456]: PUBLISHER PY NODE] namespace of node = /mrp/
[INFO] [1795222168.898253]: [SUBSCRIBER PY NODE] namespace of node = /mrp/
[INFO] [1795222169.183017]: [SUBSCRIBER PY NODE] received message with data = 2
"""


def test_events_of_the_original():
    """Its Python nodes do not say their names, and its C++ subscriber says that it publishes."""
    lines = ORIGINAL_SAYS.splitlines(keepends=True)
    assert [event for event in console(lines).events if event[1] != "first line"] == [
        (0, "ready", "mrp/publisher_cpp_node"),
        (1, "ready", "mrp/subscriber_cpp_node"),
        (2, "ready", "mrp/publisher_py_node"),
        (3, "ready", "mrp/subscriber_py_node"),
        (4, "received", "SUBSCRIBER PY NODE"),
    ]
    assert console(lines).is_up(4)
    assert not console(lines[:4]).is_up(4), "no message yet"
    assert not console(lines[1:]).is_up(4), "three nodes"


def test_exit_codes_are_in_the_log_of_roslaunch():
    log = """\
[roslaunch][INFO] 2026-11-21 23:23:06,131: process[mrp/a-4]: SIGINT killed with return value -6
[roslaunch][INFO] 2026-11-21 23:23:06,132: process[mrp/b-5]: SIGTERM killed with return value 0
[roslaunch][INFO] 2026-11-21 23:23:08,545: process[master]: SIGINT killed with return value 1
"""
    assert exits(log) == {"mrp/a": -6, "mrp/b": 0, "master": 1}


def one_start(variant="mrp", is_cold=False, kept=None, later=0.0, **other):
    nodes = ("publisher_cpp_node", "publisher_py_node", "subscriber_cpp_node", "subscriber_py_node")
    events = [(0.5, "first line", ""), (0.6, "started", "master"), (1, "master", "")]
    events += [(1.1, "started", "rosout")]
    events += [(1.5 + 0.1 * i, "started", f"mrp/{node}") for i, node in enumerate(nodes)]
    events += [(2 + 0.1 * i, "ready", f"mrp/{node}") for i, node in enumerate(nodes)]
    events += [
        (3 + later, "received", "SUBSCRIBER CPP NODE"),
        (4, "received", "SUBSCRIBER PY NODE"),
    ]
    return {
        "variant": variant,
        "cold": is_cold,
        "events": events,
        "stop": 5,
        "ended": {"mrp/publisher_cpp_node": 6, "mrp/subscriber_py_node": 7, "rosout": 7.5},
        "end": 8,
        "exits": {"mrp/publisher_cpp_node": 0, "rosout": 0},
        "read": 0,
        "kept": kept,
        "in_container": False,
        **other,
    }


def content_of(starts, missing=None, verdict=None):
    """Return the part of results.json that says when nodes started, as the pages read it."""
    content = {
        "verdict": verdict,
        "rows": [],
        "starts": start_figures.summarise(starts, missing or {}),
        "robots": {"figures": [], "exponents": {}},
        "fans": {"series": []},
    }
    return json.loads(json.dumps(content))


def test_table_of_starts():
    others = one_start("other_pkg", exits={"mrp/publisher_cpp_node": -6, "mrp/b": 1, "rosout": 0})
    others["events"] = [one for one in others["events"] if one[2] != "SUBSCRIBER CPP NODE"]
    boxed = one_start("mrp:bookworm", in_container=True, ended={}, exits={})
    measured = [others, boxed] + [one_start(later=later) for later in (0, 1, 2)]
    missing = {"something else": "not measured: why"}
    (table,) = tables.starts(content_of(measured, missing))
    assert [" | ".join(row) for row in (table.header, *table.rows)] == [
        "until | mrp, warm | mrp:bookworm, warm | other_pkg, warm",
        "roslaunch's first line | 0.50 [0.50, 0.50] | 0.50 | 0.50",
        "the master answers | 1.00 [1.00, 1.00] | 1.00 | 1.00",
        "the first node is started | 1.50 [1.50, 1.50] | 1.50 | 1.50",
        "all four are started | 1.80 [1.80, 1.80] | 1.80 | 1.80",
        "all four are ready | 2.30 [2.30, 2.30] | 2.30 | 2.30",
        "first message at the C++ subscriber | 4.00 [3.00, 5.00] | 3.00 | not seen",
        "first message at the Python subscriber | 4.00 [4.00, 4.00] | 4.00 | 4.00",
        "Ctrl-C to the end of all four | 2.00 [2.00, 2.00] | not seen | 2.00",
        "Ctrl-C to the prompt | 3.00 [3.00, 3.00] | 3.00 | 3.00",
        "read from the disk, MB | 0.00 [0.00, 0.00] | not seen | 0.00",
        "exit codes | all 0 | not seen | publisher_cpp_node: SIGABRT (1 of 1), b: 1 (1 of 1)",
    ]
    assert table.after == ["something else: not measured: why."]
    (noisy,) = tables.starts(content_of(measured, verdict="noisy"))
    assert noisy.rows[4] == ["all four are ready", *["too noisy"] * 3]
    assert tables.starts(content_of([])) == []


@proves("Where other programs keep them in memory, the table has no figures of cold starts.")
def test_a_start_that_was_warm_is_never_called_cold():
    measured = [one_start(), one_start(is_cold=True, kept=0.01), one_start(is_cold=True, kept=0.04)]
    (table,) = tables.starts(content_of(measured))
    assert table.rows[4] == ["all four are ready", "2.30", "2.30 [2.30, 2.30]"]
    measured.append(one_start(is_cold=True, kept=0.3))
    (table,) = tables.starts(content_of(measured))
    assert table.rows[4] == ["all four are ready", "2.30", "not measured"]
    (why,) = table.after
    assert why.startswith("mrp, cold: not measured: 30% of the nodes' programs and libraries")


def test_files_are_forgotten():
    # Not in /tmp, which may be in memory alone.
    with tempfile.TemporaryDirectory(dir=WORKSPACE / "build") as folder:
        path = pathlib.Path(folder) / "file"
        path.write_bytes(bytes(100_000))
        with open(path, "rb") as file:
            assert cold.in_memory(file) == (100_000, 100_000)
        (path.parent / "link").symlink_to("nothing")
        assert cold.forget([folder]) == {str(path): (0, 100_000)}


@pytest.mark.slow
def test_files_in_use_are_kept(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(bytes(100_000))
    user = "import mmap, sys; f = open(sys.argv[1], 'rb'); m = mmap.mmap(f.fileno(), 0, prot=1)"
    command = [sys.executable, "-c", f"{user}; m.read(); print(1, flush=True); input()", path]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, **pipes) as process:
        process.stdout.readline()
        files = cold.forget([tmp_path])
        assert cold.kept(files, [process.pid]) == 1
        assert cold.kept({str(path): (25_000, 100_000)}, [process.pid]) == 0.25
        # Nothing is known of what it has mapped: that is not cold either.
        assert cold.kept({}, [process.pid]) == 1
        process.stdin.close()


def test_timeline_says_what_its_colours_are(tmp_path):
    content = content_of([one_start()])
    plots.write(content, tmp_path)
    words = "subscriber_py_node starts at 1.80 s, runs at 2.30 s, has its first message at 4.00 s, "
    assert words in plots.start_and_stop(content).alt
    root = ElementTree.parse(tmp_path / "start_and_stop.svg").getroot()
    assert set(root.itertext()) >= {
        "roslaunch",
        "master",
        "subscriber_py_node",
        "starts",
        "runs",
        "has the signal to end",
        "has its first message",
        "seconds since Ctrl-C",
    }
    assert [path.name for path in tmp_path.iterdir()] == ["start_and_stop.svg"]


@proves(
    "make bench also starts the four nodes with roslaunch, and ends them with Ctrl-C, cold and "
    "warm.",
)
@pytest.mark.slow
def test_tutorial_starts_and_stops(tmp_path):
    results = rounds.Results(tmp_path)
    starts.run([starts.ours()], 1, results, print)
    found, _ = starts.load(results)
    assert sorted(one["cold"] for one in found) == [False, True]
    for one in found:
        names = {name for _, what, name in one["events"] if what == "ready"}
        assert len(names) == 4
        assert set(one["ended"]) == set(one["exits"]) == names | {"master", "rosout"}
        assert set(one["exits"].values()) == {0}
        received = {name for _, what, name in one["events"] if what == "received"}
        assert received == {"SUBSCRIBER CPP NODE", "SUBSCRIBER PY NODE"}
        assert one["stop"] < min(one["ended"].values()) <= max(one["ended"].values()) < one["end"]

    starts.run([starts.ours()], 1, results, pytest.fail)
    assert starts.load(results)[0] == found


_DOCKER = """\
#!/bin/bash
echo "$@" >> "$0.calls"
case "$1" in
  info) exit $(cat "$0.engine") ;;
  image) exit $(cat "$0.image") ;;
esac
# Before it prints what SIGINT follows on: a shell that ends without this leaves the sleep behind.
trap 'kill $!; exit' INT
for node in {PUBLISHER,SUBSCRIBER}" "{CPP,PY}; do
  name=${node,,}
  echo "process[mrp/${name/ /_}_node-1]: started with pid [1]"
  echo "[$node NODE] namespace of nh = /mrp/${name/ /_}_node"
done
for language in CPP PY; do echo "[SUBSCRIBER $language NODE] received message with data = 2"; done
sleep infinity &
wait
"""


@pytest.fixture
def fake_docker(tmp_path, monkeypatch):
    """A docker that prints what the container prints, to its SIGINT.

    Its exit codes are in the files docker.engine and docker.image, its calls in docker.calls.
    """
    path = tmp_path / "bin" / "docker"
    path.parent.mkdir()
    path.write_text(_DOCKER)
    path.chmod(0o755)
    for name in ("engine", "image"):
        path.with_suffix("." + name).write_text("0")
    monkeypatch.setenv("PATH", f"{path.parent}:{os.environ['PATH']}")
    return path


@pytest.mark.slow
def test_container_starts_and_stops(fake_docker, tmp_path):
    assert container.why_not() is None
    results = rounds.Results(tmp_path)
    starts.run([starts.in_container()], 1, results, print)
    ((one,), _) = starts.load(results)
    assert not one["cold"] and one["ended"] == {}
    assert sum(what == "ready" for _, what, _ in one["events"]) == 4
    assert one["stop"] < one["end"]
    calls = fake_docker.with_suffix(".calls").read_text().splitlines()
    assert calls[-1] == "run --rm --network none mrp:bookworm"

    # A run that is resumed where there is no engine any more has it all the same.
    starts.run([], 1, results, pytest.fail, {container.IMAGE: "not measured"})
    assert starts.load(results) == ([one], {})


@proves("If there is no such image, the table says why.")
def test_container_that_cannot_be_measured(fake_docker, monkeypatch):
    fake_docker.with_suffix(".image").write_text("1")
    assert container.why_not() == (
        "not measured: there is no image mrp:bookworm: make docker-build DEBIAN=bookworm"
    )
    fake_docker.with_suffix(".engine").write_text("1")
    assert container.why_not() == "not measured: no Docker engine answers"
    monkeypatch.setenv("PATH", str(fake_docker.parent.parent))
    assert container.why_not() == "not measured: Docker is not installed"


def test_what_is_beside_is_one_launch_file_in_its_environment(tmp_path):
    with pytest.raises(ProgramError, match="expected one launch file .* found 0"):
        starts.beside(tmp_path)
    launch = tmp_path / "src" / "some_pkg" / "launch" / "some.launch"
    launch.parent.mkdir(parents=True)
    launch.touch()
    script = tmp_path / "devel" / "env.sh"
    script.parent.mkdir()
    script.write_text('#!/bin/sh\nONE="two\nlines" exec "$@"\n')
    script.chmod(0o755)
    found = starts.beside(tmp_path)
    assert (found.name, found.command) == ("some_pkg", ["roslaunch", "some_pkg", "some.launch"])
    assert found.env["ONE"] == "two\nlines"
