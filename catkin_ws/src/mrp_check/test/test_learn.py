# SPDX-License-Identifier: BSD-3-Clause
"""Runs `make learn` at a terminal, with real checks; and what several checks of a package share."""

import os

import check_sets
import pexpect
import pyte
import pytest
from mrp_check.cli import learn
from mrp_check.confined import variables
from mrp_check.contract import defects
from mrp_check.learning.exercise import Course
from mrp_testing import compiler_cache
from mrp_testing.process import processes_with
from mrp_testing.waiting import wait_until, within

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("open_folders")]

FIRST = defects.exercises()[0]
UP = "\x1b[A"
DOWN = "\x1b[B"
CHECK = 240  # seconds that a whole check has: ten times what it takes on a machine that is idle
COMMAND = ("/usr/bin/python3", learn.__file__)
# What other tests have compiled need not be compiled here.
CACHE = str(compiler_cache.FOLDER.with_name("ccache_of_checks"))


@pytest.fixture
def env(tmp_path):
    """The environment of the program, whose temporary files lie where the test sees them."""
    temporary = tmp_path / "tmp"
    temporary.mkdir(mode=0o711)
    path = os.pathsep.join(["/usr/bin", os.environ["PATH"]])
    kept = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "VISUAL", "DISPLAY")}
    source = str(check_sets.HERE.parent / "src" / "mrp_check" / "src")
    editor = r"sed -i 's/\(msg.data\)$/\1)/'"
    own = {"TMPDIR": str(temporary), "TERM": "xterm", "PYTHONPATH": source, "EDITOR": editor}
    return {**kept, **own, "PATH": path, variables.CCACHE: CACHE}


def assert_nothing_is_left(tmp_path):
    """Every process of a check has its scratch folder in its command line, or in that of one that
    it ends with."""
    assert processes_with(str(tmp_path)) == {}
    assert [path.name for path in (tmp_path / "tmp").iterdir()] == []


class Terminal:
    """A program at a terminal, and what its screen shows."""

    def __init__(self, env, *command, rows=24, columns=80):
        self.screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self.screen)
        self.program = pexpect.spawn(
            command[0], [*command[1:]], env=env, dimensions=(rows, columns), timeout=0
        )

    @property
    def text(self):
        return "\n".join(line.rstrip() for line in self.screen.display)

    def read(self):
        try:
            while True:
                self._stream.feed(self.program.read_nonblocking(65536))
        except (pexpect.TIMEOUT, pexpect.EOF):
            pass

    def wait_for(self, *texts):
        """Wait until the screen shows all of these."""

        def is_shown():
            self.read()
            return all(text in self.text for text in texts)

        assert within(CHECK, is_shown), f"{texts} are not on the screen:\n{self.text}"

    def press(self, keys, *texts):
        """Press keys, and wait for what the screen then shows."""
        self.program.send(keys)
        self.wait_for(*texts)

    def scroll_to(self, text):
        """Press the arrow down until the screen shows this."""

        def is_shown():
            self.read()
            is_there = text in self.text
            self.program.send("" if is_there else DOWN)
            return is_there

        assert within(CHECK, is_shown), f"{text} is not on the screen:\n{self.text}"

    def quit(self, keys):
        """Press keys that end the program; return its exit code."""
        self.program.send(keys)
        wait_until(lambda: self.read() or not self.program.isalive(), "the program's end")
        return self.program.exitstatus


