# SPDX-License-Identifier: BSD-3-Clause
"""How long nodes are waited for: as long as they do something, whatever the machine's load.

Linux counts how long each thread could have run, and had no processor. So it is known what a busy
machine has cost a node, and by how much all takes longer.
"""

import glob
import time
from typing import Callable, Dict, Iterable, Iterator, List, Optional, Tuple, TypeVar, Union

import psutil

from mrp_check.confined.observe import Observer
from mrp_check.confined.plans import Common
from mrp_check.confined.seen import Log, Message, Registration

TICK = 0.02  # seconds between two looks
_IDLE = 3.0  # seconds in which an idle process uses hardly any processor time, ...
_HARDLY = 0.05  # ... which is less than this many seconds
_STARVED = 0.2  # of the looks: a process that wants a processor in more of them isn't idle
_CALM = 0.5  # seconds after which one that has announced something announces no more
BUSY = 20.0  # seconds of processor time: a process is no longer starting up, or ending
_LONGER = 6.0  # times, at most, that a busy machine may take longer
_RECENT = 400  # messages, and lines, in which a node's last one is looked for

T = TypeVar("T")


class Activity:
    """When something last came from each node, or was done by its process."""

    def __init__(self, observer: Observer) -> None:
        self.observer = observer
        self._used: Dict[int, List[Tuple[float, float, bool]]] = {}
        self._began: Dict[str, Tuple[float, float]] = {}

    def begin(self, node: str, pid_of: Callable[[], Optional[int]]) -> None:
        """Remember when a node began to publish, and how long it had waited by then."""
        if node not in self._began and self.observer.most_of(node):
            self._began[node] = time.monotonic(), _processor_of(pid_of())[1]

    def waited(self, node: str, pid: Optional[int]) -> float:
        """Return which part of the time since then its threads waited for a processor."""
        if node not in self._began:
            return 0.0
        then, before = self._began[node]
        waited = max(_processor_of(pid)[1] - before, 0.0) / (time.monotonic() - then)
        return min(waited, 1.0)

    def is_up_or_stuck(self, node: Optional[str], pid: Optional[int]) -> bool:
        """Return whether a node has registered, or is stuck."""
        return node is not None and self.last(node) is not None or self.is_stuck(pid)

    def is_stuck(self, pid: Optional[int]) -> bool:
        """Return whether a node that has not registered is not going to: its process is gone, does
        nothing, or has worked for too long."""
        if pid is None:
            return False
        used = processor_seconds(pid)
        return used is None or used > BUSY or self.is_idle(pid)

    def is_idle(self, pid: Optional[int]) -> bool:
        """Return whether a process has used hardly any processor time for a while, or is no more.

        One that waits for a processor on a busy machine isn't idle, nor is one that waits for the
        disk from which it reads its modules."""
        used, now, status = processor_seconds(pid), time.monotonic(), _status(pid)
        if used is None or pid is None:
            return True
        if status == psutil.STATUS_DISK_SLEEP:
            self._used.pop(pid, None)
        history = self._used.setdefault(pid, [])
        history.append((now, used, status == psutil.STATUS_RUNNING))
        # The latest that is old enough to be compared with, and all that came after it.
        while len(history) > 1 and history[1][0] <= now - _IDLE:
            del history[0]
        then, before, _ = history[0]
        is_starved = sum(wants for _, _, wants in history) > _STARVED * len(history)
        return now - then >= _IDLE and used - before < _HARDLY and not is_starved

    def is_calm(self, node: str) -> bool:
        """Return whether a node has announced all that it has, as far as one can see."""
        seen = self.observer.seen
        records = [*seen.publications, *seen.subscriptions, *seen.services]
        times = [record.time for record in records if record.node == node]
        is_late = bool(times) and is_over(time.monotonic() - max(times), _CALM)
        return is_late and not self.observer.is_held(node)

    def last(self, node: str) -> Optional[float]:
        """Return when something last came from a node, or None if nothing has."""
        seen = self.observer.seen
        records: List[Union[Message, Log, Registration]] = [*seen.publications, *seen.subscriptions]
        records += seen.services
        records += [*seen.messages[-_RECENT:], *seen.logs[-_RECENT:]]
        return max((record.time for record in records if record.node == node), default=None)


def processor_seconds(pid: Optional[int]) -> Optional[float]:
    """Return the processor time that a process has used, or None if it is no more."""
    try:
        times = psutil.Process(pid).cpu_times() if pid else None
    except psutil.Error:
        return None
    return times and times.user + times.system


def runnable(pid: Optional[int]) -> Dict[str, float]:
    """Return for how many seconds each thread of a process ran, or waited for a processor."""
    return {path: ran + waited for path, ran, waited in _threads(pid)}


def _threads(pid: Union[int, str, None]) -> Iterator[Tuple[str, float, float]]:
    """Yield for each thread the seconds that it ran, and that it waited for a processor."""
    for path in glob.glob(f"/proc/{pid}/task/*/schedstat"):
        try:
            with open(path) as file:
                ran, waited, _ = file.read().split()
        except OSError:
            continue  # the thread has ended
        yield path, int(ran) / 1e9, int(waited) / 1e9


def _status(pid: Optional[int]) -> Optional[str]:
    try:
        return str(psutil.Process(pid).status()) if pid else None
    except psutil.Error:
        return None


def _processor_of(pid: Union[int, str, None]) -> Tuple[float, float]:
    """Return the seconds that a process ran, and that it waited for a processor meanwhile."""
    threads = [*_threads(pid)]
    return sum(ran for _, ran, _ in threads), sum(waited for _, _, waited in threads)


def is_over(passed: float, seconds: float) -> bool:
    """Return whether so many seconds are over, and as many more as a busy machine takes longer.

    By how much it does, this process knows from itself."""
    if passed <= seconds:
        return False
    ran, waited = _processor_of("self")
    return passed > seconds * min(1 + waited / max(ran, TICK), _LONGER)


def wait(
    plan: Common,
    nodes: Iterable[T],
    is_up: Callable[[T], bool],
    is_settled: Callable[[T], bool],
    step: Callable[[], Optional[str]],
) -> str:
    """Wait until all nodes are settled, for as long as the plan says; return why no more is waited
    for: "enough", "time", "most", or what step() returns.

    step: called all the time; ends the waiting by what it returns, if that is not None
    """
    nodes, began, all_up = list(nodes), time.monotonic(), None
    while True:
        now = time.monotonic()
        if all_up is None and all(map(is_up, nodes)):
            all_up = now
        ending = step()
        if ending:
            return ending
        if is_over(now - (all_up or now), plan.seconds):
            return "time"
        if now - began > plan.most:
            return "most"
        if all(map(is_settled, nodes)):
            return "enough"
        time.sleep(TICK)
