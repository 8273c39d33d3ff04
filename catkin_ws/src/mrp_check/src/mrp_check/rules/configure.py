# SPDX-License-Identifier: BSD-3-Clause
"""CMake can configure the package."""

from __future__ import annotations

from typing import Iterator

from mrp_check import evidence
from mrp_check.building import configuring
from mrp_check.case import Case
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.sources import uses


def findings(case: Case) -> Iterator[Finding]:
    if case.built is not None:
        return
    package, step = case.package, case.catkin.configured
    missing = configuring.absent(package, step.output, case.spec.is_contract)
    if missing:
        # CMake stops at the first.
        others = [one for one in case.catkin.model.components if not uses.is_ros_package(one)]
        names = [missing, *(one for one in others if one != missing and uses.is_called_so(one))]
        raise CannotCheck(" ".join(uses.absent(one, "cpp") for one in names))
    missing = configuring.without_definitions(step.output)
    if missing:
        raise CannotCheck(uses.absent(missing, "msg"))
    output = "" if step.why_ended else step.output
    finding = configuring.finding(package, output, case.package_folder, case.catkin.model)
    yield finding or configuring.unknown(package, step, "configure")


RULE = Rule(
    stage="build",
    order=10,
    needs=("built",),
    findings=findings,
    requirements={
        "configure": Requirement("CMake can configure the package", "building", evidence.cmake)
    },
)
