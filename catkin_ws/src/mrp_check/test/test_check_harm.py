# SPDX-License-Identifier: BSD-3-Clause
"""Builds and runs packages that try to do harm: they're reported, and get no further."""

import textwrap

import pytest
from check_rules import ISOLATIONS
from lab_package import findings_of, make_package, spec_of
from mrp_check import sandbox
from mrp_check.contract.finding import ERROR
from mrp_check.contract.verdict import MET
from mrp_check.package.package import Package
from mrp_check.verdict import check
from mrp_testing.process import processes_with

pytestmark = [pytest.mark.slow, pytest.mark.place, pytest.mark.usefixtures("open_folders")]


FLOODS = {
    "prints": "while not rospy.is_shutdown(): print('x' * 1000)",
    "publishes": "while not rospy.is_shutdown(): node.publisher.publish(1)",
    "forks": "import os\n    for _ in range(50): os.fork()",
    "no_memory": "x = []\n    while True: x.append(b'x' * 10**7)",
}
if sandbox.isolation() is not sandbox.Isolation.NONE:
    # Else it ends all that is its user's, these tests as well.
    FLOODS["kills_all"] = "import os, signal; os.kill(-1, signal.SIGKILL)"


@pytest.mark.parametrize("flood", FLOODS)
def test_a_node_that_does_harm_is_reported_and_ended(tmp_path, flood):
    program = FLOODS[flood]
    folder = make_package(
        tmp_path / "lab_pkg",
        {"flood": ("    rospy.spin()", textwrap.indent(program, "    ").strip("\n"))},
        {},
    )
    script = folder / "scripts" / "publisher_flood.py"
    script.write_text(
        script.read_text().replace("#!/usr/bin/python3\n", f"#!/usr/bin/python3\n# {tmp_path}\n")
    )
    found = findings_of(folder, spec_of(["flood"], []), tmp_path / "scratch")
    assert any(f.severity == ERROR for f in found)
    assert not processes_with(str(tmp_path / "scratch"))


# What a publisher with wrong values may try, so that nobody hears of them.
FORGERY = """
import os, signal, threading, time, xmlrpc.client


def attack():
    while True:
        for process in os.listdir("/proc"):
            try:
                with open(f"/proc/{process}/cmdline") as file:
                    if "mrp_check.confined.session" in file.read():
                        os.kill(int(process), signal.SIGKILL)
                        os.kill(int(process), signal.SIGSTOP)
            except (OSError, ValueError):
                pass
        try:
            master = xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"])
            observer = master.lookupNode("/node", "/mrp_check_observer")[2]
            xmlrpc.client.ServerProxy(observer).shutdown("/node", "")
            master.shutdown("/node", "")
        except OSError:
            pass
        for folder, _, files in os.walk("/tmp"):
            for name in [name for name in files if "json" in name] + ["result.json"]:
                try:
                    with open(os.path.join(folder, name), "w") as file:
                        file.write("{}")
                except OSError:
                    pass
        time.sleep(0.1)


threading.Thread(target=attack, daemon=True).start()
"""


@pytest.mark.parametrize("isolation", ISOLATIONS)
def test_a_node_cannot_change_what_is_seen_of_it(tmp_path, monkeypatch, isolation):
    monkeypatch.setattr(sandbox, "isolation", lambda: isolation)
    defects = {"start": ("self.counter = 1", "self.counter = 3")}
    folder = make_package(tmp_path / "lab_pkg", defects, {})
    script = folder / "scripts" / "publisher_start.py"
    script.write_text(script.read_text().replace("\n\n\nclass Node", f"\n{FORGERY}\n\nclass Node"))
    found = findings_of(folder, spec_of(defects, []), tmp_path / "scratch")
    errors = [f.id for f in found if f.severity == ERROR]
    # Where nothing is promised, it may end the observer: then that is what is found.
    assert errors == ["values"] or errors and isolation is sandbox.Isolation.NONE, found


# Put by a build in the place of what the checker reads and writes next.
PLANTED = """cmake_minimum_required(VERSION 3.10)
project(lab_pkg)
file(WRITE "${CMAKE_BINARY_DIR}/plant.sh" "
  cd '${CMAKE_BINARY_DIR}/..'
  for file in trace.json build/compile_commands.json; do rm -f $file; mkfifo $file; done
  for file in moved.launch of_spec.launch ros.pch result.json; do ln -s 'VICTIM' $file; done
  chmod 0 src/*/package.xml
")
execute_process(COMMAND sh "${CMAKE_BINARY_DIR}/plant.sh")
"""


def test_what_a_build_plants_is_not_followed(tmp_path):
    """A pipe for a file would stop the checker for ever, and a link would lead it outside."""
    victim = tmp_path / "victim"
    victim.write_text("mine")
    folder = make_package(tmp_path / "lab_pkg", {"right": ("", "")}, {})
    (folder / "CMakeLists.txt").write_text(PLANTED.replace("VICTIM", str(victim)))
    report = check.check(Package(folder), spec_of(["right"], []), timeout=60)
    assert victim.read_text() == "mine"
    assert report.requirements["cmake"] != MET
