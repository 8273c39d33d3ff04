# SPDX-License-Identifier: BSD-3-Clause
"""The ways in which a message is sent and received, and what each of them sends."""

import collections
import typing

# What is sent: messages of that many bytes, so many per second (0: as fast as it goes), and how
# many.
Stream = collections.namedtuple("Stream", "size rate count")


class Way(typing.NamedTuple):
    """text: what tables say.

    publisher, subscriber: programs with their own parameters; None: the publisher is both
    subscribers: how many
    """

    text: str
    publisher: str
    subscriber: typing.Optional[str]
    subscribers: int = 1


CPP, PY = "bench_node", "bench_node.py"

# What each way is compared with.
LIMIT = "raw"

WAYS = {
    LIMIT: Way("raw TCP", "bench_raw", "bench_raw"),
    "cpp_cpp": Way("C++ to C++", CPP, CPP),
    "cpp_py": Way("C++ to Python", CPP, PY),
    "py_cpp": Way("Python to C++", PY, CPP),
    "py_py": Way("Python to Python", PY, PY),
    "cpp_direct": Way("C++: callback in the receiving thread", CPP, f"{CPP} _direct:=true"),
    "cpp_no_delay": Way("C++: tcpNoDelay", CPP, f"{CPP} _no_delay:=true"),
    "cpp_one_process": Way("C++: one process", f"{CPP} _subscribe:=true", None),
    "cpp_shared": Way(
        "C++: one process, shared pointers", f"{CPP} _subscribe:=true _shared:=true", None
    ),
    "cpp_shared_direct": Way(
        "C++: one process, shared pointers, callback in the publishing thread",
        f"{CPP} _subscribe:=true _shared:=true _direct:=true",
        None,
    ),
    "cpp_batch": Way("C++: 100 values in a message", f"{CPP} _batch:=100", f"{CPP} _batch:=100"),
    "py_unqueued": Way("Python: queue_size=None", f"{PY} _unqueued:=true", PY),
    "py_timer_slack": Way("Python: timer slack of 1 ns", f"{PY} _timer_slack:=1", PY),
    "py_batch": Way("Python: 100 values in a message", f"{PY} _batch:=100", f"{PY} _batch:=100"),
    "cpp_to_4": Way("C++ to 4 subscribers in C++", CPP, CPP, 4),
    "py_to_4": Way("Python to 4 subscribers in Python", PY, PY, 4),
}

kB, MB = 1 << 10, 1 << 20  # noqa: N816


def size_text(size):
    for unit, factor in (("MB", MB), ("kB", kB)):
        if size >= factor:
            return f"{size // factor} {unit}"
    return f"{size} B"


def steps(ways, *stream):
    """Return (way, Stream) for each of the ways."""
    return [(way, Stream(*stream)) for way in ways]


PAIRS = ["raw", "cpp_cpp", "cpp_py", "py_cpp", "py_py"]
_FASTER = ["cpp_direct", "cpp_one_process", "cpp_shared", "cpp_shared_direct", "py_unqueued"]

# A stream takes long enough that the kernel's buffers do not hold all of it. As fast as it goes, a
# publisher in Python with a queue takes far longer for as many messages.
PLAN = [
    *steps([*PAIRS, *_FASTER, "py_timer_slack", "cpp_no_delay"], 8, 1000, 500),
    *steps(["cpp_to_4", "py_to_4"], 8, 1000, 500),
    # At 1 kB TCP may hold a message back until the one before it is acknowledged.
    *steps([*PAIRS, "cpp_no_delay"], kB, 1000, 300),
    *steps(PAIRS, 64 * kB, 500, 150),
    *steps([*PAIRS, *_FASTER, "cpp_no_delay"], MB, 50, 25),
    *steps(["raw", "cpp_batch"], 8, 0, 200000),
    *steps(["cpp_cpp", "cpp_py", *_FASTER, "cpp_no_delay", "cpp_to_4", "py_batch"], 8, 0, 50000),
    *steps(["py_cpp", "py_py", "py_timer_slack", "py_to_4"], 8, 0, 10000),
    *steps([*PAIRS, *_FASTER, "cpp_no_delay"], MB, 0, 100),
]
