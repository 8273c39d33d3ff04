# SPDX-License-Identifier: BSD-3-Clause
"""A variable that a parameter is read into has a value where the parameter is not set."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import braced, last_part, line_of, nearest
from mrp_check.sources import uses

_CALL = r"""(?:\w+(?:\.|->)getParam|ros::param::get)\s*\(\s*"([~/\w]+)"\s*,\s*(\w+)\s*\)"""
# A whole statement: what the call returns is not looked at.
_READ = re.compile(rf"(?<=[;{{}})])\s*{_CALL}\s*;")
# What it returns is looked at: the variable has no value where nothing there gives it one.
_ASKED = re.compile(rf"\bif\s*\(\s*(?P<not>!\s*)?{_CALL}\s*\)\s*(?=\{{)")
_ELSE = re.compile(r"\}\s*else\s*(?=\{)")
_LEAVES = r"\b(?:return|throw|exit|abort|shutdown|continue|break)\b"
_NUMBER = r"\b(?:int|double|float|bool|long|short|unsigned|size_t|u?int\d+_t)\s+(?:\w+\s*,\s*)*"


def _findings(case: Case) -> Iterator[Finding]:
    params = {last_part(name) for launch in case.launches for name in launch.params}
    for node, files in case.facts.sources.items():
        for file in files:
            if case.package.kind(file) in ("cpp", "header"):
                yield from _of(node, file, uses.code(case.package, file), params)


def _reads(text: str) -> Iterator[tuple[str, str, re.Match[str]]]:
    """Yield (parameter, variable, place) of each reading that may leave the variable as it is."""
    for match in _READ.finditer(text):
        yield match[1], match[2], match
    for match in _ASKED.finditer(text):
        name, variable = match[2], match[3]
        otherwise = braced(text, match.end())
        end = match.end() + len(otherwise)
        if not match["not"]:
            other = _ELSE.match(text, end)
            otherwise = braced(text, other.end()) if other else ""
            end = other.end() + len(otherwise) if other else end
        is_given = re.search(rf"\b{variable}\s*=(?!=)|[,&]\s*{variable}\b|{_LEAVES}", otherwise)
        function = text.find("\n}", end)
        if not is_given and re.search(rf"\b{variable}\b", text[end:function]):
            yield name, variable, match


def _of(node: str, file: str, text: str, params: set[str]) -> Iterator[Finding]:
    for name, variable, match in _reads(text):
        is_asked = re.search(rf'hasParam\s*\(\s*"{re.escape(name)}"', text)
        if is_asked or _has_value(text, variable, match.start()):
            continue
        near = nearest(last_part(name), params, 0.8)
        yield Finding(
            "starts",
            f"Where the parameter {name} is not set, {variable} has no value: getParam() leaves it"
            " as it is, and it may be any number."
            + (f" A launch file sets {near}." if near and near != last_part(name) else ""),
            file,
            line_of(match, match.lastindex or 0),
            WARNING,
            expected=f'param("{name}", {variable}, DEFAULT), or a value where {variable} is made',
            seen=match.group().strip(),
            fix=f"Give {variable} a value where it is declared.",
            node=node,
        )


def _has_value(text: str, variable: str, at: int) -> bool:
    """Return whether a variable may have a value at a place: it has none if it is a number that is
    declared before without one, and not named since then."""
    declared = [*re.finditer(rf"{_NUMBER}{variable}\s*[;,]", text[:at])]
    before = text[: declared[-1].start()] if declared else ""
    if before.count("{") == before.count("}"):
        return True  # outside of all functions and classes it begins with 0
    between = text[declared[-1].end() : at]
    if between.count("{") == between.count("}"):
        return bool(re.search(rf"\b{variable}\b", between))
    # In a function of its class, another one may have set it.
    return bool(re.search(rf"\b{variable}\s*(=(?!=)|[{{(])|(>>|,)\s*{variable}\s*[;,]", text))


RULE = Rule("static", 92, ("facts",), _findings, also=("starts",), only=ANY)
