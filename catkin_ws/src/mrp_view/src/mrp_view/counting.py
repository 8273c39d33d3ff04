# SPDX-License-Identifier: BSD-3-Clause
"""Count what one publisher sends on one topic: exactly, however few messages are looked at."""

import collections
import struct
import threading

SAMPLES = 5  # messages that are kept from one look to the next
_TOO_LARGE = 8_000_000  # bytes: of a larger message only the size is kept
_WINDOW = 5.0  # seconds over which a rate is taken
_STEPS = 4096  # differences that are told apart


class Gaps:
    """How many values are missing in what a publisher counts.

    A publisher may count in any step: the usual one is the step, and a difference of n steps means
    that n - 1 values are missing. A value that is smaller than the one before means that the
    publisher began anew.
    """

    def __init__(self, modulus):
        self._modulus = modulus
        self._last = None
        self._differences = collections.Counter()
        self.restarts = 0

    def add(self, value):
        if self._last is not None:
            difference = (value - self._last) % self._modulus
            if difference > self._modulus // 2:
                self.restarts += 1
            elif difference in self._differences or len(self._differences) < _STEPS:
                self._differences[difference] += 1
        self._last = value

    def missing(self):
        """Return the number of missing values; or None as long as no step can be seen: before the
        third value, and if not at least half of the differences are the same one."""
        total = sum(self._differences.values())
        if total < 2:
            return None
        (step, often), *_ = self._differences.most_common(1)
        if step == 0 or often * 2 < total:
            return None
        return sum(
            (difference // step - 1) * count
            for difference, count in self._differences.items()
            if difference and difference % step == 0
        )


class Sender:
    """What one publisher has sent on one topic.

    count: messages since the first one that was heard
    size: bytes of the last one

    counter: (read, modulus, name) as fields.counter_of returns it, or None
    stamp_of: how to read the stamp in a raw message, or None
    """

    def __init__(self, counter=None, stamp_of=None):
        self.count = 0
        self.size = 0
        self.last = 0.0  # when the last message came, in seconds since the epoch
        self.latency = None  # seconds, of the last message that had a stamp
        self._read, modulus, self.counted = counter or (None, 1, None)
        self._gaps = Gaps(modulus) if counter else None
        self._stamp_of = stamp_of
        self._samples = collections.deque(maxlen=SAMPLES)
        self._rate_at = collections.deque()
        self._rate = 0.0
        self._lock = threading.Lock()

    def add(self, now, raw, clock):
        """Count a raw message. now: seconds since the epoch; clock(): ROS's time, for the latency.

        A publisher may send what is no message of its type: then nothing in it is looked at.
        """
        with self._lock:
            self.count += 1
            self.last = now
            self.size = len(raw)
            self._samples.append((now, raw if self.size <= _TOO_LARGE else self.size))
            try:
                if self._gaps is not None:
                    self._gaps.add(self._read(raw))
                if self._stamp_of is not None:
                    stamp = self._stamp_of(raw)
                    self.latency = None if stamp is None else clock() - stamp
            except struct.error:
                self._gaps = None

    def take(self):
        """Return (count, the last SAMPLES messages, or their sizes, since it was called before)."""
        with self._lock:
            samples = list(self._samples)
            self._samples.clear()
            return self.count, samples

    def missing(self):
        """Return (missing values, restarts), or None: see Gaps."""
        with self._lock:
            missing = self._gaps.missing() if self._gaps else None
            return None if missing is None else (missing, self._gaps.restarts)

    def rate(self, now):
        """Return messages per second, over the last seconds; a new one once a second, or when the
        first messages come. To be called more often than that."""
        at = self._rate_at
        if not at or now - at[-1][0] >= 1:
            at.append((now, self.count))
            while len(at) > 2 and now - at[1][0] >= _WINDOW:
                at.popleft()
            seconds = now - at[0][0]
            self._rate = (self.count - at[0][1]) / seconds if seconds else 0.0
        return self._rate
