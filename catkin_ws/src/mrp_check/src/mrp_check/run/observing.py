# SPDX-License-Identifier: BSD-3-Clause
"""Runs the package's nodes, twice at the same time, and keeps what was seen for run and stop.

Once as its launch file starts them; and once each by itself, as rosrun does, in a namespace of its
own: there each subscriber is sent values, each Python publisher is run again near the end of its
numbers, and each is ended by the contract's signal.
"""

from __future__ import annotations

import dataclasses
import os
import pathlib
import re
from typing import Iterable

from mrp_check.code.facts import Facts
from mrp_check.confined import messages
from mrp_check.confined.launch_dump import Started
from mrp_check.confined.seen import Alone, DirectResult, LaunchResult, Log
from mrp_check.contract.names import last_part
from mrp_check.contract.resources import SHARES
from mrp_check.contract.spec import NodeSpec, Spec
from mrp_check.package.launch import Launch
from mrp_check.package.workspace import Workspace
from mrp_check.run.planning import Planner
from mrp_check.run.sessions import Sessions, too_busy

# What roslaunch says; only of what has died it says a code.
_DIED = re.compile(
    r"\[(?P<name>\S+)-\d+\] process has "
    r"(?:died \[pid \d+, exit code (?P<code>-?\d+)|finished cleanly)"
)


def ends(lines: Iterable[str]) -> dict[str, int]:
    """Return full name -> exit code of each node whose end roslaunch tells of in these lines: of
    one that was started again, the first."""
    found = [match for match in map(_DIED.search, lines) if match]
    return {f"/{match['name']}": int(match["code"] or 0) for match in reversed(found)}


@dataclasses.dataclass
class Launched:
    """What came of the nodes under one of several launch files.

    file: relative to the package; empty of one that the checker has made
    nodes: full name -> node of the spec
    """

    file: str
    nodes: dict[str, str]
    seen: LaunchResult

    @property
    def where(self) -> str:
        """In the words of a message."""
        return f"under {self.file}" if self.file else "together with the other nodes"

    def kept_up(self) -> set[str]:
        """Return the nodes of the spec that came up under a launch file, and did not end."""
        seen, ended = self.seen.seen, self.died()
        paths = {entry.node for entry in [*seen.publications, *seen.subscriptions, *seen.services]}
        up = {name for path, name in self.nodes.items() if path in paths and name not in ended}
        return up if self.file else set()

    def logs(self, path: str) -> list[Log]:
        """Return what the node of a full name logged before it was asked to end."""
        logs, asked = self.seen.seen.logs, self.seen.asked
        return [log for log in logs if log.node == path and log.time < asked]

    def died(self) -> dict[str, int]:
        """Return node of the spec -> exit code, of those that ended by themselves."""
        codes = ends(self.seen.until_asked())
        return {name: codes[path] for path, name in self.nodes.items() if path in codes}


@dataclasses.dataclass
class Observed:
    """What was seen.

    launch: what came of the nodes under the launch file, or None if it could not be had
    direct: the same of each node by itself
    started: node of the spec -> what of the launch file starts it
    executables: node of the spec -> path of its executable
    moved: what roslaunch makes of the launch file inside another group, or None
    launches: the same as launch, of each launch file of a package without a contract
    problems: sentences on what could not be observed, and why
    """

    launch: LaunchResult | None = None
    direct: DirectResult | None = None
    started: dict[str, Started] = dataclasses.field(default_factory=dict)
    executables: dict[str, pathlib.Path] = dataclasses.field(default_factory=dict)
    moved: Launch | None = None
    launches: list[Launched] = dataclasses.field(default_factory=list)
    problems: list[str] = dataclasses.field(default_factory=list)

    @property
    def own_launch(self) -> bool:
        """Whether the launch file is the package's, not one made from the spec."""
        return bool(self.started)

    def alone(self, key: str | None) -> Alone | None:
        """Return what was seen of a node of the plan for each by itself, or None."""
        return self.direct.nodes.get(key) if self.direct and key else None


def observe(sessions: Sessions, spec: Spec, launch: Launch | None, facts: Facts) -> Observed:
    """Run the nodes, and return what was seen. Raises CannotCheck.

    launch: what roslaunch makes of the package's launch file
    """
    result, file, workspace = Observed(), None, sessions.workspace
    if launch and not launch.error:
        result.started = {node.name: node for node in launch.nodes if node.name in spec.nodes}
    if launch and result.started:
        file, result.moved = workspace.package_folder / launch.file, launch.moved
    planner = planner_of(workspace, spec, launch.params if launch else {}, facts, result)
    if not planner:
        result.problems.append("none of the nodes has an executable to be run")
        return result
    under, problems = planner.launch(file), result.problems
    # What lasts longest begins first.
    direct = workspace.submit(sessions.result, planner.direct(), DirectResult, problems)
    result.launch = sessions.result(under, LaunchResult, problems)
    result.direct = direct.result()
    if result.launch and result.launch.ending == "most":
        # Not the package's fault: one that never comes up is idle, or uses up its time.
        raise too_busy(under.common.most)
    return result


def planner_of(
    workspace: Workspace, spec: Spec, params: dict[str, object], facts: Facts, result: Observed
) -> Planner | None:
    """Look for the nodes' executables. Return the Planner of their runs, or None without one.

    params: those of the launch files
    """
    for name, node in spec.nodes.items():
        started, files = result.started.get(name), facts.sources.get(name, [])
        path = executable_of(workspace, node, started, files)
        if path:
            result.executables[name] = path
    if not result.executables:
        return None
    workspace.progress("running the nodes")
    package = workspace.package
    folders = sorted(
        {(package.root / file).parent for file in package.of_kind("message", "service")}
    )
    own = messages.definitions(package.name, folders, SHARES)
    known = result.executables, result.started, params
    return Planner(workspace, spec, *known, workspace.environment.result(), own)


def executable_of(
    workspace: Workspace, node: NodeSpec, started: Started | None, files: list[str]
) -> pathlib.Path | None:
    """Return the path of a node's executable as rosrun finds it, or None.

    files: the node's sources
    """
    package = workspace.package
    names = [started.type] if started and started.package == package.name else []
    names += [node.executable] if node.executable else []
    names += [last_part(file) for file in files if file.endswith(".py")]
    # A script is no stand-in for a C++ node of its name that could not be built.
    names += [node.name, *([] if node.language == "cpp" else [f"{node.name}.py"])]
    for name in names:
        built = workspace.folder / "devel" / "lib" / package.name / name
        scripts = [path for path in package.files if last_part(path) == name]
        for path in (built, *(workspace.package_folder / path for path in scripts)):
            if path.is_file() and os.access(path, os.X_OK):
                return path
    return None
