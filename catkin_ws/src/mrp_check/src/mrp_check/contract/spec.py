# SPDX-License-Identifier: BSD-3-Clause
"""The contract of an exercise, read from a YAML file such as specs/pub_sub.yaml."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import re

import genmsg
import jsonschema
import yaml

from mrp_check.contract import resources
from mrp_check.contract.errors import SpecError
from mrp_check.contract.resources import SHARES
from mrp_check.contract.words import nearest

SCHEMA = resources.folder("schema") / "spec.json"
PACKAGE = "PACKAGE"  # in a type: the package's own name


@dataclasses.dataclass(frozen=True)
class Topic:
    name: str
    type: str
    field: str = "data"
    namespace: str = "group"

    def type_in(self, package_name):
        """Return the type with the package's name in it."""
        package, name = self.type.split("/")
        return f"{package_name if package == PACKAGE else package}/{name}"


@dataclasses.dataclass(frozen=True)
class Values:
    """The values are start, start + step, start + 2 * step, ..., modulo modulus (if not None)."""

    start: int
    step: int
    modulus: int | None = None

    def after(self, value):
        """Return the value that comes after `value`."""
        return value + self.step if self.modulus is None else (value + self.step) % self.modulus


@dataclasses.dataclass(frozen=True)
class Publishes:
    topic: Topic
    queue: int | None = None
    period: float | None = None  # seconds
    tolerance: float = 0.1  # as a part of the period
    latched: bool = False
    values: Values | None = None


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
    times: int = 1
    modulus: int | None = None

    def of(self, value):
        """Return what is published when `value` is received."""
        product = value * self.times
        return product if self.modulus is None else product % self.modulus


@dataclasses.dataclass(frozen=True)
class Node:
    name: str
    language: str = "any"  # cpp, python or any
    file: str | None = None
    executable: str | None = None
    publishes: Publishes | None = None
    subscribes: Subscribes | None = None
    relays: Relays | None = None
    prints: tuple[str, ...] = ()

    @property
    def publishing(self):
        """The topic that the node publishes on, or None."""
        if self.publishes:
            return self.publishes.topic
        return self.relays.target if self.relays else None

    @property
    def subscribing(self):
        """The topic that the node subscribes to, or None."""
        if self.subscribes:
            return self.subscribes.topic
        return self.relays.source if self.relays else None


@dataclasses.dataclass(frozen=True)
class Launch:
    file: str
    group: str | None = None


@dataclasses.dataclass(frozen=True)
class Shutdown:
    signal: str = "SIGINT"
    exit_code: int = 0
    seconds: float = 10.0


@dataclasses.dataclass(frozen=True)
class Spec:
    title: str
    topics: dict[str, Topic]
    nodes: dict[str, Node]
    launch: Launch
    shutdown: Shutdown = Shutdown()
    messages: dict[str, dict[str, str]] = dataclasses.field(default_factory=dict)
    install: bool = False
    points: dict[str, float] = dataclasses.field(default_factory=dict)

    def node_path(self, node_name, group=None):
        """Return a node's full name, such as /mrp/publisher_cpp_node."""
        group = self.launch.group if group is None else group
        return f"/{group}/{node_name}" if group else f"/{node_name}"


def pattern(line, name=None):
    """Return the compiled regular expression of a line in `prints`.

    name: the node's full name, put in for {name}; any name if None. {value} is any whole number,
    which is the group `value`.
    """
    name_pattern = re.escape(name) if name is not None else r"\S*"
    text = line.replace("{name}", name_pattern).replace("{value}", r"(?P<value>-?\d+)")
    return re.compile(text)


def find(name):
    """Return the path of a spec: a file, or the name of one of ours, such as pub_sub."""
    path = pathlib.Path(name)
    ours = resources.folder("specs") / (name if name.endswith(".yaml") else f"{name}.yaml")
    return ours if not path.is_file() and ours.is_file() else path


def read(path, requirements=None):
    """Return the Spec in a file. Raises SpecError if it is no spec.

    requirements: the ids of those that there are, to which points can be given; any if None
    """
    try:
        text = pathlib.Path(path).read_text(encoding="utf-8")
        data = yaml.load(text, Loader=_Loader)
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


