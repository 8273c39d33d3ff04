# SPDX-License-Identifier: BSD-3-Clause
"""The nodes as a launch file starts them, and roslaunch ends them."""

import os
import re
import signal
import time
from typing import Dict, Optional

from mrp_check.confined import apart, variables
from mrp_check.confined.activity import TICK, Activity, is_over, processor_seconds, wait
from mrp_check.confined.observe import Observer
from mrp_check.confined.plans import LaunchNode, LaunchPlan
from mrp_check.confined.program import Program, left_behind
from mrp_check.confined.seen import LaunchResult

_DIED = re.compile(r"\[(?P<name>\S+)-\d+\] process has (?P<how>died|finished cleanly)")
_STARTED = re.compile(r"process\[(?P<name>\S+)-\d+\]: started with pid \[(?P<pid>\d+)\]")
_SAYS_SO = 3.0  # seconds in which roslaunch says that a process has ended
_CALLS_BACK = 4.0  # seconds after the first message in which a callback is waited for
_NOT_STARTED = re.compile(r"cannot launch node of type \[(?P<type>[^\]]*)\]")


def run(plan: LaunchPlan, observer: Observer, starter: apart.Starter) -> LaunchResult:
    """Run roslaunch until its nodes have done enough, and end it."""
    env = {**plan.common.environment, variables.MASTER: observer.uri}
    roslaunch = Program(starter, plan.command, env, plan.common.writable, merge=True)
    launch = RunningLaunch(plan, roslaunch, observer)

    def has_ended() -> Optional[str]:
        launch.begin()
        return None if roslaunch.poll() is None else "itself"

    ending = wait(plan.common, plan.nodes, launch.is_up, launch.is_settled, has_ended)
    waited = launch.waited()
    latched = observer.latched()
    uncalled = [node.path for node in plan.nodes if launch.is_uncalled(node)]
    observer.release()
    asked, code = time.monotonic(), roslaunch.poll()
    roslaunch.send(signal.SIGINT)
    stop_seconds = plan.common.stop_seconds
    while roslaunch.poll() is None and not is_over(time.monotonic() - asked, stop_seconds):
        time.sleep(TICK)
    stopped_in = None if roslaunch.poll() is None else time.monotonic() - asked
    if stopped_in is None:
        roslaunch.kill()
    return LaunchResult(
        ending=ending,
        asked=asked - roslaunch.started,
        code=code,
        stopped_in=stopped_in,
        left=left_behind({None: roslaunch}),
        lines=roslaunch.all_lines(),
        latched=latched,
        waited=waited,
        uncalled=uncalled,
        seen=observer.seen_since(roslaunch.started),
    )


class RunningLaunch:
    """What roslaunch and its nodes are doing."""

    def __init__(self, plan: LaunchPlan, roslaunch: Program, observer: Observer) -> None:
        self.plan, self.roslaunch, self.observer = plan, roslaunch, observer
        self.activity = Activity(observer)
        self._gone: Dict[int, float] = {}  # process id -> when it was first seen to be gone

    def begin(self) -> None:
        """Look which nodes have begun to publish."""
        for node in self.plan.nodes:
            self.activity.begin(node.path, lambda: self._pid(node))

    def waited(self) -> Dict[str, float]:
        """Return node -> which part of the time since then it waited for a processor."""
        nodes = self.plan.nodes
        return {node.path: self.activity.waited(node.path, self._pid(node)) for node in nodes}

    def is_uncalled(self, node: LaunchNode) -> bool:
        """Return whether it would be seen if a node called a callback, and it has called none."""
        file, pid = self.plan.common.environment.get(variables.CALLBACKS), self._own_pid(node)
        return bool(file and node.is_cpp) and not os.path.exists(f"{file}.{pid}")

    def _may_call_back(self, node: LaunchNode) -> bool:
        """Return whether messages have come to a node, so that it may still call a callback."""
        if not self.is_uncalled(node):
            return False
        seen = self.observer.seen
        topics = {sub.topic: sub.time for sub in list(seen.subscriptions) if sub.node == node.path}
        if not topics:
            return False
        heard = (m.time for m in list(seen.messages) if m.time > topics.get(m.topic, m.time))
        first = next(heard, None)
        return first is not None and not is_over(time.monotonic() - first, _CALLS_BACK)

    def is_up(self, node: LaunchNode) -> bool:
        return self._has_died(node) or self.activity.is_up_or_stuck(node.path, self._pid(node))

    def _has_just_ended(self, node: LaunchNode) -> bool:
        """Return whether a node's process is gone, and roslaunch may be about to say so."""
        pid = self._pid(node)
        if pid is None or processor_seconds(pid) is not None:
            return False
        return time.monotonic() - self._gone.setdefault(pid, time.monotonic()) < _SAYS_SO

    def is_settled(self, node: LaunchNode) -> bool:
        """Return whether no more has to be waited for from a node."""
        if self._has_died(node):
            return True
        if self._has_just_ended(node):
            return False
        if self._may_call_back(node):
            return False
        last = self.activity.last(node.path)
        if last is None:  # not asked twice: by then it may have come up, and is not settled
            return self.activity.is_stuck(self._pid(node))
        pid = self._pid(node)
        silent = time.monotonic() - last > self.plan.common.silence
        if silent and (pid is None or self.activity.is_idle(pid)):
            return True
        if node.publishes and self.observer.most_of(node.path) < self.plan.enough:
            return False
        return self._has_heard(node)

    def _has_heard(self, node: LaunchNode) -> bool:
        """Return whether a node has heard as much as it should, if it should hear anything."""
        subscriptions, logs = self.observer.seen.subscriptions, self.observer.seen.logs
        # It may be that nobody sends it anything.
        if node.hears and not any(sub.node == node.path for sub in list(subscriptions)):
            return False
        if not node.received:
            return node.publishes or self.activity.is_calm(node.path)
        pattern = re.compile(node.received)
        lines = [log for log in list(logs) if log.node == node.path and pattern.search(log.text)]
        enough = self.plan.enough * node.senders
        # One that logs other lines is waited for until there was twice as much to be heard.
        counts = list(self.observer.counts.items())
        sent = sum(count for (_, topic), count in counts if topic == node.hears)
        return len(lines) >= enough or sent >= 2 * enough

    def _pid(self, node: LaunchNode) -> Optional[int]:
        """Return the process id that roslaunch has printed for a node, or None."""
        pid, init = self._own_pid(node), self.roslaunch.init
        if pid is None:
            return None
        return apart.id_outside(init, pid) if init else int(pid)

    def _own_pid(self, node: LaunchNode) -> Optional[str]:
        """Return the process id that a node has where it runs, or None."""
        started = [_STARTED.search(text) for _, _, text in list(self.roslaunch.lines)]
        pids = (match["pid"] for match in started if match and "/" + match["name"] == node.path)
        return next(pids, None)

    def _has_died(self, node: LaunchNode) -> bool:
        for _, _, text in list(self.roslaunch.lines):
            died, not_started = _DIED.search(text), _NOT_STARTED.search(text)
            if died and "/" + died["name"] == node.path:
                return True
            if not_started and not_started["type"] == node.type:
                return True
        return False
