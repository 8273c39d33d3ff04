# SPDX-License-Identifier: BSD-3-Clause
"""The launch file starts each node of the spec, by what the package has."""

from __future__ import annotations

import dataclasses
import os
import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import CERTAIN, HABIT, Finding
from mrp_check.contract.names import last_part, line_of, nearest
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.cmake import Model
from mrp_check.package.launch import Launch
from mrp_check.package.package import Package
from mrp_check.package.xml_file import elements
from mrp_check.run import evidence
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    yield from () if case.spec.is_contract else gone(case)
    launch = case.launch
    if not launch or launch.error:
        return
    asked = case.spec.nodes if case.spec.is_contract else ()
    others = [n for n in launch.nodes if n.name not in asked and n.package == case.package.name]
    for name in asked:
        found = [node for node in launch.nodes if node.name == name]
        if not found:
            yield _missing(case.package, launch, name, others)
        for node in found[:1]:
            yield from _can_start(case, node, name)
    for node in others:
        for finding in _can_start(case, node):
            finding.node = None if case.spec.is_contract else node.type
            yield finding
    own = _executables(case.package, case.model)
    for node in launch.nodes if not case.spec.is_contract else ():
        is_ros = node.package == case.package.name or uses.is_called_so(case.package, node.package)
        if node.type in own and not is_ros:
            finding = _other_package(case.package, case.model, node, None)
            yield dataclasses.replace(finding, certainty=HABIT)


def _missing(package: Package, launch: Launch, name: str, spare: list[Started]) -> Finding:
    """Return the Finding about a node that the launch file does not start.

    spare: what it starts of the package, and is no node of the spec
    """
    # What is started by another name has, most of all, the executable of that name.
    near = [n for n in spare if os.path.splitext(n.type)[0] == name]
    near = near or [n for n in spare if nearest(name, [n.name], 0.8)]
    if near:
        node = near[0]
        return Finding(
            "launch-nodes",
            f"The launch file starts {node.type} under the name {node.name}; expected {name}.",
            node.file,
            node.line,
            node=name,
            expected=f'name="{name}"',
            seen=f'name="{node.name}"',
            fix=f'Write name="{name}".',
        )
    tags = [e for e in elements(package.bytes(launch.file)) if e.tag in ("node", "group", "launch")]
    lines = [element.line for element in tags]
    return Finding(
        "launch-nodes",
        f"The launch file doesn't start the node {name}.",
        launch.file,
        lines[-1] if lines else 1,
        node=name,
        expected=f'a <node> with name="{name}"',
        seen=", ".join(n.name for n in launch.nodes) or "no node",
        fix=f'Add a <node> with name="{name}".',
    )


def _executables(package: Package, model: Model) -> set[str]:
    """Return the names that roslaunch can find in the package: built ones and scripts."""
    names = set(model.executables())
    names |= {last_part(script.path) for script in model.scripts}
    names |= {last_part(path) for path in package.of_kind("python")}
    others = (path for path in package.files if package.shebang(path))  # such as bash's
    return names | {last_part(path) for path in others if package.is_executable(path)}


def _can_start(case: Case, node: Started, spec_node: str | None = None) -> Iterator[Finding]:
    """Yield a finding if roslaunch cannot find what a <node> names."""
    package, model = case.package, case.model
    if node.package != package.name:
        if spec_node and not uses.is_installed(node.package):
            yield _other_package(package, model, node, spec_node)
        return
    names = _executables(package, model)
    # Where CMake failed, nobody knows what it would have made.
    if node.type in names or not model.complete:
        return
    stems = {os.path.splitext(name)[0]: name for name in names}
    near = stems.get(os.path.splitext(node.type)[0]) or nearest(node.type, names, 0.75)
    source = _source_of(package, model, node.type)
    if source and near is None:
        yield _not_built(model, node, source, spec_node)
        return
    yield Finding(
        "launch-nodes",
        f"The launch file starts {node.type}, but the package has no executable of that name."
        + (f" It has {near}." if near else ""),
        node.file,
        node.line,
        node=spec_node,
        expected=f'type="{near}"' if near else "the name of an executable or a script",
        seen=f'type="{node.type}"',
        fix=f'Write type="{near}".' if near else "Name an executable that is built.",
        why="launch-node-not-found",
    )


