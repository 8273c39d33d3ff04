# SPDX-License-Identifier: BSD-3-Clause
"""Start the measured programs and a master, have messages sent, and collect what arrived.

include/mrp_bench/program.h describes how the programs talk.
"""

import array
import collections
import os
import pathlib
import queue
import re
import signal
import socket
import subprocess
import threading
import time

import rosgraph
import roslib.packages

PACKAGE = "mrp_bench"

# Seconds in which a program must have answered.
DEADLINE = 120

# sent: the stamps, in ns. received: of each receiver, stamps and times of arrival in turns.
# sender_cpu: seconds of processor time. receiver_cpu: that of all receivers, or None if they are
# in the sender's process.
Measurement = collections.namedtuple("Measurement", "sent received sender_cpu receiver_cpu")


class ProgramError(Exception):
    """A measured program did not do what it should."""


class Program:
    """A running program; `name` and `log`, a file, are for error messages."""

    def __init__(self, command, log, namespace):
        self.name = " ".join(command)
        self._log = log
        executable, *arguments = command
        found = roslib.packages.find_node(PACKAGE, executable)
        if not found:
            raise ProgramError(
                f"expected the program {executable} of {PACKAGE}, found none: run make build, and "
                "source catkin_ws/devel/setup.bash"
            )
        with open(log, "ab") as file:
            self._popen = subprocess.Popen(
                with_parent([found[0], *arguments]),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=file,
                env={**os.environ, "ROS_NAMESPACE": namespace},
                # A group of its own: so what it has started stops and ends with it.
                start_new_session=True,
            )
        self._answers = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        with self._popen.stdout as stream:
            for line in stream:
                word, count = line.split()
                numbers = array.array("q")
                numbers.frombytes(stream.read(8 * int(count)))
                self._answers.put((word.decode(), numbers))
        self._answers.put((None, None))

    def tell(self, order):
        try:
            self._popen.stdin.write(order.encode() + b"\n")
            self._popen.stdin.flush()
        except BrokenPipeError:
            pass  # it has ended: answer() says so

    def answer(self, word):
        """Wait for the next answer, which must begin with that word; return its numbers.

        Raises ProgramError if the program ended, or did not answer within DEADLINE.
        """
        try:
            found, numbers = self._answers.get(timeout=DEADLINE)
        except queue.Empty:
            found = f"nothing for {DEADLINE} s"
        if found != word:
            raise ProgramError(
                f"expected of '{self.name}' the answer '{word}', found "
                f"{found or 'its end'}: see {self._log}"
            )
        return numbers

    def cpu(self):
        """Return the processor time that it has used so far, with its children, in seconds."""
        return cpu(tree(self._popen.pid))

    def ask_to_end(self):
        try:
            self._popen.stdin.close()
        except BrokenPipeError:
            pass
        self._popen.send_signal(signal.SIGINT)

    def end(self):
        """Wait for the end; kill what does not end by itself."""
        try:
            self._popen.wait(10)
        except subprocess.TimeoutExpired:
            self._popen.kill()
            self._popen.wait()
        self._reader.join()


class Running:
    """The programs of a way (see ways.py), connected. Use it in a `with`."""

    def __init__(self, way, log):
        self.way = way
        self.receivers = []
        self.sender = None
        self._log = log
        self._namespace = f"/mrp_bench/{way.name}_{os.getpid()}"

    def __enter__(self):
        try:
            if self.way.receiver:
                command = self.way.receiver
                self.receivers = [self._program(command) for _ in range(self.way.receivers)]
            command = self.way.sender
            if self.way.is_raw:
                (port,) = self.receivers[0].answer("port")
                command = (*command, f"send={port}")
            self.sender = self._program(command)
            if not self.way.is_raw:
                for receiver in self.receivers or [self.sender]:
                    receiver.answer("subscribed")
            self.sender.answer("ready")
        except BaseException:
            self.__exit__()
            raise
        return self

    def _program(self, command):
        return Program(command, self._log, self._namespace)

    def measure(self, stream):
        """Let the sender send a Stream, and return what became of it, as a Measurement."""
        sender_cpu, receiver_cpu = self.sender.cpu(), _cpu(self.receivers)
        self.sender.tell(f"run {stream.size} {stream.rate} {stream.count}")
        sent = self.sender.answer("sent").tolist()
        self.sender.tell("end")
        received = [
            receiver.answer("received").tolist() for receiver in self.receivers or [self.sender]
        ]
        sender_cpu = self.sender.cpu() - sender_cpu
        receiver_cpu = _cpu(self.receivers) - receiver_cpu
        return Measurement(sent, received, sender_cpu, receiver_cpu if self.receivers else None)

    def __exit__(self, *exception):
        programs = [*self.receivers, *filter(None, [self.sender])]
        for program in programs:
            program.ask_to_end()
        for program in programs:
            program.end()


def _cpu(programs):
    return sum(program.cpu() for program in programs)


def with_parent(command, number=signal.SIGKILL):
    """Return a command whose program gets that signal when the thread that started it ends.

    A process that is killed can't end what it has started, but the kernel still does.
    """
    # setpriv becomes the program: there is no other process.
    return ["setpriv", "--pdeathsig", signal.Signals(number).name, *command]


def tree(pid):
    """Return the process ids of a process and of all its descendants that run."""
    pids = [pid]
    for task in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            for child in task.read_text().split():
                pids += tree(int(child))
        except (FileNotFoundError, ProcessLookupError):
            pass  # it has just ended
    return pids


def cpu(pids):
    """Return the processor time that all threads of these processes have used, in seconds."""
    nanoseconds = 0
    for pid in pids:
        for path in pathlib.Path(f"/proc/{pid}/task").glob("*/schedstat"):
            try:
                nanoseconds += int(path.read_text().split()[0])
            except (FileNotFoundError, ProcessLookupError):
                pass  # it has just ended
    return nanoseconds / 1e9


def megabytes(pid):
    """Return the memory of a process; what several share is divided among them (proc(5): Pss)."""
    text = pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text()
    return int(re.search(r"^Pss:\s*(\d+)", text, re.MULTILINE).group(1)) / 1024


class Master:
    """roscore on a free port, of which all programs know that are started within this `with`.

    log: the file to which what it prints is appended
    """

    def __init__(self, log):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
        with open(log, "ab") as file:
            self._roscore = subprocess.Popen(
                with_parent(["roscore", "-p", str(port)], signal.SIGINT),
                stdout=file,
                stderr=file,
                start_new_session=True,
            )
        while self._roscore.poll() is None and not rosgraph.is_master_online():
            time.sleep(0.02)
        # While it is not set, each node asks for it at each line that it logs.
        rosgraph.Master("/bench").setParam("/rosout_disable_topics_generation", False)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._roscore.send_signal(signal.SIGINT)
        self._roscore.wait()
