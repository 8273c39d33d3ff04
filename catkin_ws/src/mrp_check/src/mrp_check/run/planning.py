# SPDX-License-Identifier: BSD-3-Clause
"""What is to be observed: a plan for all nodes under a launch file, and one for each by itself."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import re
import shlex
import signal
import tempfile
import xml.etree.ElementTree as ElementTree
import xml.sax.saxutils
from typing import Mapping

import yaml

from mrp_check import sandbox
from mrp_check.confined import plans, variables
from mrp_check.confined.launch_dump import Started
from mrp_check.contract import spec as specs
from mrp_check.package.workspace import Workspace

ENOUGH = 6  # messages of a publisher that runs by itself
# Under a launch file its nodes begin later: both runs are to end at about the same time.
ENOUGH_LAUNCHED = 4
BURST = tuple(range(21, 29))  # what each subscriber is sent at once: fewer than its queue holds
PACED = (2, 3, 33, 34)  # and then one by one, small ones too
WRAP = "wrap:"  # before the name of a Python publisher that runs near the end of its numbers

EXAMPLE = "example:"  # before a node's name, another colon and the number of its example

_PERIOD = 0.5  # seconds, where the contract names none
# In seconds, at the least: in which all must be seen; without a message; and for all of it.
_SECONDS, _SILENCE, _TIMEOUT = 20, 6, 60
_SILENT_PERIODS = 12  # after which no more is waited for
_ROSLAUNCH_SECONDS = 8  # that roslaunch takes to end, after its nodes
_FIRST_LINE = 200  # bytes


@dataclasses.dataclass
class Planner:
    """Makes the plans.

    executables: node of the spec -> path of its executable
    started: node of the spec -> what of the package's launch file starts it; empty without one
    params: those of that file
    environment: of the nodes
    messages: what messages.definitions() says of the package's own
    preload: the library that sees the callbacks of roscpp's subscribers; or None
    """

    workspace: Workspace
    spec: specs.Spec
    executables: dict[str, pathlib.Path]
    started: dict[str, Started]
    params: dict[str, object]
    environment: dict[str, str]
    messages: dict[str, list[str]]
    preload: pathlib.Path | None = None

    @property
    def period(self) -> float:
        """The longest period of the spec, in seconds."""
        periods = [role.period for n in self.spec.nodes.values() for role in n.published]
        return max([period for period in periods if period] or [_PERIOD])

    def _common(self, stop_seconds: float) -> plans.Common:
        folder = tempfile.mkdtemp(prefix="nodes_", dir=self.workspace.folder)
        return plans.Common(
            environment={**self.environment, **variables.folders(folder)},
            writable=[folder],
            messages=self.messages,
            silence=max(_SILENT_PERIODS * self.period, _SILENCE),
            seconds=max(_SECONDS, 3 * ENOUGH * self.period),
            most=max(self.workspace.timeout, _TIMEOUT),
            stop_seconds=stop_seconds,
        )

    # --- Under a launch file

    def launch(self, file: pathlib.Path | None) -> plans.LaunchPlan:
        """Return the plan for a launch file; without one, for one that is made from the spec."""
        roles = (self.spec.nodes[name].publishing for name in self.executables)
        senders = [topic.name for topics in roles for topic in topics]
        nodes = [
            self._launch_node(node, senders)
            for name, node in self.spec.nodes.items()
            if name in self.executables and (name in self.started or not self.started)
        ]
        # They are counted on one topic of a node: those on another may be one behind.
        several = any(len(node.published) > 1 for node in self.spec.nodes.values())
        return plans.LaunchPlan(
            common=self._common(self.spec.shutdown.seconds + _ROSLAUNCH_SECONDS),
            command=["roslaunch", str(file or self.write_launch_file(self.executables))],
            nodes=nodes,
            enough=ENOUGH_LAUNCHED + several,
        )

    def of_file(
        self, file: pathlib.Path, seconds: float, nodes: list[plans.LaunchNode], enough: int
    ) -> plans.LaunchPlan:
        """Return the plan for a launch file without a contract; all lines come to the screen."""
        common = self._common(self.spec.shutdown.seconds + _ROSLAUNCH_SECONDS)
        if self.preload:
            common.environment["LD_PRELOAD"] = str(self.preload)
            common.environment[variables.CALLBACKS] = f"{common.writable[0]}/callbacks"
        return plans.LaunchPlan(
            common=dataclasses.replace(common, seconds=seconds),
            command=["roslaunch", "--screen", str(file)],
            nodes=nodes,
            enough=enough,
        )

    def _launch_node(self, node: specs.NodeSpec, senders: list[str]) -> plans.LaunchNode:
        started, topic = self.started.get(node.name), next(iter(node.subscribing), None)
        path = started.path if started else self.spec.node_path(node.name)
        return plans.LaunchNode(
            path=path,
            type=f"{started.package}/{started.type}" if started else None,
            publishes=node.of_itself,
            received=_received(node),
            hears=resolved(topic, path) if topic else None,
            senders=senders.count(topic.name) if topic else 0,
        )

    def write_launch_file(self, nodes: Mapping[str, pathlib.Path]) -> pathlib.Path:
        """Write a launch file that starts these nodes in the spec's group; return its path.

        nodes: a node's name -> its executable
        """
        lines = []
        for name, executable in nodes.items():
            attributes = {"pkg": self.workspace.package.name, "type": executable.name, "name": name}
            text = " ".join(f"{k}={xml.sax.saxutils.quoteattr(v)}" for k, v in attributes.items())
            params = self.spec.nodes[name].parameters if name in self.spec.nodes else {}
            lines.append(f'    <node {text} output="screen">')
            lines += [f"      {_param(*param)}" for param in params.items()]
            lines.append("    </node>")
        group = self.spec.launch.group
        if group:
            lines = [f'  <group ns="{group}">', *lines, "  </group>"]
        path = self.workspace.given / "of_spec.launch"
        path.write_text("\n".join(["<launch>", *lines, "</launch>", ""]))
        return path

    def write_launch_file_of_all(self, nodes: Mapping[str, str]) -> pathlib.Path:
        """Write a launch file that starts all these nodes, each as the package's launch files do,
        if one of them starts it; return its path.

        nodes: full name -> node of the spec
        """
        root = ElementTree.Element("launch")
        for name, value in self.params.items() if self.started else ():
            ElementTree.SubElement(root, "rosparam", param=name).text = yaml.safe_dump(value)
        for path, node in nodes.items():
            space, _, own = path.rpartition("/")
            words = {"pkg": self.workspace.package.name, "type": self.executables[node].name}
            element = ElementTree.SubElement(root, "node", words, name=own, ns=space or "/")
            started = self.started.get(node)
            if started:
                element.set("args", started.arguments)
                for source, target in started.remaps:
                    ElementTree.SubElement(element, "remap", {"from": source, "to": target})
                for name, given in started.env:
                    ElementTree.SubElement(element, "env", name=name, value=given)
        file = self.workspace.given / "of_all.launch"
        file.write_bytes(ElementTree.tostring(root))
        return file

    # --- Each by itself

    def direct(self) -> plans.DirectPlan:
        """Return the plan that starts each node by itself."""
        common, nodes = self._common(self.spec.shutdown.seconds), {}
        for index, (name, path) in enumerate(self.executables.items()):
            node, hook = self.spec.nodes[name], None
            if is_python(path):
                events = f"{common.writable[0]}/events_check_{index}"
                sources = str(self.workspace.package_folder)
                hook = plans.Hook(str(sandbox.code() / "hook"), events, sources)
            nodes[name] = self._direct_node(node, path, f"/check_{index}", hook)
            role = node.publishes
            if hook and role and role.values and role.values.modulus:
                rule = dataclasses.asdict(role.values)
                wrap = plans.Wrap(role.topic.field, told=plans.TOLD, **rule)
                hook = dataclasses.replace(hook, events=f"{hook.events}_wrap", wrap=wrap)
                plan = self._direct_node(node, path, f"/check_wrap_{index}", hook)
                nodes[WRAP + name] = dataclasses.replace(plan, publishes=0, values=[], paced=[])
            for number, example in enumerate(node.examples):
                space = f"/check_example_{index}_{number}"
                plan = self._direct_node(node, path, space, None)
                nodes[f"{EXAMPLE}{name}:{number}"] = self._example(plan, node, example, space)
        number = getattr(signal, self.spec.shutdown.signal)
        return plans.DirectPlan(common, nodes, number)

    def _direct_node(
        self, node: specs.NodeSpec, path: pathlib.Path, namespace: str, hook: plans.Hook | None
    ) -> plans.DirectNode:
        started, topic = self.started.get(node.name), next(iter(node.subscribing), None)
        # Examples say what a node is sent, where it logs no value.
        is_sent = topic and topic.kind and (node.received_line or not node.examples)
        arguments, params = [] if started else _arguments(node.parameters), {}
        if started:
            # The node's own namespace and that of its group move; what is elsewhere stays.
            params = {
                _moved(param, started.namespace, namespace): value
                for param, value in self.params.items()
            }
            arguments = shlex.split(started.arguments)
            arguments += [f"{source}:={target}" for source, target in started.remaps]
        relayed = len(BURST + PACED) if node.relays else 0
        return plans.DirectNode(
            command=[str(path), *arguments],
            namespace=namespace,
            env=dict(started.env) if started else {},
            params=params,
            publishes=relayed or (ENOUGH if node.of_itself else 0),
            values=list(BURST) if is_sent else [],
            paced=list(PACED) if is_sent else [],
            field=topic.field if topic else None,
            topic=topic.name if topic else None,
            relays=bool(relayed),
            text=topic.text if topic else None,
            type=topic.type_in(self.workspace.package.name) if topic else None,
            received=_received(node),
            hook=hook,
            offers=[self._service(service, namespace) for service in node.offers],
            calls=[self._service(service, namespace) for service in node.calls],
        )

    def _service(self, service: specs.Service, namespace: str) -> plans.ServicePlan:
        calls = [plans.CallPlan(dict(c.request), dict(c.response)) for c in service.examples]
        kind = service.type_in(self.workspace.package.name)
        return plans.ServicePlan(resolved(service, f"{namespace}/~"), kind, calls)

    def _example(
        self, plan: plans.DirectNode, node: specs.NodeSpec, example: specs.Example, namespace: str
    ) -> plans.DirectNode:
        """Return the node as it is run for one of its examples: with no other parameters."""
        package, path = self.workspace.package.name, f"{namespace}/~"
        gives = [
            plans.Given(resolved(topic, path), topic.type_in(package), dict(fields))
            for topic, fields in example.receives
        ]
        expects = {
            resolved(self.spec.topics[name], path): [dict(message) for message in messages]
            for name, messages in example.publishes.items()
        }
        periods = [r.period for r in node.published if r.topic.name in example.publishes]
        is_among = bool(gives and any(periods))
        given = [word for word in plan.command if not re.match(r"_[A-Za-z]\w*:=", word)]
        own = f"{namespace}/{node.name}/"
        return dataclasses.replace(
            plan,
            command=[*given, *_arguments(example.parameters)],
            params={name: value for name, value in plan.params.items() if own not in name},
            values=[],
            paced=[],
            offers=[],
            example=plans.ExamplePlan(gives, expects, is_among, example.tolerance),
        )


def _arguments(parameters: Mapping[str, object]) -> list[str]:
    """Return what gives a node its private parameters, whatever its name is."""
    return [f"_{name}:={json.dumps(value)}" for name, value in parameters.items()]


def _param(name: str, value: object) -> str:
    quoted = xml.sax.saxutils.quoteattr(value if isinstance(value, str) else json.dumps(value))
    return f'<param name="{name}" value={quoted}/>'


def _moved(name: str, old: str, new: str) -> str:
    old = old.rstrip("/") + "/"
    return f"{new}/{name[len(old) :]}" if name.startswith(old) else name


def is_python(path: pathlib.Path) -> bool:
    """Return whether an executable is a Python script, by its first line."""
    with open(path, "rb") as file:
        first = file.readline(_FIRST_LINE)
    return first.startswith(b"#!") and b"python" in first


def resolved(topic: specs.Topic | specs.Service, path: str) -> str:
    """Return the full name of a spec's topic, for a node of that full name."""
    group = path.rsplit("/", 1)[0]
    start = {"global": "/", "private": path + "/", "group": group + "/"}[topic.namespace]
    return start + topic.name


def _received(node: specs.NodeSpec) -> str | None:
    """Return the regular expression of the line that a node logs on receiving, or None."""
    return node.pattern(node.received_line).pattern if node.received_line else None
