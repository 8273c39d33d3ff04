# SPDX-License-Identifier: BSD-3-Clause
"""Reads the settings for VS Code and for the Dev Container."""

import json
import pathlib
import re

import pytest
from mrp_testing.workspace import ROOT, WORKSPACE

pytestmark = pytest.mark.quick


def vscode(name):
    return json.loads((ROOT / ".vscode" / f"{name}.json").read_text())


def test_vscode_has_the_settings_of_pyright():
    """It looks for pyproject.toml only in the folder that it has opened."""
    text = (WORKSPACE / "pyproject.toml").read_text()
    section = text.split("[tool.pyright]\n")[1].split("\n[")[0]
    lines = [line.split(" = ") for line in section.splitlines() if not line.startswith("#")]
    wanted = {key: json.loads(value) for key, value in lines}
    settings = vscode("settings")
    paths = [str(pathlib.Path("catkin_ws", path)) for path in wanted["extraPaths"]]
    assert settings["python.analysis.extraPaths"] == paths
    assert settings["python.analysis.typeCheckingMode"] == wanted["typeCheckingMode"]
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
