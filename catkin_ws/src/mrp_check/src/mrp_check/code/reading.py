# SPDX-License-Identifier: BSD-3-Clause
"""Reads all sources of a package: what they say without being run."""

from __future__ import annotations

from mrp_check.code import python_facts, python_read, roles, uses
from mrp_check.code.cpp_read import CppReader
from mrp_check.code.facts import Facts
from mrp_check.confined.places import Kind, Said
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Spec
from mrp_check.package.cmake import Model
from mrp_check.package.launch import Launch
from mrp_check.package.package import Package


def read(reader: CppReader, spec: Spec, model: Model, launch: Launch | None) -> Facts:
    """Return the Facts: what all sources say.

    launch: what roslaunch makes of the launch file, or None
    """
    workspace = reader.workspace
    package, facts = workspace.package, Facts()
    cpp = [file for file in package.of_kind("cpp") if not uses.is_test(file)]
    futures = {file: workspace.submit(reader.read, file) for file in cpp}
    for file in python_files(package):
        source, problem = python_read.read(package, file)
        if source is None:
            facts.unread.add(file)
            if problem and _is_code(package, file):
                facts.problems.append(problem)
            continue
        facts.python[file] = source
        facts.places += python_facts.places(source)
    if cpp:
        workspace.progress("reading the C++ sources")
    _used_elsewhere(facts)
    named: set[str] = set()
    for file, future in futures.items():
        named |= take(facts, file, future.result())
    mark_unused(facts, named)
    nodes = launch.nodes if launch else []
    facts.launch = {node.name: (node.file, node.line or 1) for node in nodes if node.file}
    facts.sources = roles.sources(package, spec, model, launch, facts.python)
    facts.relevant = _relevant(package, model, launch, facts)
    return facts


def python_files(package: Package) -> list[str]:
    """Return the Python files to read: all but those of tests and of setup."""
    return [
        path
        for path in package.of_kind("python")
        if not uses.is_test(path)
        and path not in ("setup.py", "doc/conf.py")
        and not path.startswith(("doc/", "docs/"))
    ]


def _is_code(package: Package, file: str) -> bool:
    """Return whether a Python file lies where nodes and their modules do, or is a script."""
    folders = file.split("/")[:-1]
    usual = not folders or folders[0] in ("src", "scripts", "script", "nodes", "node", "bin")
    return usual or bool(package.shebang(file))


def _used_elsewhere(facts: Facts) -> None:
    """Take back that a Python function is unused where another source has its name."""
    names = {file: source.names() for file, source in facts.python.items()}
    for place in facts.places:
        if place.unused:
            others = (names[file] for file in names if file != place.file)
            place.unused = not any(place.text in known for known in others)


def _relevant(package: Package, model: Model, launch: Launch | None, facts: Facts) -> list[str]:
    """Return the Python files that are nodes, or that nodes are made of."""
    scripts = [script.path for script in model.scripts]
    started = [node.type for node in (launch.nodes if launch else [])]
    begins = {p.file for p in facts.places if p.kind is Kind.INIT}
    of_nodes = {file for files in facts.sources.values() for file in files}
    chosen = [
        file
        for file in [*facts.python, *facts.unread]
        if file in scripts
        or file in begins
        or file in of_nodes
        or last_part(file) in started
        or package.shebang(file)
        and package.is_executable(file)
    ]
    return roles.with_own(package, chosen, facts.python)


def mark_unused(facts: Facts, named: set[str]) -> None:
    """Say which functions of C++ no source names: one may be used in another than its own."""
    for place in facts.places:
        if place.usr and not facts.unread:
            place.unused = place.usr not in named


def take(facts: Facts, file: str, result: Said | None) -> set[str]:
    """Put what is said of one C++ source into the facts; return the functions that it names."""
    if result is None or result.errors:
        facts.unread.add(file)
    if result is None:
        return set()
    seen = {(p.file, p.line, p.kind, p.text) for p in facts.places}
    # A header is read with each source that includes it.
    facts.places += [p for p in result.places if (p.file, p.line, p.kind, p.text) not in seen]
    return set(result.named)
