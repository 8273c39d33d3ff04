# SPDX-License-Identifier: BSD-3-Clause
"""Publishers and subscribers meet, as their sources say, where they did not run. meeting.py says
it of what ran."""

from __future__ import annotations

import ast
import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
from mrp_check.rules.meeting import End, is_plain, meant
from mrp_check.sources import uses
from mrp_check.sources.python_facts import argument
from mrp_check.sources.python_source import Source

_TYPE = r"(?P<package>\w+)::(?P<type>\w+?)"
_PUBLISHES = re.compile(rf'\badvertise\s*<\s*{_TYPE}\s*>\s*\(\s*"(?P<topic>[^"]+)"')
_SUBSCRIBES = re.compile(
    rf'\bsubscribe\s*(?:<\s*{_TYPE}\s*>\s*)?\(\s*"(?P<topic>[^"]+)"\s*,[^,;]+,'
    r"\s*&?\s*(?:\w+::)*(?P<callback>\w+)"
)
# What a callback takes: std_msgs::String::ConstPtr, std_msgs::StringConstPtr, or the message.
_TAKES = rf"\s*\(\s*(?:const\s+)?{_TYPE}(?:(?:::)?(?:Const)?Ptr)?(?:\s+const)?\s*[&\s,)]"


def _findings(case: Case) -> Iterator[Finding]:
    publishers: list[End] = []
    subscribers: list[End] = []
    launches = [case.package.text(file) for file in case.package.of_kind("launch")]
    if any("<remap" in text for text in launches):
        return  # what is remapped has another name
    is_grouped = any(" ns=" in text for text in launches)
    for node, files in case.facts.sources.items():
        for file, text in uses.cpp_code(case.package, files).items():
            publishers += _of_cpp(_PUBLISHES, text, node, file)
            subscribers += _of_cpp(_SUBSCRIBES, text, node, file)
        for source in filter(None, map(case.facts.python.get, files)):
            publishers += _of_python("rospy.Publisher", source, node)
            subscribers += _of_python("rospy.Subscriber", source, node)
    for end in subscribers:
        others = [one for one in publishers if one.topic == end.topic]
        is_named = not others and not is_grouped and is_plain(case, end)
        near = meant(case, end, publishers, subscribers) if is_named else []
        ends = [end, *(others or near[:1])]
        ran = all(case.nodes[one.node].is_up for one in ends if one.node in case.nodes)
        if ran or end.type in {one.type for one in others}:
            continue
        yield from _apart(end, near[0], "topic") if near else ()
        yield from _apart(end, others[0], "type") if others else ()


def _apart(end: End, other: End, id_: str) -> Iterator[Finding]:
    """Yield the Finding about two ends that do not meet, as their topics or their types differ."""
    if id_ == "topic":
        where = f"{end.topic}, where no node of this package publishes, and"
        what = f"publishes on {other.topic}, with the same type."
        expected, seen = other.topic, end.topic
        fix = "Give both topics one name; a <remap> in the launch file does so, too."
    else:
        where = f"{end.topic} with messages of type {end.type}, and"
        what = f"publishes {other.type} there: with these names, nothing arrives."
        expected, seen = other.type, end.type
        fix = "Let both use the same type, or give the topics two names."
    said = f"{end.node} subscribes to {where} {other.node} {what}"
    place = end.file, end.line
    yield Finding(id_, said, *place, WARNING, expected, seen, fix, node=end.node)


def _of_cpp(shape: re.Pattern[str], text: str, node: str, file: str) -> Iterator[End]:
    for match in shape.finditer(text):
        named: re.Match[str] | None = match
        if not match["type"]:
            named = re.search(rf"\b{match['callback']}{_TAKES}", text)
        if named:
            type_ = f"{named['package']}/{named['type']}"
            yield End(node, match["topic"].strip("/"), type_, file, line_of(match, "topic"))


def _of_python(maker: str, source: Source, node: str) -> Iterator[End]:
    for call in source.nodes(ast.Call):
        if source.dotted(call.func) == maker:
            topic = source.value(argument(call, 0, "name"))
            class_ = source.dotted(argument(call, 1, "data_class"))
            made = re.fullmatch(r"(\w+)\.msg\.(\w+)", class_ or "")
            if isinstance(topic, str) and made:
                type_ = f"{made[1]}/{made[2]}"
                yield End(node, topic.strip("/"), type_, source.file, call.lineno)


RULE = Rule("run", 26, ("nodes",), _findings, also=("topic", "type"), only=ANY)
