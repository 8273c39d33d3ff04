# SPDX-License-Identifier: BSD-3-Clause
"""CMake can configure the package."""

from __future__ import annotations

from typing import Iterator

from mrp_check.build import configuring, stubs
from mrp_check.build.catkin import WANTS_TESTS
from mrp_check.code import uses
from mrp_check.contract.errors import NotHere
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.case import Case


def findings(case: Case) -> Iterator[Finding]:
    package, step = case.package, case.catkin.configured
    if case.built is not None:
        yield from _wants_tests(case)
        if case.catkin.stubs.names:
            raise NotHere(uses.absent(name, "cpp") for name in case.catkin.stubs.names)
        return
    missing = stubs.absent(package, step.output, case.spec.is_contract)
    if missing:
        # CMake stops at the first.
        others = [
            component
            for component in case.catkin.model.components
            if uses.is_called_so(package, component) and not uses.is_here(package, component)
        ]
        names = dict.fromkeys([missing, *others])
        raise NotHere(uses.absent(name, "cpp") for name in names)
    missing = configuring.without_definitions(step.output)
    if missing:
        raise NotHere([uses.absent(missing, "msg")])
    output = "" if step.why_ended else step.output
    finding = configuring.finding(package, output, case.package_folder, case.catkin.model)
    yield finding or configuring.unknown(package, step, "configure")


def _wants_tests(case: Case) -> Iterator[Finding]:
    """Yield a warning if CMake went on only as tests were made, too."""
    output = case.catkin.configured.output
    if WANTS_TESTS in " ".join(output.split()):
        found = configuring.finding(case.package, output, case.package_folder, case.catkin.model)
        if found:
            found.certainty = HABIT
            found.message += " With catkin_make, which builds tests, it continues."
            yield found


RULE = Rule(
    stage="build",
    needs=("built",),
    findings=findings,
    requirements={
        "configure": Requirement("CMake can configure the package", "building", evidence.cmake)
    },
)
