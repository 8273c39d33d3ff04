# SPDX-License-Identifier: BSD-3-Clause
"""Reads the stubs that make build writes for editors, and the settings that lead to them."""

import json
import re
import subprocess

import pytest
from mrp_testing.workspace import ROOT, WORKSPACE

pytestmark = pytest.mark.quick

MESSAGE = """# A comment
int8 LIMIT=3
std_msgs/Header header
bool[] flags
uint8[] raw
float64[3] position
time stamp
duration wait
Other other
string text
"""

STUB = """# Made by make build from the .msg or .srv files: do not edit.
import genpy
import one.msg
import std_msgs.msg

class One(genpy.Message):
    LIMIT: int
    header: std_msgs.msg.Header
    flags: list[bool]
    raw: bytes
    position: list[float]
    stamp: genpy.Time
    wait: genpy.Duration
    other: one.msg.Other
    text: str
    def __init__(self, header: std_msgs.msg.Header = ..., flags: list[bool] = ..., \
raw: bytes = ..., position: list[float] = ..., stamp: genpy.Time = ..., \
wait: genpy.Duration = ..., other: one.msg.Other = ..., text: str = ...) -> None: ...

class Other(genpy.Message):
    value: int
    def __init__(self, value: int = ...) -> None: ...
"""

SERVICE = """class AddRequest(genpy.Message):
    a: int
    def __init__(self, a: int = ...) -> None: ...

class AddResponse(genpy.Message):
    sum: float
    def __init__(self, sum: float = ...) -> None: ...

class Add: ...
"""


def test_stubs_have_each_field_with_its_type(tmp_path):
    package = tmp_path / "one"
    for kind in ("msg", "srv"):
        (package / kind).mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>one</name></package>")
    (package / "msg" / "One.msg").write_text(MESSAGE)
    (package / "msg" / "Other.msg").write_text("uint32 value\n")
    (package / "srv" / "Add.srv").write_text("int32 a\n---\nfloat32 sum\n")
    stubs = tmp_path / "stubs"
    subprocess.run(
        [WORKSPACE / "tools" / "make_stubs.py", stubs],
        env={"PATH": "/usr/bin:/bin", "ROS_PACKAGE_PATH": str(tmp_path)},
        check=True,
    )
    assert (stubs / "one" / "msg" / "__init__.pyi").read_text() == STUB
    assert (stubs / "one" / "srv" / "__init__.pyi").read_text().endswith("\n\n" + SERVICE)


def vscode(name):
    return json.loads((ROOT / ".vscode" / f"{name}.json").read_text())


def test_vscode_has_the_settings_of_pyright():
    """It looks for pyproject.toml only in the folder that it has opened."""
    text = (WORKSPACE / "pyproject.toml").read_text()
    section = text.split("[tool.pyright]\n")[1].split("\n[")[0]
    lines = [line.split(" = ") for line in section.splitlines() if not line.startswith("#")]
    wanted = {key: json.loads(value) for key, value in lines}
    settings = vscode("settings")
    assert settings["python.analysis.stubPath"] == "catkin_ws/" + wanted["stubPath"]
    for name in ("extraPaths", "typeCheckingMode"):
        assert settings["python.analysis." + name] == wanted[name]
    overrides = settings["python.analysis.diagnosticSeverityOverrides"]
    assert overrides == {k: v for k, v in wanted.items() if k.startswith("report")}


def test_tasks_and_launches_name_what_there_is():
    commands = [task["command"] for task in vscode("tasks")["tasks"]]
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert [re.match("make ([a-z-]+)", command)[1] for command in commands] == [
        target for target in ("build", "run", "test", "check") if target in targets
    ]
    (node,) = vscode("launch")["inputs"]
    sources = (WORKSPACE / "src" / "mrp" / "src").glob("*.cpp")
    assert sorted(node["options"]) == sorted(path.stem for path in sources)


def test_dev_container_is_a_stage_of_the_image_with_the_same_extensions():
    container = json.loads((ROOT / ".devcontainer" / "devcontainer.json").read_text())
    stages = re.findall(
        r"^FROM .* AS (\w+)$", (ROOT / "docker/Dockerfile").read_text(), re.MULTILINE
    )
    assert stages[-1] == container["build"]["target"]
    extensions = container["customizations"]["vscode"]["extensions"]
    assert extensions == vscode("extensions")["recommendations"]
