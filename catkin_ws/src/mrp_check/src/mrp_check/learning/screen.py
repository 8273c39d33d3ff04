# SPDX-License-Identifier: BSD-3-Clause
"""The exercises on the whole screen of a terminal, with a key for each thing to do."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
from typing import Callable

from prompt_toolkit.application import Application, run_in_terminal
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.key_binding import KeyBindings
from prompt_toolkit.layout import FormattedTextControl, HSplit, Layout, Window
from prompt_toolkit.output import ColorDepth
from prompt_toolkit.styles import Style

from mrp_check.learning import opening, views
from mrp_check.learning.watch import INTERVAL, Watched

_ESCAPE_SECONDS = 0.05  # after which an escape is the key, and no beginning of another
_AGAIN = "Press x again to discard your changes; any other key cancels."


def show(watched: Watched) -> None:
    """Show the exercises, and follow what is saved, until somebody quits."""
    _Screen(watched).run()


class _Screen:
    """The whole screen: what it shows, and what its keys do.

    view: what is shown: task, list, nodes or solution
    top: the first line of it that is shown
    note: what is said in place of the exercise's state, until the next key or verdict
    """

    def __init__(self, watched: Watched) -> None:
        self.watched = watched
        self.view, self.top, self.note = "task", 0, ""
        self.hint = self.explains = False
        self.chosen = 0
        self.diff: list[str] = []
        self.app: Application[None] = Application(
            layout=Layout(self._windows()),
            key_bindings=self._keys(),
            style=Style.from_dict(views.STYLES),
            full_screen=True,
            color_depth=ColorDepth.DEPTH_1_BIT if "NO_COLOR" in os.environ else None,
        )
        self.app.ttimeoutlen = _ESCAPE_SECONDS

    # --- What is shown

    def _windows(self) -> HSplit:
        def line(text: Callable[[], StyleAndTextTuples], style: str = "") -> Window:
            return Window(FormattedTextControl(text), height=1, style=style)

        body = FormattedTextControl(self._body, focusable=True, show_cursor=False)
        return HSplit(
            [
                line(lambda: [("", views.heading(self.watched))], "class:bar"),
                Window(body),
                line(self._state),
                line(lambda: [("", views.keys(self.watched))], "class:bar"),
            ]
        )

    def _body(self) -> StyleAndTextTuples:
        lines, height = self._lines(), self._height
        if self.view == "list":  # the chosen one is in sight
            self.top = max(min(self.top, self.chosen), self.chosen - height + 1)
        self.top = max(0, min(self.top, len(lines) - height))
        shown = lines[self.top : self.top + height]
        return [(f"class:{style}" if style else "", f" {text}\n") for style, text in shown]

    def _lines(self) -> list[views.StyledLine]:
        width = max(20, self.app.output.get_size().columns - 2)
        if self.view == "list":
            return [*views.list_of(self.watched, self.chosen)]
        if self.view == "nodes":
            return [*views.nodes(self.watched, width)]
        if self.view == "solution":
            return [*views.diff(self.diff, width)]
        return [*views.task(self.watched, self.hint, self.explains, width)]

    @property
    def _height(self) -> int:
        return max(1, self.app.output.get_size().rows - 3)

    def _state(self) -> StyleAndTextTuples:
        style, text = ("busy", self.note) if self.note else views.state(self.watched)
        below = len(self._lines()) - self.top - self._height
        more = f" ({below} more lines below: arrow down)" if below > 0 and not self.note else ""
        return [(f"class:{style}", f" {text}{more}")]

    # --- What the keys do

    def _keys(self) -> KeyBindings:
        bindings = KeyBindings()

        def on(*keys: str) -> Callable[[Callable[[], None]], None]:
            def bind(function: Callable[[], None]) -> None:
                def act(event: object) -> None:
                    note, self.note = self.note, ""
                    self._armed = note == _AGAIN
                    function()

                for key in keys:
                    bindings.add(key)(act)

            return bind

        on("n")(self._next)
        on("o")(self._open_file)
        on("e")(self._explain)
        on("h")(self._hint)
        on("p")(self._show_page)
        on("r")(self._run_nodes)
        on("l")(self._list)
        on("s")(self._solution)
        on("x")(self._reset)
        on("q", "c-c")(self._quit)
        on("escape")(lambda: self._go("task"))
        on("enter")(self._open_chosen)
        on("up")(lambda: self._move(-1))
        on("down")(lambda: self._move(1))
        on("pageup")(lambda: self._move(-self._height))
        on("pagedown")(lambda: self._move(self._height))
        return bindings

    def _go(self, view: str) -> None:
        self.view, self.top = view, 0

    def _next(self) -> None:
        course, exercise = self.watched.course, self.watched.exercise
        later = [other for other in course.open if other.number > exercise.number]
        if not course.is_passed(exercise):
            self.note = "This exercise is still open. To leave it for later, choose another with l."
        elif not course.open:
            self.note = f"You have finished all {len(course.exercises)}. Well done!"
        else:
            self._open((later or course.open)[0])

    def _open(self, exercise: views.exercises.Exercise) -> None:
        self.watched.open(exercise)
        self.hint = self.explains = False
        self._go("task")

    def _hint(self) -> None:
        self.hint = self.view != "task" or not self.hint
        self._go("task")

    def _explain(self) -> None:
        self.explains = self.view != "task" or not self.explains
        self._go("task")

    def _open_file(self) -> None:
        file, editor = str(self.watched.exercise.file), opening.editor()
        if editor:
            run_in_terminal(lambda: subprocess.call([*editor, file]), in_executor=True)
        elif opening.start("code", file):
            self.note = "The file opens in VS Code."
        else:
            self.note = "To open it with o, choose an editor first: export EDITOR=nano"

    def _show_page(self) -> None:
        name = self.watched.exercise.defect.page
        path = opening.page(name)
        self.note = f"The page {name}: {path}"
        if opening.show_page(name):
            self.note = f"The page opens in your browser: {path}"

    def _run_nodes(self) -> None:
        self.watched.again()
        self._go("nodes")

    def _list(self) -> None:
        self.chosen = self.watched.exercise.number - 1
        self._go("task" if self.view == "list" else "list")

    def _open_chosen(self) -> None:
        if self.view == "list":
            self._open(self.watched.course.exercises[self.chosen])

    def _solution(self) -> None:
        if self.watched.course.is_passed(self.watched.exercise):
            self.diff = self.watched.exercise.solution()
            self._go("task" if self.view == "solution" else "solution")
        else:
            self.note = "You'll see the solution when you've passed. h gives a hint, e explains."

    def _reset(self) -> None:
        if self._armed:
            self.watched.reset()
            self._go("task")
        else:
            self.note = _AGAIN

    def _move(self, lines: int) -> None:
        if self.view == "list":
            last = len(self.watched.course.exercises) - 1
            self.chosen = max(0, min(self.chosen + lines, last))
        else:
            self.top += lines

    def _quit(self) -> None:
        if self.app.is_running and not self.app.is_done:
            self.app.exit()

    # --- Its life

    def run(self) -> None:
        self.app.run(pre_run=self._begin)

    def _begin(self) -> None:
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, self._quit)
        self.app.create_background_task(self._follow())

    async def _follow(self) -> None:
        """Look at the files again and again; draw when something is known that was not."""
        before: object = None
        while True:
            try:
                self.watched.look()
            except Exception as error:  # such as a disk that is full
                self.app.exit(exception=error)
                return
            check = self.watched.check
            now = check and (check, check.doing, check.report, check.done)
            if now != before:
                before = now
                self.note = "" if check and check.done else self.note
                self.app.invalidate()
            await asyncio.sleep(INTERVAL)
