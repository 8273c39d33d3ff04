# SPDX-License-Identifier: BSD-3-Clause
"""The nodes of any package, by what it makes executables of: they stand in for a contract."""

from __future__ import annotations

import ast
import functools
import re
from typing import Iterator

from mrp_check.code import uses
from mrp_check.code.python_source import Source
from mrp_check.contract import spec as specs
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Spec
from mrp_check.package.cmake import Model
from mrp_check.package.package import Package

# What a program that is a node, or was meant to be one, calls of rospy.
_OF_NODES = {"init_node", "Publisher", "Subscriber", "Service", "ServiceProxy"}
# The same in what Python 3 can't read: it counts as a node, so that this is reported.
_UNREAD = re.compile(
    r"^[^#\n]*\b(init_node|rospy\.(?:Publisher|Subscriber|Service|ServiceProxy))\s*\(", re.M
)
_TESTS = {"rostest", "rosunit", "unittest"}
# Which programs are nodes is asked before the messages are built, and without those, clang can't
# read a source.
_ROSCPP = re.compile(r"\bros\s*::\s*(?:init\b|NodeHandle\b)")
_SECONDS = 5  # in which a node has to end on Ctrl-C


def spec(package: Package, model: Model) -> Spec:
    """Return a Spec with each node of a package, by its executable's name, and nothing more."""
    nodes = {node.name: node for node in [*_python(package, model), *_cpp(package, model)]}
    end = specs.Shutdown(seconds=_SECONDS)
    return Spec("no contract", {}, nodes, specs.LaunchSpec(""), end, is_contract=False)


def is_script(package: Package, path: str) -> bool:
    """Return whether a Python file is a node that can be started, not one that others import."""
    called = _called(package, path)
    if uses.is_test(path) or path == "setup.py" or not called & _OF_NODES:
        return False
    if _TESTS & _imported(package, path):
        return False
    starts = "init_node" in called
    if not starts and _is_imported(package, path):
        return False
    if package.shebang(path) or package.is_executable(path) and not _is_module(package, path):
        return True
    # In a Python package, it's a module that a script elsewhere imports and starts.
    return not _is_module(package, path) and starts


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
    stem, others = last_part(path).split(".")[0], package.of_kind("python")
    return any(stem in _imported(package, other) for other in others if other != path)


@functools.lru_cache(maxsize=None)  # asked of each file for each of the others
def _imported(package: Package, path: str) -> frozenset[str]:
    """Return each part of the names of the modules that a Python file imports, and the names that
    it takes from them."""
    names = [module for module, _ in uses.imports(package, path)]
    for node in ast.walk(package.tree(path)):
        if isinstance(node, ast.ImportFrom):
            names += [node.module or "", *(alias.name for alias in node.names)]
    return frozenset(part for name in names for part in name.split("."))


@functools.lru_cache(maxsize=None)  # asked as the nodes are looked for, and again as they run
def _called(package: Package, path: str) -> frozenset[str]:
    """Return the names of what a Python file calls of rospy."""
    try:
        source = Source(path, package.text(path))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return frozenset(name.split(".")[-1] for name in _UNREAD.findall(package.text(path)))
    calls = source.nodes(ast.Call)
    # Without its import, too.
    names = (source.dotted(call.func) or ast.unparse(call.func) for call in calls)
    return frozenset(name[len("rospy.") :] for name in names if name.startswith("rospy."))


def _python(package: Package, model: Model) -> Iterator[specs.NodeSpec]:
    for path in package.of_kind("python"):
        if is_script(package, path):
            name = last_part(path)
            yield specs.NodeSpec(name, "python", file=path, executable=name)


def _cpp(package: Package, model: Model) -> Iterator[specs.NodeSpec]:
    for name, target in model.executables().items():
        sources = [file for file in model.all_sources(target) if file in package.files]
        is_node = any(_ROSCPP.search(uses.code(package, file)) for file in sources)
        if is_node and not all(map(uses.is_test, target.sources or sources)):
            yield specs.NodeSpec(name, "cpp", executable=name)
