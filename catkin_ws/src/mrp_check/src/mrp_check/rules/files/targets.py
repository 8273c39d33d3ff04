# SPDX-License-Identifier: BSD-3-Clause
"""Targets are made of files that are there, and what the calls of CMakeLists.txt name exists."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import evidence
from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.words import last_part, nearest, perhaps
from mrp_check.package.cmake import Call, Model, parsed
from mrp_check.package.package import Package

_LAUNCH_FILE = {"add_rostest": 0, "add_rostest_gtest": 1, "add_rostest_gmock": 1}  # its place
_NO_LAUNCH_FILES = (".cpp", ".cc", ".cxx", ".py")
_MAIN = re.compile(r"\bint\s+main\s*\(")
_VARIED = re.compile(r"[\w.-]*\$\{\w+\}[\w.-]*\.c\w+")  # a source's name with a variable in it
_EXPORTED = re.compile(r"\$\{(\w+)_EXPORTED_TARGETS\}")


def _findings(case: Case) -> Iterator[Finding]:
    yield from _no_sources(case)
    yield from _no_dependencies(case.package, case.model)
    yield from _no_libraries(case.package, case.model)
    yield from _no_system_libraries(case.package, case.model)
    yield from _no_launch_files(case.package)
    if not case.spec.is_contract:
        yield from _commented_out(case)
        yield from _never_built(case)
        yield from _empty_dependencies(case.package, case.model)


def _no_sources(case: Case) -> Iterator[Finding]:
    for target in case.model.targets.values():
        for source, file, line in target.missing:
            near = nearest(source, case.package.of_kind("cpp"))
            yield Finding(
                "targets",
                f"The target {target.name} is made of {source}, and there is no such file."
                + perhaps(near),
                file,
                line,
                expected="the name of a file, relative to CMakeLists.txt",
                seen=source,
                fix=f"Write {near} for {source}." if near else "Name a file that is there.",
            )


def _missing(
    package: Package, call: Call, name: str, message: str, expected: str, fix: str
) -> Finding:
    line = call.line_of(package.lines(call.file), name)
    return Finding("targets", message, call.file, line, HABIT, expected, name, fix)


def _no_dependencies(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a warning for each target that is waited for, and that nothing makes. CMake says so
    only where cmake_minimum_required() names version 3.0 or later: then it stops."""
    for call in model.calls:
        for name in call.arguments[1:] if call.command == "add_dependencies" else ():
            if model.lacks_target(name):
                of_messages = "_generate_messages" in name and not model.generate
                near = None if of_messages else nearest(name, model.made)
                yield _missing(
                    package,
                    call,
                    name,
                    f"add_dependencies() lets {call.arguments[0]} wait for {name}, and there is no"
                    f" such target.{perhaps(near)}"
                    + (" generate_messages() makes it, where it is called." if of_messages else ""),
                    f"a target {name}",
                    f"Write {near} for {name}." if near else f"Take {name} out.",
                )


