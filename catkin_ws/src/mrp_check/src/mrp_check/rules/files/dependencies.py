# SPDX-License-Identifier: BSD-3-Clause
"""Does the package declare each ROS package that its code uses, in package.xml and in CMake?"""

from __future__ import annotations

import re
from typing import Collection, Iterable, Iterator

from catkin_pkg.package import Package as Manifest

from mrp_check.case import evidence
from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.code.uses import Use
from mrp_check.contract.finding import HABIT, HINT, READ, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.words import nearest
from mrp_check.package.cmake import Call, Model
from mrp_check.package.manifest import FILE, declared, first_dependency, named
from mrp_check.package.package import Package

# Of these, a node in C++ needs more than the headers: a library, or what shows a message.
_RUNS = re.compile(r"^(?:roscpp|tf|tf2_ros|actionlib|rosbag)$|_msgs$|_srvs$")


def _findings(case: Case) -> Iterator[Finding]:
    package, model, (manifest, _) = case.package, case.model, case.manifest
    used = uses.of_all(package, model, case.spec.is_contract)
    # Which packages the exercise is about: to leave one of them out is the manifest's fault. Any
    # other is the fault of the line that uses it.
    own = {"roscpp", "rospy"} | {topic.type.split("/")[0] for topic in case.spec.topics.values()}
    if not case.spec.is_contract:
        own.update(used)
    for name, use in sorted(used.items()):
        in_manifest = manifest is None or name in named(manifest, tests=not use.firm)
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


def _foreign(package: Package, name: str, use: Use) -> Finding:
    return Finding(
        "dependencies",
        f"{use.file} uses the package {name}, which neither package.xml nor CMakeLists.txt names."
        " Where it is not installed, this package cannot be built.",
        use.file,
        use.line,
        certainty=READ if use.firm else HABIT,
        expected=f"no use of {name}; or <depend>{name}</depend>, and {name} in COMPONENTS",
        seen=package.line(use.file, use.line),
        fix="Take the line out if nothing of it is used; else declare the package.",
    )


def _kind(package: Package, name: str, use: Use, manifest: Manifest) -> Iterator[Finding]:
    """Yield a finding if package.xml names a package for the wrong time."""
    known = declared(manifest)
    if use.language == "cpp" and name not in known["build"]:
        when = "when it is built"
    elif name not in known["exec"] and (use.language != "cpp" or _RUNS.search(name)):
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
        HABIT,
        expected=f"<depend>{name}</depend>",
        seen=package.line(FILE, line),
        fix=f"Write <depend>{name}</depend>.",
    )


def _misspelt(name: str, names: Iterable[str], used: Collection[str]) -> str | None:
    """Return the name in `names` that is no package and looks like this one, or None."""
    others = [one for one in names if one not in used and not uses.is_ros_package(one)]
    return nearest(name, others, 0.8)


def _not_in_manifest(
    package: Package, name: str, use: Use, manifest: Manifest, used: Collection[str]
) -> Finding:
    near = _misspelt(name, named(manifest), used)
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
        certainty=READ if use.firm else HABIT,
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
        certainty=READ if is_cpp and use.firm else HINT,
        expected=f"find_package(catkin REQUIRED COMPONENTS ... {name} ...)",
        seen=", ".join(model.components) or "no COMPONENTS",
        fix=f"Write {name} for {near}." if near else f"Add {name} to COMPONENTS.",
        change=(near, name) if near else None,
    )


RULE = Rule(
    stage="files",
    needs=("manifest", "model"),
    findings=_findings,
    requirements={
        "dependencies": Requirement(
            "Each package that the code uses is declared in package.xml and CMakeLists.txt",
            "building#package-xml",
            evidence.code,
        )
    },
    sure=READ,
)
