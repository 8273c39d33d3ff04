# SPDX-License-Identifier: BSD-3-Clause
"""make bench: its statistics, on known data."""

import numpy
import pytest
from mrp_bench import machine, stats, tables

pytestmark = pytest.mark.quick


def test_percentiles_are_values_that_were_measured():
    hundred = numpy.random.default_rng(1).permutation(range(1, 101))
    assert stats.percentiles(hundred) == {"p50": 50, "p90": 90, "p99": 99, "max": 100}
    assert stats.percentiles([3, 1, 2]) == {"p50": 2, "p90": 3, "p99": 3, "max": 3}
    assert stats.percentiles([7]) == {"p50": 7, "p90": 7, "p99": 7, "max": 7}


def test_percentiles_of_nothing_are_an_error():
    with pytest.raises(ValueError, match="expected at least one value"):
        stats.percentiles([])


def test_delivery_in_order_and_whole():
    found = stats.delivery([10, 20, 30], [10, 15, 20, 26, 30, 37])
    assert (list(found.latencies), found.lost, found.disordered) == ([5, 6, 7], 0, 0)


def test_delivery_counts_what_is_lost():
    found = stats.delivery([10, 20, 30], [10, 15, 30, 37])
    assert (list(found.latencies), found.lost, found.disordered) == ([5, 7], 1, 0)
    assert stats.delivery([10, 20], []).lost == 2


def test_delivery_counts_what_comes_late_or_twice():
    assert stats.delivery([10, 20, 30], [10, 40, 30, 41, 20, 42]).disordered == 1
    twice = stats.delivery([10, 20], [10, 40, 20, 41, 20, 42])
    assert (twice.lost, twice.disordered) == (0, 1)


def test_delivery_of_what_was_not_sent_is_an_error():
    with pytest.raises(ValueError, match="found 25, which was not"):
        stats.delivery([10, 20], [10, 11, 25, 26])


def exponential(count, median, number):
    """Return latencies as they are measured: some far above the median."""
    values = numpy.random.default_rng(number).exponential(size=count)
    return list(median * (0.8 + 0.2 * values / numpy.log(2)))


def test_ratio_of_known_distributions():
    ours = [exponential(500, 30, number) for number in range(6)]
    limit = [exponential(500, 12, number + 6) for number in range(6)]
    found = stats.ratio(ours, limit)
    assert found.low < 2.5 < found.high
    assert found.value == pytest.approx(2.5, rel=0.05)
    assert found.high / found.low < 1.1
    assert stats.ratio(ours, limit) == found


@pytest.mark.slow
def test_interval_of_ratio_has_the_true_value_as_often_as_it_says():
    """In 95 of 100, or about; the rounds are six, and each is slower or faster as a whole."""
    hits = 0
    for number in range(100):
        random = numpy.random.default_rng(1000 + number)
        factors = random.lognormal(sigma=0.2, size=6)
        medians = numpy.outer([30, 12], factors) * random.lognormal(sigma=0.05, size=(2, 6))
        ours, limit = (
            [exponential(60, median, random.integers(1 << 30)) for median in side]
            for side in medians
        )
        found = stats.ratio(ours, limit)
        hits += found.low <= 2.5 <= found.high
    assert 88 <= hits


def test_interval_of_ratio_is_wide_when_rounds_differ():
    limit = [exponential(100, 10, number) for number in range(4)]
    steady = [exponential(100, 20, number + 4) for number in range(4)]
    unsteady = [exponential(100, 10 * 2**number, number + 8) for number in range(4)]
    assert not tables.is_noisy(stats.ratio(steady, limit))
    assert tables.is_noisy(stats.ratio(unsteady, limit))


def test_ratio_needs_the_same_rounds():
    with pytest.raises(ValueError, match="expected the same number of rounds, found 2 and 1"):
        stats.ratio([[1], [2]], [[1]])
    with pytest.raises(ValueError, match="at least one value in each round"):
        stats.ratio([[1], []], [[1], [1]])


def test_noise_is_the_time_in_long_gaps():
    steady = list(range(0, 1_000_000, 100))
    assert machine.lost_share(steady) == 0
    interrupted = steady + [moment + 2_000_000 for moment in steady]
    assert machine.lost_share(interrupted) == pytest.approx(1 / 3, abs=0.001)


def test_noise_is_judged_by_most_probes():
    assert machine.verdict([0.0, 0.01, 0.9]) is None
    assert "others took 60% of the processors' time" in machine.verdict([0.5, 0.6, 0.9])
