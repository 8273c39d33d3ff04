# SPDX-License-Identifier: BSD-3-Clause
"""Start the measured programs and a master, and read what arrived."""

import contextlib
import os
import socket
import subprocess
import tempfile
import time
import typing

import numpy
import rosgraph
import roslib.packages

from mrp_bench.ways import LIMIT, WAYS

# Seconds in which the programs must have done their work.
DEADLINE = 120


class ProgramError(Exception):
    """A measured program did not do what it should."""


class Measurement(typing.NamedTuple):
    """latencies: in µs, in the order of arrival; of several subscribers, one after another

    throughput: messages per second
    sender_cpu, receiver_cpu: seconds of processor time per million messages; receiver_cpu is None
        if the receiver is in the sender's process
    """

    latencies: numpy.ndarray
    throughput: float
    sender_cpu: float
    receiver_cpu: typing.Optional[float]


@contextlib.contextmanager
def master(log):
    """Run a master on a free port, of which all programs know that are started meanwhile.

    log: a file for what it prints
    """
    with socket.create_server(("localhost", 0)) as probe:
        port = probe.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    command = ["rosmaster", "--core", "-p", str(port)]
    with open(log, "ab") as file:
        process = subprocess.Popen(command, stdout=file, stderr=file, start_new_session=True)
    try:
        while process.poll() is None and not rosgraph.is_master_online():
            time.sleep(0.02)
        yield
    finally:
        process.kill()
        process.wait()


def measure(name, stream, log):
    """Send a Stream in a way, and return what became of it, as a Measurement.

    log: a file for what the programs print beside their results
    Raises ProgramError if a program doesn't end by itself, or if a message is lost or late.
    """
    with contextlib.ExitStack() as stack:
        start = _start_raw if name == LIMIT else _start_nodes
        sender, *receivers = (
            stack.enter_context(program) for program in start(WAYS[name], stream, stack, log)
        )
        for program in receivers or [sender]:
            program.wait(sender, *receivers)
        sender.stop_waiting()
        sender.wait()
        (sender_cpu, pairs), *others = (program.result() for program in [sender, *receivers])
    received = [pairs for _, pairs in others] or [pairs]
    for pairs in received:
        stamps = pairs[:, 0]
        if len(stamps) != stream.count or (stamps[1:] <= stamps[:-1]).any():
            raise ProgramError(f"expected {stream.count} messages in order in {name}: see {log}")
    begin, end = min(pairs[0, 0] for pairs in received), max(pairs[-1, 1] for pairs in received)
    # The first messages wake the programs up, and fill caches.
    late = [(pairs[:, 1] - pairs[:, 0])[stream.count // 10 :] for pairs in received]
    return Measurement(
        numpy.concatenate(late) / 1e3,
        stream.count / (end - begin) * 1e9,
        sender_cpu / stream.count / 1e3,
        sum(cpu for cpu, _ in others) / stream.count / len(others) / 1e3 if others else None,
    )


def _start_nodes(way, stream, stack, log):
    """Yield the sender and the receivers."""
    settings = [f"_{name}:={value}" for name, value in stream._asdict().items()]
    # A topic of their own: the master may still know the nodes of the stream before.
    settings.append(f"__ns:=/stream_{time.monotonic_ns()}")
    yield Program(log, *way.publisher.split(), f"_publish:={way.subscribers}", *settings)
    if way.subscriber:
        for _ in range(way.subscribers):
            yield Program(log, *way.subscriber.split(), "_subscribe:=true", *settings)


def _start_raw(way, stream, stack, log):
    """Yield the sender and the receiver, which have the two ends of a connection."""
    server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
    client = stack.enter_context(socket.create_connection(server.getsockname()))
    client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    accepted = stack.enter_context(server.accept()[0])
    for task, end in (("send", client), ("receive", accepted)):
        number = end.fileno()
        yield Program(log, way.publisher, task, number, *stream, pass_fds=[number])


class Program:
    """A running program of this package. arguments: texts or numbers; log: for its stderr"""

    def __init__(self, log, executable, *arguments, pass_fds=()):
        found = roslib.packages.find_node("mrp_bench", executable)
        if not found:
            raise ProgramError(
                f"expected the program {executable} of mrp_bench, found none: run make build, and "
                "source catkin_ws/devel/setup.bash"
            )
        self._output = tempfile.TemporaryFile("w+")
        with open(log, "ab") as errors:
            self._popen = subprocess.Popen(
                [found[0], *map(str, arguments)],
                stdin=subprocess.PIPE,
                stdout=self._output,
                stderr=errors,
                pass_fds=pass_fds,
                # Ctrl-C is for the bench, which then kills this program.
                start_new_session=True,
            )
        self._description = f"{executable} {' '.join(map(str, arguments))}: see {log}"

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._popen.kill()
        self._popen.communicate()
        self._output.close()

    def check(self):
        """Return whether it still runs. Raises ProgramError if it has failed."""
        code = self._popen.poll()
        if code:
            raise ProgramError(f"expected exit code 0, found {code} of {self._description}")
        return code is None

    def wait(self, *others):
        """Wait for the end. Raises ProgramError if this or another program fails before, or if it
        takes too long."""
        end = time.monotonic() + DEADLINE
        while self.check():
            for other in others:
                other.check()
            if time.monotonic() > end:
                raise ProgramError(f"expected the end within {DEADLINE} s of {self._description}")
            time.sleep(0.02)

    def stop_waiting(self):
        """Close its stdin: a sender ends then."""
        self._popen.stdin.close()

    def result(self):
        """Return its processor time, in ns, and an array of stamps and times of arrival."""
        self._output.seek(0)
        numbers = numpy.fromstring(self._output.read(), dtype=numpy.int64, sep=" ")
        return numbers[0], numbers[1:].reshape(-1, 2)
