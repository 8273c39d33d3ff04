# SPDX-License-Identifier: BSD-3-Clause
"""The ways in which a message is sent and received, and what each of them sends."""

import collections
import typing

# What is sent: messages of that many bytes, so many per second (0: as fast as it goes), and how
# many.
Stream = collections.namedtuple("Stream", "size rate count")


class Way(typing.NamedTuple):
    """name: as in the results. text: what tables say.

    sender, receiver: the commands, see programs.py; without a receiver the sender is both
    receivers: how many
    """

    name: str
    text: str
    sender: typing.Tuple[str, ...]
    receiver: typing.Optional[typing.Tuple[str, ...]]
    receivers: int = 1

    @property
    def is_raw(self):
        return self.sender[0] == "bench_raw"


CPP, PY = "bench_node", "bench_node.py"


def _way(name, text, sender, receiver, publish=(), subscribe=(), receivers=1):
    """Return the Way of two nodes; publish, subscribe: arguments of the one and of the other."""
    return Way(
        name,
        text,
        (sender, f"publish={receivers}", *publish),
        (receiver, "subscribe=1", *subscribe),
        receivers,
    )


def _one_process(name, text, *arguments):
    return Way(name, text, (CPP, "publish=1", "subscribe=1", *arguments), None)


_ALL = [
    Way("raw", "raw TCP", ("bench_raw",), ("bench_raw", "receive=1")),
    _way("cpp_cpp", "C++ to C++", CPP, CPP),
    _way("cpp_py", "C++ to Python", CPP, PY),
    _way("py_cpp", "Python to C++", PY, CPP),
    _way("py_py", "Python to Python", PY, PY),
    _way("cpp_direct", "C++: callback in the receiving thread", CPP, CPP, (), ("direct=1",)),
    _way("cpp_no_delay", "C++: tcpNoDelay", CPP, CPP, (), ("no_delay=1",)),
    _way("cpp_async", "C++: AsyncSpinner, 2 threads", CPP, CPP, (), ("async=2",)),
    _one_process("cpp_one_process", "C++: one process"),
    _one_process("cpp_shared", "C++: one process, shared pointers", "shared=1"),
    _one_process(
        "cpp_shared_direct",
        "C++: one process, shared pointers, callback in the publishing thread",
        "shared=1",
        "direct=1",
    ),
    _way("cpp_batch", "C++: 100 values in a message", CPP, CPP, ("batch=100",)),
    _way("py_unqueued", "Python: queue_size=None", PY, PY, ("unqueued=1",)),
    _way(
        "py_unqueued_cpp_direct",
        "Python: queue_size=None, to C++: callback in the receiving thread",
        PY,
        CPP,
        ("unqueued=1",),
        ("direct=1",),
    ),
    _way("py_timer_slack", "Python: timer slack of 1 ns", PY, PY, ("timer_slack=1",)),
    _way("py_no_delay", "Python: tcp_nodelay", PY, PY, (), ("no_delay=1",)),
    _way("py_buff_size", "Python: buff_size of 8 MB", PY, PY, (), ("buff_size=8388608",)),
    _way("py_serialised", "Python: publishes bytes", PY, PY, ("serialised=1",)),
    _way("py_batch", "Python: 100 values in a message", PY, PY, ("batch=100",)),
    _way("cpp_to_4", "C++ to 4 subscribers in C++", CPP, CPP, receivers=4),
    _way("py_to_4", "Python to 4 subscribers in Python", PY, PY, receivers=4),
]
WAYS = {way.name: way for way in _ALL}

# What each way is compared with.
LIMIT = "raw"


def size_text(size):
    for unit, factor in (("MB", 1 << 20), ("kB", 1 << 10)):
        if size >= factor:
            return f"{size // factor} {unit}"
    return f"{size} B"


kB, MB = 1 << 10, 1 << 20  # noqa: N816
_PAIRS = ["raw", "cpp_cpp", "cpp_py", "py_cpp", "py_py"]
_FASTER = [
    "cpp_direct",
    "cpp_one_process",
    "cpp_shared",
    "cpp_shared_direct",
    "py_unqueued",
    "py_unqueued_cpp_direct",
]
_FASTER_SMALL = [
    *_FASTER,
    "cpp_no_delay",
    "cpp_async",
    "py_timer_slack",
    "py_no_delay",
    "cpp_to_4",
    "py_to_4",
]
_FASTER_LARGE = [*_FASTER, "cpp_no_delay", "py_no_delay", "py_buff_size", "py_serialised"]
# As fast as it goes, a publisher in Python with a queue takes far longer for as many messages.
_BURST_FAST = [
    "cpp_cpp",
    "cpp_py",
    *_FASTER,
    "cpp_no_delay",
    "cpp_async",
    "cpp_to_4",
    "py_batch",
]
_BURST_SLOW = ["py_cpp", "py_py", "py_timer_slack", "py_no_delay", "py_to_4"]


def steps(ways, *streams):
    """Return (way, Stream) for each of the ways and streams."""
    return [(way, Stream(*stream)) for stream in streams for way in ways]


# A stream takes long enough that the kernel's buffers do not hold all of it.
PLAN = [
    *steps(_PAIRS + _FASTER_SMALL, (8, 1000, 500)),
    # At 1 kB TCP may hold a message back until the one before it is acknowledged.
    *steps([*_PAIRS, "cpp_no_delay", "py_no_delay"], (kB, 1000, 300)),
    *steps(_PAIRS, (64 * kB, 500, 150), (4 * MB, 20, 12)),
    *steps(["cpp_shared"], (4 * MB, 20, 12)),
    *steps(_PAIRS + _FASTER_LARGE, (MB, 50, 25)),
    *steps(["raw", "cpp_batch"], (8, 0, 200000)),
    *steps(_BURST_FAST, (8, 0, 50000)),
    *steps(_BURST_SLOW, (8, 0, 10000)),
    *steps(_PAIRS + _FASTER_LARGE, (MB, 0, 100)),
]
