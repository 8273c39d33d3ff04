# SPDX-License-Identifier: BSD-3-Clause
"""The contract of the tutorial, for every test: names, values and console lines."""

import collections
import re

from mrp_testing import log_line

PACKAGE = "mrp"
LAUNCH_FILE = "pub_sub.launch"
GROUP = "/mrp"
TOPIC = "great_topic"
TYPE = "std_msgs/UInt32"

QUEUE_SIZE = 10  # of each publisher and each subscriber, in messages
PERIOD = 0.5  # seconds from one message of a publisher to its next
STEP = 2
MODULUS = 2**32  # a UInt32 wraps round past 2^32-1

Node = collections.namedtuple("Node", "name executable language start_line")

PUBLISHER_CPP = Node(
    "publisher_cpp_node",
    "publisher_cpp_node",
    "C++",
    "[PUBLISHER CPP NODE] namespace of nh = {}",
)
PUBLISHER_PY = Node(
    "publisher_py_node",
    "publisher_py_node.py",
    "Python",
    "[PUBLISHER PY NODE] namespace of node = {}",
)
SUBSCRIBER_CPP = Node(
    "subscriber_cpp_node",
    "subscriber_cpp_node",
    "C++",
    "[SUBSCRIBER CPP NODE] namespace of nh = {}",
)
SUBSCRIBER_PY = Node(
    "subscriber_py_node",
    "subscriber_py_node.py",
    "Python",
    "[SUBSCRIBER PY NODE] namespace of node = {}",
)

PUBLISHERS = (PUBLISHER_CPP, PUBLISHER_PY)
SUBSCRIBERS = (SUBSCRIBER_CPP, SUBSCRIBER_PY)
NODES = PUBLISHERS + SUBSCRIBERS

FIRST_VALUE = {PUBLISHER_CPP: 2, PUBLISHER_PY: 1}
RECEIVED_LINE = {
    SUBSCRIBER_CPP: "[SUBSCRIBER CPP NODE] received message with data = {}",
    SUBSCRIBER_PY: "[SUBSCRIBER PY NODE] received message with data = {}",
}


def logged_text(line):
    """Return what a node logged as INFO in a line of the console, or None if it is no such line."""
    logged = log_line.parse(line)
    return logged.text if logged and logged.level == "INFO" else None


def publisher_of(value):
    """Return the publisher that a value comes from: parity is provenance."""
    return PUBLISHER_CPP if value % 2 == 0 else PUBLISHER_PY


def received_value(subscriber, text):
    """Return the value in a subscriber's console line, or None if the line is no such line."""
    before, after = RECEIVED_LINE[subscriber].split("{}")
    match = re.fullmatch(re.escape(before) + r"(\d+)" + re.escape(after), text)
    return int(match.group(1)) if match else None


def first_fault(values):
    """Say where the values of one publisher first leave their sequence, or None if nowhere.

    The sequence is n, n + STEP, n + 2 * STEP, ..., modulo MODULUS; it may begin anywhere.
    """
    for before, value in zip(values, values[1:]):
        expected = (before + STEP) % MODULUS
        if value != expected:
            return f"after {before} came {value}, expected {expected}"
    return None


def runs(values):
    """Split the values of one publisher into runs without a fault."""
    result = []
    for value in values:
        if result and first_fault([result[-1][-1], value]) is None:
            result[-1].append(value)
        else:
            result.append([value])
    return result
