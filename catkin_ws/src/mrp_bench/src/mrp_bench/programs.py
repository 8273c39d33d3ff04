# SPDX-License-Identifier: BSD-3-Clause
"""The measured programs: started, told what to send, and asked for what has arrived.

How they talk is said in include/mrp_bench/program.h.
"""

import array
import collections
import os
import queue
import signal
import subprocess
import threading

import roslib.packages

from mrp_bench.processes import cpu, tree, with_parent

PACKAGE = "mrp_bench"

# Seconds in which a program must have answered.
DEADLINE = 120

# What is sent: messages of that many bytes, so many per second (0: as fast as it goes), and how
# many.
Stream = collections.namedtuple("Stream", "size rate count")

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

    def signal(self, number):
        try:
            os.killpg(self._popen.pid, number)
        except ProcessLookupError:
            pass

    def cpu(self):
        """Return the processor time that it has used so far, with its children, in seconds."""
        return cpu(tree(self._popen.pid))

    def ask_to_end(self):
        try:
            self._popen.stdin.close()
        except BrokenPipeError:
            pass
        self.signal(signal.SIGCONT)
        self.signal(signal.SIGINT)

    def end(self):
        """Wait for the end; kill what does not end by itself."""
        try:
            self._popen.wait(10)
        except subprocess.TimeoutExpired:
            pass
        self.signal(signal.SIGKILL)
        self._popen.wait()
        self._reader.join()


class Running:
    """The programs of a way (see ways.py), which stand still until they are needed.

    They are started by start(), which several of these do at once, and then finished by connect().
    Use it in a `with`.
    """

    def __init__(self, way, log):
        self.way = way
        self.receivers = []
        self.sender = None
        self._log = log
        self._namespace = f"/mrp_bench/{way.name}_{os.getpid()}"

    def start(self):
        if self.way.receiver:
            self.receivers = [self._program(self.way.receiver) for _ in range(self.way.receivers)]
        if not self.way.is_raw:
            self.sender = self._program(self.way.sender)

    def _program(self, command):
        return Program(command, self._log, self._namespace)

    def connect(self):
        if self.way.is_raw:
            (port,) = self.receivers[0].answer("port")
            self.sender = self._program([self.way.sender[0], f"send={port}"])
        for receiver in self.receivers or [self.sender]:
            if not self.way.is_raw:
                receiver.answer("subscribed")
        self.sender.answer("ready")
        self.signal(signal.SIGSTOP)

    def measure(self, stream):
        """Let the sender send a Stream, and return what became of it, as a Measurement."""
        self.signal(signal.SIGCONT)
        sender_cpu, receiver_cpu = self.sender.cpu(), _cpu(self.receivers)
        self.sender.tell(f"run {stream.size} {stream.rate} {stream.count}")
        sent = self.sender.answer("sent").tolist()
        self.sender.tell("end")
        received = [
            receiver.answer("received").tolist() for receiver in self.receivers or [self.sender]
        ]
        sender_cpu = self.sender.cpu() - sender_cpu
        receiver_cpu = _cpu(self.receivers) - receiver_cpu
        self.signal(signal.SIGSTOP)
        return Measurement(sent, received, sender_cpu, receiver_cpu if self.receivers else None)

    def _programs(self):
        return [*self.receivers, *filter(None, [self.sender])]

    def signal(self, number):
        for program in self._programs():
            program.signal(number)

    def ask_to_end(self):
        for program in self._programs():
            program.ask_to_end()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.ask_to_end()
        for program in self._programs():
            program.end()


def _cpu(programs):
    return sum(program.cpu() for program in programs)
