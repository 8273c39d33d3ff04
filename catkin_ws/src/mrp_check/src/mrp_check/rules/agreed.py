# SPDX-License-Identifier: BSD-3-Clause
"""CMakeLists.txt and package.xml name the same packages, each once, and for the right time."""

from __future__ import annotations

from typing import Collection, Iterator, Mapping

from catkin_pkg.package import Package as Manifest

from mrp_check.case import Case
from mrp_check.contract.finding import NOTE, WARNING, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.contract.words import nearest
from mrp_check.sources import uses
from mrp_check.sources.uses import Use
from mrp_check.student.cmake import Call, Model
from mrp_check.student.manifest import FILE, declared, doubled, named
from mrp_check.student.package import Package

# What CMake calls a library -> (a part of all its names in rosdep, one of them).
# https://github.com/ros/rosdistro/blob/master/rosdep/base.yaml
_KEYS = {
    "Boost": ("boost", "boost"),
    "Eigen3": ("eigen", "eigen"),
    "OpenCV": ("cv", "libopencv-dev"),
    "PCL": ("pcl", "libpcl-all-dev"),
}
_MAKES = {"message_generation", "genmsg"}  # of ROS: they make code of messages
# They bring commands of CMake.
_OF_CMAKE = {*_MAKES, "message_runtime", "roslaunch", "roslint", "rostest", "rosunit"}


def _findings(case: Case) -> Iterator[Finding]:
    package, model, (manifest, _) = case.package, case.model, case.manifest
    if manifest is None:
        return
    used = uses.of_all(package, model, case.spec.is_contract)
    yield from _several(package, manifest)
    yield from _no_packages(package, manifest, used)
    yield from _passed_on(package, used, manifest, model)
    if not case.spec.is_contract:
        yield from _twice(package)
        if model.catkin:
            yield from _asked_for(package, manifest, model, used)
            yield from _at_another_time(package, manifest, model, used)
            yield from _not_found(package, model, manifest)
            yield from _makes_nothing(package, model)
            yield from _for_nothing(package, model, used)


def _in_manifest(
    package: Package, name: str, message: str, expected: str, fix: str, severity: str = WARNING
) -> Finding:
    """Return a finding about the line of package.xml that names a package."""
    line = package.find_line(FILE, name, 1)
    seen = package.line(FILE, line)
    return Finding("dependencies", message, FILE, line, severity, expected, seen, fix)


def _in_cmake(
    package: Package, call: Call, name: str, message: str, expected: str, fix: str
) -> Finding:
    """Return a finding about the line of a call in which a name stands, or about its first."""
    line = call.line_of(package.lines(call.file), name)
    seen = package.line(call.file, line)
    return Finding("dependencies", message, call.file, line, WARNING, expected, seen, fix)


def _several(package: Package, manifest: Manifest) -> Iterator[Finding]:
    """Yield a warning for each tag of package.xml that has the names of several packages."""
    for name in sorted(named(manifest)):
        if len(name.split()) > 1:
            yield _in_manifest(
                package,
                name if package.find_line(FILE, name) else name.split()[0],
                f"package.xml names several packages in one tag: '{name}' is taken for the name of"
                " one, which does not exist.",
                "a tag for each package",
                "Write one tag for each.",
            )


def _no_packages(package: Package, manifest: Manifest, used: Collection[str]) -> Iterator[Finding]:
    """Yield a warning for each misspelt name of package.xml: the right one stands beside it, or has
    other signs between its words."""
    names = named(manifest)
    for name in sorted(names - {*used}):
        others = {*names, "message_generation", "message_runtime"} - {name}
        near = nearest(name, others, 0.9) if not uses.exists(name) else None
        plain = name.replace("-", "_")
        if plain != name and uses.is_called_so(plain):
            near = plain
        is_said = near in used and near not in names  # by the rule on what the code uses
        if near and uses.is_called_so(near) | uses.exists(near) and not is_said:
            finding = _in_manifest(
                package,
                f">{name}<",
                f"package.xml names {name}, and there is no such package. Perhaps {near} is meant.",
                "the name of a package",
                f"Write {near} for {name}.",
            )
            finding.change = (f">{name}<", f">{near}<")
            yield finding


def _twice(package: Package) -> Iterator[Finding]:
    for name, line in doubled(package):
        finding = _in_manifest(
            package,
            name,
            f"package.xml names {name} a second time, in a tag of the same kind.",
            f"one such tag for {name}",
            "Take this line out.",
            NOTE,
        )
        finding.line, finding.seen = line, package.line(FILE, line)
        yield finding


def _key(name: str, names: Collection[str]) -> str:
    """Return what package.xml is expected to call what CMake finds; nothing if it names it."""
    part, key = _KEYS.get(name, (name, name))
    is_named = name in names or name in _KEYS and any(part in one for one in names)
    return "" if is_named else key


def _asked_for(
    package: Package, manifest: Manifest, model: Model, used: Collection[str]
) -> Iterator[Finding]:
    """Yield a warning for each package that CMakeLists.txt alone names: nothing uses it."""
    known = {*named(manifest), *used, "catkin", *(_MAKES if _has_messages(package, model) else ())}
    for name, call in model.components.items():
        is_here = uses.is_ros_package(name) or name in _KEYS
        is_absent = call.arguments[0] == "catkin" and not nearest(name, known, 0.8)
        key = _key(name, known)
        if key and name not in _MAKES and (is_here or is_absent):
            yield _in_cmake(
                package,
                call,
                name,
                f"CMakeLists.txt asks for {name}, and package.xml does not name it: where it is not"
                " installed, CMake stops.",
                f"<build_depend>{key}</build_depend>; or no {name} in find_package()",
                f"Take {name} out of find_package() if nothing of it is used; or declare it.",
            )