def _other_package(package: Package, model: Model, node: Started, spec_node: str | None) -> Finding:
    line = package.find_line("package.xml", "<name>", 1)
    # CMakeLists.txt says the same: then package.xml is wrong, which has been said.
    same = model.project and model.project[0] == node.package
    return Finding(
        "package-name",
        f"The launch file looks for {node.type} in the package {node.package};"
        f" package.xml calls this package {package.name} (line {line}).",
        node.file,
        node.line,
        node=spec_node,
        expected=f'pkg="{package.name}"',
        seen=f'pkg="{node.package}"',
        fix=f'Write pkg="{package.name}".',
        consequence_of="package-name" if same else None,
    )


def _not_built(model: Model, node: Started, source: str, spec_node: str | None) -> Finding:
    return Finding(
        "targets",
        f"The launch file starts {node.type}, but CMakeLists.txt builds no executable of that"
        f" name: no add_executable() names {source}.",
        "CMakeLists.txt",
        _targets_line(model),
        node=spec_node,
        expected=f"add_executable({node.type} {source})",
        seen=", ".join(model.executables()) or "no executable",
        fix=f"Add add_executable({node.type} {source}), and link it with ${{catkin_LIBRARIES}}.",
    )


def _source_of(package: Package, model: Model, name: str) -> str | None:
    """Return a C++ source that no target is made of and that is called like the executable."""
    built = {source for target in model.targets.values() for source in target.sources}
    spare = [path for path in package.of_kind("cpp") if path not in built]
    for path in spare:
        if os.path.splitext(last_part(path))[0] == name:
            return path
    return spare[0] if len(spare) == 1 else None


def _targets_line(model: Model) -> int:
    lines = [target.line for target in model.targets.values() if target.file == "CMakeLists.txt"]
    return max(lines) if lines else model.catkin_package.line if model.catkin_package else 1


# What stands in the file -> what to say of it, how severe it is, what to write for it, and which
# word the file has, too.
_GONE = {
    r"\btype\s*=\s*\"(state_publisher)\"": (
        "robot_state_publisher no longer has an executable state_publisher, so roslaunch can't"
        " start it",
        CERTAIN,
        "robot_state_publisher",
        "",
    ),
    r"\(find xacro\)/(xacro\.py)\b": (
        "xacro no longer has an xacro.py, so roslaunch can't load the file",
        CERTAIN,
        "xacro",
        "",
    ),
    r"\bname\s*=\s*\"(use_gui)\"": (
        "joint_state_publisher no longer reads use_gui, so no window with sliders appears",
        HABIT,
        "a node of type joint_state_publisher_gui",
        "joint_state_publisher",
    ),
}


def gone(case: Case) -> Iterator[Finding]:
    for file in case.package.of_kind("launch"):
        text = uses.code(case.package, file)
        for shape, (sentence, certainty, instead, beside) in _GONE.items():
            for match in re.finditer(shape, text) if beside in text else ():
                yield Finding(
                    "launch-nodes",
                    f"{sentence} (it went with Noetic).",
                    file,
                    line_of(match, 1),
                    certainty,
                    expected=instead,
                    seen=match[1],
                    fix=f"Write {instead} for {match[1]}.",
                )


RULE = Rule(
    stage="files",
    needs=("model", "launch"),
    findings=_findings,
    requirements={
        "launch-nodes": Requirement(
            "The launch file starts each node under its name", "launching", evidence.launch
        )
    },
    also=("package-name", "targets"),
)
