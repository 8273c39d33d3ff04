# SPDX-License-Identifier: BSD-3-Clause
"""The package's launch file: what roslaunch makes of it, and the line of each of its nodes."""

from __future__ import annotations

import dataclasses
import pathlib
import re
import xml.parsers.expat
import xml.sax.saxutils
from typing import Iterable, List, Sequence

from mrp_check import sandbox
from mrp_check.confined import crossing, variables
from mrp_check.confined.launch_dump import Dump, Started
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import Finding
from mrp_check.contract.names import last_part, nearest
from mrp_check.contract.spec import Spec
from mrp_check.package.cmake import relative
from mrp_check.package.package import Package
from mrp_check.package.workspace import Workspace
from mrp_check.package.xml_file import Element, elements, xml_finding
from mrp_check.sandbox import confine

SECONDS = 180  # that loading a launch file may take
_OF_OTHERS = re.compile(rb"\b(command|textfile|binfile)\s*=")  # attributes of a <param>
_SAID = 500  # characters of what roslaunch's reader says when it fails


@dataclasses.dataclass
class Launch(Dump):
    """What roslaunch makes of a file; files are relative to the package, those of others left out.

    file: the one that it was asked about
    moved: what roslaunch makes of it inside another group, if it was asked about that, and can
    """

    file: str = ""
    moved: Launch | None = None

    def of_spec(self, spec: Spec) -> list[Started]:
        """Return the first node of each name of the spec; none if roslaunch cannot read it."""
        nodes = {} if self.error else {node.name: node for node in reversed(self.nodes)}
        return [nodes[name] for name in spec.nodes if name in nodes]

    def elements(self, package: Package) -> list[tuple[str, Element]]:
        """Return the (file, Element)s of the file and of what of the package it includes."""
        found = []
        for file in self.files or [self.file]:
            try:
                found += [(file, element) for element in elements(package.bytes(file))]
            except (xml.parsers.expat.ExpatError, OSError):
                continue
        return found


def find(package: Package, spec: Spec) -> str | None:
    """Return the path of the spec's launch file in the package, or None."""
    found = [path for path in package.files if last_part(path) == spec.launch.file]
    return min(found, key=lambda path: (not path.startswith("launch/"), path), default=None)


def readable(package: Package, spec: Spec) -> tuple[str | None, list[Finding]]:
    """Return (path of the launch file or None, the Findings that say why it cannot be loaded)."""
    if not spec.launch.file:
        return None, []
    path = find(package, spec)
    if path is None:
        others = package.of_kind("launch")
        near = nearest(spec.launch.file, [last_part(o) for o in others], 0)
        other = next((o for o in others if near and o.endswith(near)), None)
        return None, [
            Finding(
                "launch-file",
                f"The package has no launch file {spec.launch.file}."
                + (f" There's {other}." if other else ""),
                other,
                1 if other else None,
                expected=f"launch/{spec.launch.file}",
                seen=", ".join(others) or "no launch file",
                fix=f"Rename it to {spec.launch.file}."
                if other
                else "Write one, as the page shows.",
            )
        ]
    return path, problems(package, path)


def problems(package: Package, path: str) -> list[Finding]:
    """Return the Findings that say why a launch file is no XML."""
    try:
        elements(package.bytes(path))
    except xml.parsers.expat.ExpatError as error:
        return [xml_finding("launch-file", package, path, error, why="launch-xml")]
    return []


def load(workspace: Workspace, file: str) -> Launch:
    """Return the Launch of a file of the package; runs roslaunch's reader. Raises CannotCheck."""
    return _load(workspace, [workspace.package_folder / file], file)


def load_twice(workspace: Workspace, file: str) -> Launch:
    """Return the same, with what comes of the file inside another group."""
    path, target = workspace.given / "moved.launch", workspace.package_folder / file
    included = xml.sax.saxutils.quoteattr(str(target))
    path.write_text(
        f'<launch><group ns="check_moved"><include file={included}/></group></launch>\n'
    )
    # One start of the reader is most of its time.
    return _load(workspace, [target, path], file)


def _load(workspace: Workspace, paths: Sequence[pathlib.Path], file: str) -> Launch:
    reader = sandbox.code() / "launch_dump.py"
    command = ["/usr/bin/python3", str(reader), *map(str, paths)]
    env = {variables.PACKAGES: workspace.ros_packages}
    if _reads_more(workspace.package):
        done = workspace.run(*command, seconds=SECONDS, env=env)
    else:
        files = workspace.package.of_kind("launch")
        done = workspace.run_once(*command, of=files, seconds=SECONDS, env=env)
    try:
        first, *others = crossing.from_json(List[Dump], done.output)
    except ValueError as error:  # it may have been ended
        if done.ended_by is None:
            reason = done.errors.strip()[-_SAID:] or error
            raise CannotCheck(f"roslaunch's reader failed: {reason}") from None
        why = done.limit_text(confine.Limits(time=SECONDS))
        return Launch(f"reading it was ended: {why}", file=file)
    launch = _of_package(workspace, first, file)
    moved = [_of_package(workspace, other, file) for other in others if not other.error]
    launch.moved = moved[0] if moved else None
    return launch


def _of_package(workspace: Workspace, dump: Dump, file: str) -> Launch:
    launch, copy = Launch(**vars(dump), file=file), workspace.package_folder
    launch.error = launch.error.replace(f"{copy}/", "")
    for node in launch.nodes:
        node.file = relative(node.file or "", copy.resolve())
    _find_lines(workspace.package, launch.nodes)
    launch.files = [
        name for name in (relative(path, copy.resolve()) for path in launch.files) if name
    ]
    return launch


def _reads_more(package: Package) -> bool:
    """Return whether a launch file may take a parameter from a program, or from any file."""
    return any(_OF_OTHERS.search(package.bytes(path)) for path in package.of_kind("launch"))


def _find_lines(package: Package, nodes: Iterable[Started]) -> None:
    """Fill in the line of each node: its element, by what stands in it, else by its order."""
    taken = set()
    for node in nodes:
        if node.file is None:
            continue
        try:
            tags = [e for e in elements(package.bytes(node.file)) if e.tag == "node"]
        except xml.parsers.expat.ExpatError:
            continue

        def rank(element: Element, node: Started = node) -> tuple[bool, bool, bool]:
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
