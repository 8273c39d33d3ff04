# SPDX-License-Identifier: BSD-3-Clause
"""What pylint says of the Python sources, as far as it matters to a node.

It infers what a name stands for, in rospy's own sources, too. Nothing of the package is run or
imported. https://pylint.readthedocs.io/en/stable/user_guide/messages/messages_overview.html
"""

from __future__ import annotations

import ast
import json
from concurrent.futures import Future
from typing import Iterator

from mrp_check.build.row import Row
from mrp_check.code import reading
from mrp_check.contract.errors import CannotCheck, NotHere
from mrp_check.contract.finding import HINT, READ, Finding
from mrp_check.contract.requirements import ANY, Requirement, Rule
from mrp_check.run import evidence
from mrp_check.run.case import Case
from mrp_check.sandbox.confine import Result

_COMMAND = (
    *("/usr/bin/python3", "-m", "pylint", "--rcfile=/dev/null", "--persistent=n", "--exit-zero"),
    *("--output-format=json", "--jobs=1", "--score=n", "--disable=all"),
)
_CATCHES_ALL = Row(
    "This `except` also catches what rospy raises to end the node.",
    "Name the errors that you expect.",
    HINT,
)
_NO_VALUE = Row(
    "The variable may have no value at this line: then Python raises an error.",
    "Give it a value before the condition or the loop; or leave the function in that case.",
)
_TABLE = {
    "assigning-non-slot": Row(
        "The message has no field of that name: Python raises an AttributeError here.",
        "Correct the name; `rosmsg show` lists the fields.",
        READ,
        "no-such-field",
    ),
    "assignment-from-no-return": Row(
        "The function that is called here returns nothing: the variable is None.",
        "Return a value, or don't use the result.",
    ),
    "bare-except": _CATCHES_ALL,
    "broad-exception-caught": _CATCHES_ALL,
    "function-redefined": Row(
        "This name was defined before: Python forgets the first definition.",
        "Give one of the two another name.",
    ),
    "inconsistent-return-statements": Row(
        "On some paths, this function returns a value, and on others None.",
        "Return a value on each path. The callback of a service must return a response.",
        HINT,
    ),
    "no-member": Row(
        "This object has no member of that name: Python raises an AttributeError here.",
        "Correct the name.",
        READ,
    ),
    "no-method-argument": Row(
        "A method's first parameter has to be self: Python can't call this one.",
        "Write self as the first parameter.",
        READ,
    ),
    "no-value-for-parameter": Row(
        "This call lacks an argument: Python raises a TypeError here.",
        "Pass what the function takes.",
        READ,
    ),
    "pointless-statement": Row(
        "This line computes a value, but does nothing with it.",
        "Call the function, write = for ==, or remove the line.",
    ),
    "possibly-used-before-assignment": _NO_VALUE,
    "too-few-format-args": Row(
        "The text has more placeholders than values: Python raises a TypeError here.",
        "Give each placeholder a value.",
        READ,
    ),
    "too-many-format-args": Row(
        "The text has fewer placeholders than values: Python raises a TypeError here.",
        "Write a placeholder such as %s for each value.",
        READ,
    ),
    "too-many-function-args": Row(
        "This call has more arguments than the function takes: Python raises a TypeError here.",
        "Pass what the function takes.",
        READ,
    ),
    "unexpected-keyword-arg": Row(
        "The function has no parameter of that name: Python raises a TypeError here.",
        "Correct the name.",
        READ,
    ),
    "used-before-assignment": _NO_VALUE,
    "using-constant-test": Row(
        "This condition never changes. Often the parentheses of a call are missing.",
        "Call the function that the condition names.",
    ),
}
# Of other classes, pylint may not know what they are given at run time.
_CLASSES = set(
    (
        "ActionClient Buffer Duration Publisher Rate Service ServiceProxy SimpleActionClient"
        " SimpleActionServer Subscriber Time Timer TransformBroadcaster TransformListener"
    ).split()
)


def _begin(case: Case) -> Future[Result] | None:
    """Start pylint, if there is something to read: which files are nodes isn't known yet."""
    files = reading.python_files(case.package)
    paths = [str(case.package_folder / file) for file in files]
    command = *_COMMAND, f"--enable={','.join(_TABLE)}", *paths
    of = case.package.of_kind("python")
    return case.tool("pylint", case.run_once, *command, of=of) if files else None


def _findings(case: Case) -> Iterator[Finding]:
    package, read = case.package, case.facts.python
    files = [file for file in case.facts.relevant if file in read and file not in case.facts.unread]
    running = _begin(case) if files else None
    if not running:
        return
    paths, done = [str(case.package_folder / file) for file in files], running.result()
    if "No module named pylint" in done.errors:
        raise NotHere(["pylint (Debian package pylint)"])
    try:
        entries = json.loads(done.output)
    except ValueError:
        raise CannotCheck(f"pylint failed: {done.errors.strip()[-300:]}") from None
    own = {node.name for source in read.values() for node in source.nodes(ast.ClassDef)}
    for entry in entries:
        row = _TABLE.get(entry["symbol"])
        file = next((f for f, path in zip(files, paths) if path.endswith(entry["path"])), None)
        if row and file and _is_sure(entry, own) and entry["line"] not in read[file].told:
            name = f"pylint calls {entry['symbol']}"
            yield row.finding("pylint", package, file, entry["line"], name, entry["message"])


def _is_sure(entry: dict[str, str], own: set[str]) -> bool:
    """own: the package's own classes"""
    if entry["symbol"] != "no-member":
        return True
    known = _CLASSES | own
    return entry["message"].startswith(tuple(f"Instance of '{name}'" for name in known))


RULE = Rule(
    stage="build",
    needs=("facts",),
    findings=_findings,
    begins=_begin,
    requirements={
        "pylint": Requirement(
            "pylint has no doubts about the Python code", "wrong", evidence.python
        )
    },
    only=ANY,
)
