# SPDX-License-Identifier: BSD-3-Clause
"""The launch file: can roslaunch read it, and does it start the spec's nodes as it should?"""

from __future__ import annotations

import difflib
import os
import re
import xml.parsers.expat

from mrp_check.contract.finding import WARNING, Finding
from mrp_check.sources import uses
from mrp_check.student import launch as launching
from mrp_check.student.manifest import xml_finding


def readable(package, spec):
    """Return (path of the launch file or None, the Findings that say why it cannot be loaded)."""
    path = launching.find(package, spec)
    if path is None:
        others = package.of_kind("launch")
        near = difflib.get_close_matches(
            spec.launch.file, [o.rsplit("/", 1)[-1] for o in others], 1, 0
        )
        other = next((o for o in others if near and o.endswith(near[0])), None)
        return None, [
            Finding(
                "launch-file",
                f"The package has no launch file {spec.launch.file}."
                + (f" There is {other}." if other else ""),
                other,
                1 if other else None,
                expected=f"launch/{spec.launch.file}",
                seen=", ".join(others) or "no launch file",
                fix=f"Rename it to {spec.launch.file}."
                if other
                else "Write one, as the page shows.",
            )
        ]
    try:
        launching.elements(package.bytes(path))
    except xml.parsers.expat.ExpatError as error:
        return path, [xml_finding("launch-file", package, path, error)]
    return path, []


def findings(package, spec, model, launch):
    """Yield findings about a launch file that is XML, from a launching.Launch."""
    tags = _all_elements(package, launch)
    if launch.error:
        yield _error(package, launch, tags)
        return
    yield from _unknown(tags)
    nodes = list(launch.nodes)
    for name in spec.nodes:
        found = [node for node in nodes if node.name == name]
        if not found:
            yield _missing(package, spec, model, launch, name)
        for node in found[:1]:
            yield from _of(package, spec, model, node, launch)
    for node in nodes:
        if node.name not in spec.nodes and node.package == package.name:
            yield from _can_start(package, model, node)
    yield from _group(package, spec, launch, tags)


def _all_elements(package, launch):
    """Return the (file, Element)s of the launch file and of what of the package it includes."""
    found = []
    for file in launch.files or [launch.file]:
        try:
            found += [(file, element) for element in launching.elements(package.bytes(file))]
        except (xml.parsers.expat.ExpatError, OSError):
            continue
    return found


_TAGS = ("launch node group arg param rosparam remap include env machine test master").split()


