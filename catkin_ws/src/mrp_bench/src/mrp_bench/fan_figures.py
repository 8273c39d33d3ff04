# SPDX-License-Identifier: BSD-3-Clause
"""What follows from the fans (fans.py): what each number of nodes costs, and how that grows."""

import collections

from mrp_bench import stats
from mrp_bench.fans import LANGUAGES, PIECE

# What is fitted.
_COSTS = (
    *("up", "cores", "publisher_megabytes", "subscriber_megabytes"),
    *("p50", "p99", "per_second"),
)

# The side of which there are many, in the order of the tables; one to one is in both.
_SIDES = ("publishers", "subscribers")

# The share of the messages that are sent first and are left out of the latencies: until then the
# nodes have been woken up.
_WARM_UP = 0.1

# The share of the processors' time above which they count as full: the nodes do not get all of it.
_FULL = 0.9


def figures(fan):
    """Return a dictionary of all in _COSTS, of "sent" and of "lost"; fan: of fans.measure()."""
    sent = sorted(fan["sent"])
    warm = sent[int(len(sent) * _WARM_UP)]
    latencies = []
    lost = 0
    for received in fan["received"]:
        pairs = list(zip(received[::2], received[1::2]))
        # A stamp may be there twice: of two publishers at the same nanosecond.
        missing = collections.Counter(sent) - collections.Counter(received[::2])
        lost += sum(missing.values())
        latencies += [(arrival - stamp) / 1e3 for stamp, arrival in pairs if stamp >= warm]
    arrived = len(sent) * len(fan["received"]) - lost
    seconds = (max(max(received[1::2]) for received in fan["received"] if received) - sent[0]) / 1e9
    percentiles = stats.percentiles(latencies)
    return {
        **{name: fan[name] for name in ("up", "publisher_megabytes", "subscriber_megabytes")},
        "cores": (fan["sender_cpu"] + fan["receiver_cpu"]) / seconds,
        "p50": percentiles["p50"],
        "p99": percentiles["p99"],
        "per_second": arrived / seconds,
        "sent": arrived + lost,
        "lost": lost,
    }


def series(fans):
    """Return pairs of a language and a direction -> how many nodes -> figures()."""
    found = {(language, side): {} for side in _SIDES for language in LANGUAGES}
    for fan in fans:
        for side, other in (("publishers", "subscribers"), ("subscribers", "publishers")):
            if fan[other] == 1:
                found[fan["language"], side][fan[side]] = figures(fan)
    return {key: of for key, of in found.items() if of}


def exponents(of):
    """Return a figure's name -> stats.Estimate of its growth; of: how many nodes -> figures().

    Empty if there are fewer than three numbers of nodes.
    """
    if len(of) < 3:
        return {}
    return {name: stats.exponent(list(of), [one[name] for one in of.values()]) for name in _COSTS}


def full_at(of, cores):
    """Return the smallest number of nodes that fill so many cores, or None."""
    return next((count for count, one in of.items() if one["cores"] > _FULL * cores), None)


def summarise(fans, cores):
    """Return what results.json says of fans. cores: of this machine."""
    return {
        "size": PIECE.size,
        "rate": PIECE.rate,
        "series": [
            {
                "language": LANGUAGES[language][0],
                "side": side,
                "figures": [{"nodes": count, **one} for count, one in of.items()],
                "exponents": exponents(of),
                "full_at": full_at(of, cores),
            }
            for (language, side), of in series(fans).items()
        ],
    }
