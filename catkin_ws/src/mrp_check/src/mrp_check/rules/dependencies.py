# SPDX-License-Identifier: BSD-3-Clause
"""Does the package declare each ROS package that its code uses, in package.xml and in CMake?"""

from __future__ import annotations

from typing import Collection, Iterable, Iterator, Mapping

from catkin_pkg.package import Package as Manifest

from mrp_check import evidence
from mrp_check.case import Case
from mrp_check.contract.finding import NOTE, WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.words import nearest
from mrp_check.sources import uses
from mrp_check.sources.uses import Use
from mrp_check.student.cmake import Call, Model
from mrp_check.student.manifest import FILE, declared, first_dependency
from mrp_check.student.package import Package


def _findings(case: Case) -> Iterator[Finding]:
    package, model, (manifest, _) = case.package, case.model, case.manifest
    is_known = uses.is_ros_package if case.spec.is_contract else uses.is_called_so
    used = uses.of(package, model, is_known)
    # Which packages the exercise is about: to leave one of them out is the manifest's fault. Any
    # other is the fault of the line that uses it.
    own = {"roscpp", "rospy"} | {topic.type.split("/")[0] for topic in case.spec.topics.values()}
    if not case.spec.is_contract:
        used = {**uses.of_launch(package), **used}
        own.update(used)
    for name, use in sorted(used.items()):
        in_manifest = manifest is None or name in _all(manifest, tests=not use.firm)
        is_open = model.catkin is None or model.finds_all or use.language == "launch"
        in_cmake = is_open or name in model.components
        if in_manifest and manifest is not None:
            yield from _kind(package, name, use, manifest)
        if not in_manifest and not in_cmake and name not in own:
            yield _foreign(package, name, use)
            continue
        if not in_manifest:
            yield _not_in_manifest(package, name, use, manifest, used)
        if not in_cmake and model.catkin:
            yield _not_in_cmake(name, use, model, model.catkin)
    if manifest is not None:
        yield from _several(package, manifest)
        yield from _no_packages(package, manifest, used)
        yield from _passed_on(package, used, manifest, model)
        if model.catkin and not case.spec.is_contract:
            yield from _asked_for(package, manifest, model, used)
            yield from _not_found(model)


def _all(manifest: Manifest, tests: bool) -> set[str]:
    known = declared(manifest)
    return set().union(*(names for kind, names in known.items() if kind != "test" or tests))


def _foreign(package: Package, name: str, use: Use) -> Finding:
    return Finding(
        "dependencies",
        f"{use.file} uses the package {name}, which neither package.xml nor CMakeLists.txt names."
        " Where it is not installed, this package cannot be built.",
        use.file,
        use.line,
        severity="error" if use.firm else WARNING,
        expected=f"no use of {name}; or <depend>{name}</depend>, and {name} in COMPONENTS",
        seen=package.line(use.file, use.line),
        fix="Take the line out if nothing of it is used; else declare the package.",
    )


def _kind(package: Package, name: str, use: Use, manifest: Manifest) -> Iterator[Finding]:
    """Yield a finding if package.xml names a package for the wrong time."""
    known = declared(manifest)
    if use.language == "cpp" and name not in known["build"]:
        when = "when it is built"
    elif use.language != "cpp" and name not in known["exec"]:
        when = "when it runs"
    else:
        return
    line = package.find_line(FILE, f">{name}<", 1)
    yield Finding(
        "dependencies",
        f"package.xml names {name}, but not as something that the package needs {when}:"
        f" {use.file} uses it.",
        FILE,
        line,
        WARNING,
        expected=f"<depend>{name}</depend>",
        seen=package.line(FILE, line),
        fix=f"Write <depend>{name}</depend>.",
    )


def _misspelt(name: str, names: Iterable[str], used: Collection[str]) -> str | None:
    """Return the name in `names` that is no package and looks like this one, or None."""
    others = [one for one in names if one not in used and not uses.is_ros_package(one)]
    return nearest(name, others, 0.8)


def _several(package: Package, manifest: Manifest) -> Iterator[Finding]:
    """Yield a warning for each tag of package.xml that has the names of several packages."""
    for name in sorted(_all(manifest, tests=True)):
        if len(name.split()) > 1:
            line = package.find_line(FILE, name.split()[0], 1)
            yield Finding(
                "dependencies",
                f"package.xml names several packages in one tag: '{name}' is taken for the name of"
                " one, which does not exist.",
                FILE,
                line,
                WARNING,
                expected="a tag for each package",
                seen=package.line(FILE, line),
                fix="Write one tag for each.",
            )


def _no_packages(package: Package, manifest: Manifest, used: Collection[str]) -> Iterator[Finding]:
    """Yield a warning for each misspelt name that package.xml has beside the right one."""
    names = _all(manifest, tests=True)
    for name in sorted(names - {*used}):
        near = nearest(name, names - {name}, 0.9)
        if near and "-" not in name and uses.exists(near) and not uses.exists(name):
            line = package.find_line(FILE, f">{name}<", 1)
            yield Finding(
                "dependencies",
                f"package.xml names {name}, and there is no such package. Perhaps {near} is meant.",
                FILE,
                line,
                WARNING,
                expected="the name of a package",
                seen=package.line(FILE, line),
                fix=f"Write {near} for {name}.",
                change=(f">{name}<", f">{near}<"),
            )


