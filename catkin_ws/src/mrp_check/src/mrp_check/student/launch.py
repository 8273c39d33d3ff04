# SPDX-License-Identifier: BSD-3-Clause
"""The package's launch file: what roslaunch makes of it, and the line of each of its elements."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import xml.parsers.expat

from mrp_check import confine
from mrp_check.contract.errors import CannotCheck

_DUMP = pathlib.Path(__file__).resolve().parents[1] / "confined" / "launch_dump.py"
SECONDS = 180  # that loading a launch file may take


@dataclasses.dataclass
class Element:
    """One XML element; line: where it begins."""

    tag: str
    attributes: dict
    line: int
    parents: list


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


def elements(data):
    """Return the Elements of an XML file's bytes. Raises xml.parsers.expat.ExpatError."""
    found, stack = [], []
    parser = xml.parsers.expat.ParserCreate()

    def start(tag, attributes):
        element = Element(tag, attributes, parser.CurrentLineNumber, list(stack))
        found.append(element)
        stack.append(element)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda tag: stack.pop()
    parser.Parse(data, True)
    return found


def find(package, spec):
    """Return the path of the spec's launch file in the package, or None."""
    found = [path for path in package.files if path.rsplit("/", 1)[-1] == spec.launch.file]
    return min(found, key=lambda path: (not path.startswith("launch/"), path), default=None)


def load(package, workspace, file, *arguments):
    """Return the Launch of a file of the package. Runs roslaunch's own reader, confined."""
    copy = workspace.package_folder
    done = workspace.catkin.run(
        "/usr/bin/python3",
        str(_DUMP),
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
