# SPDX-License-Identifier: BSD-3-Clause
"""What a launch file gives a node is named in the sources: a parameter, or a name to change."""

from __future__ import annotations

import re
from typing import Iterator

from mrp_check.case import Case
from mrp_check.confined.launch_dump import Started
from mrp_check.contract.finding import NOTE, WARNING, Finding
from mrp_check.contract.requirements import ANY, Rule
from mrp_check.contract.words import last_part
from mrp_check.rules.launch_remap import remap_line
from mrp_check.sources import asked, uses
from mrp_check.student.launch import Launch

# What reads parameters, or publishes, under names that stand in no source of the node.
_UNSEEN = re.compile(
    r"\b(get_param_names|getParamNames|search\w*param)\b|(?i:param)\w*\s*(<[\w:]+>\s*)?\(\s*[^\"'\s)]"
    r"|dynamic_reconfigure|nodelet|plugin|actionlib|image_transport|camera_info|controller|diagnos"
    r"|tf2?_ros|moveit|message_filters"
)
_OF_ROS = {"/use_sim_time", "/robot_description", "/rosversion", "/rosdistro", "/run_id"}
# A node that has one of these may read its own parameters.
_PRIVATE = re.compile(r"""["']~|get_name\s*\(|getName\s*\(|getNamespace|PrivateNodeHandle""")
# What reads a parameter by the name that it is given, and a NodeHandle without a name of its own.
_READS = r"""(\w+)(?:\.|->)(?:get|has)?[pP]aram\w*\s*(?:<[^;()]*>\s*)?\(\s*["']{}["']"""
_PUBLIC = r"\bros::NodeHandle\s+{}\s*(?:;|\(\s*\)|\{{\s*\}})"
_GIVEN = r"(?<!NodeHandle )\b{}\s*(?:[({{]\s*[^)}}\s]|=)"  # it may get a name of its own there


def _findings(case: Case) -> Iterator[Finding]:
    # A node may be of many classes: all that the package has may be its own.
    files = case.package.of_kind("cpp", "header", "python")
    text = "\n".join(uses.code(case.package, file) for file in files)
    is_seen = not _UNSEEN.search(text)
    for launch in case.launches:
        yield from _of_nobody(case, launch, text) if is_seen else ()
        for node in launch.nodes:
            if node.package == case.package.name and case.facts.sources.get(node.type):
                yield from _of_own(case, launch, node, text)
                if not is_seen:
                    continue
                yield from _of_params(case, launch, node, text)
                if node.type not in case.nodes or not case.nodes[node.type].is_up:
                    yield from _of_remaps(case, node, text)


def _of_params(case: Case, launch: Launch, node: Started, text: str) -> Iterator[Finding]:
    for own in _own(launch, node).values():
        if any(is_named(part, text) for part in own.split("/")):
            continue
        lines = [
            (file, element.line)
            for file, element in launch.elements(case.package)
            if element.tag == "param" and last_part(element.attributes.get("name", "")) == own
        ]
        file, line = lines[0] if lines else (node.file, node.line)
        yield Finding(
            "starts",
            f"The launch file sets the parameter {own} of {node.name}, and no source of this"
            " package names it: it changes nothing.",
            file,
            line,
            WARNING,
            expected="a parameter that the node reads",
            seen=f"{own}, which nothing reads",
            fix=f"Read {own} in the node; or take the <param> out.",
            node=node.type,
        )


def _of_nobody(case: Case, launch: Launch, text: str) -> Iterator[Finding]:
    """Yield a note for each parameter beside the nodes' own that nothing names, where a launch file
    starts nodes of this package alone."""
    if any(node.package != case.package.name for node in launch.nodes):
        return
    own = tuple(f"{node.path}/" for node in launch.nodes)
    tags = launch.elements(case.package)
    for name in (one for one in launch.params if not one.startswith(own) and one not in _OF_ROS):
        if any(is_named(part, text) for part in name.strip("/").split("/")):
            continue
        sets = [one for one in tags if one[1].attributes.get("name", "") == last_part(name)]
        sets += [one for one in tags if one[1].tag == "rosparam"]
        for file, element in sets[:1]:
            yield Finding(
                "starts",
                f"{file} sets the parameter {name}, and no source of this package names it.",
                file,
                element.line,
                NOTE,
                expected="a parameter that a node reads",
                seen=f"{name}, which nothing reads",
                fix=f"Read {last_part(name)} in a node; or take it out.",
            )


def _own(launch: Launch, node: Started) -> dict[str, str]:
    """Return full name -> the rest behind the node's own, of the parameters that it is given."""
    begin = f"{node.path}/"
    return {name: name[len(begin) :] for name in launch.params if name.startswith(begin)}


def _of_own(case: Case, launch: Launch, node: Started, text: str) -> Iterator[Finding]:
    """Yield a Finding about a parameter of a node's own that its sources ask for as another one."""
    said = sorted(asked.of(case.package, case.facts.sources[node.type]), key=lambda one: one.line)
    for name, own in _own(launch, node).items():
        there = [one for one in said if one.what in ("reads", "knows") and one.name == own]
        others = [one for one in launch.params if one != name and last_part(one) == last_part(own)]
        if there and not others and (not _PRIVATE.search(text) or _is_public(case, there[0])):
            yield Finding(
                "starts",
                f"{node.file} sets {own} within {node.name}: that is {name}. The node reads {own}"
                " beside it, and finds none.",
                there[0].file,
                there[0].line,
                WARNING,
                expected=f"~{own}"
                if case.package.kind(there[0].file) == "python"
                else 'ros::NodeHandle("~")',
                seen=case.package.line(there[0].file, there[0].line),
                fix="Read it as a private parameter; or set it outside of <node>.",
                node=node.type,
            )


def _is_public(case: Case, said: asked.Said) -> bool:
    """Return whether a parameter is read beside the node's own by a node that has both."""
    if case.package.kind(said.file) == "python":
        return "~" not in said.name
    text = uses.code(case.package, said.file)
    handles = {found[1] for found in re.finditer(_READS.format(re.escape(said.name)), text)}
    return bool(handles) and all(
        len(re.findall(rf"\bNodeHandle\s+{one}\b", text)) == 1
        and re.search(_PUBLIC.format(one), text)
        and not re.search(_GIVEN.format(one), text)
        for one in handles
    )


def _of_remaps(case: Case, node: Started, text: str) -> Iterator[Finding]:
    """Yield those of a node that was not seen: of one that was, it is known what it uses."""
    for old, new in node.remaps:
        if not is_named(last_part(old).lstrip("~"), text):
            yield Finding(
                "topic",
                f"The launch file renames {old} of {node.name}, and no source of this package has"
                " such a name.",
                node.file,
                remap_line(case.package, node, old, new),
                WARNING,
                expected="a name that the node uses",
                seen=f"{old} renamed to {new}",
                node=node.type,
            )


def is_named(name: str, text: str) -> bool:
    """Return whether a text has a name, and not only as a part of another one."""
    return re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text) is not None


RULE = Rule("run", 23, ("nodes",), _findings, also=("starts", "topic"), only=ANY)