def _unknown(tags):
    """roslaunch passes over elements and attributes that it does not know."""
    for file, element in tags:
        if element.tag not in _TAGS:
            near = difflib.get_close_matches(element.tag, _TAGS, 1, 0.5)
            yield Finding(
                "launch-file",
                f"roslaunch knows no element <{element.tag}>, and passes over it.",
                file,
                element.line,
                WARNING,
                expected=", ".join(f"<{tag}>" for tag in near) or "an element of roslaunch",
                seen=f"<{element.tag}>",
                fix=f"Write <{near[0]}>." if near else "Take it out.",
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


def _missing(package, spec, model, launch, name):
    """Return the Finding about a node that the launch file does not start."""
    spare = [n for n in launch.nodes if n.name not in spec.nodes and n.package == package.name]
    # What is started by another name has, most of all, the executable of that name.
    near = [n for n in spare if os.path.splitext(n.type)[0] == name]
    near = near or [n for n in spare if difflib.get_close_matches(name, [n.name], 1, 0.8)]
    if near:
        node = near[0]
        return Finding(
            "launch-nodes",
            f"The launch file starts {node.type} under the name {node.name}; expected {name}.",
            node.file,
            node.line,
            node=name,
            expected=f'name="{name}"',
            seen=f'name="{node.name}"',
            fix=f'Write name="{name}".',
        )
    return Finding(
        "launch-nodes",
        f"The launch file does not start the node {name}.",
        launch.file,
        _last_line(package, launch),
        node=name,
        expected=f'a <node> with name="{name}"',
        seen=", ".join(n.name for n in launch.nodes) or "no node",
        fix=f'Add a <node> with name="{name}".',
    )


def _last_line(package, launch):
    lines = [
        e.line
        for e in launching.elements(package.bytes(launch.file))
        if e.tag in ("node", "group", "launch")
    ]
    return lines[-1] if lines else 1


def executables(package, model):
    """Return the names that roslaunch can find in the package: built ones and scripts."""
    names = set(model.executables())
    names |= {script.path.rsplit("/", 1)[-1] for script in model.scripts}
    names |= {path.rsplit("/", 1)[-1] for path in package.of_kind("python")}
    return names


def _can_start(package, model, node, spec_node=None):
    """Yield a finding if roslaunch cannot find what a <node> names."""
    if node.package != package.name:
        if spec_node and not uses.is_ros_package(node.package):
            manifest_line = package.find_line("package.xml", "<name>", 1)
            # CMakeLists.txt says the same: then package.xml is wrong, which has been said.
            same = model.project and model.project[0] == node.package
            yield Finding(
                "package-name",
                f"The launch file looks for {node.type} in the package {node.package};"
                f" package.xml calls this package {package.name} (line {manifest_line}).",
                node.file,
                node.line,
                node=spec_node,
                expected=f'pkg="{package.name}"',
                seen=f'pkg="{node.package}"',
                fix=f'Write pkg="{package.name}".',
                consequence_of="package-name" if same else None,
            )
        return
    names = executables(package, model)
    # Where CMake failed, nobody knows what it would have made.
    if node.type in names or not model.complete:
        return
    stems = {os.path.splitext(name)[0]: name for name in names}
    near = stems.get(os.path.splitext(node.type)[0])
    near = near or next(iter(difflib.get_close_matches(node.type, names, 1, 0.75)), None)
    built = _source_of(package, model, node.type)
    if built and near is None and model.complete:
        yield Finding(
            "targets",
            f"The launch file starts {node.type}, and CMakeLists.txt makes no executable of that"
            f" name: {built} is built by no add_executable().",
            "CMakeLists.txt",
            _targets_line(model),
            node=spec_node,
            expected=f"add_executable({node.type} {built})",
            seen=", ".join(model.executables()) or "no executable",
            fix=f"Add add_executable({node.type} {built}), and link it with ${{catkin_LIBRARIES}}.",
        )
        return
    yield Finding(
        "launch-nodes",
        f"The launch file starts {node.type}, and the package has no executable of that name."
        + (f" It has {near}." if near else ""),
        node.file,
        node.line,
        node=spec_node,
        expected=f'type="{near}"' if near else "the name of an executable or a script",
        seen=f'type="{node.type}"',
        fix=f'Write type="{near}".' if near else "Name an executable that is built.",
    )


def _source_of(package, model, name):
    """Return a C++ source that no target is made of and that is called like the executable."""
    built = {source for target in model.targets.values() for source in target.sources}
    spare = [path for path in package.of_kind("cpp") if path not in built]
    for path in spare:
        if os.path.splitext(path.rsplit("/", 1)[-1])[0] == name:
            return path
    return spare[0] if len(spare) == 1 else None


def _targets_line(model):
    lines = [target.line for target in model.targets.values() if target.file == "CMakeLists.txt"]
    return max(lines) if lines else model.catkin_package.line if model.catkin_package else 1


def _of(package, spec, model, node, launch):
    """Yield findings about the <node> of a node of the spec."""
    yield from _can_start(package, model, node, node.name)
    if node.output != "screen":
        yield Finding(
            "launch-output",
            f'What {node.name} prints goes to a log file: its <node> has no output="screen".',
            node.file,
            node.line,
            node=node.name,
            expected='output="screen"',
            seen=f'output="{node.output}"',
            fix='Add output="screen".',
        )
    topics = {
        topic
        for topic in (spec.nodes[node.name].publishing, spec.nodes[node.name].subscribing)
        if topic
    }
    for topic in topics:
        base = node.namespace.rstrip("/") + "/"
        own = {topic.name, base + topic.name}
        for old, new in node.remaps:
            if old in own and new not in own:
                yield Finding(
                    "topic",
                    f"The launch file renames the topic {old} of {node.name} to {new}:"
                    " the nodes do not meet there.",
                    node.file,
                    _remap_line(package, node, old, new),
                    node=node.name,
                    expected=f"the topic {topic.name}",
                    seen=f"{old} renamed to {new}",
                    fix="Take the <remap> out.",
                )


def _remap_line(package, node, old, new):
    for element in launching.elements(package.bytes(node.file)):
        if element.tag == "remap" and old.endswith(
            element.attributes.get("from", "?").lstrip("~/")
        ):
            if new.endswith(element.attributes.get("to", "?").lstrip("~/")):
                return element.line
    return node.line


def _group(package, spec, launch, tags):
    """Yield findings about the namespace of the spec's nodes."""
    group = spec.launch.group
    if not group:
        return
    wrong = {}
    for node in launch.nodes:
        if node.name in spec.nodes and node.namespace.strip("/") != group:
            wrong.setdefault(node.namespace, []).append(node)
    for namespace, nodes in wrong.items():
        node = nodes[0]
        seen = f"the namespace {namespace}"
        line, file = node.line, node.file
        groups = [(f, e) for f, e in tags if e.tag == "group" and "ns" in e.attributes]
        inside = [
            (f, e)
            for f, e in groups
            if f == node.file
            and any(t.line == node.line and e in t.parents for g, t in tags if g == node.file)
        ]
        own = next(
            (
                e
                for f, e in tags
                if f == node.file
                and e.line == node.line
                and e.tag == "node"
                and "ns" in e.attributes
            ),
            None,
        )
        if inside and own is None:
            file, line = inside[-1][0], inside[-1][1].line
            argument = re.search(r"\$\(arg (\w+)\)", inside[-1][1].attributes["ns"])
            for f, e in tags:
                if (
                    argument
                    and e.tag == "arg"
                    and e.attributes.get("name") == argument.group(1)
                    and ("default" in e.attributes or "value" in e.attributes)
                    and f == file
                ):
                    line = e.line
        elif groups == [] and len(nodes) > 1:
            launch_tag = [e for f, e in tags if f == node.file and e.tag == "launch"]
            groups_without = [e for f, e in tags if f == node.file and e.tag == "group"]
            line = groups_without[0].line if groups_without else launch_tag[0].line
        names = ", ".join(n.name for n in nodes)
        yield Finding(
            "launch-group",
            f"The launch file starts {names} in {seen}; expected the group {group}.",
            file,
            line,
            node=node.name if len(nodes) == 1 else None,
            expected=f'<group ns="{group}"> around the nodes',
            seen=seen,
            fix=f'Put the nodes into <group ns="$(arg group)">, with <arg name="group"'
            f' default="{group}"/> above it.',
        )
    plain = [
        (f, e)
        for f, e in tags
        if e.tag in ("group", "node", "include") and e.attributes.get("ns", "").strip("/") == group
    ]
    if plain and not wrong:
        file, element = plain[0]
        yield Finding(
            "launch-group",
            f"The group's name {group} is written into the launch file: a second robot cannot be"
            " given another one when it is started.",
            file,
            element.line,
            WARNING,
            expected=f'<arg name="group" default="{group}"/> and ns="$(arg group)"',
            seen=f'ns="{element.attributes["ns"]}"',
            fix=f'Make it an argument: <arg name="group" default="{group}"/>.',
        )
