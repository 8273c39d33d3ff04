# SPDX-License-Identifier: BSD-3-Clause
"""Which sources each node of the spec is made of, whatever they are called."""

from __future__ import annotations

import ast
import os
from typing import Iterable, Iterator, Mapping

from mrp_check.code import uses
from mrp_check.code.python_source import Source
from mrp_check.contract import spec as specs
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Spec
from mrp_check.package.cmake import Model
from mrp_check.package.launch import Launch
from mrp_check.package.package import Package


def sources(
    package: Package, spec: Spec, model: Model, launch: Launch | None, python: Mapping[str, Source]
) -> dict[str, list[str]]:
    """Return name of a spec's node -> its files, the main one first.

    python: file -> python_source.Source
    """
    # Without a contract, the nodes of the spec are executables, whatever a launch file calls them.
    by_name = launch.nodes if launch and spec.is_contract else []
    started = {node.name: node for node in by_name}
    result = {}
    for name, node in spec.nodes.items():
        files = []
        if name in started and started[name].package == package.name:
            files = of_executable(package, model, started[name].type)
        if not files and node.executable:
            files = of_executable(package, model, node.executable)
        result[name] = files or _by_name(package, model, node)
    return {name: with_own(package, files, python) for name, files in result.items()}


def of_executable(package: Package, model: Model, executable: str) -> list[str]:
    """Return the sources of what roslaunch calls `executable`: of a target, or a script."""
    target = model.executables().get(executable)
    if target is not None:
        return model.all_sources(target)
    scripts = [s.path for s in model.scripts if last_part(s.path) == executable]
    scripts += [p for p in package.of_kind("python") if last_part(p) == executable]
    return [path for path in scripts if path in package.files][:1]


def _by_name(package: Package, model: Model, node: specs.NodeSpec) -> list[str]:
    if node.language != "python":
        for name, target in model.executables().items():
            if name == node.name:
                return model.all_sources(target)
    kinds = {"cpp": ("cpp",), "python": ("python",)}.get(node.language, ("cpp", "python"))
    return [
        path
        for path in package.of_kind(*kinds)
        if os.path.splitext(last_part(path))[0] == node.name and not uses.is_test(path)
    ][:1]


def with_own(package: Package, files: Iterable[str], python: Mapping[str, Source]) -> list[str]:
    """Return the files and, after them, what of the package they include or import."""
    found, queue = [], list(files)
    while queue:
        file = queue.pop(0)
        if file in found or file not in package.files:
            continue
        found.append(file)
        if file in python:
            queue += _imported(package, python[file])
        elif package.kind(file) in ("cpp", "header"):
            queue += _included(package, file)
    return found


def _included(package: Package, file: str) -> Iterator[str]:
    for header, _ in uses.includes(package, file):
        for path in package.of_kind("header", "cpp"):
            if f"/{path}".endswith(f"/{header}") and path != file:
                yield path


def _imported(package: Package, source: Source) -> Iterator[str]:
    names = set()
    for node in source.import_nodes:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        else:
            module = node.module or ""
            names |= {module} | {f"{module}.{alias.name}".strip(".") for alias in node.names}
    for name in sorted(names - {""}):
        path = name.replace(".", "/")
        for file in package.of_kind("python"):
            if f"/{file}".endswith((f"/{path}.py", f"/{path}/__init__.py")) and file != source.file:
                yield file
