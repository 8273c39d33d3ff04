# SPDX-License-Identifier: BSD-3-Clause
"""Does the package declare each ROS package that its code uses, in package.xml and in CMake?"""

from __future__ import annotations

import re
import sys
from typing import Iterator, Mapping

from catkin_pkg.package import Package as Manifest

from mrp_check.code import uses
from mrp_check.code.python_modules import is_ros
from mrp_check.code.uses import Use
from mrp_check.contract.finding import HABIT, HINT, READ, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.cmake import Command, Model
from mrp_check.package.manifest import FILE, declared, first_dependency, named
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case

# Of these, a node in C++ needs more than the headers: a library, or what shows a message.
_RUNS = re.compile(r"^(?:roscpp|tf|tf2_ros|actionlib|rosbag)$|_msgs$|_srvs$")


def _findings(case: Case) -> Iterator[Finding]:
    yield from () if case.spec.is_contract else undeclared(case)
    package, model, (manifest, _) = case.package, case.model, case.manifest
    is_apart = case.spec.is_contract
    used = uses.of_all(package, model, is_apart)
    # Where the same line lacks them -> package -> its use; a contract tells the sure ones apart.
    lacking: dict[tuple[str, bool], dict[str, Use]] = {}
    for name, use in sorted(used.items()):
        in_manifest = manifest is None or name in named(manifest, tests=not use.firm)
        is_open = model.catkin is None or model.finds_all or use.language == "launch"
        in_cmake = is_open or name in model.components
        if in_manifest and manifest is not None:
            yield from _kind(package, name, use, manifest)
        if not in_manifest:
            lacking.setdefault((FILE, is_apart and use.firm), {})[name] = use
        # Python finds it all the same.
        if not in_cmake and model.catkin and use.language == "cpp":
            lacking.setdefault((model.catkin.file, is_apart and use.firm), {})[name] = use
    for (file, _), uses_ in lacking.items():
        firm = any(use.firm for use in uses_.values())
        if file == FILE:
            yield _not_in_manifest(package, uses_, manifest, firm)
        elif model.catkin:
            yield _not_in_cmake(uses_, model, model.catkin, firm)


def _kind(package: Package, name: str, use: Use, manifest: Manifest) -> Iterator[Finding]:
    """Yield a finding if package.xml names a package for the wrong time."""
    known = declared(manifest)
    if use.language == "cpp" and name not in known["build"]:
        when = "when it is built"
    elif name in ("rostest", "rosunit") and name in known["test"]:
        return  # the file is a test, wherever it is
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
        packages=(name,),
    )


def _not_in_manifest(
    package: Package, found: Mapping[str, Use], manifest: Manifest | None, firm: bool
) -> Finding:
    line = first_dependency(package)
    text = package.lines(FILE)[line - 1]  # with its indent
    tags = [f"<depend>{name}</depend>" for name in found]
    if manifest is not None and manifest.package_format < 2:  # which knows no <depend>
        tags = [
            f"<{tag}>{name}</{tag}>" for name in found for tag in ("build_depend", "run_depend")
        ]
    indent = text[: len(text) - len(text.lstrip())]
    added = "\n".join([text, *(indent + tag for tag in tags)])
    return Finding(
        "dependencies",
        f"package.xml doesn't name {_used_in(found)}.",
        FILE,
        line,
        certainty=READ if firm else HABIT,
        expected=" ".join(tags),
        seen=f"no dependency on {', '.join(found)}",
        fix=f"Add {' '.join(tags)}.",
        change=(text, added) if "depend>" in text else None,
        packages=tuple(found),
    )


def _used_in(found: Mapping[str, Use]) -> str:
    """Return packages as a part of a sentence, each with a place that uses it."""
    if len(found) == 1:
        ((name, use),) = found.items()
        return f"{name}, which {use.file} uses on line {use.line}"
    *rest, last = [f"{name} (used in {use.file}:{use.line})" for name, use in found.items()]
    return f"{', '.join(rest)} and {last}"


def _not_in_cmake(found: Mapping[str, Use], model: Model, call: Command, firm: bool) -> Finding:
    names = " ".join(found)
    return Finding(
        "dependencies",
        f"find_package(catkin ...) doesn't name {_used_in(found)}. So headers and libraries may"
        " not be found.",
        call.file,
        call.line,
        certainty=READ if firm else HINT,
        expected=f"find_package(catkin REQUIRED COMPONENTS ... {names} ...)",
        seen=", ".join(model.components) or "no COMPONENTS",
        fix=f"Add {names} to COMPONENTS.",
        packages=tuple(found),
    )


# Folder of headers, or module -> a part of the names by which package.xml may have it, and rosdep's
# own name of it.
_LIBRARIES = {
    "yaml-cpp": (("yaml",), "yaml-cpp"),
    "opencv2": (("opencv", "cv_bridge"), "libopencv-dev"),
    "cv2": (("opencv", "cv_bridge"), "python3-opencv"),
    "PIL": (("pil",), "python3-pil"),
    "sklearn": (("sklearn", "scikit"), "python3-sklearn"),
}
# They come with ROS itself, or with Python.
_BROUGHT = {*sys.builtin_module_names, "yaml", "rospkg", "catkin_pkg", "genpy", "setuptools", "em"}


def undeclared(case: Case) -> Iterator[Finding]:
    package, (manifest, _) = case.package, case.manifest
    if manifest is None:
        return
    names = {name.lower() for known in declared(manifest).values() for name in known}
    reported: set[str] = set()
    for file, line, module in _used(case):
        top = module.partition(".")[0]
        is_package = module.endswith((".msg", ".srv"))
        parts, key = _LIBRARIES.get(top, ((top.lower().replace("_", "-"), top.lower()), ""))
        key = key or (top if is_package else f"python3-{top.lower().replace('_', '-')}")
        if top in reported or any(part in name for part in parts for name in names):
            continue
        reported.add(top)
        yield Finding(
            "dependencies",
            f"{file} uses {top}, but package.xml doesn't name it: where it isn't installed, this"
            " fails.",
            file,
            line,
            HABIT,
            expected=f"<depend>{key}</depend> in package.xml",
            seen=package.line(file, line),
            fix=f"Add <depend>{key}</depend> to package.xml; or remove the line if you don't need"
            " it.",
            packages=(top,),
        )


def _used(case: Case) -> Iterator[tuple[str, int, str]]:
    """Yield (file, line, module or folder of headers) of what others than ROS made."""
    package = case.package
    for file in package.of_kind("cpp", "header"):
        for header, line in () if uses.is_test(file) else uses.includes(package, file):
            if header.partition("/")[0] in _LIBRARIES:
                yield file, line, header.partition("/")[0]
    paths = [f"/{path}" for path in package.of_kind("python")]
    for file in package.of_kind("python"):
        if uses.is_test(file) or file in ("setup.py", "doc/conf.py"):
            continue
        for module, line in uses.imports(package, file):
            top = module.partition(".")[0]
            is_own = any(f"/{top}/" in path or path.endswith(f"/{top}.py") for path in paths)
            is_others = (
                top in uses.STANDARD | _BROUGHT or is_ros(top) or uses.is_called_so(package, top)
            )
            is_package = module.endswith((".msg", ".srv"))
            if not is_own and not is_others and top != package.name:
                if uses.is_of_debian(top) or is_package:
                    yield file, line, module


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
