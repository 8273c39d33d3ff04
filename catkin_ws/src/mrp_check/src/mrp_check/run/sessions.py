# SPDX-License-Identifier: BSD-3-Clause
"""The processes that observe the nodes. They take a while to begin: so one for each kind of plan is
begun before there is a plan, while the package is built."""

from __future__ import annotations

import concurrent.futures
import pathlib
from typing import NamedTuple, TypeVar

from mrp_check import sandbox
from mrp_check.confined import crossing, variables
from mrp_check.confined.plans import DirectPlan, LaunchPlan
from mrp_check.contract.errors import CannotCheck
from mrp_check.package.workspace import Workspace, search_path, sourced
from mrp_check.sandbox import confine

_SESSION = "mrp_check.confined.session"  # not imported: it needs rospy, which takes its time
_SPARE_SECONDS = 300  # that one may take in addition to building and running
_MOST_SEEN = 64 * 2**20  # bytes of a run's result
_KINDS = (DirectPlan.__name__, LaunchPlan.__name__)

T = TypeVar("T")


class _Begun(NamedTuple):
    """A process, and the file that it waits for: that of its plan, or an empty one, to end it."""

    plan: pathlib.Path
    result: concurrent.futures.Future[confine.Result]

    def give(self, plan: str) -> None:
        written = self.plan.with_suffix(".part")
        written.write_text(plan)
        written.rename(self.plan)  # whole at every moment


class Sessions:
    """The processes that observe the nodes of one package.

    workspace: that of the package
    """

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        # Longer than the package may take to be built and to run: then one hangs.
        seconds = 2 * workspace.timeout + _SPARE_SECONDS
        self._limits = confine.Limits(time=seconds, output=_MOST_SEEN)
        self._pool = concurrent.futures.ThreadPoolExecutor()
        self._begun: dict[str, _Begun] = {}

    def begin(self) -> None:
        """Begin one for each kind of plan."""
        self._begun = {kind: self._begin(kind) for kind in _KINDS}

    @property
    def have_begun(self) -> bool:
        """Whether one waits for its plan."""
        return bool(self._begun)

    def _begin(self, kind: str) -> _Begun:
        plan = self.workspace.given / f"{kind}.json"
        plan.unlink(missing_ok=True)  # that of another one, which has ended
        return _Begun(plan, self._pool.submit(self._run, kind, plan))

    def _run(self, kind: str, plan: pathlib.Path) -> confine.Result:
        workspace, own = self.workspace, str(sandbox.PACKAGE.parent)
        return confine.run(
            sourced(["/usr/bin/python3", "-m", _SESSION, kind, str(plan)]),
            workspace.folder,
            self._limits,
            variables.environment(workspace.folder, PYTHONPATH=own, PATH=search_path()),
            readable=[workspace.given],
            observes=True,
        )

    def end(self) -> None:
        """End those that have got no plan, and wait for all."""
        for begun in self._begun.values():
            begun.give("")
        self._pool.shutdown(wait=True)

    def result(self, plan: LaunchPlan | DirectPlan, kind: type[T], problems: list[str]) -> T | None:
        """Have a plan carried out; return the result, which is of that kind.

        Returns None if the package kept it from giving a result; `problems` then has the reason.
        Raises CannotCheck.
        """
        name = type(plan).__name__
        begun = self._begun.pop(name, None) or self._begin(name)
        sandbox.hand_over(str(self.workspace.folder))  # the nodes' folders have come since then
        begun.give(crossing.to_json(plan))
        try:
            done = begun.result.result()
        except confine.ConfineError as error:
            problems.append(f"{error}")
            return None
        if done.ended_by == "time":
            raise too_busy(plan.common.most)
        if done.code == 0:
            try:
                return crossing.from_json(kind, done.output)
            except crossing.CrossingError as error:
                raise CannotCheck(f"What the observer says can't be read: {error}") from None
        last_line = (done.errors.strip().splitlines() or [f"it ended with {done.code}"])[-1]
        why = done.limit_text(self._limits)
        if not why and "Traceback" in done.errors:
            raise CannotCheck(f"The observer itself failed: {last_line}. Please report it.")
        problems.append(f"the nodes couldn't be observed: {why or last_line}")
        return None


def too_busy(seconds: float) -> CannotCheck:
    return CannotCheck(
        f"The nodes didn't come up within {seconds:.0f} s, though they were working: this machine"
        " is too busy. Try again with fewer programs running."
    )
