# SPDX-License-Identifier: BSD-3-Clause
"""A module imports its neighbours by their full name, or with a dot: Python 3 looks for no other
name beside it. https://docs.python.org/3/whatsnew/3.0.html#removed-syntax
"""

from __future__ import annotations

import ast
import os
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.sources import uses


def _findings(case: Case) -> Iterator[Finding]:
    package = case.package
    for file, source in case.facts.python.items():
        folder = os.path.dirname(file)
        is_script = package.shebang(file) or package.is_executable(file)
        if (
            f"{folder}/__init__.py" not in package.files
            or not folder.startswith("src/")
            or is_script
        ):
            continue
        for node in source.import_nodes:
            names = [one.name for one in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level and node.module:
                names = [node.module]
            for name in (one for one in names if one not in uses.STANDARD):
                beside = {f"{folder}/{name}.py", f"{folder}/{name}/__init__.py"}
                if beside & {*package.files} and f"src/{name}.py" not in package.files:
                    yield Finding(
                        "python-names",
                        f"Python 3 does not look for {name} beside this file: it ends with a"
                        " ModuleNotFoundError.",
                        file,
                        node.lineno,
                        WARNING,
                        expected=f"from . import {name}, or from .{name} import ...",
                        seen=package.line(file, node.lineno),
                        fix=f"Write .{name} for {name}.",
                    )


RULE = Rule("static", 111, ("facts",), _findings, also=("python-names",), only=ANY)
