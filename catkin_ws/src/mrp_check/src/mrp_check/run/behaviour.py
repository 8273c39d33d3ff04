# SPDX-License-Identifier: BSD-3-Clause
"""Describe what a node did as a contract would, for packages without one."""

from __future__ import annotations

import dataclasses
import re
import statistics
from typing import Callable, Iterable, Mapping, Sequence

from mrp_check.confined.seen import DirectResult, LaunchResult, Message, Number, Registration, Seen
from mrp_check.contract.spec import Topic
from mrp_check.run.node import FEW
from mrp_check.run.planning import resolved
from mrp_check.run.traces import ROS_SERVICES, ROS_TOPICS, ends

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_STEADY = 0.3  # of the middle gap: by less differ most others of a publisher with a period
_LINES = 3  # at most, that a contract asks of a node
_EXPRESSION = re.compile(r"[][\\.^$*+?{}|()]")

Entry = dict[str, object]  # of a contract


@dataclasses.dataclass
class Run:
    """A run of a node, among others.

    path: its full name then; seen: what was seen of all nodes; asked: when they were to end
    latched: topic -> the nodes that latch it
    """

    path: str
    seen: Seen
    asked: float
    latched: Mapping[str, Sequence[str]] = dataclasses.field(default_factory=dict)

    def own(self, records: Iterable[Registration]) -> dict[str, str]:
        """Return topic or service -> type, of those of the node."""
        return {one.topic: one.type for one in records if one.node == self.path}

    def messages(self, topic: Topic, of_all: bool = False) -> list[Message]:
        """Return what the node sent on a topic, or what all nodes did."""
        sent = [
            message for message in self.seen.messages if message.topic == resolved(topic, self.path)
        ]
        return [one for one in sent if of_all or one.node == self.path]

    def numbers(self, topic: Topic, of_all: bool = False) -> list[Number]:
        fields = [one.fields or {} for one in self.messages(topic, of_all)]
        found = [topic.value_in(one.get(topic.field)) for one in fields]
        return [number for number in found if number is not None]

    def lines(self) -> list[str]:
        """Return what the node logged, each line as an expression with {name} in it."""
        logs = [log for log in self.seen.logs if log.node == self.path and log.level == "INFO"]
        texts = [log.text for log in logs if log.time < self.asked and "\n" not in log.text]
        plain = [_EXPRESSION.sub(r"\\\g<0>", text) for text in texts]
        return [text.replace(self.path, "{name}") for text in plain]


class Behaviour:
    """What a node did.

    name: of its executable
    launched: its runs beside others; alone: the one by itself, or None
    ends: whether it ended by itself, with exit code 0
    """

    def __init__(
        self,
        name: str,
        launched: Sequence[tuple[str, LaunchResult]],
        direct: DirectResult | None,
    ) -> None:
        self.name = name
        self.launched = [Run(path, one.seen, one.asked, one.latched) for path, one in launched]
        alone = direct.nodes.get(name) if direct else None
        self.alone = None
        self.ends = bool(not launched and alone and alone.ended_after and alone.code == 0)
        if direct and alone and alone.name:
            asked = alone.asked or alone.ended_after or 0.0
            self.alone = Run(alone.name, direct.seen, asked)
        for path, one in launched:
            self.ends |= ends(one.until_asked()).get(path) == 0
        self.runs = [*self.launched, *filter(None, [self.alone])]

    @property
    def publishes(self) -> list[Topic]:
        return self._named(lambda seen: seen.publications)

    @property
    def subscribes(self) -> list[Topic]:
        return self._named(lambda seen: seen.subscriptions)

    @property
    def offers(self) -> list[Topic]:
        """The services that it offers, each with its type."""
        return self._named(lambda seen: seen.services)

    @property
    def calls(self) -> list[Topic]:
        """The services that it looks for, whose type is not known."""
        return self._named(lambda seen: seen.lookups)

    def _named(self, records: Callable[[Seen], Iterable[Registration]]) -> list[Topic]:
        # In a namespace of its own, it shows whether a name follows that.
        run = next(iter(reversed(self.runs)), None)
        if run is None:
            return []
        found = run.own(records(run.seen)).items()
        named = [_named(*entry, run.path) for entry in found if entry[0] not in ROS_TOPICS]
        return [one for one in named if one.name not in ROS_SERVICES]

    def series(self, topic: Topic) -> list[list[Message]]:
        """Return what it sent on a topic, in each run in which that was enough to tell."""
        found = [run.messages(topic) for run in self.runs]
        return [messages for messages in found if len(messages) >= FEW]

    def role(self, topic: Topic) -> Entry:
        """Return what a contract says of a topic that it publishes on, without the queue."""
        said: Entry = {}
        period = _period(self.series(topic))
        if period:
            said["period"] = period
            if period < 0.5:
                said["tolerance"] = 0.5  # other programs of the machine change it as much
        if any(run.path in run.latched.get(resolved(topic, run.path), ()) for run in self.runs):
            said["latched"] = True
        counted = [run.numbers(topic) for run in self.runs]
        return {**said, **_counted([one for one in counted if len(one) >= FEW])}

    def relayed(self, source: Topic, target: Topic) -> int | None:
        """Return by what it multiplies each number that it receives, if it does nothing else."""
        if self.alone and self.alone.messages(target):
            return None
        for run in self.launched:
            received, sent = run.numbers(source, of_all=True), run.numbers(target)
            ratios = [sent[0] / one for one in received if one] if len(sent) >= FEW else []
            for ratio in (int(one) for one in ratios if one and one == int(one)):
                if all(one / ratio in received for one in sent):
                    return ratio
        return None

    def lines(self, topic: Topic | None, of_all: bool) -> list[str]:
        """Return the lines that it is sure to log: once in each run; or with each number that came
        on a topic, from it or from all nodes."""
        logged = [run.lines() for run in self.runs]
        first = logged[0] if len(logged) > 1 else []
        once = [line for line in first if all(one.count(line) == 1 for one in logged)]
        sure = [line for line in dict.fromkeys(once) if not _NUMBER.search(line)]
        for run, lines in zip(self.launched, logged):
            known = {float(one) for one in run.numbers(topic, of_all)} if topic else set()
            said: dict[str, list[float]] = {}
            for line in lines:
                numbers = _NUMBER.findall(line.replace("\\", ""))
                if len(numbers) == 1:
                    shape = line.replace(numbers[0].replace(".", r"\."), "{value}")
                    said.setdefault(shape, []).append(float(numbers[0]))
            sure += [shape for shape, all_ in said.items() if len(all_) >= FEW and {*all_} <= known]
        return [*dict.fromkeys(sure)][:_LINES]


