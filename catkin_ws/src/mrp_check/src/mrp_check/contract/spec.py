# SPDX-License-Identifier: BSD-3-Clause
"""The contract of an exercise, read from a YAML file such as contracts/pub_sub.yaml."""

from __future__ import annotations

import dataclasses
import pathlib
from typing import Any, Collection, Dict, Iterable, Mapping, NoReturn, Sequence, TypeVar, Union

import jsonschema
import yaml

from mrp_check.contract import lines, message_types, resources
from mrp_check.contract.errors import SpecError
from mrp_check.contract.message_types import PACKAGE as PACKAGE
from mrp_check.contract.message_types import REQUEST, RESPONSE
from mrp_check.contract.parts import SCHEMA as SCHEMA
from mrp_check.contract.parts import SCHEMA_DATA, default
from mrp_check.contract.parts import Call as Call
from mrp_check.contract.parts import Example as Example
from mrp_check.contract.parts import LaunchSpec as LaunchSpec
from mrp_check.contract.parts import Message as Message
from mrp_check.contract.parts import NodeSpec as NodeSpec
from mrp_check.contract.parts import Publishes as Publishes
from mrp_check.contract.parts import Relays as Relays
from mrp_check.contract.parts import Service as Service
from mrp_check.contract.parts import Shutdown as Shutdown
from mrp_check.contract.parts import Subscribes as Subscribes
from mrp_check.contract.parts import Topic as Topic
from mrp_check.contract.parts import Values as Values
from mrp_check.contract.schema import Loader, listed, no_such, sentence

MORE = ("services", "parameters", "examples")  # what counts only where a contract names some

_PAGE = "What can be said: pages/contract.html, which is generated from"


@dataclasses.dataclass(frozen=True)
class Spec:
    title: str
    topics: dict[str, Topic]
    nodes: dict[str, NodeSpec]
    launch: LaunchSpec = LaunchSpec()
    shutdown: Shutdown = Shutdown()
    messages: dict[str, dict[str, str]] = dataclasses.field(default_factory=dict)
    install: bool = default("install")
    points: dict[str, float] = dataclasses.field(default_factory=dict)
    not_asked: tuple[str, ...] = ()  # requirements that do not count
    hidden: tuple[str, ...] = ()  # requirements that count, and that no student sees
    services: dict[str, Service] = dataclasses.field(default_factory=dict)
    is_contract: bool = True  # if not, it only lists the nodes of a package

    def node_path(self, name: str) -> str:
        """Return a node's full name, such as /mrp/publisher_cpp_node."""
        return f"/{self.launch.group}/{name}" if self.launch.group else f"/{name}"

    def asks(self, id_: str) -> bool:
        """Return whether a requirement counts."""
        nodes = self.nodes.values()
        parameters = self.launch.file and any(node.parameters for node in nodes)
        parts = dict(zip(MORE, (self.services, parameters, any(node.examples for node in nodes))))
        of_launch = id_.startswith("launch-") and not self.launch.file
        return not of_launch and id_ not in self.not_asked and bool(parts.get(id_, True))

    def points_of(self, id_: str) -> float:
        """Return the points of a requirement: 1 where the spec does not say."""
        return self.points.get(id_, 1) if self.asks(id_) else 0

    def without_marks(self) -> Spec:
        """Return all that a check depends on: a report does not change with the rest."""
        return dataclasses.replace(self, points={}, hidden=())


def find(name: str) -> pathlib.Path:
    """Return the path of a spec: a file, or the name of one of ours, such as pub_sub."""
    path = pathlib.Path(name)
    ours = resources.folder("contracts") / (name if name.endswith(".yaml") else f"{name}.yaml")
    return ours if not path.is_file() and ours.is_file() else path


def read(path: str | pathlib.Path, requirements: Collection[str] | None = None) -> Spec:
    """Return the Spec in a file. Raises SpecError if it is no spec.

    requirements: the ids of those that there are, which points and hidden can name; any if None
    """
    try:
        text = pathlib.Path(path).read_text(encoding="utf-8")
        data = yaml.load(text, Loader=Loader)
    except OSError as error:
        raise SpecError(f"{path}: the contract can't be read: {error.strerror}.") from None
    except UnicodeDecodeError as error:
        raise SpecError(f"{path}: the contract isn't UTF-8 text, at byte {error.start}.") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"{path}:{mark.line + 1}" if mark else str(path)
        raise SpecError(f"{where}: the contract isn't valid YAML: {error.problem}.") from None
    except yaml.YAMLError as error:
        raise SpecError(f"{path}: the contract isn't valid YAML: {error}.") from None
    return _Reader(path, text, requirements).spec(data)


Entry = Dict[str, Any]  # of the YAML file
Messages = Dict[str, Dict[str, str]]  # name -> field -> type
KeyPath = Sequence[Union[str, int]]  # keys and indices
T = TypeVar("T")


