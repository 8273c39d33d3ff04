# SPDX-License-Identifier: BSD-3-Clause
"""What a contract is made of; its keys and their defaults are those of schema/spec.json."""

from __future__ import annotations

import dataclasses
import json
import re
from typing import Any, Mapping, Union

from mrp_check.contract import lines, resources
from mrp_check.contract.message_types import PACKAGE

SCHEMA = resources.folder("schema") / "spec.json"
SCHEMA_DATA = json.loads(SCHEMA.read_text())

Plain = Union[bool, int, float, str]
Message = Mapping[str, Plain]  # a field's path, such as linear.x -> its value


def default(key: str, *kind: str) -> Any:
    """Return what a key has if it is left out: the schema says it, and the page made of that."""
    definitions = SCHEMA_DATA["definitions"]
    entry = (definitions[kind[0]] if kind else SCHEMA_DATA)["properties"][key]
    return (
        definitions[entry["$ref"].split("/")[-1]]["default"]
        if "$ref" in entry
        else entry["default"]
    )


class _Typed:
    type: str

    def type_in(self, package_name: str) -> str:
        """Return the type with the package's name in it."""
        package, name = self.type.split("/")
        return f"{package_name if package == PACKAGE else package}/{name}"


@dataclasses.dataclass(frozen=True)
class Topic(_Typed):
    name: str
    type: str
    field: str = default("field", "topic")
    namespace: str = default("namespace", "topic")
    text: str | None = None  # all that the field says, with {value} in the value's place
    kind: str = ""  # the field's type; empty if the messages have no such field

    @property
    def has_decimals(self) -> bool:
        return bool(self.text) or self.kind.startswith("float")

    def value_in(self, content: object) -> int | float | None:
        """Return the number that the field's content says, or None: it may be of any type."""
        if self.text and isinstance(content, str):
            shape = re.escape(self.text).replace(r"\{value\}", f"({lines.WHOLE}({lines.DECIMALS}))")
            found = re.fullmatch(shape, content)
            if not found:
                return None
            return float(found.group(1)) if found.group(2) else int(found.group(1))
        return content if isinstance(content, (int, float)) else None


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
    tolerance: float = default("tolerance", "publishes")  # as a part of the period
    latched: bool = default("latched", "publishes")
    values: Values | None = None
    rises: bool = default("rises", "publishes")


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
    times: int = default("times", "relays")
    modulus: int | None = None

    def of(self, value: int) -> int:
        """Return what is published when `value` is received."""
        product = value * self.times
        return product if self.modulus is None else product % self.modulus


@dataclasses.dataclass(frozen=True)
class Call:
    """What a service is asked, and what it answers to that."""

    request: Message
    response: Message
    tolerance: float = default("tolerance", "call")


@dataclasses.dataclass(frozen=True)
class Service(_Typed):
    """A service; request, response: field -> type, of a type of the package's own."""

    name: str
    type: str
    request: Mapping[str, str] = dataclasses.field(default_factory=dict)
    response: Mapping[str, str] = dataclasses.field(default_factory=dict)
    namespace: str = default("namespace", "service")
    examples: tuple[Call, ...] = ()


@dataclasses.dataclass(frozen=True)
class Example:
    """What a node publishes when it is started with these parameters, and is sent these messages.

    receives: (topic, message), in order; publishes: topic's name -> the messages
    """

    parameters: Mapping[str, Plain]
    receives: tuple[tuple[Topic, Message], ...]
    publishes: Mapping[str, tuple[Message, ...]]
    tolerance: float = default("tolerance", "example")


@dataclasses.dataclass(frozen=True)
class NodeSpec:
    name: str
    language: str = default("language", "node")  # cpp, python or any
    anonymous: bool = default("anonymous", "node")
    ends: bool = default("ends", "node")
    file: str | None = None
    executable: str | None = None
    published: tuple[Publishes, ...] = ()
    subscribed: tuple[Subscribes, ...] = ()
    relays: Relays | None = None
    offers: tuple[Service, ...] = ()
    calls: tuple[Service, ...] = ()
    parameters: Mapping[str, Plain] = dataclasses.field(default_factory=dict)
    examples: tuple[Example, ...] = ()
    prints: tuple[str, ...] = ()

    @property
    def publishes(self) -> Publishes | None:
        """What it publishes on its first topic, or None."""
        return next(iter(self.published), None)

    @property
    def subscribes(self) -> Subscribes | None:
        """What it subscribes to first, or None."""
        return next(iter(self.subscribed), None)

    @property
    def publishing(self) -> list[Topic]:
        """The topics that the node publishes on."""
        return [role.topic for role in self.published] or [r.target for r in (self.relays,) if r]

    @property
    def subscribing(self) -> list[Topic]:
        """The topics that the node subscribes to."""
        return [role.topic for role in self.subscribed] or [r.source for r in (self.relays,) if r]

    @property
    def of_itself(self) -> bool:
        """Whether it publishes without being sent anything; one that relays does, if others do."""
        after = {
            name for example in self.examples if example.receives for name in example.publishes
        }
        timed = {role.topic.name for role in self.published if role.period}
        return any(topic.name in timed or topic.name not in after for topic in self.publishing)

    @property
    def received_line(self) -> str | None:
        """The line for a value that the node receives, one of `prints`, or None."""
        return next((line for line in self.prints if "{value}" in line), None)

    def pattern(self, line: str, name: str | None = None) -> re.Pattern[str]:
        """Return the compiled regular expression of one of `prints`."""
        topics = self.subscribing or self.publishing
        return lines.pattern(line, name, any(topic.has_decimals for topic in topics))


@dataclasses.dataclass(frozen=True)
class LaunchSpec:
    file: str = ""  # without one, the checker starts the nodes by one of its own
    group: str | None = None


@dataclasses.dataclass(frozen=True)
class Shutdown:
    signal: str = default("signal", "shutdown")
    exit_code: int = default("exit_code", "shutdown")
    seconds: float = default("seconds", "shutdown")
