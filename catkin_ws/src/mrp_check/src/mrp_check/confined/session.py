# SPDX-License-Identifier: BSD-3-Clause
"""Runs a package's nodes under observation, and prints what was seen. Runs confined.

Usage: python3 -m mrp_check.confined.session PLAN    (JSON, as the result is)

The nodes run apart from it, as apart.py says. Nothing of the package is run, read or imported here:
it hears of the nodes through ROS, their output and /proc.

There are two kinds of plan. Both have:
    environment  of the nodes, and of roslaunch
    writable     the folders that these may write to
    messages     what messages.definitions() says of the package's own

launch: the nodes are started by a launch file, and ended by Ctrl-C to roslaunch.
    command    of roslaunch
    nodes      {node of the spec: {path: full name, type: package/executable, publishes: bool,
               received: regex or null, hears: topic or null,
               senders: number of publishers that it hears}}
    enough     messages of each publisher, and of each publisher at each subscriber
    silence    seconds without a message after which no more is waited for
    seconds    that it may take to see enough, once all nodes are up
    most       that it may take in all
    stop_seconds  that ending may take

direct: each node is started by itself, in a namespace of its own, as rosrun would; each subscriber
is sent messages; then each is sent the signal.
    nodes      {key: {command, namespace, env, params, publishes, field, type,
               received, values (sent at once), paced (sent one by one), wrap}}
    signal, silence, seconds, most, stop_seconds
"""

import ctypes
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

import psutil
import rospy

from mrp_check.confined import apart, messages, warden, written
from mrp_check.confined.observe import Observer

_ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")
_DIED = re.compile(r"\[(?P<name>\S+)-\d+\] process has (?P<how>died|finished cleanly)")
_STARTED = re.compile(r"process\[(?P<name>\S+)-\d+\]: started with pid \[(?P<pid>\d+)\]")
_NOT_STARTED = re.compile(r"cannot launch node of type \[(?P<type>[^\]]*)\]")
_NOT_EXECUTED = re.compile(r"(bwrap: execvp|setpriv: failed to execute) ")
_LINES = 5000  # that are kept of a program's output
# Of what hook/sitecustomize.py writes; the node could write there, too.
_EVENT = {"event": str, "file": (str, type(None)), "line": (int, type(None))}
# A node that has not registered is waited for as long as it does something, whatever the load.
_IDLE = 3.0  # seconds in which an idle process uses hardly any processor time, ...
_HARDLY = 0.05  # ... which is less than this many seconds
_BUSY = 20.0  # seconds of processor time: it is no longer starting up, or ending
_ENDING = 90.0  # seconds after which not even a busy node is waited for
_PACE = 1.0  # seconds after which the next value is sent, though the last one was not logged
_TICK = 0.02


class Program:
    """A running program whose lines are collected as they come.

    pid: the program's own, or None if it has ended already
    lines: (time, stream, text), with stream "out" or "err"
    """

    def __init__(self, starter, command, env, writable, merge=False):
        self.lines = []
        self.line_count = 0
        self.started = time.monotonic()
        self.ended = None
        self._popen, self.init = starter.start(
            command,
            writable,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if merge else subprocess.PIPE,
            env=env,
            cwd=writable[0],
            start_new_session=True,
        )
        self._in_sandbox = starter.in_sandbox
        if self._in_sandbox:
            self.pid = self.init and apart.started_in(self.init)
        else:
            self.pid = self._popen.pid
        streams = [("out", self._popen.stdout), ("err", self._popen.stderr)]
        self._readers = [
            threading.Thread(target=self._read, args=stream, daemon=True)
            for stream in streams
            if stream[1]
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, name, stream):
        while True:
            data = stream.readline(4096)
            if not data:
                return
            self.line_count += 1
            if len(self.lines) < _LINES:
                text = _ESCAPES.sub("", data.decode("utf-8", "replace")).rstrip("\r\n")
                self.lines.append((time.monotonic(), name, text))

    def poll(self):
        """Return the exit code, or None while it runs."""
        code = apart.exit_code(self._popen, self._in_sandbox)
        if code is not None and self.ended is None:
            self.ended = time.monotonic()
        return code

    def send(self, number):
        if self.pid and self._popen.poll() is None:
            _send(self.pid, number)

    def kill(self):
        if self.init:
            _send(self.init.pid, signal.SIGKILL)  # and with it all that is in its sandbox
        try:
            os.killpg(self._popen.pid, signal.SIGKILL)
        except OSError:
            pass
        self._popen.wait()

    def owns(self, process):
        """Return whether a process comes from this program, as far as that can still be seen."""
        try:
            if self.init:
                return self.init in process.parents()
            return os.getsid(process.pid) == self._popen.pid
        except (OSError, psutil.Error):
            return False

    def was_executed(self):
        """Return whether the system could execute it: it may lack the right first line."""
        return not any(_NOT_EXECUTED.match(text) for _, _, text in self.lines[:1])

    def read_rest(self):
        """Wait until all output is read; not for ever, a child may keep the pipe open."""
        for reader in self._readers:
            reader.join(1)

    def result(self):
        return {
            "code": self.poll(),
            "line_count": self.line_count,
            "lines": [(t - self.started, stream, text) for t, stream, text in list(self.lines)],
        }


