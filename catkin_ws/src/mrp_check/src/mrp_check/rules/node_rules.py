# SPDX-License-Identifier: BSD-3-Clause
"""What the facts of a node's sources prove to be wrong, in both languages."""

from __future__ import annotations

import os
import re

from mrp_check.contract.finding import ERROR, WARNING, Finding
from mrp_check.sources.python_source import GAP


def findings(package, spec, model, launch, facts):
    """Yield findings about each node of the spec whose sources could all be read."""
    started = {node.name: node for node in (launch.nodes if launch else [])}
    for name, node in spec.nodes.items():
        files = facts.sources.get(name)
        if not files or any(file in facts.unread for file in files):
            continue
        one = _Node(package, spec, model, node, started.get(name), facts)
        mistaken = list(one.other_sources())
        yield from mistaken
        if mistaken:
            continue  # whatever else these sources say is said of another node
        yield from one.start()
        yield from one.name()
        yield from one.spin()
        yield from one.queues()
        yield from one.lifetime()
        yield from one.unused()
        yield from one.wrap()


class _Node:
    def __init__(self, package, spec, model, node, started, facts):
        self.package, self.spec, self.model = package, spec, model
        self.node, self.started, self.facts = node, started, facts
        self.files = facts.sources[node.name]
        self.main = self.files[0]
        self.is_python = package.kind(self.main) == "python"

    def places(self, *kinds):
        return self.facts.of(self.node.name, *kinds)

    def finding(self, id_, message, place, **more):
        if not isinstance(place, tuple):
            place = (place.file, place.line)
        more.setdefault("seen", self.package.lines(place[0])[place[1] - 1].strip())
        return Finding(id_, message, *place, node=self.node.name, **more)

    def has_role(self, files, node):
        """Return whether files have what a node of the spec does: publish, or subscribe."""
        kinds = {p.kind for p in self.facts.places if p.file in files}
        needs = set()
        if node.publishing:
            needs.add("publisher")
        if node.subscribing:
            needs.add("subscriber")
        return needs <= kinds

    # E7, and a wrong type="..." in the launch file

    def other_sources(self):
        """Yield a finding if the node is made of another node's sources."""
        names = {p.text for p in self.places("init")}
        others = [n for n in names if n in self.spec.nodes and n != self.node.name]
        if len(names) != 1 or not others:
            return
        other = self.spec.nodes[others[0]]
        if self.has_role(self.files, self.node) and not self._is_called(self.main, other.name):
            return
        executable = self.started.type if self.started else self.node.name
        stem = os.path.splitext(executable)[0]
        target = self.model.executables().get(executable)
        own = self._own_source(other)
        if target is not None and stem != other.name and self._belongs(other):
            yield self.finding(
                "targets",
                f"The target {target.name} is made of {self.main}, which is the source of"
                f" {other.name}: {self.node.name} is then a second {other.name}.",
                (target.file, target.line),
                expected=f"add_executable({target.name} {own or 'ITS OWN SOURCE'})",
                fix=f"Write {own} for {self.main}." if own else "Name its own source.",
            )
        elif (
            self.started is not None
            and self.started.file
            and stem != self.node.name
            and (stem == other.name or self._belongs(other))
        ):
            yield self.finding(
                "launch-nodes",
                f"The launch file starts {executable} under the name {self.node.name}; it is the"
                f" executable of {other.name}.",
                (self.started.file, self.started.line or 1),
                expected=f"the executable of {self.node.name}",
                seen=f'type="{executable}"',
                fix="Name the node's own executable as its type.",
            )

    def _is_called(self, file, name):
        return os.path.splitext(file.rsplit("/", 1)[-1])[0] == name

    def _belongs(self, other):
        """Return whether the main source is another node's: it is called so, or is used so, or the
        other's says that it is this one's."""
        return (
            self._is_called(self.main, other.name)
            or self.facts.sources.get(other.name, [None])[0] == self.main
            or self.node.name in {place.text for place in self.facts.of(other.name, "init")}
        )

    def _own_source(self, other):
        """Return the source that says of itself that it is this node, or None."""
        for place in self.facts.places:
            if place.kind == "init" and place.text == self.node.name:
                return place.file
        spare = [
            path
            for path in self.package.of_kind("cpp")
            if not any(path in files for files in self.facts.sources.values())
        ]
        return next(
            (p for p in spare if self._is_called(p, self.node.name)),
            spare[0] if len(spare) == 1 else None,
        )

    # Starting and ending

    def start(self):
        inits = self.places("init")
        if not inits:
            call = "rospy.init_node(...)" if self.is_python else "ros::init(...)"
            where = [p for p in self.places("function") if p.text == "main"] or self.places(
                "publisher", "subscriber", "timer"
            )
            yield self.finding(
                "node-start",
                f"{self.main} never calls {call}: without it, there is no node.",
                where[0] if where else (self.main, 1),
                expected=f"{call}, with the name {self.node.name}, before all other calls of ROS",
                seen="no such call",
                fix=f'Add rospy.init_node("{self.node.name}").'
                if self.is_python
                else f'Add ros::init(argc, argv, "{self.node.name}"); as the first line of main.',
            )
            return
        for place in self.places("global"):
            if "ros::NodeHandle" in (place.text, *place.values.get("holds", ())):
                yield self.finding(
                    "node-start",
                    f"{place.values.get('name')} is made before main begins, and so before"
                    " ros::init(): a ros::NodeHandle then ends the program.",
                    place,
                    expected="no NodeHandle at file scope",
                    fix="Make it in main, after ros::init().",
                )
        for init in inits:
            early = [
                p
                for p in self.places("handle")
                if p.file == init.file
                and p.values.get("function") == "main"
                and p.values["offset"] < init.values.get("offset", 0)
                and "ros::NodeHandle" in (p.text, *p.values.get("holds", ()))
            ]
            if len(inits) == 1 and early:
                yield self.finding(
                    "node-start",
                    f"{early[0].values.get('name')} is made in line {early[0].line}, before"
                    f" ros::init() in line {init.line}: that ends the program.",
                    early[0],
                    expected="ros::init() before the first ros::NodeHandle",
                    fix="Move ros::init() to the beginning of main.",
                )

    def name(self):
        inits = self.places("init")
        names = {p.text for p in inits}
        if len(inits) != 1 or None in names or GAP in inits[0].text:
            return
        init = inits[0]
        if init.text.lstrip("/") != self.node.name:
            yield self.finding(
                "node-name",
                f"The node gives itself the name {init.text}; expected {self.node.name}. roslaunch"
                " hides it, as the launch file's name wins; rosrun does not.",
                init,
                expected=self.node.name,
                fix=f'Write "{self.node.name}".',
                change=(f'"{init.text}"', f'"{self.node.name}"'),
            )
        elif init.values.get("anonymous") is True:
            yield self.finding(
                "node-name",
                "The node asks for an anonymous name: rosrun starts it under another name each"
                " time.",
                init,
                severity=WARNING,
                expected=self.node.name,
                fix="Leave anonymous out." if self.is_python else "Leave AnonymousName out.",
            )

    def spin(self):
        waits = self.places("loop", "sleep")
        spins = self.places("spin")
        if spins and {place.text for place in spins} == {"spinOnce"}:
            if not waits:
                yield self.finding(
                    "spin",
                    "ros::spinOnce() calls the callbacks of what has arrived, and returns at once:"
                    " the program then comes to its end.",
                    spins[0],
                    expected="ros::spin() at the end of main",
                    fix="Write ros::spin() for ros::spinOnce().",
                    change=("spinOnce", "spin"),
                )
            return
        if spins:
            yield from self._made_too_late(spins)
            return
        called_back = self.places("subscriber") + (
            []
            if self.is_python
            else [
                p
                for p in self.places("timer")
                if p.values.get("oneshot") is not True and not self._is_rate(p)
            ]
        )
        if self.is_python and waits or not self.is_python and waits and not called_back:
            return
        if not called_back and not self.places("timer", "publisher"):
            return
        call = "rospy.spin()" if self.is_python else "ros::spin()"
        yield self.finding(
            "spin",
            f"{self.main} never calls {call}: "
            + (
                "the program loops, and no callback is ever called."
                if waits
                else "the program comes to its end at once."
            ),
            self.facts.end_of_main(self.node.name) or (self.main, self._last_line()),
            expected=f"{call} at the end of main",
            seen="no such call",
            fix=f"Add {call}{'' if self.is_python else ';'} at the end of main.",
        )

    def _last_line(self):
        """Return the last line of the main source in which something stands."""
        lines = self.package.lines(self.main)
        return max((n for n, text in enumerate(lines, 1) if text.strip()), default=1)

    def _made_too_late(self, spins):
        """Yield a finding if the node's parts are made below a spin() of the same function."""
        classes = {
            name
            for file in self.files
            for line in self.package.lines(file)
            for name in re.findall(r"^\s*(?:class|struct) (\w+)", line)
        }
        for spin in spins:
            ends = [f.values["end"] for f in self.places("function") if f.is_around(spin)]
            if spin.text not in (None, "spin", "waitForShutdown") or not ends:
                continue
            made = {p.line for p in self.places("publisher", "subscriber") if p.file == spin.file}
            for number in range(spin.line + 1, min(ends) + 1):
                line = self.package.lines(spin.file)[number - 1]
                if number in made or classes & set(re.findall(r"\w+", line)):
                    call = "rospy.spin()" if self.is_python else "ros::spin()"
                    yield self.finding(
                        "spin",
                        f"{call} returns only when the node is to end: what stands below it, in"
                        f" line {number}, is made too late.",
                        spin,
                        expected=f"{call} below all that the node is made of",
                        fix=f"Move it below line {number}.",
                    )
                    return

    def _is_rate(self, place):
        return "Rate" in self.package.lines(place.file)[place.line - 1]

    # Topics

    def _on(self, kind, topic):
        """Return the places of a kind that are about the topic, or may be."""
        return [
            p
            for p in self.places(kind)
            if topic and (p.text is None or p.text.strip("~/").split("/")[-1] == topic.name)
        ]

    def queues(self):
        """Each queue is as long as the contract says, as far as the source says it plainly."""
        node = self.node
        for kind, topic, role in (
            ("subscriber", node.subscribing, node.subscribes or node.relays),
            ("publisher", node.publishing, node.publishes or node.relays),
        ):
            asked = role and role.queue
            for place in self._on(kind, topic) if asked else ():
                queue = place.values.get("queue")
                if isinstance(queue, int) and queue is not True and queue != asked:
                    yield self._other_queue(place, kind, queue, asked)
                elif self.is_python and kind == "publisher" and self._says_none(place):
                    yield self.finding(
                        "queue",
                        "rospy.Publisher() is given no queue_size: it then sends each message"
                        " before it returns, and warns of it.",
                        place,
                        severity=WARNING,
                        expected=f"queue_size={asked}",
                        fix=f"Add queue_size={asked}.",
                    )

    def _other_queue(self, place, kind, queue, asked):
        why = {
            (True, "subscriber", 0): "rospy.Subscriber() takes no queue_size of 0: it raises an"
            " error.",
            (True, "subscriber", 1): "The subscriber's queue has room for one message. In rospy"
            " each publisher has a queue of its own; a callback that is late loses messages all"
            " the same.",
            (False, "subscriber", 1): "The subscriber's queue has room for one message. All"
            " publishers of the topic share it: two that publish at the same moment push out each"
            " other's values.",
        }
        rooms = f"has room for {queue} messages" if queue else "has no limit"
        return self.finding(
            "queue",
            why.get((self.is_python, kind, queue))
            or f"The {kind}'s queue {rooms}; the contract asks for {asked}.",
            (place.file, place.values.get("queue_line", place.line)),
            # A longer one loses nothing, and one that is little shorter hardly ever.
            severity=ERROR if queue == 1 or (self.is_python, kind, queue) in why else WARNING,
            expected=f"queue_size={asked}" if self.is_python else f"a queue of {asked}",
            fix=f"Write {asked} for {queue}.",
            change=(f"queue_size={queue}", f"queue_size={asked}")
            if self.is_python
            else (f", {queue}", f", {asked}"),
        )

    def _says_none(self, place):
        """Return whether a call that begins in a line has no queue_size in its lines."""
        lines = self.package.lines(place.file)[place.line - 1 : place.line + 6]
        text, depth = "", 0
        for line in lines:
            text += line + "\n"
            depth += line.count("(") - line.count(")")
            if depth <= 0:
                break
        if "queue" in place.values:
            return False
        return "queue_size" not in text and "**" not in text and text.count(",") < 6

    def lifetime(self):
        """roscpp: what is not kept ends. (rospy keeps it.)"""
        topics = {"subscribe": self.node.subscribing, "advertise": self.node.publishing}
        kinds = {"subscribe": "subscriber", "advertise": "publisher"}
        for place in self.places("discarded", "local"):
            call = place.text
            if call in kinds:
                same = [
                    p
                    for p in self._on(kinds[call], topics[call])
                    if p.file == place.file and p.line == place.line
                ]
                if not same:
                    continue
            what = {"subscribe": "subscriber", "advertise": "publisher"}.get(call, "timer")
            if place.kind == "discarded":
                how = "is kept nowhere: it ends with this very line"
            else:
                how = (
                    f"is kept in {place.values['name']}, a variable of"
                    f" {place.values['function']}(): it ends when that returns"
                )
            yield self.finding(
                "lifetime",
                f"The {what} that {call}() makes {how}.",
                place,
                expected=f"a {what} that lives as long as the node, such as a member of the class",
                fix=f"Keep it as a member: {what}_ = ...{call}(...);",
            )

    def unused(self):
        """A function that publishes, or makes a topic, and that nobody ever calls."""
        said = set()
        for kind, id_, does in (
            ("init", "node-start", "starts the node"),
            ("publisher", "topic", "makes the publisher"),
            ("subscriber", "topic", "makes the subscriber"),
            ("publish", "callbacks", "publishes"),
        ):
            places = self.places(kind)
            functions = {id(p): self._unused_around(p) for p in places}
            if not places or not all(functions.values()):
                continue
            function = functions[id(places[0])]
            if (function.file, function.line) in said:
                continue
            said.add((function.file, function.line))
            timer = " A timer has to be given it as its callback." if kind == "publish" else ""
            yield self.finding(
                id_,
                f"{function.text} {does}, and nobody ever calls or uses it.{timer}",
                function,
                expected=f"a place where {function.text} is used",
                fix=f"Call {function.text}, or hand it over as a callback.",
            )

    def _unused_around(self, place):
        around = [
            f for f in self.places("function") if f.is_around(place) and f.values.get("unused")
        ]
        return around[0] if around else None

    def wrap(self):
        """The counter's type in C++, and where it begins anew, against the largest value."""
        values = self.node.publishes.values if self.node.publishes else None
        if self.is_python or values is None or not values.modulus:
            return
        used = {name for p in self.places("data") for name in p.values.get("names", ())}
        yield from self._resets(used, values)
        said = set()
        for place in self.places("step"):
            kind, bits = place.values.get("type", ""), place.values.get("bits", 0)
            if place.text not in used or place.text in said or bits <= 0:
                continue
            floating = kind in ("float", "double")
            enough = bits - (0 if "unsigned" in kind else 1)
            if not floating and 2**enough >= values.modulus:
                continue
            said.add(place.text)
            if floating or bits < 32:
                largest = f"2^{24 if kind == 'float' else 53}" if floating else f"{2**enough - 1}"
                yield self.finding(
                    "wrap",
                    f"The counter {place.text} is a {kind}: "
                    + (
                        f"past {largest} it no longer counts in whole steps, and it never wraps"
                        " round."
                        if floating
                        else f"after {largest} it begins again, and the message could hold up to"
                        f" {values.modulus - 1}."
                    ),
                    self._declared(place),
                    expected="uint32_t",
                    fix=f"Make {place.text} a uint32_t.",
                )
            else:
                yield self.finding(
                    "wrap",
                    f"The counter {place.text} is a {kind}: what happens past {2**enough - 1} is"
                    " undefined in C++.",
                    self._declared(place),
                    severity=WARNING,
                    expected="uint32_t",
                    fix=f"Make {place.text} a uint32_t.",
                )

    def _resets(self, used, values):
        for place in self.places("reset"):
            limit, value = place.values["limit"], place.values["value"]
            # Within the last two steps of the range whoever begins anew does no harm.
            if place.text in used and limit < values.modulus - 2 * abs(values.step):
                yield self.finding(
                    "wrap",
                    f"The counter {place.text} begins again at {value} when it comes to {limit};"
                    f" the message could hold up to {values.modulus - 1}.",
                    place,
                    expected=f"the next value up to {values.modulus - 1}",
                    fix="Take the limit away: a uint32_t begins again at 0 by itself.",
                )

    def _declared(self, place):
        same = [p for p in self.places("counter") if p.text == place.text]
        return same[0] if same else place
