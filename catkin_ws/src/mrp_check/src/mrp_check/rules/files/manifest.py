# SPDX-License-Identifier: BSD-3-Clause
"""package.xml: is it complete and valid?"""

from __future__ import annotations

from typing import Iterator

from mrp_check.contract.finding import HABIT, HINT, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.manifest import FILE, Manifest, of_ros_2
from mrp_check.package.package import Package
from mrp_check.run import evidence
from mrp_check.run.case import Case


def _findings(case: Case) -> Iterator[Finding]:
    package, (manifest, problem) = case.package, case.manifest
    if problem:
        yield problem
    if manifest and "catkin" not in {d.name for d in manifest.buildtool_depends}:
        yield _not_of_catkin(package, manifest)
    if manifest and "TODO" in manifest.licenses:
        yield _no_licence(case)


def _not_of_catkin(package: Package, manifest: Manifest) -> Finding:
    line = "<buildtool_depend>catkin</buildtool_depend>"
    message = "package.xml doesn't say that the package is built with catkin."
    expected, fix, why = line, f"Add the line {line}.", "buildtool-missing"
    ros_2 = of_ros_2(manifest)
    if ros_2:
        message = f"This is a package for ROS 2: it needs {ros_2}, which ROS 1 doesn't have."
        expected, why = "a package for ROS 1", "package-of-ros2"
        fix = "Take its version for ROS 1, if there is one."
    return Finding(
        "manifest",
        message,
        FILE,
        # Where it belongs: at the first of the dependencies.
        package.find_line(FILE, "depend>", package.find_line(FILE, "<package", 1)),
        expected=expected,
        seen=", ".join(d.name for d in manifest.buildtool_depends) or "no buildtool_depend",
        fix=fix,
        why=why,
    )


def _no_licence(case: Case) -> Finding:
    # A tag may have an attribute, or go over several lines.
    tag = case.package.find_line(FILE, "<license", 1)
    return Finding(
        "licensed",
        "package.xml still has the licence that catkin_create_pkg wrote, so nobody may use the"
        " package.",
        FILE,
        case.package.find_line(FILE, "TODO</license>", tag),
        HABIT if case.spec.is_contract else HINT,
        expected="the name of a licence, such as BSD-3-Clause",
        seen="<license>TODO</license>",
        fix="Choose a licence, and write its name.",
    )


RULE = Rule(
    stage="files",
    needs=("manifest",),
    findings=_findings,
    requirements={
        "manifest": Requirement(
            "package.xml is complete and valid", "building#package-xml", evidence.always
        ),
        "licensed": Requirement(
            "package.xml names a licence", "building#package-xml", evidence.manifest
        ),
    },
)
