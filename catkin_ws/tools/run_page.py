#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does what the pages in src/mrp/doc tell their reader to do.

The steps of a page are done in the order of reading. Pages that do not need one another are read
side by side: see TUTORIAL.

The directives `file` and `terminal` in src/mrp/doc/extension/ say what a step is.
"""

import concurrent.futures
import io
import json
import multiprocessing
import os
import pathlib
import re
import subprocess
import sys
import time
from urllib.parse import urlsplit

import pexpect
import rosgraph
from mrp_testing import compiler_cache
from mrp_testing.master import uri_of
from mrp_testing.ports import free_port
from mrp_testing.workspace import WORKSPACE, copy_repository

DOC = WORKSPACE / "src" / "mrp" / "doc"
RECORDED = DOC / "recorded"
sys.path.insert(0, str(DOC / "extension"))

import meaning  # noqa: E402

SECONDS = 900  # that a command may take: one builds the whole repository
PRINTS_SECONDS = 180  # that one may go on until it has printed what the page says

# Which pages need one another. One reader reads these in their order: they write ~/catkin_ws, build
# it, run it, and break it.
TUTORIAL = ("talk", "listen", "cpp", "launch", "look", "check_it", "wrong")
# They build the clone in ~/mrp: a second reader reads them meanwhile.
CLONE = ("run", "message_types")
# Each other page runs what is built in the clone, and writes nothing that another page reads: so it
# has a reader of its own. Where it names this folder, it needs the tutorial as well.
OF_TUTORIAL = "~/catkin_ws"
SIDE_BY_SIDE = 3

_PROMPT = re.compile(r"<reader (\d+)> $")
# rospy prints it, and goes on, where two nodes that start at once both make the link `latest`.
_CHANCE = re.compile("INFO: cannot create a symlink to latest log directory")
_STARTED = re.compile(r"^process\[(\S+)-\d+\]: started", re.MULTILINE)
_ESCAPES = re.compile(r"\x1b\[[0-9;?]*[a-zA-Z]|\x1b\][^\x07]*\x07|\x07")


class StepError(Exception):
    """Says which step of which page failed, and how."""


def docs_python():
    """Return the Python that has Sphinx, which is installed if it is not there yet."""
    script = WORKSPACE / "tools" / "docs_env.sh"
    return subprocess.check_output([script], text=True).strip()


def build(folder, *options):
    """Build the site. Raises StepError with what Sphinx said if that failed."""
    done = subprocess.run(
        [docs_python(), "-m", "sphinx", "-q", "-W", "--keep-going", *options, DOC, folder],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if done.returncode != 0:
        raise StepError(done.stdout)


def steps(site):
    """Return the steps of a site that has been built, in the order of reading."""
    return json.loads((pathlib.Path(site) / "steps.json").read_text())


class Shown:
    """What the steps show.

    outputs: name -> what was printed, as it goes into recorded/outputs.json
    printed: name -> all that was printed, also what the page leaves out
    graphs: name -> what goes into recorded/graphs.json
    """

    def __init__(self):
        self.outputs = {}
        self.printed = {}
        self.graphs = {}

    def add(self, other):
        for mine, theirs in zip(vars(self).values(), vars(other).values()):
            mine.update(theirs)


def read(to_do, home, say=None, only=None):
    """Do all steps, in an empty home that gets a clone of the repository; return what they show.

    say: is called with a line at each step
    only: a page: then only the steps of the pages that it needs are done, and its own

    Raises StepError if a step does not go as the page says.
    """
    copy_repository(pathlib.Path(home) / "mrp")
    pages = needed(to_do, only) if only else pages_of(to_do)
    others = [page for page in pages if page not in TUTORIAL + CLONE]
    after_tutorial = [page for page in others if needs_tutorial(to_do, page)]
    # Processes, not threads: a terminal is made by a fork, which none but a single thread may do.
    with concurrent.futures.ProcessPoolExecutor(
        SIDE_BY_SIDE, multiprocessing.get_context("spawn")
    ) as pool:

        def begin(*pages):
            return pool.submit(read_pages, to_do, pages, home, say)

        tutorial, clone = (
            begin(*(page for page in mine if page in pages)) for mine in (TUTORIAL, CLONE)
        )
        clone.result()
        rest = [begin(page) for page in others if page not in after_tutorial]
        tutorial.result()
        rest += [begin(page) for page in after_tutorial]
        shown = Shown()
        for reader in (tutorial, clone, *rest):
            shown.add(reader.result())
        return shown


def page_of(step):
    return step["page"].split("/")[-1]


def pages_of(to_do):
    return list(dict.fromkeys(page_of(step) for step in to_do))


def needed(to_do, page):
    """Return the pages whose steps a page needs, in the order of reading; it is the last one."""
    for readers in (TUTORIAL, CLONE):
        if page in readers:
            return [*readers[: readers.index(page) + 1]]
    return [*(TUTORIAL if needs_tutorial(to_do, page) else ()), *CLONE, page]


def needs_tutorial(to_do, page):
    return any(
        OF_TUTORIAL in command
        for step in to_do
        if page_of(step) == page
        for command in step.get("commands", [])
    )


def read_pages(to_do, pages, home, say):
    """Do the steps of some pages, as one reader; return what they show."""
    with Reader(home) as reader:
        for number, step in enumerate(to_do, 1):
            if page_of(step) not in pages:
                reader.keep_in_mind(step)
                continue
            if say:
                what = step.get("path") or "; ".join(step["commands"]) or "Ctrl-C"
                say(f"[{number}/{len(to_do)}] {step['page']}: {what}", flush=True)
            reader.do(step)
    return reader.shown


class Reader:
    """One who reads some of the pages, with terminals and a master of one's own.

    shown: what the steps have shown so far

    Use it in a `with`: on leaving, whatever runs in a terminal is ended.
    """

    def __init__(self, home):
        self.home = pathlib.Path(home)
        self.shown = Shown()
        self._terminals = {}
        self._begin_with = {}  # terminal -> commands
        self._master = uri_of(free_port())

    def keep_in_mind(self, step):
        """Where another reader does a step: begin with the folder and the setup of its terminal."""
        for command in step.get("commands", []):
            if command.split()[0] in ("cd", "source"):
                self._begin_with.setdefault(step["terminal"], []).append(command)

    def do(self, step):
        """Do a step of a page. Raises StepError if it does not go as the page says."""
        try:
            if step["kind"] == "file":
                if page_of(step) not in TUTORIAL:
                    raise StepError("it writes a file: is this page one of TUTORIAL?")
                path = self.home / step["path"]
                if not path.parent.is_dir():
                    raise StepError(f"no page has made the folder {path.parent}")
                path.write_text(step["text"])
            else:
                self._type(step)
        except (StepError, pexpect.ExceptionPexpect) as error:
            where = f"{step['page']}.rst, line {step['line']}"
            raise StepError(f"{where}: {step.get('commands', '')}\n{error}") from None

    def _type(self, step):
        terminal = self._terminals.get(step["terminal"])
        if terminal is None:
            terminal = self._terminals[step["terminal"]] = Terminal(
                self._environment(), self._terminals
            )
            for command in self._begin_with.get(step["terminal"], []):
                terminal.run(command, 0)
        shows = step.get("shows", "").splitlines()
        if "stop" in step:
            printed = terminal.stop()
        else:
            *first, last = step["commands"]
            for command in first:
                terminal.run(command, 0)
            if "until" in step:
                printed = terminal.run_until(last, step["until"], shows)
            else:
                printed = terminal.run(last, step.get("exit", 0))
        if "graph" in step:
            self.shown.graphs[step["graph"]] = self._whole_graph(printed)
        if "until" in step and "keep" not in step:
            terminal.stop()
        if "output" in step:
            text = "\n".join(line for line in printed if not _CHANCE.match(line))
            lines = text.strip().replace(str(self.home), "/home/you").split("\n")
            shown = only(step.get("only", ""), lines)
            missing = meaning.missing(shows, shown)
            if missing:
                raise StepError(f"expected {missing}; found {shown}")
            self.shown.outputs[step["output"]] = shown
            self.shown.printed[step["output"]] = lines

    def _whole_graph(self, printed):
        """Return the graph once it has all nodes that roslaunch has started."""
        started = {"/" + name for name in _STARTED.findall("\n".join(printed))} - {"/rosout"}
        end = time.monotonic() + SECONDS
        while not started <= _nodes(graph(self._master)):
            if time.monotonic() > end:
                raise StepError(f"expected the nodes {started}, found {graph(self._master)}")
            time.sleep(0.1)
        return graph(self._master)

    def _environment(self):
        names = ("USER", "LOGNAME", "LANG", "TZ")
        port = urlsplit(self._master).port
        return {
            **{name: os.environ[name] for name in names if name in os.environ},
            "PATH": "/usr/bin:/bin:/usr/sbin:/sbin",
            "HOME": str(self.home),
            "TERM": "dumb",
            "ROS_MASTER_URI": self._master,
            "ROS_HOSTNAME": "localhost",
            "MRP_DOCS_ENV": str(WORKSPACE / "build" / "docs_env"),
            # The reader's master has a port of its own, for which roscore does not look there.
            "BASH_FUNC_roscore%%": f'() {{ command roscore -p {port} "$@"; }}',
            **compiler_cache.variables(self.home),
        }

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        for terminal in self._terminals.values():
            terminal.close()


class Terminal:
    """A shell in a terminal of its own, as on a desktop."""

    def __init__(self, env, all_terminals=None):
        self._all = {} if all_terminals is None else all_terminals
        self._shell = pexpect.spawn(
            "bash",
            ["--norc", "--noprofile", "-i"],
            env={**env, "PS1": "<reader $?> "},
            cwd=env["HOME"],
            encoding="utf-8",
            echo=False,
            timeout=SECONDS,
            dimensions=(50, 1000),
        )
        self._printed = self._shell.logfile_read = io.StringIO()
        self._wait_for_prompt()

    def run(self, command, code):
        """Run a command to its end; return the lines that it printed."""
        self._begin(command)
        actual = self._wait_for_prompt()
        if actual != code:
            raise StepError(f"{command}: exit code {actual}, expected {code}\n{self._text()}")
        return self._lines()

    def run_until(self, command, pattern, shows=()):
        """Run a command until it has printed a line that has the pattern, and what it shows.

        Returns all lines.
        """
        self._begin(command)
        # Only from the start of a line: from each place in it, looking ahead takes seconds.
        pattern = re.compile(f"(?<![^\r\n])[^\r\n]*(?:{pattern})[^\r\n]*\r\n")
        end = time.monotonic() + PRINTS_SECONDS
        if self._expect([pattern, _PROMPT], PRINTS_SECONDS) == 1:
            raise StepError(f"it ended before it printed {pattern.pattern}:\n{self._text()}")
        while meaning.missing(shows, self._lines()) and time.monotonic() < end:
            self._shell.expect("\r\n")
        return self._lines()

    def stop(self):
        """Press Ctrl-C; return all that the command has printed."""
        self._shell.sendcontrol("c")
        self._wait_for_prompt()
        return self._lines()

    def close(self):
        self._shell.sendcontrol("c")
        self._shell.close(force=True)

    def _begin(self, command):
        self._printed.seek(0)
        self._printed.truncate()
        self._shell.sendline(command)

    def _expect(self, patterns, seconds=SECONDS):
        """Wait for one of the patterns; return its number. Meanwhile, read what others print.

        A command that goes on in another terminal stops once nobody takes its output.
        """
        end = time.monotonic() + seconds
        while True:
            late = time.monotonic() > end
            found = self._shell.expect([*patterns, *([] if late else [pexpect.TIMEOUT])], timeout=1)
            if found < len(patterns):
                return found
            for terminal in list(self._all.values()):
                if terminal is not self:
                    terminal.read_on()

    def read_on(self):
        """Read what has been printed since."""
        while True:
            try:
                self._shell.read_nonblocking(65536, timeout=0)
            except pexpect.ExceptionPexpect:  # there is no more
                return

    def _wait_for_prompt(self):
        self._expect([_PROMPT])
        return int(self._shell.match.group(1))

    def _text(self):
        return _PROMPT.sub("", _ESCAPES.sub("", self._printed.getvalue().replace("\r\n", "\n")))

    def _lines(self):
        return [line.rstrip() for line in self._text().splitlines()]


def only(pattern, lines):
    """Return the lines that have a pattern, and at the end how many others are left out."""
    chosen = [line for line in lines if re.search(pattern, line)]
    count = len(lines) - len(chosen)
    while chosen and not chosen[0]:
        del chosen[0]
    return chosen + [f"[{count} other line{'s' * (count > 1)} left out]"] * (count > 0)


def graph(master_uri):
    """Return the topics that a master knows, and who is at them, without those of the log."""
    master = rosgraph.Master("/run_page", master_uri=master_uri)
    publishers, subscribers = map(_pairs, master.getSystemState()[:2])
    types = dict(master.getTopicTypes())
    return {
        "topics": {topic: types.get(topic) for _, topic in publishers + subscribers},
        "publishers": [f"{node} -> {topic}" for node, topic in publishers],
        "subscribers": [f"{topic} -> {node}" for node, topic in subscribers],
    }


def _pairs(state):
    """Return (node, topic) of one kind of what a master knows."""
    pairs = sorted((node, topic) for topic, nodes in state for node in nodes)
    return [pair for pair in pairs if "/rosout" not in pair]


def _nodes(found):
    """Return the nodes of a graph()."""
    publishers = {edge.split(" -> ")[0] for edge in found["publishers"]}
    return publishers | {edge.split(" -> ")[1] for edge in found["subscribers"]}
