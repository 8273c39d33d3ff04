# SPDX-License-Identifier: BSD-3-Clause
"""package.xml: can catkin read it, and what does it name?"""

from __future__ import annotations

import re
import xml.parsers.expat
import xml.sax.saxutils

from catkin_pkg.package import InvalidPackage, parse_package_string
from catkin_pkg.package import Package as Manifest

from mrp_check.contract.finding import Finding
from mrp_check.package.package import Package
from mrp_check.package.workspace import Workspace
from mrp_check.package.xml_file import elements, xml_finding

FILE = "package.xml"
_OF_ROS_2 = ("ament_", "rclcpp", "rclpy", "rosidl_")


def parse(package: Package) -> tuple[Manifest | None, Finding | None]:
    """Return (catkin_pkg's Package or None, the Finding that says why not, or None)."""
    data = package.bytes(FILE)
    try:
        elements(data)
    except xml.parsers.expat.ExpatError as error:
        return None, xml_finding("manifest", package, FILE, error, why="package-xml-no-xml")
    try:
        text = data.decode("utf-8", "replace").lstrip("\ufeff")
        # It would print its warnings: rules/files/package_name.py reports what matters of them.
        return parse_package_string(text, FILE, warnings=[]), None
    except (InvalidPackage, AssertionError, ValueError) as error:
        text = " ".join(str(error).replace(f"Error(s) in package '{FILE}':", "").split())
        return None, Finding(
            "manifest",
            f"package.xml isn't valid: {text}",
            FILE,
            _line_of(package, text),
            expected="a manifest as catkin reads it",
            seen=text,
            fix="Compare it with the package.xml of the tutorial's package.",
            why="package-xml-invalid",
        )


def _line_of(package: Package, text: str) -> int | None:
    """Return the line of the first tag, attribute or value that a message names."""
    words = re.findall(r"following tags: ([\w, ]+)", text) or re.findall(r"\"([^\"]+)\"", text)
    for word in ",".join(words).replace(" ", "").split(","):
        line = package.find_line(FILE, f"<{word}") or package.find_line(FILE, f">{word}<")
        if word.strip() and line:
            return line
    return package.find_line(FILE, "<package", 1)


def replace(workspace: Workspace) -> None:
    """Put a valid package.xml into the copy, so that what comes after can be checked."""
    name = workspace.package.name
    (workspace.package_folder / FILE).write_text(
        f'<package format="3"><name>{xml.sax.saxutils.escape(name)}</name><version>0.0.0</version>'
        '<description>x</description><maintainer email="x@x.example">x</maintainer>'
        "<license>x</license><buildtool_depend>catkin</buildtool_depend>"
        + "".join(f"<depend>{needed}</depend>" for needed in ("roscpp", "rospy", "std_msgs"))
        + "<depend>message_generation</depend><depend>message_runtime</depend></package>"
    )


def of_ros_2(manifest: Manifest | None) -> str:
    """Return what a package of ROS 2 needs that ROS 1 has not, such as ament_cmake; or nothing."""
    depends = manifest.buildtool_depends + manifest.exec_depends if manifest else []
    names = [depend.name for depend in depends]
    if "catkin" in names:
        return ""
    return next((name for name in names if name.startswith(_OF_ROS_2)), "")


def declared(manifest: Manifest) -> dict[str, set[str]]:
    """Return kind -> names of the packages that a manifest declares."""
    return {
        "build": {d.name for d in manifest.build_depends},
        "exec": {d.name for d in [*manifest.exec_depends, *manifest.run_depends]},
        "export": {d.name for d in manifest.build_export_depends},
        "test": {d.name for d in manifest.test_depends},
    }


def named(manifest: Manifest, tests: bool = True) -> set[str]:
    """Return the names of all packages that a manifest declares, with or without those of tests."""
    known = declared(manifest).items()
    return set().union(*(names for kind, names in known if kind != "test" or tests))


def first_dependency(package: Package, tag: str = "") -> int:
    """Return the line in package.xml at which its dependencies begin, other than catkin, or those
    with a tag, if there are any: where a reader looks for one that is missing."""
    named = [element for element in elements(package.bytes(FILE)) if element.tag.endswith("depend")]
    named = [element for element in named if element.tag != "buildtool_depend"] or named
    named = [element for element in named if element.tag == tag] or named
    return named[0].line if named else package.find_line(FILE, "<package", 1)
