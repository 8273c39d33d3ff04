#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run a lab, mark the lines that show what it claims, sum up, and end it; or list all labs.

The claim is the first line of the lab's launch file. What to look for stands in mrp_labs/labs.yaml.
"""

import argparse
import difflib
import os
import pathlib
import queue
import re
import shlex
import signal
import socket
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import urllib.parse

import yaml

PACKAGE = pathlib.Path(__file__).resolve().parents[1] / "src" / "mrp_labs"
DEADLINE = float(os.environ.get("MRP_TEST_DEADLINE", 60))  # seconds that a line may take
# Seconds after Ctrl-C: longer than roslaunch gives its nodes (15, and 2 more after SIGTERM).
GRACE = 30
MARK = "   <- here"

# What roslaunch prints about itself, which hides what the nodes say.
CHATTER = r"^process\[|^setting /run_id|^started core service|^auto-starting|^ROS_MASTER_URI"
ESCAPES = re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07")  # colours, and the window's title


class NotSeenError(Exception):
    """A lab did not show what it claims; the text is one sentence."""


def read_labs():
    """Return section -> name of a lab -> its entry of labs.yaml, in the order to learn them."""
    return yaml.safe_load((PACKAGE / "labs.yaml").read_text())


def launch_file(name):
    """Return the path of a lab's launch file."""
    return PACKAGE / "launch" / f"{name}.launch"


def claim_of(name):
    """Return the first line of a lab's launch file, without the signs of a comment."""
    return re.sub("^<!-- | -->$", "", launch_file(name).read_text().split("\n")[0])


def steps_of(name, entry):
    """Return the steps of a lab, the first of which starts its launch file."""
    steps = entry.get("steps") or [{"look": entry["look"], "never": entry.get("never")}]
    start = {"start": f"roslaunch mrp_labs {name}.launch"}
    return steps if "start" in steps[0] else [start, *steps]


