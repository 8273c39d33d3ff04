# SPDX-License-Identifier: BSD-3-Clause
"""What several tests of the checker use."""

import json
import os
import textwrap
import uuid

import pytest
from mrp_check import sandbox
from mrp_check.contract import resources
from mrp_check.sandbox import confine
from mrp_testing.process import processes_with


@pytest.fixture
def open_folders(tmp_path, tmp_path_factory):
    """Without namespaces, the user that a command runs as must be able to come to its folder."""
    for folder in (tmp_path, *tmp_path.parents):
        if folder.name.startswith("pytest-") or tmp_path_factory.getbasetemp() in folder.parents:
            folder.chmod(0o711)
    tmp_path_factory.getbasetemp().chmod(0o711)


@pytest.fixture
def programs(monkeypatch):
    """The names of the programs that run confined: a list that grows, and may be cleared."""
    names, run = [], confine.run

    def spied(command, *arguments, **options):
        words = command[4:] if command[:2] == ["bash", "-c"] else command  # what bash executes
        program = words[1] if words[0] == "/usr/bin/python3" else words[0]
        names.append(os.path.basename(program))
        return run(command, *arguments, **options)

    monkeypatch.setattr(confine, "run", spied)
    return names


@pytest.fixture
def report_schema():
    """The JSON schema of a report."""
    return json.loads((resources.folder("schema") / "report.json").read_text())


@pytest.fixture(params=["strongest", "plain"])
def confined(request, tmp_path):
    """Runs a Python program confined; checks afterwards that none of its processes is left."""
    token = f"attack-{uuid.uuid4().hex}"

    def run_program(program, **limits):
        folder = tmp_path / "scratch"
        folder.mkdir(exist_ok=True)
        return confine.run(
            ["/usr/bin/python3", "-c", textwrap.dedent(program), token],
            folder,
            limits=confine.Limits(**limits),
            namespaces=request.param == "strongest",
        )

    run_program.token = token
    run_program.scratch = tmp_path / "scratch"
    run_program.plain = (
        request.param == "plain" or sandbox.isolation() is not sandbox.Isolation.NAMESPACES
    )
    yield run_program
    assert not processes_with(token)
