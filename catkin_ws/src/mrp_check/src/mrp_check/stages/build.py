# SPDX-License-Identifier: BSD-3-Clause
"""The stage build: catkin_make in the scratch workspace."""

from __future__ import annotations

import os

from mrp_check.finding import Finding
from mrp_check.stages import compiler, configuring, linker


def findings(package, spec, workspace):
    """Yield a Finding for each source that does not compile and each target that does not link."""
    catkin = workspace.catkin
    built = catkin.built if catkin.configured.ok else None
    copy = workspace.package_folder
    if built is None:
        yield _not_configured(package, catkin, copy)
    elif not built.ok:
        found = [compiler.finding(package, p) for p in compiler.problems(built.output, copy)]
        found += linker.findings(package, built.output, catkin.model)
        yield from found or [_unknown(package, built, "compile")]
    workspace.built = built is not None and built.ok
    workspace.executables = _executables(workspace, package)


def _not_configured(package, catkin, copy):
    step = catkin.configured
    finding = (
        None if step.why_ended else configuring.finding(package, step.output, copy, catkin.model)
    )
    return finding or _unknown(package, step, "configure")


def _unknown(package, step, id_):
    """Return a Finding about a failure whose output names no place in the package."""
    lines = [line for line in step.output.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    what = "CMake" if id_ == "configure" else "catkin_make"
    if step.why_ended:
        message, seen = f"{what} was ended: {step.why_ended}.", step.why_ended
    else:
        message = f"{what} failed; what it printed names no line of the package."
        seen = " ".join((errors or lines)[-3:])[:500]
    return Finding(
        id_,
        message,
        "CMakeLists.txt" if "CMakeLists.txt" in package.files else None,
        1 if "CMakeLists.txt" in package.files else None,
        expected=f"{what} to succeed",
        seen=seen,
        fix="Run catkin_make yourself, and read what it prints from the top.",
    )


def _executables(workspace, package):
    """Return name -> path of what roslaunch can start: built executables, and scripts."""
    found = {}
    for path in package.of_kind("python"):
        if package.is_executable(path):
            found[path.rsplit("/", 1)[-1]] = workspace.package_folder / path
    folder = workspace.folder / "devel" / "lib" / package.name
    for path in sorted(folder.glob("*")) if folder.is_dir() else ():
        if path.is_file() and os.access(path, os.X_OK):
            found[path.name] = path
    return found
