# SPDX-License-Identifier: BSD-3-Clause
"""A class on Dask, in containers: class.yaml, with the image of `make docker-build-class`."""

import csv
import json
import os
import stat

import pytest
from containers import ROOT, Composition, compose_commands, docker, inspect, run

PATCH = ROOT / "catkin_ws/src/mrp_check/correct/talker_listener_py.patch"
SPEC = ("--spec", "talker_listener_py")
OWNER = os.getuid() or 1234  # of the folder: not root
IMAGE = "mrp-class:" + os.environ.get("DEBIAN", "trixie")
CHECK = ("python3", "/mrp/catkin_ws/src/mrp_check/scripts/check")
KEY = "/etc/dask/key.pem"
# In place of the loop's text: what becomes of it if a student's node reads the key.
SPY = f"""
        try:
            text = open("{KEY}").read()
        except OSError as error:
            text = str(error)
"""


def hand_in(folder, name, old="", new=""):
    """Make a student's package: a correct one, but for a text of its talker."""
    package = folder / name
    package.mkdir()
    run("patch", "-p1", "--directory", package, "--input", PATCH)
    talker = package / "scripts" / "talker.py"
    talker.write_text(talker.read_text().replace(old, new))


class Class(Composition):
    """A scheduler and two workers.

    folder: what the instructor mounts: the submissions, and beside them what is kept of the checks
    """

    def __init__(self, folder):
        super().__init__(compose_commands()[0], "class.yaml", services=["scheduler"])
        self.folder = folder

    def __enter__(self):
        super().__enter__()
        self.compose("up", "--detach", "--scale", "worker=2")
        return self

    def check(self, *options):
        """Check the class; return what was said"""
        mounted = ("--volume", f"{self.folder}:/course")
        asked = ("check", "--class", "submissions", *SPEC, *options)
        return self.compose("run", "--rm", *mounted, *asked, check=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("course")
    submissions = folder / "submissions"
    submissions.mkdir()
    hand_in(submissions, "anna")
    hand_in(submissions, "berta", old="        rospy.loginfo(text)\n", new=SPY)
    (submissions / "caesar").mkdir()
    os.chown(folder, OWNER, -1)
    return folder


@pytest.fixture(scope="module")
def class_(folder):
    with Class(folder) as class_:
        yield class_


@pytest.fixture(scope="module")
def rows(class_):
    """student -> the row of the table."""
    output = class_.check("--csv", "marks.csv")
    assert (class_.folder / "marks.csv").is_file(), output
    with open(class_.folder / "marks.csv") as file:
        return {row["submission"]: row for row in csv.DictReader(file)}


@pytest.mark.parametrize(
    "protocol, config",
    [("tls", "/none"), ("tcp", "/none"), ("tls", "/etc/dask")],
    ids=["none", "plain", "another"],
)
def test_who_has_not_the_certificate_sends_no_work(class_, protocol, config):
    """The stranger is a container that class.sh makes another certificate for."""
    options = ["--network", class_.project + "_default", "--tmpfs", "/etc/dask"]
    options += ["-e", "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT=5s"]
    options += ["-e", f"DASK_ROOT_CONFIG={config}"]
    address = f"{protocol}://scheduler:8786"
    asked = (*CHECK, "--class", "/mrp", "--scheduler", address)
    done = run("docker", "run", "--rm", "--init", *options, IMAGE, *asked, check=False)
    assert f"check: There's no Dask scheduler at {address}: " in done.stdout
    assert done.returncode == 2


def test_marks(rows):
    verdicts = {name: row["verdict"] for name, row in rows.items()}
    expected = {"anna": "met", "berta": "findings", "caesar": "unchecked"}
    assert verdicts == expected, rows
    # A busy machine may leave one requirement unchecked, which has no points.
    assert "broken" not in rows["anna"].values() and rows["anna"]["points"] != "0", rows["anna"]
    assert rows["caesar"]["points"] == "0"
    broken = [column for column, cell in rows["berta"].items() if cell == "broken"]
    assert broken == ["values", "console"], rows["berta"]["why"]


def test_a_students_node_cannot_read_the_key(class_, rows):
    assert f"talker publishes “[Errno 13] Permission denied: '{KEY}'”" in rows["berta"]["why"]
    worker, _ = class_.name("worker").split()
    assert "PRIVATE KEY" in docker("exec", worker, "cat", KEY)


def test_what_is_kept_belongs_to_whose_folder_it_is(folder, rows):
    report = json.loads((folder / "submissions.checked" / "berta.json").read_text())
    assert report["report"]["verdict"] == "findings"
    kept = [folder / "marks.csv", *folder.glob("submissions.checked"), *folder.glob("*.checked/*")]
    for path in kept:
        assert path.stat().st_uid == OWNER, path
        assert path.stat().st_mode & stat.S_IRUSR and path.stat().st_mode & stat.S_IWUSR, path


def test_each_is_within_bounds(class_):
    (network,) = docker("network", "ls", "--quiet", f"--filter=name={class_.project}").split()
    assert inspect(network)["Internal"]
    names = (class_.name("scheduler") + "\n" + class_.name("worker")).split()
    assert len(names) == 3
    for state in map(inspect, names):
        assert not any(state["NetworkSettings"]["Ports"].values())
        assert state["HostConfig"]["CapDrop"] == ["ALL"]
        assert "no-new-privileges:true" in state["HostConfig"]["SecurityOpt"]
        assert not state["HostConfig"]["Privileged"]
