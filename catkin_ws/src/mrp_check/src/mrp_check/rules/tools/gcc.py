# SPDX-License-Identifier: BSD-3-Clause
"""What g++ warns of: it takes these lines, and they do something else than they seem to.

build/compiler.py says with which options it is called.
https://gcc.gnu.org/onlinedocs/gcc/Warning-Options.html
"""

from __future__ import annotations

from typing import Iterator

from mrp_check.build import compiler
from mrp_check.build.row import Row
from mrp_check.contract.finding import Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.run.case import Case

_FORMAT = "Make each placeholder fit its value, such as %d for an int."
_VALUE = "Give the variable a value where it is declared."
_TABLE = {
    "address": Row(
        "A function is named here, but not called: as a condition, that's always true.",
        "Call it: ros::ok(), with parentheses.",
    ),
    "div-by-zero": Row("Something is divided by 0 here."),
    "duplicated-cond": Row("This condition was tested before, so its branch is never taken."),
    "empty-body": Row("A semicolon ends this line: what follows always runs."),
    "format": Row("The format doesn't fit its value: any number may be shown.", _FORMAT),
    "format-extra-args": Row("The format has fewer placeholders than values.", _FORMAT),
    "format-security": Row('A text without a format is printed: write "%s" before it.', _FORMAT),
    "maybe-uninitialized": Row("This reads a variable that may have no value.", _VALUE),
    "misleading-indentation": Row("The indented lines don't all belong to the line above them."),
    "overflow": Row("The number is too large for its type."),
    "parentheses": Row("Perhaps you meant ==, or parentheses are missing."),
    "return-type": Row(
        "On some paths, this function returns nothing: its caller gets an arbitrary value."
    ),
    "tautological-compare": Row("This comparison is always true, or always false."),
    "type-limits": Row("This comparison is always true, or always false."),
    "uninitialized": Row("This reads a variable that has no value.", _VALUE),
    "unused-value": Row("This line computes something, but does nothing with it."),
}


def _findings(case: Case) -> Iterator[Finding]:
    """Yield a warning for each line of the package's own."""
    output = case.built.output if case.built else ""
    places = set()
    for file, line, name, text in compiler.warnings(output, case.package_folder):
        # Without any return, it is an error.
        if (file, line) not in places and name in _TABLE and "no return statement" not in text:
            places.add((file, line))
            row = _TABLE[name]
            yield row.finding("compile", case.package, file, line, f"g++ calls -W{name}", text)


RULE = Rule("build", ("built",), _findings, also=("compile",), only=ANY)
