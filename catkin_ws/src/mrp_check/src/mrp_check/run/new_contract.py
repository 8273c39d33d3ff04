# SPDX-License-Identifier: BSD-3-Clause
"""A contract for a package that has none: what was seen of it, to be edited."""

from __future__ import annotations

import dataclasses
import re
import statistics
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence

import genmsg
import yaml

from mrp_check.confined.launch_dump import Started
from mrp_check.confined.seen import DirectResult, LaunchResult, Message, Number, Registration, Seen
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.message_types import PACKAGE
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Topic
from mrp_check.run.any_case import AnyCase
from mrp_check.run.node import FEW
from mrp_check.run.observing import ends
from mrp_check.run.planning import resolved
from mrp_check.run.traces import ROS_SERVICES, ROS_TOPICS

_WORD = re.compile(r"[A-Za-z]\w*")  # what a contract can call a node or a topic
_ANONYMOUS = re.compile(r"_\d+_\d+$")  # how such a name ends
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_STEADY = 0.3  # of the middle gap: by less differ most others of a publisher with a period
_LINES = 3  # at most, that a contract asks of a node
_EXPRESSION = re.compile(r"[][\\.^$*+?{}|()]")

Entry = dict[str, Any]  # of a contract


@dataclasses.dataclass
class _Run:
    """A run of a node, among others or by itself.

    path: its full name then; seen: what was seen of all nodes; asked: when they were to end
    latched: topic -> the nodes that latch it
    """

    path: str
    seen: Seen
    asked: float
    latched: Mapping[str, Sequence[str]]

    def messages(self, topic: Topic, of_all: bool = False) -> list[Message]:
        """Return what the node sent on a topic, or what all nodes did."""
        name = resolved(topic, self.path)
        sent = [message for message in self.seen.messages if message.topic == name]
        return [message for message in sent if of_all or message.node == self.path]

    def numbers(self, topic: Topic, of_all: bool = False) -> list[Number]:
        sent = [(message.fields or {}).get(topic.field) for message in self.messages(topic, of_all)]
        return [value for value in sent if isinstance(value, (int, float))]

    def lines(self) -> list[str]:
        """Return what the node logged, each line as an expression with {name} in it."""
        logs = [log for log in self.seen.logs if log.node == self.path and log.level == "INFO"]
        texts = [log.text for log in logs if log.time < self.asked and "\n" not in log.text]
        plain = [_EXPRESSION.sub(r"\\\g<0>", text) for text in texts]
        return [text.replace(self.path, "{name}") for text in plain]


class Node:
    """What a node did.

    executable: its name
    launched: its runs beside others; alone: the one by itself, or None
    ends: whether it ended by itself, with exit code 0
    """

    def __init__(
        self,
        executable: str,
        launched: Sequence[tuple[str, LaunchResult]],
        direct: DirectResult | None,
    ) -> None:
        self.executable = executable
        self.launched = [_Run(path, run.seen, run.asked, run.latched) for path, run in launched]
        self.ends = any(ends(run.until_asked()).get(path) == 0 for path, run in launched)
        self.alone = None
        found = direct.nodes.get(executable) if direct else None
        if direct and found and found.name:
            asked = found.asked or found.ended_after or 0.0
            self.alone = _Run(found.name, direct.seen, asked, {})
            self.ends |= not launched and bool(found.ended_after) and found.code == 0
        self.runs = [*self.launched, *filter(None, [self.alone])]

    def named(self, records: Callable[[Seen], Iterable[Registration]]) -> list[Topic]:
        """Return the topics, or services, of some records, as the node asked for them."""
        run = self.runs[-1]  # by itself, in a namespace: so it shows whether a name follows that
        found = {asked.topic: asked.type for asked in records(run.seen) if asked.node == run.path}
        group = run.path.rsplit("/", 1)[0] + "/"
        starts = {"private": f"{run.path}/", "group": group, "global": "/"}
        named = []
        for name, kind in found.items():
            namespace = next(key for key, start in starts.items() if name.startswith(start))
            topic = Topic(name[len(starts[namespace]) :], kind, namespace=namespace)
            if name not in ROS_TOPICS and topic.name not in ROS_SERVICES:
                named.append(topic)
        return named

    def role(self, topic: Topic) -> Entry:
        """Return what a contract says of what it publishes by itself on a topic."""
        entry: Entry = {"topic": topic.name}
        if any(run.path in run.latched.get(resolved(topic, run.path), ()) for run in self.runs):
            entry["latched"] = True
        if self.alone and not self.alone.messages(topic):
            return entry  # what it publishes depends on what it's sent
        times = max(([m.time for m in run.messages(topic)] for run in self.runs), key=len)
        gaps = [b - a for a, b in zip(times, times[1:])]
        if len(times) >= FEW:
            middle = statistics.median(gaps)
            steady = [gap for gap in gaps if abs(gap - middle) < _STEADY * middle]
            if len(steady) >= 0.7 * len(gaps):
                entry["period"] = float(f"{middle:.2g}")
                if middle < 0.5:
                    entry["tolerance"] = 0.5  # other programs of the machine change it as much
        rows = [row for row in (run.numbers(topic) for run in self.runs) if len(row) >= FEW]
        steps = {b - a for row in rows for a, b in zip(row, row[1:])}
        numbers = [*{row[0] for row in rows}, *steps]
        if len(numbers) == 2 and all(number == int(number) for number in numbers) and numbers[1]:
            entry["values"] = {"start": int(numbers[0]), "step": int(numbers[1])}
        elif steps and min(steps) > 0:
            entry["rises"] = True
        return entry

    def lines(self, topic: Topic | None, of_all: bool) -> list[str]:
        """Return the lines that it is sure to log: once in each run; or with each number that came
        on a topic, from it or from all nodes."""
        logged = [run.lines() for run in self.runs]
        first = logged[0] if len(logged) > 1 else []
        once = [line for line in first if all(other.count(line) == 1 for other in logged)]
        sure = [line for line in dict.fromkeys(once) if not _NUMBER.search(line)]
        for run, lines in zip(self.launched, logged):
            known = {float(number) for number in run.numbers(topic, of_all)} if topic else set()
            rows: dict[str, list[float]] = {}
            for line in lines:
                numbers = _NUMBER.findall(line.replace("\\", ""))
                if len(numbers) == 1:
                    shape = line.replace(numbers[0].replace(".", r"\."), "{value}")
                    rows.setdefault(shape, []).append(float(numbers[0]))
            sure += [shape for shape, row in rows.items() if len(row) >= FEW and {*row} <= known]
        return [*dict.fromkeys(sure)][:_LINES]


