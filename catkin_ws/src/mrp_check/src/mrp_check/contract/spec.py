# SPDX-License-Identifier: BSD-3-Clause
"""The contract of an exercise, read from a YAML file such as specs/pub_sub.yaml."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import re
from typing import Any, Collection, Dict, Iterable, Mapping, NoReturn, Sequence

import genmsg
import jsonschema
import yaml

from mrp_check.contract import lines, resources
from mrp_check.contract.errors import SpecError
from mrp_check.contract.resources import SHARES
from mrp_check.contract.schema import Loader, near, no_such, sentence

SCHEMA = resources.folder("schema") / "spec.json"
_SCHEMA = json.loads(SCHEMA.read_text())
_PAGE = "What can be said: pages/contract.html, which is made of"
_NUMBER = re.compile(r"u?int\d+|float\d+|byte|char|bool")  # types of a message's fields
PACKAGE = "PACKAGE"  # in a type: the package's own name


def _default(key: str, *kind: str) -> Any:
    """Return what a key has if it is left out: the schema says it, and the page made of that."""
    entry = _SCHEMA["definitions"][kind[0]] if kind else _SCHEMA
    return entry["properties"][key]["default"]


@dataclasses.dataclass(frozen=True)
class Topic:
    name: str
    type: str
    field: str = _default("field", "topic")
    namespace: str = _default("namespace", "topic")
    text: str | None = None  # all that the field says, with {value} in the value's place

    def type_in(self, package_name: str) -> str:
        """Return the type with the package's name in it."""
        package, name = self.type.split("/")
        return f"{package_name if package == PACKAGE else package}/{name}"

    def value_in(self, said: object) -> int | float | None:
        """Return the number that the field's content says, or None: it may be of any type."""
        if self.text and isinstance(said, str):
            shape = re.escape(self.text).replace(r"\{value\}", f"({lines.WHOLE}({lines.DECIMALS}))")
            found = re.fullmatch(shape, said)
            if not found:
                return None
            return float(found.group(1)) if found.group(2) else int(found.group(1))
        return said if isinstance(said, (int, float)) else None


@dataclasses.dataclass(frozen=True)
class Values:
    """The values are start, start + step, start + 2 * step, ..., modulo modulus (if not None)."""

    start: int
    step: int
    modulus: int | None = None

    def after(self, value: float) -> float:
        """Return the value that comes after `value`."""
        return value + self.step if self.modulus is None else (value + self.step) % self.modulus


@dataclasses.dataclass(frozen=True)
class Publishes:
    topic: Topic
    queue: int | None = None
    period: float | None = None  # seconds
    tolerance: float = _default("tolerance", "publishes")  # as a part of the period
    latched: bool = _default("latched", "publishes")
    values: Values | None = None
    rises: bool = _default("rises", "publishes")


@dataclasses.dataclass(frozen=True)
class Subscribes:
    topic: Topic
    queue: int | None = None


@dataclasses.dataclass(frozen=True)
class Relays:
    """Each value received on `source` is published, times `times`, on `target`."""

    source: Topic
    target: Topic
    queue: int | None = None
    times: int = _default("times", "relays")
    modulus: int | None = None

    def of(self, value: int) -> int:
        """Return what is published when `value` is received."""
        product = value * self.times
        return product if self.modulus is None else product % self.modulus


@dataclasses.dataclass(frozen=True)
class Node:
    name: str
    language: str = _default("language", "node")  # cpp, python or any
    anonymous: bool = _default("anonymous", "node")
    file: str | None = None
    executable: str | None = None
    publishes: Publishes | None = None
    subscribes: Subscribes | None = None
    relays: Relays | None = None
    prints: tuple[str, ...] = ()

    @property
    def publishing(self) -> Topic | None:
        """The topic that the node publishes on, or None."""
        if self.publishes:
            return self.publishes.topic
        return self.relays.target if self.relays else None

    @property
    def subscribing(self) -> Topic | None:
        """The topic that the node subscribes to, or None."""
        if self.subscribes:
            return self.subscribes.topic
        return self.relays.source if self.relays else None

    @property
    def received_line(self) -> str | None:
        """The line for a value that the node receives, one of `prints`, or None."""
        return next((line for line in self.prints if "{value}" in line), None)

    def pattern(self, line: str, name: str | None = None) -> re.Pattern[str]:
        """Return the compiled regular expression of one of `prints`."""
        topic = self.subscribing or self.publishing
        return lines.pattern(line, name, bool(topic and topic.text))


@dataclasses.dataclass(frozen=True)
class Launch:
    file: str = ""  # without one, the checker starts the nodes by one of its own
    group: str | None = None


@dataclasses.dataclass(frozen=True)
class Shutdown:
    signal: str = _default("signal", "shutdown")
    exit_code: int = _default("exit_code", "shutdown")
    seconds: float = _default("seconds", "shutdown")


@dataclasses.dataclass(frozen=True)
class Late:
    """What each day takes off a mark: points, or percent of the contract's points."""

    points: float = 0
    percent: float = 0

    def off(self, days: float, most: float) -> float:
        """Return what so many days take off; most: the contract's points."""
        return days * (self.points + most * self.percent / 100)