def print_list(all_):
    """Print each lab's claim, and the command that runs it: of the first section, or of all."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # as when `less` is closed
    first, *others = read_labs().items()
    for section, labs in [first, *others] if all_ else [first]:
        print(f"{section}:\n")
        for name in labs:
            print(textwrap.fill(claim_of(name), 98, initial_indent="  ", subsequent_indent="  "))
            print(f"    make lab NAME={name}\n")
    if not all_:
        print(f"{sum(len(labs) for _, labs in others)} more: make labs ALL=1")


class Run:
    """The programs of a lab that is running. Use it in a `with`, which ends them."""

    def __init__(self, hide=None):
        self.programs = []  # (command, Popen)
        self.lines = queue.Queue()
        self.pids = {}  # name of a node -> the number of its process
        self.hide = re.compile("|".join(filter(None, [CHATTER, hide])))
        self.colour = sys.stdout.isatty() and "NO_COLOR" not in os.environ

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="mrp_lab_")
        return self

    def __exit__(self, *_):
        while self.programs:
            self.end(self.programs[-1][0])
        self.folder.cleanup()

    def start(self, command):
        """Start a command, whose lines are read as they come; return its Popen and its reader."""
        while not self.lines.empty():  # of what ran before
            self.show(*self.lines.get())
        command = re.sub(r"\{(\S+)\}", lambda match: self.pids[match[1]], command)
        command = os.path.expandvars(command)
        self.say(f"\n$ {command}\n", "1")
        program = subprocess.Popen(
            shlex.split(command),
            cwd=self.folder.name,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            start_new_session=True,
        )
        self.programs.append((command, program))
        reader = threading.Thread(target=self._read, args=(command, program), daemon=True)
        reader.start()
        return program, reader

    def run(self, command):
        """Run a command to its end."""
        program, reader = self.start(command)
        program.wait(DEADLINE)
        reader.join(DEADLINE)

    def wait_for_end(self, command):
        """Wait until the newest program of a command has ended by itself.

        A roslaunch that was about to end has once hung because it got Ctrl-C, too.
        """
        _, program = self.programs[self._newest(command)]
        try:
            program.wait(DEADLINE)
        except subprocess.TimeoutExpired:
            raise NotSeenError(f"expected the end of {command} within {DEADLINE:.0f} s") from None

    def _read(self, command, program):
        hidden = command.startswith("roslaunch")  # until its summary has ended
        for line in program.stdout:
            text = ESCAPES.sub("", line).rstrip()
            hidden = hidden and not re.match("ROS_MASTER_URI|RLException", text)
            if text and not hidden:
                self.lines.put((program, text))

    def wait(self, patterns, mark="", never=None):
        """Print lines until each pattern has been seen, and mark them.

        What a node in Python says is marked, too, if that in C++ is looked for, and the other way
        round. Of lines that only differ in their numbers, the first one is marked.

        Raises NotSeenError if one of them does not come, or a line comes that must not.
        """
        left = [patterns] if isinstance(patterns, str) else list(patterns)
        of_both = re.compile(
            "|".join(re.sub(r"_(py|cpp)(?![a-z])", r"_(?:py|cpp)", p) for p in left)
        )
        marked = set()  # lines without their numbers
        end = time.monotonic() + DEADLINE
        while left:
            try:
                program, line = self.lines.get(timeout=max(0.0, end - time.monotonic()))
            except queue.Empty:
                raise NotSeenError(
                    f"expected a line with {left[0]!r} within {DEADLINE:.0f} s"
                ) from None
            started = re.match(r"process\[(\S+)-\d+\]: started with pid \[(\d+)\]", line)
            if started:
                self.pids[started[1]] = started[2]
            if never and re.search(never, line):
                raise NotSeenError(f"expected no such line: {line}")
            missing = [pattern for pattern in left if not re.search(pattern, line)]
            without_numbers = re.sub(r"\b[\d.]+", "", line)
            first = of_both.search(line) and without_numbers not in marked
            if mark and (first or len(missing) < len(left)):
                marked.add(without_numbers)
                self.say(line + mark, "1;32")
            else:
                self.show(program, line)
            left = missing

    def show(self, program, line):
        """Print a line, unless it is to be hidden, or its program has been ended."""
        if not self.hide.search(line) and any(program is running for _, running in self.programs):
            self.say(line)

    def say(self, text, style=""):
        print(f"\x1b[{style}m{text}\x1b[0m" if style and self.colour else text, flush=True)

    def _newest(self, command):
        return max(n for n, (started, _) in enumerate(self.programs) if started.startswith(command))

    def end(self, command):
        """End the newest program of a command, as Ctrl-C does, and wait for it.

        A node in Python may hang if Ctrl-C comes while it publishes: rospy's handler closes the
        topic, and waits for the lock that publish() holds (QueuedConnection in tcpros_pubsub.py).
        """
        command, program = self.programs.pop(self._newest(command))
        # A roslaunch that had only begun to start may have lost the first. The second ends it and
        # its nodes, which SIGKILL would leave behind.
        for number in (signal.SIGINT, signal.SIGTERM):
            if program.poll() is None:
                os.killpg(program.pid, number)
                try:
                    program.wait(GRACE)
                except subprocess.TimeoutExpired:
                    self.say(f"{GRACE} s after {number.name}, it still runs: {command}")
        if program.poll() is None:
            self.say("So it is killed.")
            os.killpg(program.pid, signal.SIGKILL)
            program.wait()


def use_free_master():
    """Use the master's port that the environment names if it is free; else another one, and say so.

    A lab brings its own master: some labs leave parameters on it that would stop other nodes.
    """
    port = urllib.parse.urlsplit(os.environ.get("ROS_MASTER_URI", "")).port or 11311
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("", port))
        except OSError:
            probe.bind(("", 0))
            print(
                "Another master is running, so this lab uses its own. To look at it from a second"
            )
            print(
                f"terminal, type: export ROS_MASTER_URI=http://localhost:{probe.getsockname()[1]}\n"
            )
        os.environ["PORT"] = str(probe.getsockname()[1])
    # With these, a node prints each line at once also into a pipe.
    os.environ.update(ROSCONSOLE_STDOUT_LINE_BUFFERED="1", PYTHONUNBUFFERED="1")
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{os.environ['PORT']}"


def run(name, entry):
    """Run a lab. Raises NotSeenError if it does not show what it claims."""
    print(f"{name}: {claim_of(name)}\n\nThe launch file: {launch_file(name)}")
    use_free_master()
    with Run(entry.get("hide")) as lab:
        for step in steps_of(name, entry):
            if "look" in step:
                lab.wait(step["look"], MARK, step.get("never"))
            elif "wait" in step:
                lab.wait(step["wait"])
            elif "run" in step:
                lab.run(step["run"])
            elif "stop" in step:
                lab.end(step["stop"])
            elif "ends" in step:
                lab.wait_for_end(step["ends"])
            else:
                lab.start(step["start"])
        print("\nThat's it: ending the lab ...", flush=True)
    print("\n" + textwrap.fill(f"What you saw: {entry['sum up']}", 98))


def find(name):
    """Return the lab's entry, or exit with a sentence that says which labs exist."""
    labs = {name: entry for section in read_labs().values() for name, entry in section.items()}
    if name in labs:
        return labs[name]
    near = [lab for lab in labs if name and name in lab]
    near += [lab for lab in difflib.get_close_matches(name, labs, 5, 0.6) if lab not in near]
    found = f"there's no lab {name!r}" if name else "NAME is missing"
    near = f" The closest: {', '.join(near)}." if near else ""
    sys.exit(f"error: expected make lab NAME=LAB; {found}.{near} All {len(labs)}: make labs ALL=1")


def main():
    parser = argparse.ArgumentParser(description="Run a lab, and mark what shows its claim.")
    parser.add_argument("name", nargs="?", default="", help="of the lab, such as latch")
    parser.add_argument("--list", action="store_true", help="list ten labs to start with instead")
    parser.add_argument("--all", action="store_true", help="list all of them")
    parser.add_argument("--check", action="store_true", help="only say whether there is such a lab")
    options = parser.parse_args()
    if options.list:
        return print_list(options.all)
    entry = find(options.name)
    if options.check:
        return None
    try:
        return run(options.name, entry)
    except NotSeenError as error:
        sys.exit(f"\nerror: {error}")
    except KeyboardInterrupt:
        sys.exit("\nStopped: everything the lab started has ended.")


if __name__ == "__main__":
    main()
