# SPDX-License-Identifier: BSD-3-Clause
"""Runs the nodes of a package that no contract describes, and keeps what was seen.

Each by itself, as rosrun does, and then as each launch file starts them; if there are some that no
launch file starts, all run together as well, with the parameters and the names of the launch files.
"""

from __future__ import annotations

import dataclasses
import pathlib
import re
from typing import Mapping

from mrp_check import sandbox
from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind
from mrp_check.confined.plans import LaunchNode
from mrp_check.confined.seen import DirectResult, LaunchResult
from mrp_check.contract.spec import Spec
from mrp_check.package.launch import Launch
from mrp_check.package.workspace import Workspace
from mrp_check.run import observing
from mrp_check.run.observing import Launched, Observed
from mrp_check.run.sessions import Sessions

_SECONDS = 8  # in which the nodes are watched, once all are up
_MOST = 6  # launch files that are run
_BUILDING = 60  # seconds


def observe(
    sessions: Sessions, spec: Spec, launches: list[Launch], facts: Facts, enough: int
) -> Observed:
    """Run the nodes, and return what was seen. Raises CannotCheck.

    enough: messages of each publisher
    """
    result, workspace = Observed(), sessions.workspace
    loaded = {launch.file: launch for launch in launches if not launch.error}
    own: dict[str, dict[str, str]] = {}  # launch file -> full name -> node of the spec
    for file, launch in loaded.items():
        found = [n for n in launch.nodes if n.package == workspace.package.name]
        found = [started for started in found if started.type in spec.nodes]
        for started in found:
            result.started.setdefault(started.type, started)
        if not any(file in other.files for other in loaded.values() if other is not launch):
            own[file] = {started.path: started.type for started in found}
    params = {name: value for launch in launches for name, value in launch.params.items()}
    planner = observing.planner_of(workspace, spec, params, facts, result)
    if not planner:
        return result
    if any(facts.of(name, Kind.SUBSCRIBER) for name in spec.nodes):
        planner.preload = _preloaded(workspace)
    direct = planner.direct()
    direct.common.seconds = _SECONDS
    for key, node in direct.nodes.items():
        # Its launch file may give it parameters under this name.
        started_as = result.started.get(key)
        names = [f"__name:={started_as.name}"] if started_as else []
        direct.nodes[key] = dataclasses.replace(
            node, publishes=enough, command=[*node.command, *names]
        )
    problems = result.problems
    ran = workspace.submit(sessions.result, direct, DirectResult, problems)
    files = {file: nodes for file, nodes in own.items() if nodes and file}
    runs = [(file, workspace.package_folder / file, files[file]) for file in list(files)[:_MOST]]
    if len(result.executables) > 1 and result.executables.keys() - result.started.keys():
        made = _made(facts, result)
        runs.append(("", planner.write_launch_file_of_all(made), made))
    for file, path, nodes in runs:
        plan = planner.of_file(path, _SECONDS, _watched(workspace, facts, nodes), enough)
        seen = sessions.result(plan, LaunchResult, problems)
        if seen:
            result.launches.append(Launched(file, nodes, seen))
    result.direct = ran.result()
    return result


def _preloaded(workspace: Workspace) -> pathlib.Path | None:
    """Build the library of hook/callbacks.cpp; return None if that is not possible."""
    library = workspace.folder / "callbacks.so"
    sanitizes = workspace.package.first_match(workspace.package.of_kind("cmake"), "-fsanitize")
    if not workspace.package.of_kind("cpp") or sanitizes:  # a sanitizer has to be loaded first
        return None
    source = str(sandbox.code() / "hook" / "callbacks.cpp")
    done = workspace.run("g++", "-shared", "-fPIC", "-o", str(library), source, seconds=_BUILDING)
    return library if done.code == 0 else None


def _made(facts: Facts, result: Observed) -> dict[str, str]:
    """Return full name -> node of the spec, as a launch file names it or as it names itself; by its
    executable, if its own name isn't known, or is that of another one."""
    found = {started.path: name for name, started in result.started.items()}
    found = {path: name for path, name in found.items() if name in result.executables}
    for name in sorted(result.executables.keys() - {*found.values()}):
        own = next((place.text for place in facts.of(name, Kind.INIT) if place.text), "")
        path = "/" + re.sub(r"\W", "_", own.lstrip("/~"))
        if path == "/" or path in found:
            path = "/" + re.sub(r"\W", "_", name)
        found[path] = name
    return found


def _watched(workspace: Workspace, facts: Facts, nodes: Mapping[str, str]) -> list[LaunchNode]:
    package = workspace.package
    # One that asks a service is waited for as one that publishes: until it has ended, or is silent.
    busy = {
        name: bool(facts.of(name, Kind.PUBLISH)) or bool(facts.of(name, Kind.ASKS))
        for name in nodes.values()
    }
    is_cpp = {
        name: any(package.kind(file) == "cpp" for file in facts.sources.get(name, ()))
        for name in nodes.values()
    }
    return [
        LaunchNode(path, f"{package.name}/{name}", busy[name], None, None, 0, is_cpp[name])
        for path, name in nodes.items()
    ]
