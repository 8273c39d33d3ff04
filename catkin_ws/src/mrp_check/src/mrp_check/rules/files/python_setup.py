# SPDX-License-Identifier: BSD-3-Clause
"""The Python packages that setup.py names are there, and it imports no distutils."""

from __future__ import annotations

import ast
import posixpath
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import Rule
from mrp_check.package.package import Package

FILE = "setup.py"


def _findings(case: Case) -> Iterator[Finding]:
    package = case.package
    is_used = any(call.command == "catkin_python_setup" for call in case.model.calls)
    if is_used and FILE in package.files:
        yield from _old(package)
        yield from _no_folder(package)


def _old(package: Package) -> Iterator[Finding]:
    """https://wiki.ros.org/noetic/Migration#Setuptools_instead_of_Distutils"""
    place = package.first_match([FILE], r"^\s*(?:from|import)\s+distutils\b")
    if place:
        yield Finding(
            "cmake",
            f"{FILE} imports distutils, which Python has not any more from 3.12 on.",
            *place,
            HABIT,
            expected="from setuptools import setup",
            seen=package.line(*place),
            fix="Take setup from setuptools; package.xml then needs"
            " <buildtool_depend>python3-setuptools</buildtool_depend>.",
        )


def _no_folder(package: Package) -> Iterator[Finding]:
    """Yield a finding for each: catkin_make takes it, and `catkin_make install` fails."""
    given = {
        keyword.arg: _plain(keyword.value)
        for call in ast.walk(package.tree(FILE))
        if isinstance(call, ast.Call)
        for keyword in call.keywords
    }
    names, folders = given.get("packages"), given.get("package_dir") or {}
    if not isinstance(names, list) or not isinstance(folders, dict):
        return
    for name in filter(lambda one: isinstance(one, str), names):
        folder = folders.get(name) or posixpath.join(folders.get("", ""), name.replace(".", "/"))
        if not (package.root / folder).is_dir():
            line = package.find_line(FILE, name, 1)
            yield Finding(
                "cmake",
                f"{FILE} names the Python package {name}, and there is no folder {folder}:"
                " `catkin_make install` fails.",
                FILE,
                line,
                HABIT,
                expected=f"a folder {folder} with a file __init__.py",
                seen=package.line(FILE, line),
                fix=f"Make the folder; or take {FILE} and catkin_python_setup() away.",
            )


def _plain(node: ast.expr) -> object:
    try:
        return ast.literal_eval(node)
    except ValueError:
        return None


RULE = Rule(
    stage="files",
    needs=("model",),
    findings=_findings,
    also=("cmake",),
)
