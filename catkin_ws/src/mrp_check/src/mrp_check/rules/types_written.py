# SPDX-License-Identifier: BSD-3-Clause
"""Publishers and subscribers of one topic have one type, as their sources say, where they did not
run. meeting.py says it of what ran."""

from __future__ import annotations

import ast
import re
from typing import Iterator, NamedTuple

from mrp_check.case import Case
from mrp_check.contract.finding import WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import line_of
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


class _End(NamedTuple):
    node: str
    topic: str
    type: str
    file: str
    line: int


def _findings(case: Case) -> Iterator[Finding]:
    publishers: list[_End] = []
    subscribers: list[_End] = []
    if any("<remap" in case.package.text(file) for file in case.package.of_kind("launch")):
        return  # what is remapped has another name
    for node, files in case.facts.sources.items():
        for file, text in uses.cpp_code(case.package, files).items():
            publishers += _of_cpp(_PUBLISHES, text, node, file)
            subscribers += _of_cpp(_SUBSCRIBES, text, node, file)
        for source in filter(None, map(case.facts.python.get, files)):
            publishers += _of_python("rospy.Publisher", source, node)
            subscribers += _of_python("rospy.Subscriber", source, node)
    for end in subscribers:
        others = [one for one in publishers if one.topic == end.topic]
        ran = all(case.nodes[one.node].is_up for one in (end, *others) if one.node in case.nodes)
        if not others or ran or end.type in {one.type for one in others}:
            continue
        other = others[0]
        yield Finding(
            "type",
            f"{end.node} subscribes to {end.topic} with messages of type {end.type}, and"
            f" {other.node} publishes {other.type} there: with these names, nothing arrives.",
            end.file,
            end.line,
            WARNING,
            expected=other.type,
            seen=end.type,
            fix="Let both use the same type, or give the topics two names.",
            node=end.node,
        )


def _of_cpp(shape: re.Pattern[str], text: str, node: str, file: str) -> Iterator[_End]:
    for match in shape.finditer(text):
        named: re.Match[str] | None = match
        if not match["type"]:
            named = re.search(rf"\b{match['callback']}{_TAKES}", text)
        if named:
            type_ = f"{named['package']}/{named['type']}"
            yield _End(node, match["topic"].strip("/"), type_, file, line_of(match, "topic"))


def _of_python(maker: str, source: Source, node: str) -> Iterator[_End]:
    for call in source.nodes(ast.Call):
        if source.dotted(call.func) == maker:
            topic = source.value(argument(call, 0, "name"))
            class_ = source.dotted(argument(call, 1, "data_class"))
            made = re.fullmatch(r"(\w+)\.msg\.(\w+)", class_ or "")
            if isinstance(topic, str) and made:
                type_ = f"{made[1]}/{made[2]}"
                yield _End(node, topic.strip("/"), type_, source.file, call.lineno)


RULE = Rule("run", 26, ("nodes",), _findings, also=("type",), only=ANY)