class _Reader:
    """Makes a Spec of what YAML says; an error names the line of the file."""

    def __init__(
        self, path: str | pathlib.Path, text: str, requirements: Collection[str] | None
    ) -> None:
        self.path, self.requirements = path, requirements
        self.tree = yaml.compose(text, Loader=yaml.SafeLoader)

    def fail(self, place: KeyPath, sentence: str) -> NoReturn:
        """Raise SpecError about the entry at `place`, a list of keys and indices."""
        line, known = self.found(place)
        name = ".".join(known) or "the contract"
        raise SpecError(f"{self.path}:{line}: {name}: {sentence} {_PAGE} {SCHEMA}")

    def found(self, place: Iterable[str | int]) -> tuple[int, list[str]]:
        """Return the line of the entry at `place`, or of the nearest one above it; and `place`
        without the index of what stands alone, where a list could."""
        node, line, name = self.tree, 1, []
        for part in place:
            if isinstance(part, int) and node and not isinstance(node, yaml.SequenceNode):
                continue
            name.append(str(part))
            if isinstance(node, yaml.MappingNode):
                found = [(key, value) for key, value in node.value if key.value == str(part)]
                line = found[0][0].start_mark.line + 1 if found else line
                node = found[0][1] if found else None
            elif isinstance(node, yaml.SequenceNode) and isinstance(part, int):
                node = node.value[part]
                line = node.start_mark.line + 1
        return line, name

    def spec(self, data: Entry) -> Spec:
        data = listed(data, SCHEMA_DATA, SCHEMA_DATA["definitions"])
        errors = list(jsonschema.Draft7Validator(SCHEMA_DATA).iter_errors(data))
        if errors:
            error = min(
                errors, key=lambda error: (self.found(error.path)[0], list(map(str, error.path)))
            )
            self.fail(list(error.path), sentence(error))
        self.own = self.own_messages(data)
        topics = {name: self.topic(name, entry) for name, entry in data.get("topics", {}).items()}
        services = {
            name: self.service(name, entry) for name, entry in data.get("services", {}).items()
        }
        spec = Spec(
            title=data["title"],
            topics=topics,
            nodes={
                name: self.node(name, entry or {}, topics, services)
                for name, entry in data["nodes"].items()
            },
            services=services,
            launch=LaunchSpec(**data.get("launch", {})),
            shutdown=Shutdown(**data.get("shutdown", {})),
            messages=data.get("messages", {}),
            install=data.get("install", Spec.install),
            points=data.get("points", {}),
            not_asked=tuple(data.get("not_asked", ())),
            hidden=tuple(data.get("hidden", ())),
        )
        for node in spec.nodes.values():
            self.numbers(node)
        for id_ in spec.points:
            self.requirement(["points", id_], id_)
        for key in ("not_asked", "hidden"):
            for index, id_ in enumerate(data.get(key, ())):
                self.requirement([key, index], id_)
        return spec

    def numbers(self, node: NodeSpec) -> None:
        """See that a node can publish numbers, if it is to."""
        place = ["nodes", node.name]
        for index, role in enumerate(node.published):
            if role.values or role.rises:
                key = "values" if role.values else "rises"
                self.number(role.topic, [*place, "publishes", index, key])
        for key, topic in (("from", "source"), ("to", "target")) if node.relays else ():
            self.number(getattr(node.relays, topic), [*place, "relays", key])

    def number(self, topic: Topic, place: list[str | int]) -> None:
        if not topic.kind:
            self.kind(topic.type, topic.field, ["topics", topic.name])
        if not topic.text and not message_types.NUMBER.fullmatch(topic.kind):
            self.fail(
                place,
                f"{topic.field} of {topic.type} is a {topic.kind}, not a number. A string has one"
                " if the topic has a 'text'.",
            )

    def requirement(self, place: KeyPath, id_: str) -> None:
        """See that it exists."""
        if self.requirements is not None and id_ not in self.requirements:
            self.fail(place, no_such("requirement", id_, self.requirements))

    def kind(self, type_: str, path: str, place: KeyPath) -> str:
        """Return the type of a type's field; place: of what has the keys type and field."""
        try:
            return message_types.of_field(type_, path, self.own)
        except message_types.KindError as error:
            self.fail([*place, "type" if error.is_type else "field"], str(error))

    def own_messages(self, data: Entry) -> Messages:
        """See that each field's type is one that there is; return the contract's own types."""
        messages, own = data.get("messages", {}), dict(data.get("messages", {}))
        definitions = [(["messages", name], fields) for name, fields in messages.items()]
        for name, entry in data.get("services", {}).items():
            for half, key in ((REQUEST, "request"), (RESPONSE, "response")):
                if entry["type"].startswith(f"{PACKAGE}/"):
                    own[entry["type"].split("/")[1] + half] = entry.get(key, {})
                    definitions.append((["services", name, key], entry.get(key, {})))
        for place, fields in definitions:
            for field, kind in fields.items():
                plain = kind.split("[")[0]
                if message_types.is_builtin(plain) or {plain, plain.partition("/")[2]} & {*own}:
                    continue
                try:
                    message_types.of_machine(plain)
                except message_types.KindError as error:
                    self.fail([*place, field], str(error))
        return own

    def topic(self, name: str, entry: Entry) -> Topic:
        place = ["topics", name]
        asked = {"field", "text"} & {*entry}
        try:
            kind = message_types.of_field(entry["type"], entry.get("field", Topic.field), self.own)
        except message_types.KindError as error:
            if asked or error.is_type:
                self.fail([*place, "type" if error.is_type else "field"], str(error))
            kind = ""
        if "text" in entry and kind != "string":
            problem = f"only a string has a text; {entry.get('field', Topic.field)} of"
            self.fail([*place, "text"], f"{problem} {entry['type']} is a {kind}.")
        return Topic(name, kind=kind, **entry)

    def service(self, name: str, entry: Entry) -> Service:
        place: list[str | int] = ["services", name]
        type_ = entry["type"]
        is_own = type_.startswith(f"{PACKAGE}/")
        for key in ("request", "response"):
            if key in entry and not is_own:
                self.fail([*place, key], f"only a type of {PACKAGE} is defined here; {type_} is.")
        try:
            if not is_own:
                message_types.require_service(type_)
        except message_types.KindError as error:
            self.fail([*place, "type"], str(error))
        for index, call in enumerate(entry.get("examples", ())):
            for key, half in (("request", REQUEST), ("response", RESPONSE)):
                self.message(type_ + half, call[key], [*place, "examples", index, key])
        calls = tuple(Call(**call) for call in entry.get("examples", ()))
        return Service(name, **{**entry, "examples": calls})

    def message(self, type_: str, fields: Message, place: KeyPath) -> None:
        """See that a type has these fields, and that they can have these values."""
        for path, value in fields.items():
            try:
                fault = message_types.fault(message_types.of_field(type_, path, self.own), value)
            except message_types.KindError as error:
                fault = str(error)
            if fault:
                self.fail([*place, path], fault)

    def one_of(self, things: Mapping[str, T], name: str, place: KeyPath, kind: str) -> T:
        if name not in things:
            self.fail(place, no_such(kind, name, things))
        return things[name]

    def node(
        self, name: str, entry: Entry, topics: dict[str, Topic], services: dict[str, Service]
    ) -> NodeSpec:
        place: list[str | int] = ["nodes", name]

        def topic(entry: Entry, *keys: str | int) -> Topic:
            return self.one_of(topics, entry[str(keys[-1])], [*place, *keys], "topic")

        roles: Entry = {"published": (), "subscribed": ()}
        for index, role in enumerate(entry.get("publishes", ())):
            values = Values(**role["values"]) if "values" in role else None
            more = {"topic": topic(role, "publishes", index, "topic"), "values": values}
            roles["published"] += (Publishes(**{**role, **more}),)
        for index, role in enumerate(entry.get("subscribes", ())):
            on = topic(role, "subscribes", index, "topic")
            roles["subscribed"] += (Subscribes(**{**role, "topic": on}),)
        if "relays" in entry:
            relays = entry["relays"]
            rest = {k: v for k, v in relays.items() if k not in ("from", "to")}
            ends = topic(relays, "relays", "from"), topic(relays, "relays", "to")
            if roles["published"] or roles["subscribed"]:
                self.fail(
                    [*place, "relays"],
                    "a node that relays has no 'publishes' or 'subscribes': 'from' and"
                    " 'to' say both.",
                )
            roles["relays"] = Relays(*ends, **rest)
        for key in ("offers", "calls"):
            roles[key] = tuple(
                self.one_of(services, service, [*place, key, index], "service")
                for index, service in enumerate(entry.get(key, ()))
            )
        roles["examples"] = tuple(
            self.example(example, topics, [*place, "examples", index])
            for index, example in enumerate(entry.get("examples", ()))
        )
        plain = ("language", "anonymous", "executable", "ends", "parameters")
        rest = {key: entry[key] for key in plain if key in entry}
        return NodeSpec(name, prints=self.prints(name, entry.get("prints", ())), **roles, **rest)

    def example(self, entry: Entry, topics: dict[str, Topic], place: KeyPath) -> Example:
        def topic(name: str, *above: str | int) -> Topic:
            return self.one_of(topics, name, [*place, *above, name], "topic")

        receives = []
        for index, received in enumerate(entry.get("receives", ())):
            for name, message in received.items():
                receives.append((topic(name, "receives", index), message))
                self.message(receives[-1][0].type, message, [*place, "receives", index, name])
        for name, messages in entry["publishes"].items():
            type_ = topic(name, "publishes").type
            for index, message in enumerate(messages):
                self.message(type_, message, [*place, "publishes", name, index])
        return Example(
            entry.get("parameters", {}),
            tuple(receives),
            {name: tuple(messages) for name, messages in entry["publishes"].items()},
            entry.get("tolerance", Example.tolerance),
        )

    def prints(self, node: str, prints: Sequence[str]) -> tuple[str, ...]:
        """Return a node's lines, each of which is a regular expression."""
        for index, line in enumerate(prints):
            fault = lines.fault(line)
            if fault:
                self.fail(["nodes", node, "prints", index], fault)
        return tuple(prints)
