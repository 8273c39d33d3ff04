# SPDX-License-Identifier: BSD-3-Clause
"""A program looks whether an argument was given, and is a number, before it takes it for one."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case.case import Case
from mrp_check.code import uses
from mrp_check.code.in_both import OfNode
from mrp_check.code.python_source import Source
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import HABIT, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of

_READ = re.compile(r"\bargv\s*\[\s*([1-9])\s*\]")
# The parameter of main(), and what ros::init() takes out of it, say nothing of how many there are.
_TAKEN = re.compile(r"\bint\s+argc\b|\bros::init\s*\(\s*argc\b")
_COUNTED = re.compile(
    r"\bargc\b|\bif\s*\(\s*!?\s*argv\b|\bargv\s*\[\s*\d\s*\]\s*[!=]=\s*(?:NULL|nullptr|0)\b"
)
_NUMBER = re.compile(r"\bato(?:i|l|ll|f)\s*\(\s*argv\b")
# Only one count goes on past this.
_ONLY = re.compile(
    r"\bif\s*\(\s*argc\s*!=\s*(\d+)\s*\)\s*(?:\{[^{}]*?)?\b(?:return|exit)\b[^;{}]*;"
)


def _findings(case: Case) -> Iterator[Finding]:
    for node, files in case.facts.sources.items():
        for file in files:
            source = case.facts.python.get(file)
            if source:
                one = OfNode(case.package, node, file, source, "")
                yield from _of_python(case, one, source)
                yield from _of_python_number(one, source)
                yield from _from_the_end(one, source)
            elif case.package.kind(file) == "cpp":
                code = _TAKEN.sub(uses.blank, uses.code(case.package, file))
                yield from _of(node, file, code)
                yield from _of_number(case, node, file, code)


def _of_python(case: Case, one: OfNode, source: Source) -> Iterator[Finding]:
    """Yield a warning about the first argument that a program reads, if it never counts them."""
    asks = {source.dotted(call.func) for call in source.nodes(ast.Call)}
    counts = [
        call
        for call in source.nodes(ast.Call)
        if isinstance(call.func, ast.Name) and call.func.id == "len" and call.args
        if "argv" in ast.dump(call.args[0])
    ]
    reads = [
        (number, one)
        for one in source.nodes(ast.Subscript)
        if source.dotted(one.value) == "sys.argv" and isinstance(one.ctx, ast.Load)
        for number in [source.value(one.slice)]
        if isinstance(number, int) and number > 0
        if not source.is_guarded(one, "IndexError")
    ]
    if reads and not counts and "rospy.myargv" not in asks:
        number, read = min(reads, key=lambda one: one[1].lineno)
        nodes = [started for launch in case.launches for started in launch.nodes]
        bare = [started for started in nodes if _is_bare(started, one.node)]
        launched = (
            f" {bare[0].file} gives it none: it then gets what roslaunch adds." if bare else ""
        )
        yield one.finding(
            "starts",
            f"{one.node} reads sys.argv[{number}], and does not look whether it was given: without"
            f" it, Python ends with an IndexError here.{launched}",
            read.lineno,
            expected="len(rospy.myargv()), before an argument is read",
            fix="Count the arguments first, and say how the program is used if some are missing.",
        )


def _is_bare(started: Started, node: str) -> bool:
    """Return whether a launch file starts a node without arguments of its own."""
    return started.type == node and not started.arguments


def _from_the_end(one: OfNode, source: Source) -> Iterator[Finding]:
    """Yield a warning about the first argument that is counted from the end."""
    for item in source.nodes(ast.Subscript):
        number = source.value(item.slice) if source.dotted(item.value) == "sys.argv" else None
        if isinstance(number, int) and number < 0:
            yield one.finding(
                "starts",
                f"{one.node} counts its arguments from the end, where roslaunch and remaps add"
                f" some: sys.argv[{number}] is then one of those, and without any it is the"
                " program.",
                item.lineno,
                expected="rospy.myargv()[1]",
                fix="Count from the beginning, in what rospy.myargv() returns.",
            )
            return


def _of_python_number(one: OfNode, source: Source) -> Iterator[Finding]:
    """Yield a warning about the first argument, or what is typed first, that must be a number, if
    nobody catches what Python raises of one that is none."""
    for call in source.nodes(ast.Call):
        name = call.func.id if isinstance(call.func, ast.Name) else ""
        of = call.args[0] if name in ("int", "float") and call.args else None
        if of and _is_given(source, of) and not source.is_guarded(call, "ValueError"):
            yield one.finding(
                "starts",
                f"{name}() raises a ValueError if what is given is no number, and {one.node} does"
                " not catch it: it ends with a traceback.",
                call.lineno,
                expected="try and except ValueError, or argparse",
                fix="Catch the ValueError, and say what was expected.",
            )
            return


def _is_given(source: Source, node: ast.expr) -> bool:
    """Return whether an expression is an argument of the command line, or what somebody types."""
    node = source.only(node) or node
    if isinstance(node, ast.Call):
        return getattr(node.func, "id", "") in ("input", "raw_input")
    return isinstance(node, ast.Subscript) and source.dotted(node.value) == "sys.argv"


def _of_number(case: Case, node: str, file: str, code: str) -> Iterator[Finding]:
    """Yield a warning about the first argument that becomes 0 if it is no number.

    https://en.cppreference.com/w/cpp/string/byte/atoi
    """
    read = _NUMBER.search(code)
    if read:
        name = read[0].partition("(")[0].strip()
        yield Finding(
            "starts",
            f"{name}() makes 0 of an argument that is no number: {node} goes on with a wrong one.",
            file,
            line_of(read),
            HABIT,
            expected="std::stoll(), or std::stod(), which throws std::invalid_argument",
            seen=case.package.line(file, line_of(read)),
            fix=f"Write std::stoll() or std::stod() for {name}(), and say what was wrong.",
            node=node,
        )


def _of(node: str, file: str, code: str) -> Iterator[Finding]:
    only, lines = _ONLY.search(code), code.split("\n")
    for read in _READ.finditer(code):
        line = line_of(read)
        number = int(read[1])
        before = "\n".join(lines[:line])
        if only and only.end() < read.start() and number >= int(only[1]):
            goes_on = f"it goes on with argc == {only[1]} alone: then there is no argv[{number}]"
            fix = f"Ask for argc != {number + 1}."
        elif not only and not _COUNTED.search(before):
            goes_on = f"it does not look at argc first: where no argument is given, argv[{number}]"
            goes_on += " is no text"
            fix = f"Read it only if argc > {number}."
        else:
            continue
        yield Finding(
            "starts",
            f"{node} reads argv[{number}], and {goes_on}. The program then most likely dies.",
            file,
            line,
            HABIT,
            expected=f"argc > {number} wherever argv[{number}] is read",
            seen=lines[line - 1].strip(),
            fix=fix,
            node=node,
        )
        return


RULE = Rule("static", ("facts",), _findings, also=("starts",), only=ANY)