def _empty_dependencies(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a warning for each ${x_EXPORTED_TARGETS} of a package x that CMake does not find: it is
    empty, so that CMake's own trace has nothing of it."""
    file = "CMakeLists.txt"
    known = {"catkin", package.name, *model.components, *(model.project or ())[:1]}
    for call in parsed(package.text(file), file):
        for word in call.arguments[1:] if call.command == "add_dependencies" else ():
            match = _EXPORTED.fullmatch(word)
            if match and match[1] not in known:
                near = nearest(match[1], known)
                yield _missing(
                    package,
                    call,
                    f"{match[1]}_EXPORTED_TARGETS",
                    f"{word} is empty, as find_package() names no {match[1]}: {call.arguments[0]}"
                    f" waits for nothing of it.{perhaps(near)}",
                    "a package that find_package() names, or this one",
                    f"Write {near} for {match[1]}." if near else f"Take {word} out.",
                )


def _no_libraries(package: Package, model: Model) -> Iterator[Finding]:
    call, targets = model.catkin_package, model.targets
    if not call or any("$" in name for name in targets):
        return
    libraries = {target.name for target in targets.values() if target.is_library}
    others = model.made - {*targets}  # macros of other packages may make libraries, too
    for name in model.libraries:
        if re.fullmatch(r"\w+", name) and name not in libraries | others:
            near = nearest(name, libraries)
            yield _missing(
                package,
                call,
                name,
                f"catkin_package() names the library {name} in LIBRARIES, and CMakeLists.txt makes"
                " none of that name: a package that depends on this one cannot be built."
                + perhaps(near),
                f"add_library({name} ...)",
                f"Write {near} for {name}." if near else f"Take LIBRARIES {name} out.",
            )


def _no_system_libraries(package: Package, model: Model) -> Iterator[Finding]:
    call = model.catkin_package
    for name in dict.fromkeys(model.not_found):
        if call:
            yield _missing(
                package,
                call,
                name,
                f"catkin_package() names {name} in DEPENDS, and no find_package() has found it:"
                " CMake warns, and passes on nothing of it.",
                f"find_package({name}) above it, or no such name",
                f"Take DEPENDS {name} out, or find it first.",
            )


def _commented_out(case: Case) -> Iterator[Finding]:
    """Yield a warning for each program that only a comment of CMakeLists.txt makes a target of."""
    made = {source for target in case.model.targets.values() for source in target.sources}
    file = "CMakeLists.txt"
    for source in {*case.package.of_kind("cpp")} - made:
        name = re.escape(last_part(source))
        comment = rf"^\s*#+\s*add_executable\s*\(.*[\s/(]{name}\b"
        place = case.package.first_match([file], comment)
        if place and _MAIN.search(uses.code(case.package, source)):
            yield Finding(
                "targets",
                f"This line is a comment: nothing is made of {source}.",
                *place,
                HABIT,
                expected=f"add_executable(... {source})",
                seen=case.package.line(file, place[1]),
                fix="Take the # out, there and before the lines that belong to it.",
            )


def _never_built(case: Case) -> Iterator[Finding]:
    """Yield a warning for each program, or plugin, that CMakeLists.txt does not name."""
    files = [one for one in case.package.files if one.endswith(("CMakeLists.txt", ".cmake"))]
    text = "\n".join(map(case.package.text, files))
    others = [one.rpartition("/")[0] + "/" for one in files if "/" in one]
    for source in case.package.of_kind("cpp") if "file(" not in text.lower() else ():
        code, name = uses.code(case.package, source), last_part(source)
        stem = re.escape(name.rpartition(".")[0])
        # As foreach() names several: test_${name}.cpp.
        patterns = (
            re.sub(r"\\\$\\{.*?\\}", ".*", re.escape(word)) for word in _VARIED.findall(text)
        )
        is_named = bool(re.search(rf"\b{stem}\b", text)) or any(
            re.fullmatch(pattern, name) for pattern in patterns
        )
        if "aux_source" in text or is_named or source.startswith(tuple(others)):
            continue
        if _MAIN.search(code) and "ros::init" in code or "PLUGINLIB_EXPORT_CLASS(" in code:
            yield Finding(
                "targets",
                f"No line of CMakeLists.txt names {source}: nothing is made of it.",
                source,
                1,
                HABIT,
                expected=f"add_executable(... {source})",
                seen="no target that is made of it",
                fix="Write add_executable() and target_link_libraries() for it; or delete it.",
            )


def _no_launch_files(package: Package) -> Iterator[Finding]:
    """What is built has no tests: CMake passes over these calls, so that they are read as text.

    https://docs.ros.org/en/noetic/api/rostest/html/ says what the macros take.
    """
    file = "CMakeLists.txt"
    for call in parsed(package.text(file), file):
        names = call.arguments[_LAUNCH_FILE.get(call.command, len(call.arguments)) :][:1]
        for name in names:
            if name.endswith(_NO_LAUNCH_FILES):
                yield _missing(
                    package,
                    call,
                    name,
                    f"{call.command}() takes the launch file of a test here, and {name} is a"
                    " source: rostest reads it as XML, and fails.",
                    "a file such as test/some.test, which starts the test",
                    f"Name the launch file first, and {name} after it.",
                )


RULE = Rule(
    stage="files",
    needs=("model",),
    findings=_findings,
    requirements={
        "targets": Requirement(
            "Each executable is built of its own sources",
            "wrong#a-target-is-built-from-another-node-s-source",
            evidence.cpp,
        )
    },
)
