# SPDX-License-Identifier: BSD-3-Clause
"""The launch file: is it there, and can roslaunch read it?"""

from __future__ import annotations

import re

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import Requirement, Rule
from mrp_check.contract.words import nearest
from mrp_check.running import evidence

_TAGS = ("launch node group arg param rosparam remap include env machine test master").split()


def findings(package, spec, launch):
    """Yield findings about a launch file that is XML, from a launch.Launch."""
    tags = launch.elements(package)
    if launch.error:
        yield _error(package, launch, tags)
    else:
        yield from _unknown(tags)


def _unknown(tags):
    """roslaunch passes over elements and attributes that it does not know."""
    for file, element in tags:
        if element.tag not in _TAGS:
            near = nearest(element.tag, _TAGS, 0.5)
            yield Finding(
                "launch-file",
                f"roslaunch knows no element <{element.tag}>, and passes over it.",
                file,
                element.line,
                WARNING,
                expected=f"<{near}>" if near else "an element of roslaunch",
                seen=f"<{element.tag}>",
                fix=f"Write <{near}>." if near else "Take it out.",
            )


def _error(package, launch, tags):
    """Return the Finding about what roslaunch said instead of loading the file."""
    text = " ".join(launch.error.split())
    file, line = launch.file, 1

    def first(condition):
        return next(((f, e.line) for f, e in tags if condition(e)), (file, 1))

    def named(tag, name):
        return [(f, e.line) for f, e in tags if e.tag == tag and e.attributes.get("name") == name]

    twice = re.search(r"multiple nodes named \[(\S+?)\]", text)
    attribute = re.search(r"<(\w+)> tag is missing required attribute:? ?'(\w+)'", text)
    argument = re.search(
        r"arg (?:to be set|named)? ?\[?'?(\w+)'?\]?|requires the '(\w+)' arg", text
    )
    missing = re.search(r"Resource ?[Nn]ot ?[Ff]ound: (\S+)", text)
    unknown = re.search(r"unknown .*?'(\w+)'|\[(\w+)\] is not a valid", text)
    fix = "Mend this line, and try again: roslaunch --nodes says whether it can be read."
    if twice:
        name = twice.group(1).rsplit("/", 1)[-1]
        lines = named("node", name)
        file, line = lines[-1] if lines else (file, 1)
        message = f"Two nodes of the launch file have the name {name}; each needs its own."
        fix = "Give each <node> its own name."
    elif attribute:
        tag, name = attribute.groups()
        file, line = first(lambda e: e.tag == tag and name not in e.attributes)
        message = f'A <{tag}> in the launch file has no {name}="...".'
        fix = f'Add {name}="...".'
    elif missing:
        name = missing.group(1).strip("'\".,")
        file, line = first(lambda e: any(name in v for v in e.attributes.values()))
        message = f"The launch file names a package or a file that is not there: {name}."
    elif argument and ("arg" in text):
        name = next(filter(None, argument.groups()))
        declared = named("arg", name)
        if declared:
            file, line = declared[0]
            message = f"The launch file's argument {name} has no value: roslaunch asks for one."
            fix = 'Give it one for when no other is given: default="...".'
        else:
            file, line = first(lambda e: any(f"arg {name}" in v for v in e.attributes.values()))
            message = f"roslaunch cannot load the launch file: {text}"
    else:
        words = re.findall(r"[\w./$()-]+", text)
        if unknown:
            words = [next(filter(None, unknown.groups()))]
        file, line = first(lambda e: any(v in words for v in e.attributes.values()))
        message = f"roslaunch cannot load the launch file: {text}"
    return Finding(
        "launch-file",
        message,
        file,
        line,
        expected="a file that roslaunch can load",
        seen=text[:500],
        fix=fix,
    )


def _findings(case):
    yield from case.launch_file[1]
    if case.launch:
        yield from findings(case.package, case.spec, case.launch)


RULE = Rule(
    stage="files",
    order=90,
    needs=("launch",),
    findings=_findings,
    requirements={
        "launch-file": Requirement(
            "The launch file is there and roslaunch can read it", "launching", evidence.always
        )
    },
)
