# SPDX-License-Identifier: BSD-3-Clause
"""Fans: many publishers to one subscriber, and one publisher to many subscribers."""

import json
import time

from mrp_bench import noise
from mrp_bench.programs import Running, Slice
from mrp_bench.ways import CPP, PY, Way

# Each publisher sends 8 bytes at 100 Hz for a second, as fast sensors do. So in both directions
# there are as many messages as connections; they come in bursts, as all publishers begin at once.
# At 100 connections that is about what two cores can do; at 10 Hz little but the start would grow.
PIECE = Slice(size=8, rate=100, count=100)

LANGUAGES = {"cpp": ("C++", CPP), "py": ("Python", PY)}


def _way(language, publishers, subscribers):
    text, program = LANGUAGES[language]
    # The queues are unlimited: what does not keep up shows in the latency.
    both = ("only_small=1", "queue=0")
    return Way(
        name=f"{language}_{publishers}_to_{subscribers}",
        text=f"{text}, {publishers} to {subscribers}",
        sender=(program, f"publish={subscribers}", *both),
        receiver=(program, "subscribe=1", *both),
        receivers=subscribers,
        senders=publishers,
    )


def measure(language, publishers, subscribers, results):
    """Start that many nodes, let them talk, and end them; return what happened.

    up: seconds from the start of the first process until all are connected. publisher_megabytes,
    subscriber_megabytes: of one node. The rest is as in programs.Measurement.
    """
    results.keep_noise(noise.measure())
    way, log = _way(language, publishers, subscribers), results.folder / "programs.log"
    begin = time.monotonic()
    with Running(way, log) as running:
        running.start()
        running.connect()
        up = time.monotonic() - begin
        memory = {
            f"{name}_megabytes": sum(node.megabytes() for node in nodes) / len(nodes)
            for name, nodes in (("publisher", running.senders), ("subscriber", running.receivers))
        }
        measurement = running.measure(PIECE)
    return {
        "language": language,
        "publishers": publishers,
        "subscribers": subscribers,
        "up": up,
        **memory,
        **measurement._asdict(),
    }


def run(counts, results, say):
    """Measure each number of nodes on either side; keep what is found in the results' folder."""
    folder = results.folder / "fans"
    folder.mkdir(exist_ok=True)
    # One to one is in both directions.
    sides = dict.fromkeys(pair for count in counts for pair in ((count, 1), (1, count)))
    for language, (text, _) in LANGUAGES.items():
        for publishers, subscribers in sides:
            path = folder / f"{language}_{publishers}_to_{subscribers}.json"
            line = f"{text}, publishers to subscribers: {publishers} to {subscribers}"
            results.once(
                path, lambda: measure(language, publishers, subscribers, results), say, line
            )


def load(results):
    """Return all that run() has kept, sorted by the number of nodes."""
    paths = (results.folder / "fans").glob("*.json")
    return sorted(
        (json.loads(path.read_text()) for path in paths),
        key=lambda one: (one["publishers"], one["subscribers"]),
    )
