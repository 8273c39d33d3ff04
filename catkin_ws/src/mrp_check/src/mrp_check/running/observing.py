# SPDX-License-Identifier: BSD-3-Clause
"""Runs the package's nodes, twice at the same time, and keeps what was seen for run and stop.

Once as its launch file starts them; and once each by itself, as rosrun does, in a namespace of its
own: there each subscriber is sent values, each Python publisher is run again near the end of its
numbers, and each is ended by the contract's signal.
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import shlex
import signal
import tempfile
import threading
import xml.sax.saxutils

from mrp_check import confine
from mrp_check.building import catkin
from mrp_check.confined import messages
from mrp_check.contract import spec as specs
from mrp_check.contract.errors import CannotCheck
from mrp_check.student import launch as launching

ENOUGH = 8  # messages of each publisher
BURST = tuple(range(21, 29))  # what each subscriber is sent at once: fewer than its queue holds
PACED = (2, 3, 33, 34)  # and then one by one, small ones too
DEFAULT_PERIOD = 0.5  # seconds, where the contract names none
SPARE_SECONDS = 60  # that one run may take besides
MOST_SEEN = 64 * 2**20  # bytes of a run's result
WRAP = "wrap:"  # before the name of a Python publisher that runs near the end of its numbers

_PACKAGE = pathlib.Path(__file__).resolve().parents[1]
# Prints the environment that these files make, as far as there are any.
_SOURCED = (
    'for file in "$@"; do [ ! -f "$file" ] || source "$file" -- || true; done; '
    "printf '\\0'; exec env -0"
)


@dataclasses.dataclass
class Observed:
    """What was seen.

    launch: the result of the plan `launch` of session.py, or None if it could not be had
    direct: the same of the plan `direct`
    started: node of the spec -> what of the launch file starts it (a launching.Started)
    own_launch: whether the launch file is the package's, not one made from the spec
    executables: node of the spec -> path of its executable
    moved: what roslaunch makes of the launch file inside another group, or None
    problems: sentences on what could not be observed, and why
    """

    launch: dict | None = None
    direct: dict | None = None
    started: dict = dataclasses.field(default_factory=dict)
    own_launch: bool = False
    executables: dict = dataclasses.field(default_factory=dict)
    moved: launching.Launch | None = None
    problems: list = dataclasses.field(default_factory=list)

    def alone(self, key):
        """Return what was seen of a node of the plan `direct`, or None."""
        return self.direct["nodes"].get(key) if self.direct else None


def observe(case):
    """Return the Observed of a case.Case; runs the nodes."""
    return _Run(case).observe()


class _Run:
    def __init__(self, case):
        self.package, self.spec, self.workspace = case.package, case.spec, case
        self.executables = _executables(case)  # by now there is what was built
        self.result = Observed()
        self.launch_file = None
        self.too_busy, self.fault = False, ""

    def observe(self):
        self.read_launch_file()
        self.find_executables()
        if not self.result.executables:
            self.result.problems.append("none of the nodes has an executable to be run")
            return self.result
        self.workspace.progress("running the nodes")
        self.folders = {kind: self.node_folder() for kind in ("launch", "direct")}
        self.environment = self.read_environment()
        plans = {"launch": self.launch_plan(), "direct": self.direct_plan()}
        threads = [threading.Thread(target=self.run_session, args=pair) for pair in plans.items()]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        launch = self.result.launch
        if self.fault:
            raise CannotCheck(f"The observer itself failed: {self.fault}. Please report it.")
        if self.too_busy or launch and launch["ending"] == "most":
            # Not the package's fault: one that never comes up is idle, or uses up its time.
            raise CannotCheck(
                f"The nodes did not come up within {plans['launch']['most']:.0f} s, though they"
                " were at work: this machine is too busy. Try again with less at the same time."
            )
        return self.result

    # --- What there is to run

    def read_launch_file(self):
        self.launch = launch = self.workspace.launch
        of_spec = [n for n in launch.nodes if n.name in self.spec.nodes] if launch else []
        if of_spec and not launch.error:
            self.result.own_launch = True
            self.launch_file = self.workspace.package_folder / launch.file
            self.result.started = {node.name: node for node in of_spec}
            self.result.moved = self.read_moved(launch.file)

    def read_moved(self, file):
        """Return what roslaunch makes of the launch file inside another group."""
        path = self.workspace.given / "moved.launch"
        included = xml.sax.saxutils.quoteattr(str(self.workspace.package_folder / file))
        path.write_text(
            f'<launch><group ns="check_moved"><include file={included}/></group></launch>\n'
        )
        moved = launching.load(self.package, self.workspace, str(path))
        return None if moved.error else moved

    def find_executables(self):
        for name, node in self.spec.nodes.items():
            started = self.result.started.get(name)
            wanted = []
            if started and started.package == self.package.name:
                wanted.append(started.type)
            if node.executable:
                wanted.append(node.executable)
            files = self.workspace.facts.sources.get(name, [])
            wanted += [file.rsplit("/", 1)[-1] for file in files if file.endswith(".py")]
            wanted += [name, name + ".py"]
            found = next((self.executable(w) for w in wanted if self.executable(w)), None)
            if found:
                self.result.executables[name] = found

    def executable(self, name):
        """Return the path of an executable as rosrun finds it, or None."""
        path = self.executables.get(name)
        if path is None:
            path = self.workspace.folder / "devel" / "lib" / self.package.name / name
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return pathlib.Path(path)
        for path in sorted(self.workspace.package_folder.rglob(name)):
            if path.is_file() and os.access(path, os.X_OK):
                return path
        return None

    # --- Plans

    @property
    def period(self):
        periods = [n.publishes.period for n in self.spec.nodes.values() if n.publishes]
        return max([p for p in periods if p] or [DEFAULT_PERIOD])

    def silence(self):
        return max(12 * self.period, 6)

    def launch_plan(self):
        if not self.launch_file:
            self.launch_file = self.make_launch_file()
        senders = {}
        for name in self.result.executables:
            node = self.spec.nodes[name]
            if node.publishing:
                senders[node.publishing.name] = senders.get(node.publishing.name, 0) + 1
        nodes = {}
        for name, node in self.spec.nodes.items():
            started = self.result.started.get(name)
            if name not in self.result.executables or self.result.own_launch and not started:
                continue
            path = started.path if started else self.spec.node_path(name)
            hears = node.subscribing and resolved(node.subscribing, path)
            nodes[name] = {
                "path": path,
                "type": f"{started.package}/{started.type}" if started else None,
                "publishes": node.publishing is not None,
                "received": received_pattern(node),
                "hears": hears,
                "senders": senders.get(node.subscribing.name, 0) if node.subscribing else 0,
            }
        return {
            "kind": "launch",
            "command": ["roslaunch", str(self.launch_file)],
            "nodes": nodes,
            "enough": ENOUGH,
            "silence": self.silence(),
            "seconds": max(20, 3 * ENOUGH * self.period),
            "most": max(self.workspace.timeout, 60),
            "stop_seconds": self.spec.shutdown.seconds + 8,
        }

    def make_launch_file(self):
        """Write the launch file that the spec asks for; return its path."""
        lines = []
        for name, path in self.result.executables.items():
            attributes = {"pkg": self.package.name, "type": path.name, "name": name}
            text = " ".join(f"{k}={xml.sax.saxutils.quoteattr(v)}" for k, v in attributes.items())
            lines.append(f'    <node {text} output="screen"/>')
        group = self.spec.launch.group
        if group:
            lines = [f'  <group ns="{group}">', *lines, "  </group>"]
        path = self.workspace.given / "of_spec.launch"
        path.write_text("\n".join(["<launch>", *lines, "</launch>", ""]))
        return path

    def direct_plan(self):
        nodes = {}
        for index, (name, path) in enumerate(self.result.executables.items()):
            node = self.spec.nodes[name]
            nodes[name] = self.direct_node(name, path, f"/check_{index}")
            rule = node.publishes.values if node.publishes else None
            if rule and rule.modulus and is_python(path):
                wrap = self.direct_node(WRAP + name, path, f"/check_wrap_{index}")
                rule = {"field": node.publishing.field, **dataclasses.asdict(rule)}
                wrap["env"]["MRP_CHECK_WRAP"] = json.dumps(rule)
                wrap.update(wrap=True, publishes=0, values=[], paced=[])
                nodes[WRAP + name] = wrap
        return {
            "kind": "direct",
            "nodes": nodes,
            "signal": getattr(signal, self.spec.shutdown.signal),
            "silence": self.silence(),
            "seconds": max(20, 3 * ENOUGH * self.period),
            "most": max(self.workspace.timeout, 60),
            "stop_seconds": self.spec.shutdown.seconds,
        }

    def direct_node(self, key, path, namespace):
        name = key[len(WRAP) :] if key.startswith(WRAP) else key
        node = self.spec.nodes[name]
        started = self.result.started.get(name)
        arguments, env, params = [], {}, {}
        if started:
            # The node's own namespace and that of its group move; what is elsewhere stays.
            params = {
                self.moved(param, started.namespace, namespace): value
                for param, value in self.launch.params.items()
            }
            arguments = shlex.split(started.arguments) if started.arguments else []
            arguments += [f"{source}:={target}" for source, target in started.remaps]
            env = {k: v for k, v in started.env}
        if is_python(path):
            events = self.folders["direct"] / f"events_{namespace[1:]}"
            env.update(
                MRP_CHECK_HOOK=str(events),
                MRP_CHECK_HOOK_PATH=str(confine.code() / "hook"),
                MRP_CHECK_SOURCES=str(self.workspace.package_folder),
            )
        field = node.subscribing.field if node.subscribing else None
        return {
            "command": [str(path), *arguments],
            "namespace": namespace,
            "env": env,
            "params": params,
            "publishes": 3 if node.publishes else len(BURST + PACED) if node.relays else 0,
            "values": list(BURST) if node.subscribing else [],
            "paced": list(PACED) if node.subscribing else [],
            "field": field,
            "type": node.subscribing.type_in(self.package.name) if node.subscribing else None,
            "received": received_pattern(node),
            "wrap": False,
        }

    @staticmethod
    def moved(name, old, new):
        old = old.rstrip("/") + "/"
        return new + "/" + name[len(old) :] if name.startswith(old) else name

    # --- Running

    def node_folder(self):
        """Make a folder that the nodes of one run may write to."""
        return pathlib.Path(tempfile.mkdtemp(prefix="nodes_", dir=self.workspace.folder))

    def read_environment(self):
        """Return the environment that the workspace's setup.bash makes, as far as there is one."""
        setups = [catkin.NOETIC, self.workspace.folder / "devel" / "setup.bash"]
        done = self.workspace.catkin.run("bash", "-c", _SOURCED, "bash", *setups)
        pairs = (entry.split("=", 1) for entry in done.output.split("\0") if "=" in entry)
        packages = launching.package_path(self.workspace)
        env = {"ROS_PACKAGE_PATH": packages, "PYTHONPATH": "", **dict(pairs)}
        # Each line at once, also into a pipe. Whether the launch file does so is another question.
        return {**env, "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1", "PYTHONUNBUFFERED": "1"}

    def message_folders(self):
        files = self.package.of_kind("message")
        return sorted({(self.package.root / file).parent for file in files})

    def run_session(self, kind, plan):
        folder = self.folders[kind]
        plan = {
            **plan,
            "environment": {**self.environment, **confine.folders(folder)},
            "writable": [str(folder)],
            "messages": messages.definitions(self.package.name, self.message_folders()),
        }
        command = ["/usr/bin/python3", "-m", "mrp_check.confined.session", json.dumps(plan)]
        limits = confine.Limits(
            time=plan["most"] + plan["stop_seconds"] + SPARE_SECONDS, output=MOST_SEEN
        )
        try:
            done = confine.run(
                catkin.sourced(command),
                self.workspace.folder,
                limits=limits,
                env=confine.environment(
                    folder, PYTHONPATH=str(_PACKAGE.parent), PATH=catkin.search_path()
                ),
                readable=[self.workspace.given],
                observes=True,
            )
        except confine.ConfineError as error:
            self.result.problems.append(f"{error}")
            return
        if done.ended_by == "time":
            self.too_busy = True
        elif done.code == 0:
            setattr(self.result, kind, json.loads(done.output))
        else:
            said = (done.errors.strip().splitlines() or [f"it ended with {done.code}"])[-1]
            why = done.limit_text(limits) or said
            if why is said and "Traceback" in done.errors:
                self.fault = said
            self.result.problems.append(f"the nodes could not be observed: {why}")


def _executables(case):
    """Return name -> path of what roslaunch can start: built executables, and scripts."""
    found = {}
    for path in case.package.of_kind("python"):
        if case.package.is_executable(path):
            found[path.rsplit("/", 1)[-1]] = case.package_folder / path
    folder = case.folder / "devel" / "lib" / case.package.name
    for path in sorted(folder.glob("*")) if folder.is_dir() else ():
        if path.is_file() and os.access(path, os.X_OK):
            found[path.name] = path
    return found


def is_python(path):
    """Return whether an executable is a Python script, by its first line."""
    with open(path, "rb") as file:
        first = file.readline(200)
    return first.startswith(b"#!") and b"python" in first


def resolved(topic, path):
    """Return the full name of a spec's topic, for a node of that full name."""
    group = path.rsplit("/", 1)[0]
    start = {"global": "/", "private": path + "/", "group": group + "/"}[topic.namespace]
    return start + topic.name


def received_pattern(node):
    """Return the regular expression of the line that a node prints on receiving, or None."""
    for line in node.prints:
        if "{value}" in line:
            return specs.pattern(line).pattern
    return None