def seen_by(observer, began):
    """Return what an observer has seen, for JSON; times from the beginning on."""

    def records(items):
        return [{**item._asdict(), "time": item.time - began} for item in list(items)]

    return {
        "publications": records(observer.publications),
        "subscriptions": records(observer.subscriptions),
        "messages": records(observer.messages),
        "logs": records(observer.logs),
        "lag": observer.lag(),
    }


def _send(pid, number):
    try:
        os.kill(pid, number)
    except OSError:
        pass  # it has ended meanwhile


def left_behind(programs):
    """Return the processes that have come of these programs and are still there, and kill them.

    programs: key -> Program; what is found has the key of its program, if that can be told
    """
    makers = {program.init.pid for program in programs.values() if program.init}
    left = [process for process in warden.descendants() if process.pid not in makers]
    found = [
        {
            "pid": process.pid,
            "command": warden.command_of(process),
            "node": next((key for key, one in programs.items() if one.owns(process)), None),
        }
        for process in left
    ]
    for pid in [process.pid for process in left] + list(makers):
        _send(pid, signal.SIGKILL)
    return found


class Activity:
    """When something last came from each node, or was done by its process."""

    def __init__(self, observer):
        self.observer = observer
        self._used = {}

    def is_up_or_stuck(self, node, pid):
        """Return whether a node has registered, or is not going to: its process is gone, does
        nothing, or has worked for too long."""
        if node is not None and self.last(node) is not None:
            return True
        if pid is None:
            return False
        used = _processor_seconds(pid)
        return used is None or used > _BUSY or self.is_idle(pid)

    def is_idle(self, pid):
        """Return whether a process has used hardly any processor time for a while.

        On a busy machine, one that wants to work gets little, but more than that."""
        used, now = _processor_seconds(pid), time.monotonic()
        if used is None:
            return True
        history = self._used.setdefault(pid, [])
        history.append((now, used))
        # The latest that is old enough to be compared with, and all that came after it.
        while len(history) > 1 and history[1][0] <= now - _IDLE:
            del history[0]
        then, before = history[0]
        return now - then >= _IDLE and used - before < _HARDLY

    def last(self, node):
        of_node = [m.time for m in self.observer.messages[-400:] if m.node == node]
        of_node += [log.time for log in self.observer.logs[-400:] if log.node == node]
        of_node += [r.time for r in self.observer.publications if r.node == node]
        of_node += [r.time for r in self.observer.subscriptions if r.node == node]
        return max(of_node, default=None)


def _processor_seconds(pid):
    """Return the processor time that a process has used, or None if it is no more."""
    try:
        times = psutil.Process(pid).cpu_times()
    except psutil.Error:
        return None
    return times.user + times.system


# --- launch