def _named(name: str, kind: str, path: str) -> Topic:
    """Return the topic, or service, of a full name, as the node of that path asked for it."""
    group = path.rsplit("/", 1)[0] + "/"
    starts = {"private": f"{path}/", "group": group, "global": "/"}
    namespace = next(key for key, start in starts.items() if name.startswith(start))
    return Topic(name[len(starts[namespace]) :], kind, namespace=namespace)


def shaped(topic: Topic, series: Sequence[Sequence[Message]]) -> Topic:
    """Return a topic with the field that counts, and what it says beside the number.

    series: what each node sent on it in a run
    """
    fields = [[message.fields or {} for message in messages] for messages in series]
    first = next((message for messages in fields for message in messages), {})
    if isinstance(first.get("data"), str):
        text = _text([str(message.get("data")) for messages in fields for message in messages])
        return dataclasses.replace(topic, kind="string", text=text)
    numbers = [path for path, value in first.items() if type(value) in (int, float)]
    # What ROS counts by itself says nothing of the node.
    numbers = [path for path in numbers if not re.search(r"\b(seq|stamp)\b", path)]
    for path in numbers:
        rows = [[message.get(path) for message in messages] for messages in fields]
        if all(isinstance(v, (int, float)) for row in rows for v in row):
            if all(a != b for row in rows for a, b in zip(row, row[1:])):
                return dataclasses.replace(topic, field=path, kind="number")
    return topic


def _text(texts: Sequence[str]) -> str | None:
    """Return a text with {value} in place of the one number in which all of them differ."""
    rest = {tuple(_NUMBER.split(text)) for text in texts}
    numbers = [*zip(*map(_NUMBER.findall, texts))]
    changing = [place for place, row in enumerate(numbers) if len({*row}) > 1]
    if len(rest) != 1 or len(changing) != 1 or any(set("{}") & {*text} for text in texts):
        return None
    said = [row[0] for row in numbers]
    said[changing[0]] = "{value}"
    (between,) = rest
    return "".join(a + b for a, b in zip(between, [*said, ""]))


def _period(series: Sequence[Sequence[Message]]) -> float | None:
    """Return the seconds from message to message; None if they come at no steady rate."""
    times = [one.time for one in max(series, key=len, default=[])]
    gaps = [b - a for a, b in zip(times, times[1:])]
    if not gaps:
        return None
    middle = statistics.median(gaps)
    steady = [gap for gap in gaps if abs(gap - middle) < _STEADY * middle]
    return float(f"{middle:.2g}") if len(steady) >= 0.7 * len(gaps) else None


def _counted(series: Sequence[Sequence[Number]]) -> Entry:
    """Return what a contract says of the numbers that a node publishes."""
    steps = {b - a for row in series for a, b in zip(row, row[1:])}
    starts = {row[0] for row in series}
    if len(steps) == len(starts) == 1 and 0 not in steps:
        start, step = starts.pop(), steps.copy().pop()
        if start == int(start) and step == int(step):
            return {"values": {"start": int(start), "step": int(step)}}
    return {"rises": True} if steps and min(steps) > 0 else {}
