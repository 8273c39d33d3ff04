#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the map in .github/CONTRIBUTING.md again, in Mermaid's language, which GitHub shows.

Arrows between packages are those of package.xml, dotted for a test's. Arrows between the checker's
folders are its imports, without those that follow from others.
"""

import ast
import pathlib
import re
import xml.etree.ElementTree as ElementTree

SOURCES = pathlib.Path(__file__).resolve().parents[1] / "src"
CHECKER = SOURCES / "mrp_check" / "src" / "mrp_check"
CONTRIBUTING = SOURCES.parents[1] / ".github" / "CONTRIBUTING.md"
PICTURE = re.compile(r"(?<=```mermaid\n).*?(?=```)", re.DOTALL)


def packages():
    """Yield an arrow from each package to each of ours that it depends on."""
    for path in sorted(SOURCES.glob("*/package.xml")):
        found = {}
        for element in ElementTree.parse(path).getroot():
            if "depend" in element.tag and element.text.startswith("mrp"):
                found.setdefault(element.text, set()).add(element.tag)
        for name, tags in sorted(found.items()):
            yield f"{path.parent.name} {'-.->' if tags == {'test_depend'} else '-->'} {name}"


def imports():
    """Return folder of the checker -> the folders that its modules import."""
    folders = {path.parent.name for path in CHECKER.glob("*/__init__.py")}
    found = {folder: set() for folder in sorted(folders)}
    for folder, imported in found.items():
        for path in (CHECKER / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ImportFrom):
                    names = (f"{node.module}.{name.name}" for name in node.names)
                    imported |= {name.split(".")[1] for name in names}
        imported &= folders - {folder}
    return found


def reachable(graph, folder):
    """Return all folders to which arrows lead from one."""
    return graph[folder].union(*(reachable(graph, other) for other in graph[folder]))


def folders():
    """Yield the arrows between the checker's folders, but those that others imply."""
    graph = imports()
    for folder, imported in graph.items():
        implied = set().union(*(reachable(graph, other) for other in imported))
        yield from (f"{folder} --> {other}" for other in sorted(imported - implied))


def picture():
    lines = ["graph TD", *packages(), "subgraph inside[in mrp_check]", *folders(), "end"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    CONTRIBUTING.write_text(PICTURE.sub(picture(), CONTRIBUTING.read_text()))
