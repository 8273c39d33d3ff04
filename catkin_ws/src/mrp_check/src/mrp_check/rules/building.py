# SPDX-License-Identifier: BSD-3-Clause
"""The stage build: catkin_make in the scratch workspace."""

from __future__ import annotations

from mrp_check.build import compiler, configuring, linker
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Rule
from mrp_check.sources import uses


def _configure(case):
    """Yield the Finding about CMake, if it failed."""
    if case.built is None:
        yield _not_configured(case.package, case.catkin, case.package_folder)


def _build(case):
    """Yield a Finding for each source that does not compile and each target that does not link."""
    if case.built and not case.built.ok:
        output, package = case.built.output, case.package
        problems = compiler.problems(output, case.package_folder)
        found = [compiler.finding(package, problem) for problem in problems]
        found += linker.findings(package, output, case.model)
        yield from found or [_unknown(package, case.built, "compile")]


def _not_configured(package, catkin, copy):
    step = catkin.configured
    missing = configuring.absent(package, step.output)
    if missing:
        raise CannotCheck(uses.absent(missing, "cpp"))
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


RULES = (
    Rule(("configure",), ("built",), _configure),
    Rule(("compile", "link"), ("built",), _build),
)