class _Loader(yaml.SafeLoader):
    """Says when a key stands twice: plain YAML would take the last one, in silence."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode) and key.value in seen:
                raise yaml.MarkedYAMLError(
                    problem=f"the key '{key.value}' stands twice", problem_mark=key.start_mark
                )
            seen.add(getattr(key, "value", None) if isinstance(key, yaml.ScalarNode) else None)
        return super().construct_mapping(node, deep)


class _Reader:
    """Makes a Spec of what YAML says; an error names the line of the file."""

    def __init__(self, path, text, requirements):
        self.path, self.requirements = path, requirements
        self.tree = yaml.compose(text, Loader=yaml.SafeLoader)

    def fail(self, place, sentence):
        """Raise SpecError about the entry at `place`, a list of keys and indices."""
        line = self.line(place)
        name = ".".join(map(str, place)) or "the spec"
        raise SpecError(f"{self.path}:{line}: {name}: {sentence} What can be said: {SCHEMA}")

    def line(self, place):
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

    def spec(self, data):
        schema = json.loads(SCHEMA.read_text())
        errors = list(jsonschema.Draft7Validator(schema).iter_errors(data))
        if errors:
            error = min(
                errors, key=lambda error: (self.line(error.path), list(map(str, error.path)))
            )
            self.fail(list(error.path), _sentence(error))
        topics = {name: Topic(name, **entry) for name, entry in data["topics"].items()}
        spec = Spec(
            title=data["title"],
            topics=topics,
            nodes={
                name: self.node(name, entry or {}, topics) for name, entry in data["nodes"].items()
            },
            launch=Launch(**data["launch"]),
            shutdown=Shutdown(**data.get("shutdown", {})),
            messages=data.get("messages", {}),
            install=data.get("install", False),
            points=data.get("points", {}),
        )
        self.own_messages(spec.messages)
        for topic in topics.values():
            self.field(topic, spec.messages)
        for id_ in spec.points:
            if self.requirements is not None and id_ not in self.requirements:
                self.fail(["points", id_], _no_such("requirement", id_, self.requirements))
        return spec

    def own_messages(self, messages):
        """See that each field's type is one that there is."""
        for name, fields in messages.items():
            for field, kind in fields.items():
                plain = kind.split("[")[0]
                own = plain in messages or plain.partition("/")[::2][1] in messages
                if not (own or plain == "Header" or genmsg.msgs.is_builtin(plain)):
                    self.fields_of(plain, ["messages", name, field])

    def fields_of(self, kind, place):
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
            self.fail(place, f"there is no message '{kind}' on this machine." + _near(kind, names))
        return dict(zip(found.names, found.types))

    def field(self, topic, messages):
        """See that a topic's type is one that there is, and has the topic's field."""
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
                    + _near(part, fields),
                )
            kind = fields[part]

    def node(self, name, entry, topics):
        def topic(role, key):
            place = ["nodes", name, role, key]
            topic_name = entry[role][key]
            if topic_name not in topics:
                self.fail(place, _no_such("topic", topic_name, topics))
            return topics[topic_name]

        roles = {}
        if "publishes" in entry:
            values = entry["publishes"].get("values")
            roles["publishes"] = Publishes(
                **{
                    **entry["publishes"],
                    "topic": topic("publishes", "topic"),
                    "values": Values(**values) if values else None,
                }
            )
        if "subscribes" in entry:
            roles["subscribes"] = Subscribes(
                **{**entry["subscribes"], "topic": topic("subscribes", "topic")}
            )
        if "relays" in entry:
            rest = {k: v for k, v in entry["relays"].items() if k not in ("from", "to")}
            roles["relays"] = Relays(topic("relays", "from"), topic("relays", "to"), **rest)
            if "publishes" in entry or "subscribes" in entry:
                self.fail(
                    ["nodes", name, "relays"],
                    "a node that relays has no 'publishes' or 'subscribes' besides: 'from' and"
                    " 'to' say both.",
                )
        for index, line in enumerate(entry.get("prints", [])):
            try:
                pattern(line)
            except re.error as error:
                self.fail(
                    ["nodes", name, "prints", index],
                    f"'{line}' is no regular expression: {error}. A literal bracket is written"
                    r" \[ or \].",
                )
        rest = {key: entry[key] for key in ("language", "file", "executable") if key in entry}
        return Node(name, prints=tuple(entry.get("prints", ())), **roles, **rest)


def _no_such(kind, name, names):
    return f"there is no {kind} '{name}'; there are: {', '.join(names)}." + _near(name, names)


def _near(name, names):
    near = nearest(name, names)
    return f" Did you mean '{near}'?" if near else ""


def _sentence(error):
    """Return what is wrong, in words, for an error of jsonschema."""
    if error.validator == "additionalProperties":
        known = list(error.schema.get("properties", {}))
        unknown = sorted(str(key) for key in error.instance if key not in known)
        if known:
            return _no_such("key", unknown[0], known)
    if error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        return f"expected the key '{missing[0]}'; it is missing."
    kinds = {
        "object": "keys with values",
        "array": "a list",
        "string": "a text",
        "integer": "a whole number",
        "number": "a number",
        "boolean": "true or false",
    }
    if error.validator == "type":
        return f"expected {kinds[error.validator_value]}; found {_shown(error.instance)}."
    if error.validator == "enum":
        allowed = ", ".join(map(str, error.validator_value))
        return f"expected one of: {allowed}; found {_shown(error.instance)}."
    if error.validator == "pattern":
        return f"'{error.instance}' does not match {error.validator_value}."
    limits = {
        "minimum": "at least",
        "maximum": "at most",
        "exclusiveMinimum": "more than",
        "minLength": "a length of at least",
        "minProperties": "entries: at least",
    }
    if error.validator in limits:
        limit = f"{limits[error.validator]} {error.validator_value}"
        return f"expected {limit}; found {_shown(error.instance)}."
    return error.message + "."


def _shown(value):
    if value is None:
        return "nothing"
    if isinstance(value, (dict, list)) and not value:
        return "nothing"
    if isinstance(value, dict):
        return "keys with values"
    if isinstance(value, list):
        return "a list"
    return str(value).lower() if isinstance(value, bool) else repr(value)
