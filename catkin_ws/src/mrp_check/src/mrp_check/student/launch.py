# SPDX-License-Identifier: BSD-3-Clause
"""The package's launch file: what roslaunch makes of it, and the line of each of its nodes."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import xml.parsers.expat

from mrp_check import confine
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import Finding
from mrp_check.contract.words import nearest
from mrp_check.student.xml_file import elements, xml_finding

SECONDS = 180  # that loading a launch file may take


@dataclasses.dataclass
class Started:
    """A node that the launch file starts; file is relative to the package, or None."""

    package: str
    type: str
    name: str
    namespace: str
    output: str
    remaps: list
    env: list
    arguments: str
    prefix: str
    file: str | None
    line: int | None = None

    @property
    def path(self):
        return self.namespace.rstrip("/") + "/" + self.name


@dataclasses.dataclass
class Launch:
    """What roslaunch makes of a file. error: what it said instead, or an empty text."""

    file: str
    error: str
    nodes: list
    warnings: list
    files: list
    params: dict = dataclasses.field(default_factory=dict)

    def of_spec(self, spec):
        """Return the first node of each name of the spec; none if roslaunch cannot read it."""
        nodes = {} if self.error else {node.name: node for node in reversed(self.nodes)}
        return [nodes[name] for name in spec.nodes if name in nodes]

    def elements(self, package):
        """Return the (file, Element)s of the file and of what of the package it includes."""
        found = []
        for file in self.files or [self.file]:
            try:
                found += [(file, element) for element in elements(package.bytes(file))]
            except (xml.parsers.expat.ExpatError, OSError):
                continue
        return found


def find(package, spec):
    """Return the path of the spec's launch file in the package, or None."""
    found = [path for path in package.files if path.rsplit("/", 1)[-1] == spec.launch.file]
    return min(found, key=lambda path: (not path.startswith("launch/"), path), default=None)


def readable(package, spec):
    """Return (path of the launch file or None, the Findings that say why it cannot be loaded)."""
    path = find(package, spec)
    if path is None:
        others = package.of_kind("launch")
        near = nearest(spec.launch.file, [o.rsplit("/", 1)[-1] for o in others], 0)
        other = next((o for o in others if near and o.endswith(near)), None)
        return None, [
            Finding(
                "launch-file",
                f"The package has no launch file {spec.launch.file}."
                + (f" There is {other}." if other else ""),
                other,
                1 if other else None,
                expected=f"launch/{spec.launch.file}",
                seen=", ".join(others) or "no launch file",
                fix=f"Rename it to {spec.launch.file}."
                if other
                else "Write one, as the page shows.",
            )
        ]
    try:
        elements(package.bytes(path))
    except xml.parsers.expat.ExpatError as error:
        return path, [xml_finding("launch-file", package, path, error)]
    return path, []


def load(package, workspace, file, *arguments):
    """Return the Launch of a file of the package. Runs roslaunch's own reader, confined."""
    copy = workspace.package_folder
    done = workspace.catkin.run(
        "/usr/bin/python3",
        str(confine.code() / "launch_dump.py"),
        str(copy / file),
        *arguments,
        time=SECONDS,
        ROS_PACKAGE_PATH=package_path(workspace),
    )
    try:
        data = json.loads(done.output)
    except ValueError:
        if done.ended_by is None:
            raise CannotCheck(f"roslaunch's reader failed: {done.errors.strip()[-500:]}") from None
        why = done.limit_text(confine.Limits(time=SECONDS))
        return Launch(file, f"reading it was ended: {why}", [], [], [])
    nodes = []
    for entry in data["nodes"]:
        path = _relative(entry["file"], copy)
        node = Started(
            **{**entry, "remaps": [tuple(pair) for pair in entry["remaps"]], "file": path}
        )
        nodes.append(node)
    _find_lines(package, nodes)
    files = [name for name in (_relative(f, copy) for f in data["files"]) if name]
    return Launch(
        file, data["error"].replace(f"{copy}/", ""), nodes, data["warnings"], files, data["params"]
    )


def package_path(workspace):
    """Return ROS_PACKAGE_PATH for the copy and this machine's own packages."""
    folders = [workspace.folder / "src", "/opt/ros/noetic/share", "/usr/share"]
    return ":".join(str(folder) for folder in folders if pathlib.Path(folder).is_dir())


def _relative(path, folder):
    try:
        return pathlib.Path(path).relative_to(folder.resolve()).as_posix() if path else None
    except ValueError:
        return None


def _find_lines(package, nodes):
    """Fill in the line of each node: its element, by what stands in it, else by its order."""
    taken = set()
    for node in nodes:
        if node.file is None:
            continue
        try:
            tags = [e for e in elements(package.bytes(node.file)) if e.tag == "node"]
        except xml.parsers.expat.ExpatError:
            continue

        def rank(element, node=node):
            attributes = element.attributes
            return (
                (node.file, element.line, id(element.tag)) in taken,
                attributes.get("name") != node.name,
                attributes.get("type") != node.type,
            )

        if tags:
            best = min(tags, key=rank)
            taken.add((node.file, best.line, id(best.tag)))
            node.line = best.line
