# SPDX-License-Identifier: BSD-3-Clause
"""What compare.py knows by name: one way to go faster, and the plain code beside it."""

import typing


class Comparison(typing.NamedTuple):
    """text: what is compared. stream: size in bytes, messages per second, how many; see plans.py.

    ways: see ways.py
    """

    text: str
    stream: typing.Tuple[int, int, int]
    ways: typing.Tuple[str, ...]


# Messages of 8 bytes one at a time, as many as go, and large ones.
SMALL, BURST, LARGE = (8, 1000, 500), (8, 0, 5000), (1 << 20, 50, 50)

COMPARISONS = {
    "async_spinner": Comparison(
        "an AsyncSpinner: a free one of its own threads takes the message",
        SMALL,
        ("cpp_cpp", "cpp_async"),
    ),
    "batching": Comparison(
        "a hundred values in one message, which share what a message costs",
        (8, 0, 20000),
        ("cpp_cpp", "cpp_batch", "py_unqueued", "py_batch"),
    ),
    "buff_size": Comparison(
        "rospy's buff_size: how much a subscriber reads at once, by default less than a message",
        LARGE,
        ("py_py", "py_buff_size"),
    ),
    "direct_queue": Comparison(
        "a callback queue of one's own (direct_queue.h), which calls back in the receiving thread",
        SMALL,
        ("cpp_cpp", "cpp_direct"),
    ),
    "many_subscribers": Comparison(
        "four subscribers: each message is serialised once, and sent four times",
        (65536, 200, 100),
        ("cpp_cpp", "cpp_to_4", "py_py", "py_to_4"),
    ),
    "nodelets": Comparison(
        "two nodelets in one manager: a message passes the sockets by, as a shared pointer",
        LARGE,
        ("cpp_cpp", "cpp_shared", "cpp_nodelet"),
    ),
    "one_process": Comparison(
        "one process: published as a shared pointer, a message is not copied",
        LARGE,
        ("cpp_cpp", "cpp_one_process", "cpp_shared", "cpp_shared_direct"),
    ),
    "serialised": Comparison(
        "a message that is bytes already: publish() has nothing to serialise",
        LARGE,
        ("py_py", "py_serialised"),
    ),
    "tcp_no_delay": Comparison(
        "tcpNoDelay: a message does not wait until the one before it is acknowledged",
        (4096, 1000, 500),
        ("cpp_cpp", "cpp_no_delay", "py_py", "py_no_delay"),
    ),
    "timer_slack": Comparison(
        "rospy's time.sleep(0) after each message, without Linux's timer slack of 50 us",
        BURST,
        ("py_py", "py_timer_slack", "py_unqueued"),
    ),
    "unqueued": Comparison(
        "rospy's queue_size=None: publish() itself sends, and waits for the slowest subscriber",
        BURST,
        ("py_py", "py_unqueued"),
    ),
    "unqueued_latency": Comparison(
        "the same one message at a time: it does not go through another thread",
        SMALL,
        ("py_py", "py_unqueued", "py_unqueued_cpp_direct"),
    ),
}