def run_launch(plan, observer, starter):
    env = {**plan["environment"], "ROS_MASTER_URI": observer.uri}
    roslaunch = Program(starter, plan["command"], env, plan["writable"], merge=True)
    ending, all_up = None, None
    activity = Activity(observer)
    while ending is None:
        time.sleep(_TICK)
        now = time.monotonic()
        if all_up is None and all(
            _is_up(node, roslaunch, activity) for node in plan["nodes"].values()
        ):
            all_up = now
        if roslaunch.poll() is not None:
            ending = "itself"
        elif now - (all_up or now) > plan["seconds"]:
            ending = "time"
        elif now - roslaunch.started > plan["most"]:
            ending = "most"
        elif all(
            _is_settled(plan, node, roslaunch, observer, activity)
            for node in plan["nodes"].values()
        ):
            ending = "enough"
    registered = {name for name in observer.nodes() if observer.is_registered(name)}
    latched = {
        topic: [name for name in registered if observer.is_latched(name, topic)]
        for topic in {p.topic for p in observer.publications} - {"/rosout"}
    }
    asked = time.monotonic()
    roslaunch.send(signal.SIGINT)
    while roslaunch.poll() is None and time.monotonic() - asked < plan["stop_seconds"]:
        time.sleep(_TICK)
    ended_on_signal = roslaunch.poll() is not None
    seconds = time.monotonic() - asked
    if not ended_on_signal:
        roslaunch.kill()
    left = left_behind({None: roslaunch})
    roslaunch.read_rest()
    return {
        **roslaunch.result(),
        "ending": ending,
        "asked": asked - roslaunch.started,
        "stopped_in": seconds if ended_on_signal else None,
        "left": left,
        "latched": latched,
        "registered": sorted(registered),
        "still_registered": sorted(n for n in registered if observer.is_registered(n)),
        "seen": seen_by(observer, roslaunch.started),
    }


def _is_settled(plan, node, roslaunch, observer, activity):
    """Return whether no more has to be waited for from a node."""
    now, path = time.monotonic(), node["path"]
    last = activity.last(path)
    if _has_died(roslaunch, node):
        return True
    if last is None:
        return _is_up(node, roslaunch, activity)
    pid = _pid_of(roslaunch, path)
    if now - last > plan["silence"] and (pid is None or activity.is_idle(pid)):
        return True
    if node["publishes"]:
        counts = [n for (name, _), n in list(observer.counts.items()) if name == path]
        if max(counts, default=0) < plan["enough"]:
            return False
    # It may be that nobody sends it anything.
    if node["hears"] and not any(one.node == path for one in list(observer.subscriptions)):
        return False
    if node["received"]:
        pattern = re.compile(node["received"])
        lines = [
            log for log in list(observer.logs) if log.node == path and pattern.search(log.text)
        ]
        enough = plan["enough"] * node["senders"]
        # One who logs other lines is waited for until there was twice as much to be heard.
        sent = sum(n for (_, topic), n in list(observer.counts.items()) if topic == node["hears"])
        if len(lines) < enough and sent < 2 * enough:
            return False
    return True


def _is_up(node, roslaunch, activity):
    if _has_died(roslaunch, node):
        return True
    return activity.is_up_or_stuck(node["path"], _pid_of(roslaunch, node["path"]))


def _pid_of(roslaunch, path):
    """Return the process id that roslaunch has told of a node, or None."""
    for _, _, text in list(roslaunch.lines):
        found = _STARTED.search(text)
        if found and "/" + found["name"] == path:
            init = roslaunch.init
            return apart.id_outside(init, found["pid"]) if init else int(found["pid"])
    return None


def _has_died(roslaunch, node):
    for _, _, text in list(roslaunch.lines):
        died, not_started = _DIED.search(text), _NOT_STARTED.search(text)
        if died and "/" + died["name"] == node["path"]:
            return True
        if not_started and not_started["type"] == node["type"]:
            return True
    return False


# --- direct


