# SPDX-License-Identifier: BSD-3-Clause
"""Waiting for a condition: the only way in which these tests let time pass."""

import os
import time

# Seconds: far more than anything needs, so that a busy machine fails no test. The tests of the
# tests set it lower, because they wait for what never comes.
DEADLINE = float(os.environ.get("MRP_TEST_DEADLINE", 60))


def within(seconds, condition):
    """Return the first true value of condition() within that time, or its last false one."""
    end = time.monotonic() + seconds
    while True:
        result = condition()
        if result or time.monotonic() > end:
            return result
        time.sleep(0.02)


def wait_until(condition, what):
    """Return the first true value of condition().

    what: says what is waited for; it may be a function, to say at the end how far it got

    Raises AssertionError if there was none within DEADLINE.
    """
    result = within(DEADLINE, condition)
    if not result:
        explanation = what() if callable(what) else what
        raise AssertionError(f"waited {DEADLINE:.0f} s in vain: {explanation}")
    return result