@dataclasses.dataclass(frozen=True)
class Spec:
    title: str
    topics: dict[str, Topic]
    nodes: dict[str, Node]
    launch: Launch = Launch()
    shutdown: Shutdown = Shutdown()
    messages: dict[str, dict[str, str]] = dataclasses.field(default_factory=dict)
    install: bool = _default("install")
    points: dict[str, float] = dataclasses.field(default_factory=dict)
    not_asked: tuple[str, ...] = ()  # requirements that do not count
    hidden: tuple[str, ...] = ()  # requirements that count, and that no student sees
    late: Late | None = None
    is_contract: bool = True  # if not, it only lists the nodes of a package

    def node_path(self, node_name: str, group: str | None = None) -> str:
        """Return a node's full name, such as /mrp/publisher_cpp_node."""
        group = self.launch.group if group is None else group
        return f"/{group}/{node_name}" if group else f"/{node_name}"

    def asks(self, id_: str) -> bool:
        """Return whether a requirement counts."""
        of_launch = id_.startswith("launch-") and not self.launch.file
        return not of_launch and id_ not in self.not_asked

    def points_of(self, id_: str) -> float:
        """Return the points of a requirement: 1 where the spec does not say."""
        return self.points.get(id_, 1) if self.asks(id_) else 0

    def without_marks(self) -> Spec:
        """Return all that a check depends on: a report does not change with the rest."""
        return dataclasses.replace(self, points={}, hidden=(), late=None)


def find(name: str) -> pathlib.Path:
    """Return the path of a spec: a file, or the name of one of ours, such as pub_sub."""
    path = pathlib.Path(name)
    ours = resources.folder("specs") / (name if name.endswith(".yaml") else f"{name}.yaml")
    return ours if not path.is_file() and ours.is_file() else path


def read(path: str | pathlib.Path, requirements: Collection[str] | None = None) -> Spec:
    """Return the Spec in a file. Raises SpecError if it is no spec.

    requirements: the ids of those that there are, which points and hidden can name; any if None
    """
    try:
        text = pathlib.Path(path).read_text(encoding="utf-8")
        data = yaml.load(text, Loader=Loader)
    except OSError as error:
        raise SpecError(f"{path}: the spec cannot be read: {error.strerror}.") from None
    except UnicodeDecodeError as error:
        raise SpecError(f"{path}: the spec is no UTF-8 text, at byte {error.start}.") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"{path}:{mark.line + 1}" if mark else str(path)
        raise SpecError(f"{where}: the spec is no valid YAML: {error.problem}.") from None
    except yaml.YAMLError as error:
        raise SpecError(f"{path}: the spec is no valid YAML: {error}.") from None
    return _Reader(path, text, requirements).spec(data)


Entry = Dict[str, Any]  # of the YAML file
Messages = Mapping[str, Dict[str, str]]  # name -> field -> type


