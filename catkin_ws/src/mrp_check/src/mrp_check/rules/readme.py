# SPDX-License-Identifier: BSD-3-Clause
"""What a README says can be typed: its rosrun and roslaunch name what the package has."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import last_part, line_of, nearest, perhaps
from mrp_check.sources import uses

_COMMAND = re.compile(r"\b(rosrun|roslaunch)[ \t]+([A-Za-z]\w*)[ \t]+([A-Za-z][\w.-]*\w)(?![\w/<])")
_FILE = re.compile(r"(?i)^readme(\.\w+)?$")


def _findings(case: Case) -> Iterator[Finding]:
    package, model = case.package, case.model
    scripts = {last_part(path) for path in package.of_kind("python")}
    programs = {*model.executables(), *scripts} if model.complete else set()
    has = {"rosrun": programs, "roslaunch": {last_part(p) for p in package.of_kind("launch")}}
    for file in filter(_FILE.match, package.files):
        for command in _COMMAND.finditer(package.text(file)):
            tool, owner, what = command.groups()
            known = has[tool]
            if owner == package.name and known and what not in known:
                near = nearest(what, known)
                said = f"this package has no such {_KIND[tool]}.{perhaps(near)}"
                wrong, right = what, near
            elif owner != package.name and what in known and not uses.is_called_so(owner):
                said = f"the package is called {package.name}."
                wrong, right = owner, package.name
            else:
                continue
            yield Finding(
                "package-name" if wrong == owner else "starts",
                f"{file} says '{command[0]}', and {said}",
                file,
                line_of(command),
                WARNING,
                expected=right or f"what {tool} finds in this package",
                seen=wrong,
                fix=f"Write {right} for {wrong}." if right else "Name what is there.",
            )


_KIND = {"rosrun": "program", "roslaunch": "launch file"}


RULE = Rule("files", 43, ("model",), _findings, also=("package-name", "starts"), only=ANY)
