# SPDX-License-Identifier: BSD-3-Clause
"""Runs `make labs` and `make lab`: every lab shows what labs.yaml says."""

import re
import signal
from xml.etree import ElementTree

import pytest
import yaml
from front_door import make
from lab import MARK, Run
from mrp_testing.ports import free_port
from mrp_testing.process import Process, processes_with
from mrp_testing.waiting import wait_until
from mrp_testing.workspace import WORKSPACE

FOLDER = WORKSPACE / "src" / "mrp_labs"
SECTIONS = yaml.safe_load((FOLDER / "labs.yaml").read_text())
LABS = {name: entry for labs in SECTIONS.values() for name, entry in labs.items()}
STEPS = {"start", "stop", "ends", "run", "wait", "look", "never"}
LAB = str(WORKSPACE / "tools" / "lab.py")


def own(folder):
    """Return variables of a lab's environment: a folder and a master's port of its own."""
    return {"TMPDIR": str(folder), "ROS_MASTER_URI": f"http://localhost:{free_port()}"}


@pytest.mark.quick
def test_list_has_every_lab_with_its_claim():
    launch_files = {path.stem: path.read_text() for path in FOLDER.glob("launch/*.launch")}
    more = f"{len(launch_files) - 10} more"
    printed = make("labs", "ALL=1").stdout
    assert sorted(re.findall(r"^    make lab NAME=(\w+)$", printed, re.MULTILINE)) == sorted(
        launch_files
    )
    assert printed.startswith("Ten to start with:\n\n")
    ten = make("labs").stdout
    assert ten.count("make lab NAME=") == 10 and printed.startswith(ten.split(more)[0])
    assert ten.endswith(f"\n{more}: make labs ALL=1\n")
    words = " ".join(printed.split())
    for name, text in launch_files.items():
        claim = re.match(r"<!-- (.*) -->\n", text).group(1)
        assert f"{claim} make lab NAME={name}" in words


@pytest.mark.quick
@pytest.mark.parametrize("name", LABS)
def test_entry_has_patterns_to_look_for_and_a_sum(name):
    entry = LABS[name]
    assert set(entry) <= {"look", "never", "hide", "steps", "sum up"}
    assert ("look" in entry) != ("steps" in entry)
    assert entry["sum up"].endswith(".")
    steps = entry.get("steps", [entry])
    assert any("look" in step for step in steps)
    for step in steps:
        assert step is entry or set(step) <= STEPS
        for key in {"look", "wait", "never"} & set(step):
            for pattern in [step[key]] if isinstance(step[key], str) else step[key]:
                re.compile(pattern)


@pytest.mark.quick
@pytest.mark.parametrize("path", sorted(FOLDER.glob("launch/*")), ids=lambda path: path.stem)
def test_launch_file_misspells_no_parameter(path):
    """A node ignores a parameter that it doesn't know: so it must ask for each that is set."""
    root = ElementTree.parse(path)
    programs = {node.get("type").removesuffix("$(arg ending)") for node in root.iter("node")}
    sources = "".join(
        source.read_text()
        for source in (*FOLDER.glob("src/*"), *FOLDER.glob("idioms/*"))
        if {source.name, source.stem} & programs
    )
    for param in root.iter("param"):
        name = param.get("name").removeprefix("~")
        relative = name.startswith("/") or param.get("name") == "robot_name"
        assert relative or re.search(rf'"~?{name}"', sources), name


@pytest.mark.quick
@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("lach", "there's no lab 'lach'. The closest: latch."),
        ("", "NAME is missing."),
        ("../x", "there's no lab '../x'."),
    ],
)
def test_unknown_name_says_which_labs_exist(name, found):
    with Process(LAB, name) as lab:
        assert lab.wait() == 1
    assert lab.lines == [
        f"error: expected make lab NAME=LAB; {found} All {len(LABS)}: make labs ALL=1"
    ]


@pytest.mark.quick
def test_what_the_twin_says_is_marked_once(capsys):
    lines = [
        f"[{n}.5] sub_{here} received {n} from pub_{there}"
        for n in (3, 4)
        for here in ("py", "cpp")
        for there in ("cpp", "py")
    ]
    with Run() as run:
        run.start("echo '" + "\n".join(lines) + "'")
        run.wait(["sub_py received [34] from pub_py", "sub_cpp received 4 from pub_py"], MARK)
    printed = capsys.readouterr().out.splitlines()
    assert [line for line in printed if line.endswith(MARK)] == [
        line + MARK for line in (*lines[:4], lines[-1])
    ]


@pytest.mark.quick
@pytest.mark.parametrize(
    ("ignored", "code"), [("INT", -signal.SIGTERM), ("INT TERM", -signal.SIGKILL)]
)
def test_program_that_ignores_ctrl_c_is_ended(ignored, code, capsys, monkeypatch):
    monkeypatch.setattr("lab.GRACE", 0.1)
    with Run() as run:
        program, _ = run.start(
            f"sh -c 'trap \"\" {ignored}; echo ready; while :; do sleep 1; done'"
        )
        run.wait("ready")
        run.end("sh")
    assert program.returncode == code
    printed = capsys.readouterr().out
    assert "0.1 s after SIGINT, it still runs: sh -c" in printed
    assert printed.endswith("So it is killed.\n") == (code == -signal.SIGKILL)


@pytest.mark.slow
@pytest.mark.parametrize("name", LABS)
def test_lab_shows_its_claim(name, tmp_path):
    """It marks each line of labs.yaml, prints none that must not come, sums up, and stops."""
    with Process(LAB, name, extra_env=own(tmp_path)) as lab:
        while lab.code is None:  # a lab may take long, but each line must come in time
            count = len(lab.lines)
            wait_until(lambda: len(lab.lines) > count or lab.code is not None, lambda: str(lab))
        assert lab.wait() == 0, str(lab)
    claim = (FOLDER / "launch" / f"{name}.launch").read_text().splitlines()[0]
    assert f"<!-- {lab.lines[0].removeprefix(name + ': ')} -->" == claim
    marked = [line.removesuffix("   <- here") for line in lab.lines if line.endswith("<- here")]
    steps = LABS[name].get("steps", [LABS[name]])
    for look in (step["look"] for step in steps if "look" in step):
        for pattern in [look] if isinstance(look, str) else look:
            assert any(re.search(pattern, line) for line in marked), pattern
    text = " ".join(" ".join(lab.lines).split())
    assert text.endswith("What you saw: " + LABS[name]["sum up"])
    assert processes_with(str(tmp_path)) == {}
    assert [*tmp_path.iterdir()] == []


@pytest.mark.slow
def test_lab_that_does_not_show_its_claim_fails(tmp_path):
    """A deadline that no node meets stands for a lab whose line never comes."""
    env = {**own(tmp_path), "MRP_TEST_DEADLINE": "0.2"}
    with Process(LAB, "latch", extra_env=env) as lab:
        assert lab.wait() == 1
    first = LABS["latch"]["look"][0]
    assert lab.lines[-1] == f"error: expected a line with {first!r} within 0 s"
    assert processes_with(str(tmp_path)) == {}
