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

# roslaunch's elements, and the attributes of a <node>.
_KNOWN = (
    "launch node group arg param rosparam remap include env machine test"
    " args clear_params cwd if launch-prefix name ns output pkg respawn type unless"
).split()


def _findings(case: Case) -> Iterator[Finding]:
    yield from case.launch_file[1]
    for launch in case.launches:
        tags = launch.elements(case.package)
        if launch.error:
            yield _error(launch, tags, case.spec.is_contract)
        yield from _warned(launch, tags)
        yield from stray("launch-file", case.package, tags, ("rosparam",))


# What roslaunch says of an element's attribute or name, or of an element (and the one around it).
_DOUBTED = re.compile(
    r"(?:<(\w+)> (?:attribute|name) |unrecognized (?:tag )?)'?([^'\s]+)'?(?:.* tag .*?<(\w+))?"
)


def _warned(launch: Launch, tags: Sequence[tuple[str, Element]]) -> Iterator[Finding]:
    """Yield a warning for each element that roslaunch warns of."""
    for text in launch.warned:
        found = _DOUBTED.search(text)
        of, word, above = found.groups() if found else ("", "", "")
        said = re.sub(r"^(\[[^]]*\]|WARN:) ", "", text.splitlines()[0]).partition(": <")[0]
        for file, element in tags:
            words = (*element.attributes, *element.attributes.values()) if of else (element.tag,)
            is_it = element.tag == of or not of
            if is_it and word in words and (not above or element.parents[-1].tag == above):
                near = nearest(word, _KNOWN, 0.6)
                yield Finding(
                    "launch-file",
                    f"roslaunch warns of this element: {said}",
                    file,
                    element.line,
                    HABIT,
                    expected=near or f"another word than {word}",
                    seen=word,
                    fix=f"Write {near} for {word}." if near else "Correct it, or remove it.",
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
