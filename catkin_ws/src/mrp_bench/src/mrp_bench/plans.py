# SPDX-License-Identifier: BSD-3-Clause
"""What `make bench` measures: quickly, or in full."""

from mrp_bench.rounds import steps

kB, MB = 1 << 10, 1 << 20  # noqa: N816

PAIRS = ["raw_cpp", "raw_py", "cpp_cpp", "cpp_py", "py_cpp", "py_py"]
FASTER = [
    "cpp_direct",
    "cpp_one_process",
    "cpp_shared",
    "cpp_shared_direct",
    "cpp_nodelet",
    "py_unqueued",
    "py_unqueued_cpp_direct",
]
FASTER_SMALL = [
    *FASTER,
    "cpp_no_delay",
    "cpp_async",
    "py_timer_slack",
    "py_no_delay",
    "cpp_to_4",
    "py_to_4",
]
FASTER_LARGE = [*FASTER, "cpp_no_delay", "py_no_delay", "py_buff_size", "py_serialised"]
# As fast as it goes, a publisher in Python with a queue takes far longer for as many messages.
BURST_FAST = [
    "cpp_cpp",
    "cpp_py",
    *FASTER,
    "cpp_no_delay",
    "cpp_async",
    "cpp_to_4",
    "py_batch",
]
BURST_SLOW = ["py_cpp", "py_py", "py_timer_slack", "py_no_delay", "py_to_4"]

# A slice takes long enough that the kernel's buffers do not hold all of it.
# (size in bytes, messages per second, how many); a rate of 0 is as fast as it goes.
SMALL, LARGE = (8, 1000, 500), (MB, 50, 25)

QUICK_ROUNDS = 3
QUICK = [
    *steps(PAIRS + FASTER, (8, 1000, 120)),
    *steps(PAIRS, (64 * kB, 500, 40), (4 * MB, 20, 5)),
    *steps(["cpp_shared", "cpp_nodelet"], (4 * MB, 20, 5)),
    *steps(["raw_cpp", "cpp_batch"], (8, 0, 50000)),
    *steps(["raw_py", "cpp_cpp", "cpp_py", "cpp_shared", "cpp_nodelet"], (8, 0, 20000)),
    *steps(["py_unqueued", "py_batch"], (8, 0, 20000)),
    *steps(["py_cpp", "py_py"], (8, 0, 2000)),
]

FULL_ROUNDS = 6
ROBOTS = [1, 2, 5, 10, 20, 50]
FULL = [
    *steps(PAIRS + FASTER_SMALL, SMALL),
    # At 1 kB TCP may hold a message back until the one before it is acknowledged.
    *steps([*PAIRS, "cpp_no_delay", "py_no_delay"], (kB, 1000, 300)),
    *steps(PAIRS, (64 * kB, 500, 150), (4 * MB, 20, 12)),
    *steps(["cpp_shared", "cpp_nodelet"], (4 * MB, 20, 12)),
    *steps(PAIRS + FASTER_LARGE, LARGE),
    *steps(["raw_cpp", "raw_py", "cpp_batch"], (8, 0, 200000)),
    *steps(BURST_FAST, (8, 0, 50000)),
    *steps(BURST_SLOW, (8, 0, 10000)),
    *steps(PAIRS + FASTER_LARGE, (MB, 0, 100)),
]
