# SPDX-License-Identifier: BSD-3-Clause
"""Reads all sources of a package: what they say without being run."""

from __future__ import annotations

import json
import os

from mrp_check import confine
from mrp_check.confined import cpp_headers
from mrp_check.contract.errors import CannotCheck
from mrp_check.sources import facts as facts_
from mrp_check.sources import python_facts, python_read, roles, uses


def read(case):
    """Return the Facts of a case.Case: what its sources say."""
    package, model = case.package, case.model
    if package.of_kind("message"):
        case.catkin.wait_until_built()  # before, there are no headers of its messages
    reading = [
        case.catkin.submit(_read_cpp, package, case, unit) for unit in _units(package, case, model)
    ]
    facts = facts_.Facts()
    for file in _python_files(package):
        source, problem = python_read.read(package, file)
        if source is None:
            facts.unread.add(file)
            if problem and _is_code(package, file):
                facts.problems.append(problem)
            continue
        facts.python[file] = source
        facts.places += python_facts.places(source)
    case.progress("reading the C++ sources")
    _used_elsewhere(facts, facts.python)
    named = set()
    for result in reading:
        named |= _take(package, facts, *result.result())
    _mark_unused(facts, named)
    facts.launch = {
        node.name: (node.file, node.line or 1)
        for node in (case.launch.nodes if case.launch else [])
        if node.file
    }
    facts.sources = roles.sources(package, case.spec, model, case.launch, facts.python)
    facts.relevant = _relevant(package, model, case.launch, facts, facts.python)
    return facts


def _python_files(package):
    """Return the Python files to read: all but those of tests and of setup."""
    return [
        path
        for path in package.of_kind("python")
        if not uses.is_test(path)
        and path not in ("setup.py", "doc/conf.py")
        and not path.startswith(("doc/", "docs/"))
    ]


def _is_code(package, file):
    """Return whether a Python file lies where nodes and their modules do, or is a script."""
    folders = file.split("/")[:-1]
    usual = not folders or folders[0] in ("src", "scripts", "script", "nodes", "node", "bin")
    return usual or bool(package.shebang(file))


def _used_elsewhere(facts, sources):
    """Take back that a Python function is unused where another source has its name."""
    names = {file: source.names() for file, source in sources.items()}
    for place in facts.places:
        if place.values.get("unused"):
            others = (names[file] for file in names if file != place.file)
            place.values["unused"] = not any(place.text in one for one in others)


def _relevant(package, model, launch, facts, sources):
    """Return the Python files that are nodes, or that nodes are made of."""
    scripts = [script.path for script in model.scripts]
    started = [node.type for node in (launch.nodes if launch else [])]
    begins = {p.file for p in facts.places if p.kind == "init"}
    of_nodes = {file for files in facts.sources.values() for file in files}
    chosen = [
        file
        for file in [*sources, *facts.unread]
        if file in scripts
        or file in begins
        or file in of_nodes
        or file.rsplit("/", 1)[-1] in started
        or package.shebang(file)
        and package.is_executable(file)
    ]
    return roles.with_own(package, chosen, sources)


def _units(package, workspace, model):
    """Return [source, compiler's arguments...] of each C++ source that is built, or may be."""
    commands = workspace.catkin.compile_commands()
    copy = workspace.package_folder
    units = []
    for path in package.of_kind("cpp"):
        if uses.is_test(path):
            continue
        source = str(copy / path)
        directory, command = commands.get(
            source, (str(copy), ["c++", *_defaults(package, workspace)])
        )
        units.append([source, "-working-directory", directory, *_arguments(command, source)])
    return units


def _defaults(package, workspace):
    """Return arguments for a source that CMake could not say how to compile."""
    folders = [
        workspace.package_folder / "include",
        workspace.folder / "devel" / "include",
        *cpp_headers.FOLDERS,
    ]
    name = package.name.replace('"', "")
    return [f'-DROS_PACKAGE_NAME="{name}"', *(f"-I{folder}" for folder in folders)]


def _arguments(command, source):
    """Return what of a compiler's command line clang needs: without outputs and g++'s own flags."""
    kept, skip = [cpp_headers.STANDARD], False
    for word in command[1:]:
        if skip:
            skip = False
        elif word in ("-o", "-MF", "-MT", "-MQ"):
            skip = True
        elif word.startswith(("-I", "-D", "-U", "-std", "-isystem", "-include")) or not (
            word.startswith("-") or word == source
        ):
            kept.append(word)
    return [*kept, "-w", "-ferror-limit=50"]


def _read_cpp(package, workspace, unit):
    """Return (file, what cpp_facts.py says of it or None)."""
    headers = str(workspace.headers.result())
    task = {"folder": str(workspace.package_folder), "headers": headers, "units": [unit]}
    reader = confine.code() / "cpp_facts.py"
    done = workspace.catkin.run("/usr/bin/python3", str(reader), json.dumps(task))
    file = os.path.relpath(unit[0], workspace.package_folder)
    try:
        return file, json.loads(done.output)[unit[0]]
    except (ValueError, KeyError):
        if "No module named 'clang'" in done.errors:
            raise CannotCheck(
                "Python's module clang is not installed: install Debian's package python3-clang"
                " (make deps)."
            ) from None
        if done.ended_by == "time":
            raise CannotCheck(
                f"Reading {file} did not end within {workspace.timeout:.0f} s: the machine is too"
                " busy; --timeout gives it more time."
            ) from None
        if done.ended_by or not done.errors.startswith("Traceback"):
            return file, None
        raise CannotCheck(f"The C++ reader failed: {done.errors.strip()[-300:]}") from None
    except confine.ConfineError:
        return file, None


def _mark_unused(facts, named):
    """Say which functions of C++ no source names: one may be used in another than its own."""
    for place in facts.places:
        if place.values.get("usr") and not facts.unread:
            place.values["unused"] = place.values.pop("usr") not in named


def _take(package, facts, file, said):
    """Put what is said of one C++ source into the facts; return the functions that it names."""
    if said is None or said["errors"]:
        facts.unread.add(file)
    seen = {(p.file, p.line, p.kind, p.text) for p in facts.places}
    for entry in (said or {"places": []})["places"]:
        place = facts_.Place(**entry)
        # A header is read with each source that includes it.
        if (place.file, place.line, place.kind, place.text) not in seen:
            facts.places.append(place)
    return set((said or {}).get("named", ()))