class Direct:
    """One node, started by itself."""

    def __init__(self, key, plan, session, observer, starter):
        self.key, self.plan, self.observer = key, plan, observer
        self.messages = session["messages"]
        self.sent, self.sent_at, self.publisher = [], 0.0, None
        for name, value in plan["params"].items():
            rospy.set_param(name, value)
        env = {**session["environment"], **plan["env"], "ROS_NAMESPACE": plan["namespace"]}
        env["ROS_MASTER_URI"] = observer.uri
        self.events_file = env.get("MRP_CHECK_HOOK")
        if self.events_file:
            env["PYTHONPATH"] = env.pop("MRP_CHECK_HOOK_PATH") + ":" + env["PYTHONPATH"]
        self.program = Program(starter, plan["command"], env, session["writable"])

    def name(self):
        """Return the node's own name, or None as long as it has not registered."""
        inside = self.plan["namespace"] + "/"
        names = [r.node for r in self.observer.publications + self.observer.subscriptions]
        return next((name for name in names if name.startswith(inside)), None)

    def send(self):
        """Send the plan's values, once, as soon as the node has subscribed."""
        if self.sent or not self.plan["values"] or self.name() is None:
            return
        own = [s for s in self.observer.subscriptions if s.node == self.name()]
        topics = [s for s in own if s.topic not in ("/clock", "/tf", "/tf_static")]
        # Of several, the one of the contract's type first.
        topics.sort(key=lambda s: s.type != self.plan["type"])
        if not topics:
            return
        if self.publisher is None:
            kind = topics[0].type if topics[0].type != "*" else self.plan["type"]
            message_class = messages.of_type(kind, self.messages)
            if message_class is None:
                self.sent = [None]
                return
            self.message_class = message_class
            self.publisher = self.observer.publisher(topics[0].topic, message_class)
        if self.publisher.get_num_connections() == 0:
            return
        for value in self.plan["values"]:
            self.send_one(value)

    def send_one(self, value):
        message = self.message_class()
        try:
            _set_field(message, self.plan["field"], value)
            self.publisher.publish(message)
        except Exception:  # another type than the contract's
            pass
        self.sent.append(value)
        self.sent_at = time.monotonic()

    def send_paced(self):
        """Send the values that come one by one: each when the one before was logged, or did not
        come for a while."""
        pending = self.plan["paced"][max(len(self.sent) - len(self.plan["values"]), 0) :]
        if self.publisher is None or not self.sent or not pending:
            return
        if self.has_logged(self.sent[-1]) or time.monotonic() - self.sent_at > _PACE:
            self.send_one(pending[0])

    def has_logged(self, value):
        number = re.compile(rf"(?<!\d){value}(?!\d)")
        name = self.name()
        recent = [log for log in self.observer.logs[-100:] if log.node == name]
        return any(number.search(log.text) for log in recent)

    def events(self):
        if not self.events_file:
            return []
        try:
            lines = written.read(self.events_file).decode("utf-8", "replace").splitlines()
        except OSError:
            return []  # it has not written any yet
        events = []
        for line in lines:
            try:
                event = json.loads(line)
            except ValueError:
                continue  # not yet whole
            if isinstance(event, dict) and all(
                isinstance(event.get(name), types) for name, types in _EVENT.items()
            ):
                events.append(event)
        return events

    def is_up(self, activity):
        if self.program.poll() is not None:
            return True
        return activity.is_up_or_stuck(self.name(), self.program.pid)

    def is_settled(self, silence, activity):
        if self.program.poll() is not None:
            return True
        now, name = time.monotonic(), self.name()
        if name is None:
            return self.is_up(activity)
        silent = now - (activity.last(name) or now) > silence
        if silent and activity.is_idle(self.program.pid):
            return True
        if self.plan["wrap"]:
            events = self.events()
            after = [e for e in events if e["event"] == "after"]
            return len(after) >= 4 or any(e["event"] in ("error", "not_found") for e in events)
        counts = [n for (node, _), n in self.observer.counts.items() if node == name]
        if self.plan["publishes"] and max(counts, default=0) < self.plan["publishes"]:
            return False
        if self.plan["values"]:
            pattern = re.compile(self.plan["received"]) if self.plan["received"] else None
            logs = [log for log in list(self.observer.logs) if log.node == name]
            heard = [log for log in logs if pattern and pattern.search(log.text)]
            all_values = len(self.plan["values"]) + len(self.plan["paced"])
            if not self.sent or pattern and len(heard) < all_values:
                return False
        return True


