# SPDX-License-Identifier: BSD-3-Clause
"""The nodes of any package, by what it makes executables of: they stand in for a contract."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.contract import spec as specs
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Spec
from mrp_check.package.cmake import Model
from mrp_check.package.package import Package

# What a program does that is a node, or was meant to be one.
_ROSPY = re.compile(
    r"^[^#\n]*\b(?:init_node|rospy\.(?:Publisher|Subscriber|Service|ServiceProxy))\s*\(", re.M
)
_ROSCPP = re.compile(r"\bros::(?:init\b|NodeHandle\b)")
_TESTS = re.compile(r"^[ \t]*(?:from|import)[ \t]+(?:rostest|rosunit|unittest)\b", re.M)
_SECONDS = 5  # in which a node has to end on Ctrl-C
# rospy's own, and no method of that name.
_INIT = re.compile(r"^[^#\n]*(?:\br\w*\.|(?<![\w.])(?<!def ))init_node\s*\(", re.M)


def spec(package: Package, model: Model) -> Spec:
    """Return a Spec with each node of a package, by its executable's name, and nothing more."""
    nodes = {node.name: node for node in [*_python(package, model), *_cpp(package, model)]}
    end = specs.Shutdown(seconds=_SECONDS)
    return Spec("no contract", {}, nodes, specs.Launch(""), end, is_contract=False)


def is_script(package: Package, path: str) -> bool:
    """Return whether a Python file is a node that can be started, not one that others import."""
    if uses.is_test(path) or path == "setup.py" or not _ROSPY.search(package.text(path)):
        return False
    if _TESTS.search(package.text(path)):
        return False
    if not _INIT.search(package.text(path)) and _is_imported(package, path):
        return False
    if package.shebang(path) or package.is_executable(path) and not _is_module(package, path):
        return True
    # In a Python package, it's a module that a script elsewhere imports and starts.
    return not _is_module(package, path) and bool(_INIT.search(package.text(path)))


def is_tool(package: Package, path: str) -> bool:
    """Return whether a Python file is no node, and rosrun finds it all the same."""
    starts = package.shebang(path) and package.is_executable(path)
    if path.endswith(".cfg"):  # dynamic_reconfigure runs it, by the right Python
        return False
    return bool(starts) and not _is_module(package, path) and not _is_imported(package, path)


def _is_module(package: Package, path: str) -> bool:
    """Return whether a file is in a folder that Python imports as a package."""
    return f"{path.rpartition('/')[0]}/__init__.py" in package.files


def _is_imported(package: Package, path: str) -> bool:
    """Return whether another file of the package imports this one as a module."""
    stem = re.escape(last_part(path).split(".")[0])
    imports = re.compile(rf"^[ \t]*(?:from|import)\b[^\n]*\b{stem}\b", re.M)
    return any(imports.search(package.text(o)) for o in package.of_kind("python") if o != path)


def _python(package: Package, model: Model) -> Iterator[specs.NodeSpec]:
    for path in package.of_kind("python"):
        if is_script(package, path):
            name = last_part(path)
            yield specs.NodeSpec(name, "python", file=path, executable=name)


def _cpp(package: Package, model: Model) -> Iterator[specs.NodeSpec]:
    for name, target in model.executables().items():
        sources = [file for file in model.all_sources(target) if file in package.files]
        is_node = any(_ROSCPP.search(package.text(file)) for file in sources)
        if is_node and not all(map(uses.is_test, target.sources or sources)):
            yield specs.NodeSpec(name, "cpp", executable=name)
