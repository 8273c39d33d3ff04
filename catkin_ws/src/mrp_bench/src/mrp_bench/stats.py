# SPDX-License-Identifier: BSD-3-Clause
"""Statistics of latencies: percentiles, and ratios with a confidence interval."""

import collections

import numpy

# The percentiles that tables show, and their names.
PERCENTILES = {"p50": 50, "p90": 90, "p99": 99, "max": 100}

# An estimate, and the bounds between which it lies with a confidence of 95 %.
Estimate = collections.namedtuple("Estimate", "value low high")

# Of more samples than that a bootstrap takes a random choice: it would only take longer.
_MOST_SAMPLES = 1000
_RESAMPLES = 1000
_CONFIDENCE = (2.5, 97.5)

Delivery = collections.namedtuple("Delivery", "latencies lost disordered")


def delivery(sent, received):
    """Compare what was sent with what one receiver got.

    sent: the stamps of all messages, in ns, each of them another
    received: pairs of a stamp and the time of arrival, in the order of arrival
    Returns the latencies in ns, in the order of arrival; how many messages were lost; and how many
    arrived after one that was sent later, or for a second time.
    Raises ValueError if something was received that was not sent.
    """
    sent = numpy.asarray(sent, dtype=numpy.int64)
    pairs = numpy.asarray(received, dtype=numpy.int64).reshape(-1, 2)
    stamps = pairs[:, 0]
    unknown = numpy.setdiff1d(stamps, sent)
    if unknown.size:
        raise ValueError(f"expected stamps that were sent, found {unknown[0]}, which was not")
    disordered = 0
    if stamps.size:
        newest_before = numpy.maximum.accumulate(stamps)[:-1]
        disordered = int((stamps[1:] <= newest_before).sum())
    lost = sent.size - numpy.unique(stamps).size
    return Delivery(pairs[:, 1] - stamps, int(lost), disordered)


def percentiles(values):
    """Return name -> value of each of PERCENTILES.

    Each is a value that was measured: the smallest one that is not below that share of all. Raises
    ValueError if there are no values.
    """
    values = numpy.sort(numpy.asarray(values, dtype=float))
    if not values.size:
        raise ValueError("expected at least one value, found none")
    # Whole numbers, rounded up.
    ranks = {name: -(-share * values.size // 100) for name, share in PERCENTILES.items()}
    return {name: float(values[rank - 1]) for name, rank in ranks.items()}


def median_of_rounds(rounds):
    """Return the median of the rounds' medians; rounds: a list of lists of values."""
    return float(numpy.median([numpy.median(values) for values in rounds]))


def ratio(rounds, reference_rounds, seed=0):
    """Return by how much the median of the first is that of the second, as an Estimate.

    Round i of both was measured at about the same time: so the bootstrap draws whole rounds, of
    both the same ones, and then values of each.
    rounds, reference_rounds: lists of equally many lists of values, all above 0
    seed: of the random numbers; with the same one the result is the same
    Raises ValueError if the numbers of rounds differ, or a round is empty.
    """
    if len(rounds) != len(reference_rounds) or not rounds:
        raise ValueError(
            f"expected the same number of rounds, found {len(rounds)} and {len(reference_rounds)}"
        )
    random = numpy.random.default_rng(seed)
    drawn = random.integers(len(rounds), size=(_RESAMPLES, len(rounds)))
    resampled = []
    for side in (rounds, reference_rounds):
        medians = numpy.array([_resampled_medians(values, random) for values in side])
        resampled.append(numpy.median(medians[drawn, numpy.arange(_RESAMPLES)[:, None]], axis=1))
    low, high = numpy.percentile(resampled[0] / resampled[1], _CONFIDENCE)
    value = median_of_rounds(rounds) / median_of_rounds(reference_rounds)
    return Estimate(value, float(low), float(high))


def _resampled_medians(values, random):
    values = numpy.asarray(values, dtype=float)
    if not values.size:
        raise ValueError("expected at least one value in each round, found none")
    size = min(values.size, _MOST_SAMPLES)
    return numpy.median(random.choice(values, size=(_RESAMPLES, size)), axis=1)
