# SPDX-License-Identifier: BSD-3-Clause
"""The launch file: is it there, and can roslaunch read it?"""

from __future__ import annotations

import re
from typing import Callable, Iterator, Sequence

from mrp_check.contract.finding import CERTAIN, HABIT, HINT, Finding, Line
from mrp_check.contract.names import nearest
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.package.launch import Launch
from mrp_check.package.xml_file import Element
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


# What roslaunch says of an element's attribute or name, or of an element (and the one around it).
_DOUBTED = re.compile(
    r"(?:<(\w+)> (?:attribute|name) |unrecognized (?:tag )?)'?([^'\s]+)'?(?:.* tag .*?<(\w+))?"
)


def _warned(launch: Launch, tags: Sequence[tuple[str, Element]]) -> Iterator[Finding]:
    """Yield a warning for each element that roslaunch warns of."""
    for text in launch.warned:
        found = _DOUBTED.search(text)
        of, word, above = found.groups() if found else ("", "", "")
        warning = re.sub(r"^(\[[^]]*\]|WARN:) ", "", text.splitlines()[0]).partition(": <")[0]
        for file, element in tags:
            words = (*element.attributes, *element.attributes.values()) if of else (element.tag,)
            is_it = element.tag == of or not of
            if is_it and word in words and (not above or element.parents[-1].tag == above):
                near = nearest(word, _KNOWN, 0.6)
                yield Finding(
                    "launch-file",
                    f"roslaunch warns of this element: {warning}",
                    file,
                    element.line,
                    HABIT,
                    expected=near or f"another word than {word}",
                    seen=word,
                    fix=f"Write {near} for {word}." if near else "Correct it, or remove it.",
                )


# What roslaunch says where an argument, a variable of the environment, or another package's file
# is missing.
_WANTED = re.compile(r"requires the '\w+' arg|arg to be set|environment variable|[Nn]ot ?[Ff]ound")
# What roslaunch says -> the entry of the page why.
_TWICE = r"multiple nodes named \[(?:\S*/)?(\S+?)\]"
_ATTRIBUTE = r"<(\w+)> tag is missing required attribute:? ?'(\w+)'"
_NOT_THERE = r"Resource ?[Nn]ot ?[Ff]ound: (?:The following package was not found in .*>: )?(\S+)"
_ARGUMENT = r"(?:arg (?:to be set|named)?|requires the) ?\[?'?(\w+)'?\]?"
_WHY = (
    (_TWICE, "launch-name-twice"),
    (_ATTRIBUTE, "launch-attribute-missing"),
    (_NOT_THERE, "package-not-found"),
    (_ARGUMENT, "launch-arg-not-set"),
    ("", ""),
)


def _error(launch: Launch, tags: Sequence[tuple[str, Element]], is_contract: bool) -> Finding:
    """Return the Finding about what roslaunch said instead of loading the file."""
    error = " ".join(launch.error.split())
    shape, why = next(row for row in _WHY if re.search(row[0], error))
    names = [*re.findall(shape, error)[:1]] if shape else []
    message, fix = f"roslaunch can't load the launch file: {error}", ""

    def first(is_it: Callable[[Element], bool]) -> list[Line]:
        return [(file, element.line) for file, element in tags if is_it(element)][:1]

    def of_name(tag: str, name: str) -> list[Line]:
        found = [(f, e) for f, e in tags if (e.tag, e.attributes.get("name")) == (tag, name)]
        return [(file, element.line) for file, element in found]

    if shape == _TWICE:
        place = of_name("node", names[0])[-1:]
        message = f"Two nodes of the launch file have the name {names[0]}; each needs its own."
        fix = "Give each <node> its own name."
    elif shape == _ATTRIBUTE:
        tag, name = names[0]
        place = first(lambda e: e.tag == tag and name not in e.attributes)
        message, fix = f'A <{tag}> in the launch file has no {name}="...".', f'Add {name}="...".'
    elif shape == _NOT_THERE:
        name = names[0].strip("'\".,")
        place = first(lambda e: any(name in value for value in e.attributes.values()))
        message = f"The launch file names a package or a file that isn't there: {name}."
    elif shape == _ARGUMENT and (place := of_name("arg", names[0])[:1]):
        message = f"The launch file's argument {names[0]} has no value: roslaunch asks for one."
        fix = 'Give it a default: default="...".'
    elif shape == _ARGUMENT:
        place = first(lambda e: any(f"arg {names[0]}" in v for v in e.attributes.values()))
    else:
        word = re.search(r"unknown .*?'(\w+)'|\[(\w+)\] is not a valid", error)
        words = word.groups() if word else re.findall(r"[\w./$()-]+", error)
        place = first(lambda e: bool({*words} & {*e.attributes.values()}))
    return Finding(
        "launch-file",
        message,
        *(place or [(launch.file, 1)])[0],
        # Another launch file, or who calls it, may give what it wants.
        HINT if _WANTED.search(error) and not is_contract else CERTAIN,
        expected="a file that roslaunch can load",
        seen=error[:500],
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