def test_first_exercise_at_a_terminal(tmp_path, env):
    mine = tmp_path / "mine"
    terminal = Terminal(env, *COMMAND, str(mine))
    terminal.wait_for("A parenthesis", "Exercise 1 of", "| 0 passed")
    script = Course(mine).exercises[0].place / "src" / "subscriber_py_node.py"
    terminal.wait_for(
        "src/subscriber_py_node.py",
        "What the tools say",
        "SyntaxError: '(' was never",
        "Not yet: 1",
    )
    assert "Python can't read src" not in terminal.text
    terminal.press("e", "Python can't read src", "  page:     file:///")
    terminal.press("e", "press e and I'll explain.")
    terminal.press("h", "Hint", "Count the parentheses")
    terminal.press("s", "You'll see the solution when you've passed.")
    terminal.press("p", "The page subscriber: /")
    terminal.press("l", ">   1  open    read      A parenthesis", "    2  open")
    terminal.press("l", "Hint")
    terminal.press("x", "Press x again to discard your changes")
    broken = script.read_text()
    # The test's editor solves it.
    terminal.press("o", "Checking: ")
    terminal.wait_for(
        f"Passed: 1 of {len(defects.exercises())}. n shows the next one.",
        "| 1 passed",
        "You've learned: Python's last line",
    )
    terminal.press("s", "+++ b/src/subscriber_py_node.py")
    terminal.press("r", "started roslaunch server")
    terminal.scroll_to("[SUBSCRIBER PY NODE] received message")
    terminal.press("x", "Press x again to discard your changes")
    terminal.press("x", "A parenthesis")
    assert script.read_text() == broken
    terminal.press("n", "Exercise 2 of", "Checking: ")
    terminal.press("l", ">   2  open", "    1  passed")
    terminal.press(UP, ">   1  passed")
    terminal.press("\r", "Exercise 1 of", "Checking: ")
    assert terminal.quit("q") == 0
    assert_nothing_is_left(tmp_path)
    # The next call goes on where this one ended.
    terminal = Terminal(env, *COMMAND, str(mine))
    terminal.wait_for("Exercise 2 of", "| 1 passed", "Checking: ")
    assert terminal.quit("\x03") == 0
    assert_nothing_is_left(tmp_path)


def test_what_has_not_changed_is_not_built_again(tmp_path, monkeypatch, programs):
    """Puts an old file back, which is new to make, and breaks what was built before: no old
    executable replaces one that can't be built now. A changed Python file starts neither make nor
    roslaunch, unless a file of theirs runs a command of its own; a changed CMakeLists.txt starts
    neither roslaunch nor clang, unless it has files written."""
    monkeypatch.setenv(variables.CCACHE, CACHE)
    source, script, cmake, launch = (
        tmp_path / "package" / path
        for path in (
            *("src/publisher_cpp_node.cpp", "src/publisher_py_node.py"),
            *("CMakeLists.txt", "launch/pub_sub.launch"),
        )
    )
    checked = checks_of(tmp_path, programs, "compile", "lifetime")
    ids, ran, first = checked()
    assert (ids, builds(ran), len(first)) == ([], ["catkin_make", "make"], 2)
    assert checked() == ([], [], first)
    append(script, "# Another line.\n")
    assert checked() == ([], [], first)
    append(launch, "<!-- Another line. -->\n")
    assert checked() == ([], ["launch_dump.py"], first)
    append(cmake, "# Another line.\n")
    ids, ran, first = checked()
    assert (ids, ran) == ([], ["catkin_make", "make"])
    correct, times = source.read_bytes(), source.stat()
    source.write_bytes(correct.replace(b";", b"", 1))
    ids, ran, built = checked()
    assert (ids, builds(ran)) == (["compile"], ["make"])
    assert "publisher_cpp_node" not in built
    source.write_bytes(correct)
    os.utime(source, ns=(times.st_atime_ns, times.st_mtime_ns))
    ids, ran, again = checked()
    assert (ids, builds(ran), {*again}) == ([], ["make"], {*first})
    append(cmake, "add_custom_target(own ALL COMMAND true)\n")
    tags = '<launch><param name="said" command="echo"/>'
    launch.write_text(launch.read_text().replace("<launch>", tags))
    ids, ran, _ = checked()
    assert (ids, builds(ran), "cpp_facts.py" in ran) == ([], ["catkin_make", "make"], True)
    append(script, "# Another line.\n")
    assert [*map(sorted, checked()[:2])] == [[], ["launch_dump.py", "make"]]


def builds(ran):
    """Return the steps of catkin_make among the programs that ran."""
    return [name for name in ran if name in ("catkin_make", "make")]


def append(path, text):
    path.write_text(path.read_text() + text)


def checks_of(tmp_path, programs, *only):
    """Return a function that checks the tutorial's package, in a scratch folder that is kept, for
    these requirements. It returns the ids of the findings, the programs that ran, and the C++
    nodes that are built: name -> time."""
    place, scratch = tmp_path / "package", tmp_path / "scratch"
    check_sets.lay_out("mrp", place)
    scratch.mkdir(mode=0o711)

    def checked():
        programs.clear()
        report = check_sets.check_tutorial(place, *only, kept=scratch)
        built = (scratch / "workspace" / "devel" / "lib" / "mrp").glob("*_cpp_node")
        times = {path.name: path.stat().st_mtime_ns for path in built}
        return [f.id for f in report.findings], [*programs], times

    return checked