class _Reader:
    """Makes a Spec of what YAML says; an error names the line of the file."""

    def __init__(
        self, path: str | pathlib.Path, text: str, requirements: Collection[str] | None
    ) -> None:
        self.path, self.requirements = path, requirements
        self.tree = yaml.compose(text, Loader=yaml.SafeLoader)

    def fail(self, place: Sequence[str | int], sentence: str) -> NoReturn:
        """Raise SpecError about the entry at `place`, a list of keys and indices."""
        line = self.line(place)
        name = ".".join(map(str, place)) or "the spec"
        raise SpecError(f"{self.path}:{line}: {name}: {sentence} {_PAGE} {SCHEMA}")

    def line(self, place: Iterable[str | int]) -> int:
        """Return the line of the entry at `place`, or of the nearest one above it."""
        node, line = self.tree, 1
        for part in place:
            if isinstance(node, yaml.MappingNode):
                found = [(key, value) for key, value in node.value if key.value == str(part)]
                if not found:
                    break
                line, node = found[0][0].start_mark.line + 1, found[0][1]
            elif isinstance(node, yaml.SequenceNode) and isinstance(part, int):
                node = node.value[part]
                line = node.start_mark.line + 1
            else:
                break
        return line

    def spec(self, data: Entry) -> Spec:
        errors = list(jsonschema.Draft7Validator(_SCHEMA).iter_errors(data))
        if errors:
            error = min(
                errors, key=lambda error: (self.line(error.path), list(map(str, error.path)))
            )
            self.fail(list(error.path), sentence(error))
        topics = {name: Topic(name, **entry) for name, entry in data["topics"].items()}
        spec = Spec(
            title=data["title"],
            topics=topics,
            nodes={
                name: self.node(name, entry or {}, topics) for name, entry in data["nodes"].items()
            },
            launch=Launch(**data.get("launch", {})),
            shutdown=Shutdown(**data.get("shutdown", {})),
            messages=data.get("messages", {}),
            install=data.get("install", Spec.install),
            points=data.get("points", {}),
            not_asked=tuple(data.get("not_asked", ())),
            hidden=tuple(data.get("hidden", ())),
            late=Late(**data["late"]) if "late" in data else None,
        )
        self.own_messages(spec.messages)
        kinds = {name: self.field(topic, spec.messages) for name, topic in topics.items()}
        for node in spec.nodes.values():
            self.numbers(node, kinds)
        for id_ in spec.points:
            self.requirement(["points", id_], id_)
        for key in ("not_asked", "hidden"):
            for index, id_ in enumerate(data.get(key, ())):
                self.requirement([key, index], id_)
        return spec

    def numbers(self, node: Node, kinds: Mapping[str, str]) -> None:
        """See that a node can publish numbers, if it is to. kinds: topic -> its field's type"""
        role = node.publishes
        if role and not role.topic.text and not _NUMBER.fullmatch(kinds[role.topic.name]):
            key = "values" if role.values else "rises"
            if role.values or role.rises:
                self.fail(
                    ["nodes", node.name, "publishes", key],
                    f"{role.topic.field} of {role.topic.type} is a {kinds[role.topic.name]}, and no"
                    " number. A string has one if the topic has a 'text'.",
                )

    def requirement(self, place: Sequence[str | int], id_: str) -> None:
        """See that it exists."""
        if self.requirements is not None and id_ not in self.requirements:
            self.fail(place, no_such("requirement", id_, self.requirements))

    def own_messages(self, messages: Messages) -> None:
        """See that each field's type is one that there is."""
        for name, fields in messages.items():
            for field, kind in fields.items():
                plain = kind.split("[")[0]
                own = plain in messages or plain.partition("/")[::2][1] in messages
                if not (own or plain == "Header" or genmsg.msgs.is_builtin(plain)):
                    self.fields_of(plain, ["messages", name, field])

    def fields_of(self, kind: str, place: Sequence[str | int]) -> dict[str, str]:
        """Return field -> type of a message of this machine, such as std_msgs/UInt32."""
        folders = {kind.split("/")[0]: [f"{share}/{kind.split('/')[0]}/msg" for share in SHARES]}
        try:
            found = genmsg.msg_loader.load_msg_by_type(
                genmsg.MsgContext.create_default(), kind, folders
            )
        except (genmsg.MsgNotFound, genmsg.InvalidMsgSpec, ValueError):
            names = [
                f"{path.parents[1].name}/{path.stem}"
                for share in SHARES
                for path in pathlib.Path(share).glob("*/msg/*.msg")
            ]
            self.fail(place, f"there is no message '{kind}' on this machine." + near(kind, names))
        return dict(zip(found.names, found.types))

    def field(self, topic: Topic, messages: Messages) -> str:
        """See that a topic's type is one that there is, and return the type of its field."""
        kind, place = topic.type, ["topics", topic.name, "type"]
        for part in topic.field.split("."):
            package, _, message = kind.partition("/")
            if package == PACKAGE or not message and package in messages:
                message = message or package
                if message not in messages:
                    self.fail(place, f"'messages' has no message '{message}'.")
                fields = messages[message]
            else:
                fields = self.fields_of(kind, place) if message or kind == "Header" else {}
            if part not in fields:
                there = f"{kind} has: {', '.join(fields)}" if fields else f"{kind} has no fields"
                self.fail(
                    place[:-1] + ["field"],
                    f"expected a field of {topic.type}; found '{topic.field}'; {there}."
                    + near(part, fields),
                )
            kind = fields[part]
        if topic.text and kind != "string":
            said = f"only a string has a text; {topic.field} of {topic.type} is a {kind}."
            self.fail(place[:-1] + ["text"], said)
        return kind

    def node(self, name: str, entry: Entry, topics: dict[str, Topic]) -> Node:
        def topic(role: str, key: str = "topic") -> Topic:
            topic_name = entry[role][key]
            if topic_name not in topics:
                self.fail(["nodes", name, role, key], no_such("topic", topic_name, topics))
            return topics[topic_name]

        roles: Entry = {}
        if "publishes" in entry:
            values = entry["publishes"].get("values")
            more = {"topic": topic("publishes"), "values": Values(**values) if values else None}
            roles["publishes"] = Publishes(**{**entry["publishes"], **more})
        if "subscribes" in entry:
            roles["subscribes"] = Subscribes(
                **{**entry["subscribes"], "topic": topic("subscribes")}
            )
        if "relays" in entry:
            rest = {k: v for k, v in entry["relays"].items() if k not in ("from", "to")}
            roles["relays"] = Relays(topic("relays", "from"), topic("relays", "to"), **rest)
            if len(roles) > 1:
                self.fail(
                    ["nodes", name, "relays"],
                    "a node that relays has no 'publishes' or 'subscribes' besides: 'from' and"
                    " 'to' say both.",
                )
        rest = {key: entry[key] for key in ("language", "anonymous", "executable") if key in entry}
        return Node(name, prints=self.prints(name, entry.get("prints", ())), **roles, **rest)

    def prints(self, node: str, prints: Sequence[str]) -> tuple[str, ...]:
        """Return a node's lines, each of which is a regular expression."""
        for index, line in enumerate(prints):
            fault = lines.fault(line)
            if fault:
                self.fail(["nodes", node, "prints", index], fault)
        return tuple(prints)