def text(case: AnyCase) -> str:
    """Return the contract, in YAML. Raises CannotCheck if no node of the package ran."""
    return _Writer(case).text()


class _Writer:
    """Writes the contract of what was seen of a package.

    launch: what the launch file starts that starts all the nodes, by name; empty without one
    nodes: name -> what was seen of it
    topics, services, messages: what the contract says of those of all nodes, by name
    comments: what is left to be edited
    """

    def __init__(self, case: AnyCase) -> None:
        self.case, self.package = case, case.package
        self.file, self.launch = self._launch()
        self.nodes = dict(self._nodes())
        if not self.nodes:
            raise CannotCheck(
                f"no contract was written, because no node of {self.package.name} ran."
            )
        self.topics: dict[str, Entry] = {}
        self.services: dict[str, Entry] = {}
        self.messages: dict[str, Entry] = {}
        self.comments: list[str] = []

    def _launch(self) -> tuple[str, dict[str, Started]]:
        """Return (path, name -> node) of the launch file that starts all nodes in one namespace."""
        for run in self.case.observed.launches:
            found = [launch for launch in self.case.launches if launch.file == run.file]
            started = [node for node in found[0].nodes if node.path in run.nodes] if found else []
            if not {*self.case.observed.executables} <= {node.type for node in started}:
                continue
            names, spaces = {node.name for node in started}, {node.namespace for node in started}
            if len(names) == len(started) and len(spaces) == 1 and all(map(_is_word, names)):
                (space,) = spaces
                if space == "/" or _is_word(space.strip("/")):
                    return run.file, {node.name: node for node in started}
        return "", {}

    def _nodes(self) -> Iterator[tuple[str, Node]]:
        wanted: list[tuple[str, Started | None]] = [
            (started.type, started) for started in self.launch.values()
        ]
        for name, started in wanted or [(name, None) for name in self.case.spec.nodes]:
            runs: list[tuple[str, LaunchResult]] = [
                (path, launch.seen)
                for launch in self.case.observed.launches
                for path, executable in launch.nodes.items()
                if executable == name
                and (not started or (launch.file, path) == (self.file, started.path))
            ]
            # Of several that one executable makes, the run by itself shows only one.
            is_only = len([other for other, _ in wanted if other == name]) < 2
            node = Node(name, runs, self.case.observed.direct if is_only else None)
            if node.runs:
                own = last_part(node.runs[-1].path)
                yield started.name if started else _ANONYMOUS.sub("", own), node

    def text(self) -> str:
        for node in self.nodes.values():
            for service in node.named(lambda seen: seen.services):
                if _is_word(service.name) and service.type:
                    self.services[service.name] = self._service(service)
                    self.comments.append(f"{service.name} needs examples of calls and answers.")
        nodes = {name: self._node(name, node) for name, node in self.nodes.items()}
        sections: Entry = {"title": self.package.name, "messages": self.messages}
        sections.update(topics=self.topics, services=self.services, nodes=nodes)
        if self.launch:
            group = next(iter(self.launch.values())).namespace.strip("/")
            of_group = {"group": group} if group else {}
            sections["launch"] = {"file": last_part(self.file), **of_group}
        document = {key: section for key, section in sections.items() if section}
        head = [f"# What the package {self.package.name} was seen to do, to be edited.\n"]
        head += [f"# {comment}\n" for comment in self.comments]
        return "".join(head) + yaml.safe_dump(
            document, default_flow_style=None, sort_keys=False, width=1000, allow_unicode=True
        )

    def _node(self, name: str, node: Node) -> Entry:
        """Return what the contract says of a node; note its topics and comments."""
        publishes = []
        for topic in self._known(name, node.named(lambda seen: seen.publications)):
            if any(run.messages(topic) for run in node.runs):
                publishes.append(topic)
            else:
                self.comments.append(f"{name} published nothing on {topic.name} ({topic.type}).")
        subscribes = self._known(name, node.named(lambda seen: seen.subscriptions))
        for topic in (*publishes, *subscribes):
            self.topics[topic.name] = {"type": self._type(topic.type), **_namespace(topic)}
        offers, calls = (
            [service.name for service in services if service.name in self.services]
            for services in (
                node.named(lambda seen: seen.services),
                node.named(lambda seen: seen.lookups),
            )
        )
        entry: Entry = {"language": self.case.spec.nodes[node.executable].language}
        if not self.launch and node.executable not in (name, f"{name}.py"):
            entry["executable"] = node.executable
        entry["anonymous"] = bool(_ANONYMOUS.search(node.runs[-1].path))
        entry["publishes"] = [node.role(topic) for topic in publishes]
        entry["subscribes"] = [{"topic": topic.name} for topic in subscribes]
        entry["offers"], entry["calls"] = offers, calls
        entry["ends"] = node.ends
        heard = next(iter(subscribes), None)
        topic_of_lines = heard or next(iter(publishes), None)
        entry["prints"] = node.lines(topic_of_lines, of_all=topic_of_lines is heard)
        return {key: value for key, value in entry.items() if value}

    def _known(self, name: str, topics: Iterable[Topic]) -> list[Topic]:
        """Return the topics that the contract can say; leave a comment on each other one."""
        known = []
        for topic in topics:
            entry = {"type": self._type(topic.type), **_namespace(topic)}
            is_said = _is_word(topic.name) and entry["type"] not in ("", "*")
            if is_said and self.topics.get(topic.name, entry) == entry:
                known.append(topic)
            else:
                self.comments.append(f"No contract can name the topic {topic.name} of {name}.")
        return known

    def _type(self, kind: str) -> str:
        """Return a type as a contract says it, or an empty text if it has no file; note the fields
        of the package's own messages."""
        package, _, name = kind.partition("[")[0].partition("/")
        if package != self.package.name:
            return kind
        if not any(last_part(path) == f"{name}.msg" for path in self.package.files):
            return ""
        if name not in self.messages:
            read = genmsg.msg_loader.load_msg_from_string
            (self.messages[name],) = self._fields(read, f"{name}.msg", kind)
            for of_field in self.messages[name].values():
                self._type(str(of_field))
        return f"{PACKAGE}/{name}"

    def _service(self, service: Topic) -> Entry:
        package, _, name = service.type.partition("/")
        if package != self.package.name:
            return {"type": service.type, **_namespace(service)}
        read = genmsg.msg_loader.load_srv_from_string
        request, response = self._fields(read, f"{name}.srv", service.type)
        own = {"type": f"{PACKAGE}/{name}", "request": request, "response": response}
        return {**own, **_namespace(service)}

    def _fields(self, read: Callable[..., Any], file: str, kind: str) -> list[Entry]:
        """Return field -> type of a message, or of a service's request and response."""
        path = next(path for path in self.package.files if last_part(path) == file)
        made = read(genmsg.MsgContext.create_default(), self.package.text(path), kind)
        halves = [made.request, made.response] if file.endswith(".srv") else [made]
        return [dict(zip(half.names, half.types)) for half in halves]


def _namespace(topic: Topic) -> Entry:
    is_usual = topic.namespace == Topic.namespace
    return {} if is_usual else {"namespace": topic.namespace}


def _is_word(name: str) -> bool:
    """Return whether a contract can use a name."""
    return bool(_WORD.fullmatch(name))