def _at_another_time(
    package: Package, manifest: Manifest, model: Model, used: Mapping[str, Use]
) -> Iterator[Finding]:
    """Yield a warning for each package that CMake finds, and package.xml has for later alone."""
    known = declared(manifest)
    cpp = {name for name, use in used.items() if use.language == "cpp"}  # has a finding already
    for name in sorted(
        {*model.components} & named(manifest) - known["build"] - known["test"] - cpp
    ):
        # Where no code is made of messages, message_generation has a finding of its own.
        if name not in _MAKES or _has_messages(package, model):
            yield _in_manifest(
                package,
                f">{name}<",
                f"CMakeLists.txt asks for {name} when the package is built, and package.xml names"
                " it for a later time alone: where it is not installed, CMake stops.",
                f"<build_depend>{name}</build_depend>, or <depend>{name}</depend>",
                f"Add the line <build_depend>{name}</build_depend>.",
            )


def _of_messages(model: Model) -> list[str]:
    """Return the packages whose messages the package's own ones have parts of."""
    arguments = model.generate.arguments if model.generate else []
    return [name for name in arguments if uses.is_ros_package(name)]


def _has_messages(package: Package, model: Model) -> bool:
    return bool(model.generate or model.message_files or package.of_kind(*uses.DEFINITIONS))


def _not_found(package: Package, model: Model, manifest: Manifest) -> Iterator[Finding]:
    """Yield a warning for each package that generate_messages() names, and nothing finds, or that
    package.xml does not name."""
    for name in _of_messages(model):
        if not model.generate or not model.catkin:
            continue
        if name not in model.components:
            yield _in_cmake(
                package,
                model.catkin,
                "find_package",
                f"find_package(catkin ...) does not name {name}, which generate_messages() in line"
                f" {model.generate.line} names: CMake knows it only if another package brings it"
                " along.",
                f"{name} in find_package(catkin REQUIRED COMPONENTS ...)",
                f"Add {name} to the COMPONENTS of find_package().",
            )
        if name not in named(manifest) | {*model.components}:
            yield _in_manifest(
                package,
                "<build_depend>" if package.find_line(FILE, "<build_depend>") else "<buildtool",
                f"package.xml does not name {name}, which generate_messages() needs.",
                f"<depend>{name}</depend>",
                f"Add the line <depend>{name}</depend>.",
            )


def _makes_nothing(package: Package, model: Model) -> Iterator[Finding]:
    """Yield a warning if CMake finds what makes code of messages, and there are none."""
    call = model.components.get("message_generation")
    if call and not _has_messages(package, model) and not model.finds_all:
        yield _in_cmake(
            package,
            call,
            "message_generation",
            "CMakeLists.txt asks for message_generation, and the package has no messages, services"
            " or actions of its own: nothing is made.",
            "no message_generation",
            "Take message_generation out, and out of package.xml, with message_runtime.",
        )


def _for_nothing(package: Package, model: Model, used: Collection[str]) -> Iterator[Finding]:
    """Yield a note about what CMake finds, and no file of the package names."""
    files = [one for one in package.files if one not in (FILE, "CMakeLists.txt")]
    known = {*used, *_of_messages(model), *_OF_CMAKE}
    if package.of_kind(*uses.DEFINITIONS):
        known.add("std_msgs")  # of a Header
    unused = [
        name
        for name in model.components
        if uses.is_called_so(name) and name not in known
        if not package.first_match(files, rf"\b{'ros/ros.h' if name == 'roscpp' else name}\b")
    ]
    if unused and model.catkin and package.of_kind("cpp", "python"):
        finding = _in_cmake(
            package,
            model.catkin,
            unused[0],
            f"CMakeLists.txt asks for {', '.join(unused)}, and nothing of the package uses"
            f" {'it' if len(unused) == 1 else 'them'}.",
            "what the package uses",
            f"Take {', '.join(unused)} out, and out of package.xml.",
        )
        finding.severity = NOTE
        yield finding


def _passed_on(
    package: Package, used: Mapping[str, Use], manifest: Manifest, model: Model
) -> Iterator[Finding]:
    """Yield a finding about CATKIN_DEPENDS: a warning if it is what the messages need, for then
    who includes a header of theirs may not find it.

    https://docs.ros.org/en/noetic/api/catkin/html/howto/format2/building_msgs.html
    """
    call = model.catkin_package
    if call is None:
        return
    cpp = {n for n, use in used.items() if use.language == "cpp" and use.firm}
    needed = cpp & declared(manifest)["build"]
    messages = {"message_runtime", *_of_messages(model)} if model.message_files else set()
    missing = sorted((needed | messages if model.generate else needed) - {*model.depends})
    if missing:
        finding = _in_cmake(
            package,
            call,
            "CATKIN_DEPENDS",
            "catkin_package() does not pass on what the package's code depends on: CATKIN_DEPENDS"
            f" has no {', no '.join(missing)}. Within this package it works all the same.",
            f"catkin_package(CATKIN_DEPENDS {' '.join([*model.depends, *missing])})",
            f"Add {' '.join(missing)} to CATKIN_DEPENDS.",
        )
        finding.severity = WARNING if model.generate and messages & {*missing} else NOTE
        yield finding


RULE = Rule("files", 21, ("manifest", "model"), _findings, also=("dependencies",))