def _not_in_manifest(
    package: Package, name: str, use: Use, manifest: Manifest, used: Collection[str]
) -> Finding:
    near = _misspelt(name, _all(manifest, tests=True), used)
    line = (near and package.find_line(FILE, f">{near}<")) or first_dependency(package)
    text = package.lines(FILE)[line - 1]  # with its indent
    tags = f"<depend>{name}</depend>"
    if manifest is not None and manifest.package_format < 2:  # which knows no <depend>
        tags = f"<build_depend>{name}</build_depend> <run_depend>{name}</run_depend>"
    added = f"{text}\n{text[: len(text) - len(text.lstrip())]}{tags}"
    return Finding(
        "dependencies",
        f"package.xml does not name {name}, which {use.file} uses in line {use.line}."
        + (f" It names {near}, and there is no such package." if near else ""),
        FILE,
        line,
        severity="error" if use.firm else WARNING,
        expected=tags,
        seen=f"<depend>{near}</depend>" if near else f"no dependency on {name}",
        fix=f"Write {name} for {near}." if near else f"Add the line {tags}.",
        change=(f">{near}<", f">{name}<") if near else (text, added) if "depend>" in text else None,
    )


def _not_in_cmake(name: str, use: Use, model: Model, call: Call) -> Finding:
    near = _misspelt(name, model.components, ())
    is_cpp = use.language == "cpp"
    return Finding(
        "dependencies",
        f"find_package(catkin ...) does not name {name}, which {use.file} uses in line {use.line}. "
        + (
            "Its headers and libraries may then not be found."
            if is_cpp
            else "Python finds it all the same; catkin does not know of it."
        )
        + (f" It names {near}, and there is no such package." if near else ""),
        call.file,
        call.line,
        severity="error" if is_cpp and use.firm else NOTE,
        expected=f"find_package(catkin REQUIRED COMPONENTS ... {name} ...)",
        seen=", ".join(model.components) or "no COMPONENTS",
        fix=f"Write {name} for {near}." if near else f"Add {name} to COMPONENTS.",
        change=(near, name) if near else None,
    )


def _asked_for(
    package: Package, manifest: Manifest, model: Model, used: Collection[str]
) -> Iterator[Finding]:
    """Yield a warning for each package that CMakeLists.txt alone names: nothing uses it."""
    known = {*_all(manifest, tests=True), *used, "catkin", "message_generation", "genmsg"}
    for name, call in model.components.items():
        is_here = uses.is_ros_package(name)
        is_absent = call.arguments[0] == "catkin" and not nearest(name, known, 0.8)
        if name not in known and (is_here or is_absent):
            yield Finding(
                "dependencies",
                f"CMakeLists.txt asks for {name}, and package.xml does not name it: where it is not"
                " installed, CMake stops.",
                call.file,
                call.line_of(package.lines(call.file), name),
                WARNING,
                expected=f"<build_depend>{name}</build_depend>; or no {name} in COMPONENTS",
                seen=f"{name} in {call.file}, and not in package.xml",
                fix=f"Take {name} out of COMPONENTS if nothing of it is used; or declare it.",
            )


def _of_messages(model: Model) -> list[str]:
    """Return the packages whose messages the package's own ones have parts of."""
    named = model.generate.arguments if model.generate else []
    return [name for name in named if uses.is_ros_package(name)]


def _not_found(model: Model) -> Iterator[Finding]:
    """Yield a warning for each package that generate_messages() names, and nothing finds."""
    for name in _of_messages(model):
        if model.generate and name not in model.components:
            yield Finding(
                "dependencies",
                f"generate_messages() names {name}, and find_package(catkin ...) does not: CMake"
                " knows it only if another package brings it along.",
                model.generate.file,
                model.generate.line,
                WARNING,
                expected=f"{name} in find_package(catkin REQUIRED COMPONENTS ...)",
                seen=f"generate_messages({' '.join(model.generate.arguments)})",
                fix=f"Add {name} to the COMPONENTS of find_package().",
            )


def _passed_on(
    package: Package, used: Mapping[str, Use], manifest: Manifest, model: Model
) -> Iterator[Finding]:
    """Yield a finding about CATKIN_DEPENDS."""
    call = model.catkin_package
    if call is None:
        return
    cpp = {n for n, use in used.items() if use.language == "cpp" and use.firm}
    needed = cpp & declared(manifest)["build"]
    if model.generate and model.message_files:
        needed |= {"message_runtime", *_of_messages(model)}
    missing = sorted(needed - set(model.depends))
    if missing:
        yield Finding(
            "dependencies",
            "catkin_package() does not pass on what the package's code depends on: CATKIN_DEPENDS"
            f" has no {', no '.join(missing)}. Within this package it works all the same.",
            call.file,
            call.line_of(package.lines(call.file), "CATKIN_DEPENDS"),
            NOTE,
            expected=f"catkin_package(CATKIN_DEPENDS {' '.join([*model.depends, *missing])})",
            seen=f"catkin_package({' '.join(call.arguments)})",
            fix=f"Add {' '.join(missing)} to CATKIN_DEPENDS.",
        )


RULE = Rule(
    stage="files",
    order=20,
    needs=("manifest", "model"),
    findings=_findings,
    requirements={
        "dependencies": Requirement(
            "Each package that the code uses is declared in package.xml and CMakeLists.txt",
            "building#package-xml",
            evidence.code,
        )
    },
)