def _set_field(message, path, value):
    *above, name = path.split(".")
    for part in above:
        message = getattr(message, part)
    setattr(message, name, type(getattr(message, name))(value))


def _is_ending(node, seconds, plan, activity):
    """Return whether a node, asked to end so many seconds ago, may still be about to."""
    if node.program.poll() is not None:
        return False
    idle = activity.is_idle(node.program.pid)  # asked each time, so that it knows
    if seconds < plan["stop_seconds"]:
        return True
    # On a busy machine it may take longer, as long as it does something.
    used = _processor_seconds(node.program.pid) or 0
    return not idle and used < _BUSY and seconds < _ENDING


def run_direct(plan, observer, starter):
    began = time.monotonic()
    nodes = [Direct(key, one, plan, observer, starter) for key, one in plan["nodes"].items()]
    activity = Activity(observer)
    all_up = None
    while time.monotonic() - began < plan["most"]:
        now = time.monotonic()
        if all_up is None and all(node.is_up(activity) for node in nodes):
            all_up = now
        if now - (all_up or now) > plan["seconds"]:
            break
        for node in nodes:
            node.send()
            node.send_paced()
        if all(node.is_settled(plan["silence"], activity) for node in nodes):
            break
        time.sleep(_TICK)
    running = [n for n in nodes if n.program.poll() is None]
    registered = {n.key: bool(n.name() and observer.is_registered(n.name())) for n in running}
    asked = time.monotonic()
    for node in running:
        node.program.send(signal.SIGKILL if node.plan["wrap"] else plan["signal"])
    while any([_is_ending(node, time.monotonic() - asked, plan, activity) for node in running]):
        time.sleep(_TICK)
    stuck = [node for node in running if node.program.poll() is None]
    for node in stuck:
        if node.events_file:
            node.program.send(signal.SIGUSR1)  # the hook then prints where each thread stands
    end = time.monotonic() + (1 if stuck else 0)
    while time.monotonic() < end:
        time.sleep(_TICK)
    results = {}
    for node in nodes:
        results[node.key] = {"name": node.name(), "sent": node.sent}
        node.program.poll()
        if not node.program.was_executed():
            continue
        was_running = node in running
        ended = node.program.ended
        results[node.key].update(
            asked=asked - node.program.started if was_running else None,
            stopped_in=ended - asked if was_running and ended else None,
            ended_after=None if was_running or not ended else ended - node.program.started,
            still_registered=registered.get(node.key, False)
            and observer.is_registered(node.name()),
            events=node.events(),
        )
        if node in stuck:
            node.program.kill()
            results[node.key]["ended_by"] = "kill"
    left = left_behind({node.key: node.program for node in nodes})
    for node in nodes:
        if node.program.was_executed():
            node.program.read_rest()
            results[node.key].update(node.program.result())
    return {"nodes": results, "left": left, "seen": seen_by(observer, began)}


def main():
    plan = json.loads(sys.argv[1])
    # Nothing but the result is printed.
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    # Orphans of the package's programs become children of this one: so they are found. And what
    # runs as the same user must not look into this process, nor write there.
    libc = ctypes.CDLL(None)
    libc.prctl(warden.PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    libc.prctl(warden.PR_SET_DUMPABLE, 0, 0, 0, 0)
    starter = apart.Starter.of_environment()
    # The nodes cannot write to its own files.
    del os.environ["TMPDIR"]
    os.environ["HOME"] = os.environ["ROS_HOME"] = os.environ["ROS_LOG_DIR"] = tempfile.mkdtemp()
    with Observer() as observer:
        run = {"launch": run_launch, "direct": run_direct}[plan["kind"]]
        result = run(plan, observer, starter)
    with answer:
        json.dump(result, answer, default=str)
    # rospy's threads, and connections to what was killed, are no reason to wait.
    os._exit(0)


if __name__ == "__main__":
    main()
