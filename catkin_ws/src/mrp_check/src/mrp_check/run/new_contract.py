# SPDX-License-Identifier: BSD-3-Clause
"""A contract for a package that has none: what was seen of it, to be edited."""

from __future__ import annotations

import re
import textwrap
from typing import Any, Callable, Iterator, Sequence

import genmsg
import yaml

from mrp_check.confined.launch_dump import Started
from mrp_check.confined.places import Kind
from mrp_check.confined.seen import LaunchResult
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.kinds import PACKAGE
from mrp_check.contract.names import last_part
from mrp_check.contract.spec import Topic
from mrp_check.run.any_case import AnyCase
from mrp_check.run.behaviour import Behaviour, Entry, shaped

_WORD = re.compile(r"[A-Za-z]\w*")  # what a contract can call a node or a topic
_UINT = re.compile(r"std_msgs/UInt(\d+)")
_VALUES = re.compile(r"(values: .*)")


def text(case: AnyCase) -> str:
    """Return the contract, in YAML. Raises CannotCheck if no node of the package ran."""
    return _Writer(case).text()


class _Writer:
    """See above.

    launch: what the launch file starts that starts all the nodes, by name; empty without one
    nodes: name -> what was seen of it
    topics, services: those of all nodes, by name
    used: the names of the topics on which something was seen
    comments: name of a node -> what is left to be edited
    """

    def __init__(self, case: AnyCase) -> None:
        self.case, self.package = case, case.package
        self.file, self.launch = self._launch()
        self.nodes = dict(self._nodes())
        self.used: set[str] = set()
        self.comments: dict[str, list[str]] = {name: [] for name in self.nodes}
        if not self.nodes:
            raise CannotCheck(
                f"no contract was written, because no node of {self.package.name} ran."
            )
        self.topics = self._topics()
        offered = [one for node in self.nodes.values() for one in node.offers]
        self.services = {one.name: one for one in offered if _is_word(one.name) and one.type}

    # --- What ran

    def _launch(self) -> tuple[str, dict[str, Started]]:
        """Return (path, name -> node) of the launch file that starts all nodes in one namespace."""
        for one in self.case.observed.launches:
            found = [launch for launch in self.case.launches if launch.file == one.file]
            started = [node for node in found[0].nodes if node.path in one.nodes] if found else []
            if not {*self.case.observed.executables} <= {node.type for node in started}:
                continue
            names, spaces = {node.name for node in started}, {node.namespace for node in started}
            if len(names) == len(started) and len(spaces) == 1 and all(map(_is_word, names)):
                (space,) = spaces
                if space == "/" or _is_word(space.strip("/")):
                    return one.file, {node.name: node for node in started}
        return "", {}

    def _nodes(self) -> Iterator[tuple[str, Behaviour]]:
        seen = self.case.observed
        wanted: list[tuple[str, Started | None]] = [(one.type, one) for one in self.launch.values()]
        types = [name for name, _ in wanted]
        for name, started in wanted or [(name, None) for name in self.case.spec.nodes]:
            runs: list[tuple[str, LaunchResult]] = [
                (path, launch.seen)
                for launch in seen.launches
                for path, executable in launch.nodes.items()
                if executable == name
                and (not started or (launch.file, path) == (self.file, started.path))
            ]
            # Of several that one executable makes, the run by itself shows only one.
            node = Behaviour(name, runs, seen.direct if types.count(name) < 2 else None)
            if node.runs:
                yield started.name if started else self._name(node), node

    def _name(self, node: Behaviour) -> str:
        """Return the name that a node gives itself."""
        name = last_part(node.runs[-1].path)
        return re.sub(r"(_\d+)+$", "", name) if self._is_anonymous(node) else name

    def _is_anonymous(self, node: Behaviour) -> bool:
        return any(place.anonymous for place in self.case.facts.of(node.name, Kind.INIT))

    def _topics(self) -> dict[str, Topic]:
        """Return the topics that a contract can name, each with the field that counts."""
        found: dict[str, Topic] = {}
        for node in self.nodes.values():
            for topic in [*node.publishes, *node.subscribes]:
                if _is_word(topic.name) and self._is_said(topic.type):
                    found.setdefault(topic.name, topic)
        nodes = self.nodes.values()
        return {
            name: shaped(topic, [row for node in nodes for row in node.series(topic)])
            for name, topic in found.items()
        }

    def _is_said(self, kind: str) -> bool:
        """Return whether a contract can say a type: one of the package has a file."""
        package, _, name = kind.partition("/")
        return kind != "*" and (package != self.package.name or bool(self._file(f"{name}.msg")))

    def _file(self, name: str) -> str | None:
        return next((path for path in self.package.files if last_part(path) == name), None)

    # --- What a contract says

    def text(self) -> str:
        sections: Entry = {"title": self.package.name}
        nodes = "".join(self._node_text(name, node) for name, node in self.nodes.items())
        self.topics = {name: one for name, one in self.topics.items() if name in self.used}
        sections["messages"] = self._messages()
        sections["topics"] = {name: self._topic(one) for name, one in self.topics.items()}
        sections["services"] = {name: self._service(o) for name, o in self.services.items()}
        parts = [_yaml({key: said}) for key, said in sections.items() if said]
        if self.services:
            parts.append("    # examples: what it is asked, and what it answers\n")
        parts.append(f"nodes:\n{textwrap.indent(nodes, '  ')}")
        if self.launch:
            group = next(iter(self.launch.values())).namespace.strip("/")
            said = {"file": last_part(self.file), **({"group": group} if group else {})}
            parts.append(_yaml({"launch": said}))
        head = f"# What the package {self.package.name} was seen to do, to be edited.\n"
        return head + "".join(parts)

    def _type(self, kind: str) -> str:
        package, _, name = kind.partition("/")
        return f"{PACKAGE}/{name}" if package == self.package.name else kind

    def _topic(self, topic: Topic) -> Entry:
        said: Entry = {"type": self._type(topic.type)}
        if topic.field != Topic.field:
            said["field"] = topic.field
        if topic.text:
            said["text"] = topic.text
        if topic.namespace != Topic.namespace:
            said["namespace"] = topic.namespace
        return said

    def _messages(self) -> dict[str, Entry]:
        """Return the fields of the package's own messages that its topics have."""
        found: dict[str, Entry] = {}
        queue = [topic.type for topic in self.topics.values()]
        for kind in queue:
            package, _, name = kind.partition("[")[0].partition("/")
            if package == self.package.name and name not in found:
                read = genmsg.msg_loader.load_msg_from_string
                found[name] = self._fields(read, f"{name}.msg", kind)[0]
                queue += [str(one) for one in found[name].values()]
        return found

    def _service(self, service: Topic) -> Entry:
        said: Entry = {"type": self._type(service.type)}
        if said["type"] != service.type:
            read = genmsg.msg_loader.load_srv_from_string
            halves = self._fields(read, f"{last_part(service.type)}.srv", service.type)
            said.update(zip(("request", "response"), halves))
        if service.namespace != Topic.namespace:
            said["namespace"] = service.namespace
        return said

    def _fields(self, read: Callable[..., Any], file: str, kind: str) -> list[Entry]:
        """Return field -> type of a message, or of a service's request and response."""
        path = self._file(file)
        assert path, f"{kind} was built, and there is no {file}"
        made = read(genmsg.MsgContext.create_default(), self.package.text(path), kind)
        halves = [made.request, made.response] if file.endswith(".srv") else [made]
        return [dict(zip(half.names, half.types)) for half in halves]

    # --- Of a node

    def _node_text(self, name: str, node: Behaviour) -> str:
        said = {key: value for key, value in self._node(name, node).items() if value}
        body = "".join(f"# {one}\n" for one in self.comments[name]) + _yaml(said)
        bits = [_UINT.fullmatch(one.type) for one in node.publishes]
        if len(bits) == 1 and bits[0]:
            modulus = 2 ** int(bits[0].group(1))
            body = _VALUES.sub(rf"\1  # modulus: {modulus}, if it should wrap around", body)
        return f"{name}:\n{textwrap.indent(body, '  ')}"

    def _node(self, name: str, node: Behaviour) -> Entry:
        publishes = [self.topics[o.name] for o in node.publishes if self._is_known(name, o)]
        silent = [one for one in publishes if not any(run.messages(one) for run in node.runs)]
        publishes = [one for one in publishes if one not in silent]
        if silent:
            names = ", ".join(f"{one.name} ({self._type(one.type)})" for one in silent)
            self.comments[name].append(f"It was sent nothing. It may then publish on {names}.")
        subscribes = [self.topics[o.name] for o in node.subscribes if self._is_known(name, o)]
        said: Entry = {"language": self.case.spec.nodes[node.name].language}
        if not self.launch and node.name not in (name, f"{name}.py"):
            said["executable"] = node.name
        said["anonymous"] = self._is_anonymous(node)
        said["parameters"] = self._parameters(name)
        self.used.update(one.name for one in [*publishes, *subscribes])
        times = None
        if len(publishes) == len(subscribes) == 1:
            times = node.relayed(subscribes[0], publishes[0])
        queues = [self._queue(node, Kind.SUBSCRIBER, topic) for topic in subscribes]
        if times:
            ends = {"from": subscribes[0].name, "to": publishes[0].name}
            said["relays"] = {**ends, **queues[0], "times": times}
        else:
            said["publishes"] = _listed([*self._publishes(node, publishes)])
            said["subscribes"] = _listed(
                [{"topic": one.name, **queue} for one, queue in zip(subscribes, queues)]
            )
        said["offers"] = _listed([one.name for one in node.offers if one.name in self.services])
        said["calls"] = _listed([*self._calls(name, node)])
        said["ends"] = node.ends
        heard = next(iter(subscribes), None) if not times else publishes[0]
        topic = heard or next(iter(publishes), None)
        said["prints"] = node.lines(topic, of_all=topic is heard)
        return said

    def _is_known(self, name: str, topic: Topic) -> bool:
        """Return whether a topic can be said; if not, leave a comment."""
        known = self.topics.get(topic.name)
        if known and (known.type, known.namespace) == (topic.type, topic.namespace):
            return True
        self.comments[name].append(f"No contract can name its topic {topic.name}.")
        return False

    def _publishes(self, node: Behaviour, topics: Sequence[Topic]) -> Iterator[Entry]:
        for topic in topics:
            queue = self._queue(node, Kind.PUBLISHER, topic)
            yield {"topic": topic.name, **queue, **node.role(topic)}

    def _queue(self, node: Behaviour, kind: Kind, topic: Topic) -> Entry:
        """Return the length of a queue, if the sources say it plainly."""
        places = self.case.facts.of(node.name, kind)
        of_topic = [
            place for place in places if last_part(place.text or "").strip("~") == topic.name
        ]
        found = {one.queue for one in of_topic or (places if len(places) == 1 else ())}
        queue = found.pop() if len(found) == 1 else None
        return {"queue": queue} if isinstance(queue, int) and queue > 0 else {}

    def _calls(self, name: str, node: Behaviour) -> Iterator[str]:
        for one in node.calls:
            if one.name in self.services:
                yield one.name
            else:
                self.comments[name].append(
                    f"It calls {one.name}, a service whose type wasn't seen."
                )

    def _parameters(self, name: str) -> Entry:
        """Return the private parameters that the launch file gives a node."""
        started = self.launch.get(name)
        files = [launch for launch in self.case.launches if launch.file == self.file]
        params = files[0].params if started and files else {}
        start = f"{started.path}/" if started else ""
        return {
            key[len(start) :]: value
            for key, value in params.items()
            if key.startswith(start) and isinstance(value, (bool, int, float, str))
        }


def _is_word(name: str) -> bool:
    """Return whether a contract can use a name."""
    return bool(_WORD.fullmatch(name))


def _listed(entries: Sequence[object]) -> object:
    """Return what stands alone without a list around it."""
    return entries[0] if len(entries) == 1 else [*entries]


def _yaml(said: Entry) -> str:
    """Return entries as YAML: what has nothing in it but plain values stands in one line."""
    texts = []
    for key, value in said.items():
        is_long = isinstance(value, list) and len(str(value)) > 60
        flow = False if is_long or not isinstance(value, (dict, list)) else None
        entry = {key: value}
        texts.append(
            yaml.safe_dump(
                entry, default_flow_style=flow, sort_keys=False, width=1000, allow_unicode=True
            )
        )
    return "".join(texts)
