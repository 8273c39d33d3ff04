# SPDX-License-Identifier: BSD-3-Clause
"""The launch file: is it there, and can roslaunch read it?"""

from __future__ import annotations

import re
from typing import Callable, Iterator, Optional, Sequence, Tuple

from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding, Line
from mrp_check.contract.names import last_part, nearest
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.launch import Launch
from mrp_check.package.xml_file import Element, stray
from mrp_check.run import evidence
from mrp_check.run.case import Case

_TAGS = ("launch node group arg param rosparam remap include env machine test master").split()
_OF_NODES = "env param remap rosparam".split()
_WITHIN = {"include": ["arg", "env"], "node": _OF_NODES, "test": _OF_NODES}
_ATTRIBUTES = (
    "args clear_params cwd if launch-prefix name ns output pkg respawn type unless".split()
)


def _findings(case: Case) -> Iterator[Finding]:
    yield from case.launch_file[1]
    for launch in case.launches:
        tags = launch.elements(case.package)
        if launch.error:
            yield _error(launch, tags, case.spec.is_contract)
        yield from _unknown(tags)
        yield from _no_attributes(launch, tags)
        yield from stray("launch-file", case.package, tags, ("rosparam",))


def _unknown(tags: Sequence[tuple[str, Element]]) -> Iterator[Finding]:
    """roslaunch passes over elements that it does not know, or not there."""
    for file, element in tags:
        above = element.parents[-1].tag if element.parents else ""
        known = _WITHIN.get(above, _TAGS)
        if element.tag not in known:
            near = nearest(element.tag, known, 0.5)
            where = f" within <{above}>" if element.tag in _TAGS else ""
            yield Finding(
                "launch-file",
                f"roslaunch doesn't know an element <{element.tag}>{where}, so it ignores it.",
                file,
                element.line,
                HABIT,
                expected=f"<{near}>" if near else "an element of roslaunch",
                seen=f"<{element.tag}>",
                fix=f"Write <{near}>." if near else "Remove it.",
                why="launch-unknown-tag",
            )


# What roslaunch says of an attribute that it passes over.
_NO_ATTRIBUTE = re.compile(r"unknown <(\w+)> attribute '([\w-]+)'")


def _no_attributes(launch: Launch, tags: Sequence[tuple[str, Element]]) -> Iterator[Finding]:
    """Yield a warning for each attribute that roslaunch does not know."""
    said = {match.groups() for match in map(_NO_ATTRIBUTE.search, launch.warned) if match}
    for file, element in tags:
        for name in (one for one in element.attributes if (element.tag, one) in said):
            near = nearest(name, _ATTRIBUTES, 0.7)
            yield Finding(
                "launch-file",
                f"roslaunch doesn't know an attribute {name} of <{element.tag}>, so it ignores it.",
                file,
                element.line,
                HABIT,
                expected=f'{near}="..."' if near else "an attribute of roslaunch",
                seen=f'{name}="{element.attributes[name]}"',
                fix=f"Write {near} for {name}." if near else "Remove it.",
            )


# Where the fault is, what it is, and what to do.
_Words = Tuple[Line, str, Optional[str]]


class _Said:
    """What roslaunch said instead of loading a file; finds the element that is to blame."""

    def __init__(self, launch: Launch, tags: Sequence[tuple[str, Element]]) -> None:
        self.text = " ".join(launch.error.split())
        self.tags, self.start = tags, (launch.file, 1)

    def first(self, condition: Callable[[Element], bool]) -> Line:
        """Return the place of the first element for which the condition holds."""
        return next(((f, e.line) for f, e in self.tags if condition(e)), self.start)

    def named(self, tag: str, name: str) -> list[Line]:
        """Return the places of the elements of that tag and name."""
        same = ((f, e) for f, e in self.tags if e.tag == tag and e.attributes.get("name") == name)
        return [(file, element.line) for file, element in same]

    def not_understood(self, name: str | None = None) -> _Words:
        words = [name] if name else re.findall(r"[\w./$()-]+", self.text)
        place = self.first(lambda e: any(v in words for v in e.attributes.values()))
        return place, f"roslaunch can't load the launch file: {self.text}", None


def _twice(said: _Said, name: str) -> _Words:
    name = last_part(name)
    place = [said.start, *said.named("node", name)][-1]
    message = f"Two nodes of the launch file have the name {name}; each needs its own."
    return place, message, "Give each <node> its own name."


def _attribute(said: _Said, tag: str, name: str) -> _Words:
    place = said.first(lambda e: e.tag == tag and name not in e.attributes)
    message = f'A <{tag}> in the launch file has no {name}="...".'
    return place, message, f'Add {name}="...".'


def _not_there(said: _Said, name: str) -> _Words:
    name = name.strip("'\".,")
    place = said.first(lambda e: any(name in v for v in e.attributes.values()))
    message = f"The launch file names a package or a file that isn't there: {name}."
    return place, message, None


def _argument(said: _Said, name: str) -> _Words:
    declared = said.named("arg", name)
    if declared:
        message = f"The launch file's argument {name} has no value: roslaunch asks for one."
        return declared[0], message, 'Give it a default: default="...".'
    place = said.first(lambda e: any(f"arg {name}" in v for v in e.attributes.values()))
    return place, f"roslaunch can't load the launch file: {said.text}", None


# What roslaunch says where an argument, a variable of the environment, or another package's file
# is missing.
_WANTED = re.compile(r"requires the '\w+' arg|arg to be set|environment variable|[Nn]ot ?[Ff]ound")
# What roslaunch says -> the function of _Said and of its groups that returns (place, message, fix),
# and the entry of the page why.
_WORDS = (
    (r"multiple nodes named \[(\S+?)\]", _twice, "launch-name-twice"),
    (
        r"<(\w+)> tag is missing required attribute:? ?'(\w+)'",
        _attribute,
        "launch-attribute-missing",
    ),
    (
        r"Resource ?[Nn]ot ?[Ff]ound: (?:The following package was not found in .*>: )?(\S+)",
        _not_there,
        "package-not-found",
    ),
    (
        r"arg (?:to be set|named)? ?\[?'?(\w+)'?\]?|requires the '(\w+)' arg",
        _argument,
        "launch-arg-not-set",
    ),
    (r"unknown .*?'(\w+)'|\[(\w+)\] is not a valid|$", _Said.not_understood, ""),
)


def _error(launch: Launch, tags: Sequence[tuple[str, Element]], is_contract: bool) -> Finding:
    """Return the Finding about what roslaunch said instead of loading the file."""
    said = _Said(launch, tags)
    match, words, why = next(
        (match, words, why)
        for shape, words, why in _WORDS
        for match in [re.search(shape, said.text)]
        if match
    )
    place, message, fix = words(said, *filter(None, match.groups()))
    return Finding(
        "launch-file",
        message,
        *place,
        # Another launch file, or who calls it, may give what it wants.
        HINT if _WANTED.search(said.text) and not is_contract else CERTAIN,
        expected="a file that roslaunch can load",
        seen=said.text[:500],
        fix=fix
        or "Correct this line, and try again: roslaunch --nodes says whether it can be read.",
        why=why,
    )


RULE = Rule(
    stage="files",
    needs=("launch",),
    findings=_findings,
    requirements={
        "launch-file": Requirement(
            "The launch file is there and roslaunch can read it", "launching", evidence.always
        )
    },
)
