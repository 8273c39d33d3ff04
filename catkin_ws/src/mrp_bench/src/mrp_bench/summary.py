# SPDX-License-Identifier: BSD-3-Clause
"""What follows from the samples: a row for each way and Stream, beside the limits."""

import collections

import numpy

from mrp_bench import stats
from mrp_bench.ways import LIMITS, WAYS

# The share of a slice's messages that arrive first and are left out of its latencies: until then
# the programs have been woken up, and their caches filled.
_WARM_UP = 0.1

# latency: in us, of the names in stats.PERCENTILES. throughput: messages per second.
# latency_ratio, throughput_ratio: limit's name -> stats.Estimate, without those that were not
#   measured for this Stream, and without itself
# sender_cpu, receiver_cpu: seconds per million messages (None: see programs.Measurement)
# sent, lost, disordered: how many messages, of all receivers, in all rounds
Row = collections.namedtuple(
    "Row",
    "way size rate rounds latency latency_ratio throughput throughput_ratio sender_cpu "
    "receiver_cpu sent lost disordered",
)


class _Round:
    """What one measurement says; see rounds.Results.keep()."""

    def __init__(self, measurement):
        sent = measurement["sent"]
        deliveries = [stats.delivery(sent, pairs) for pairs in measurement["received"]]
        warm_up = int(len(sent) * _WARM_UP)
        latencies = (
            numpy.concatenate([delivery.latencies[warm_up:] for delivery in deliveries]) / 1e3
        )
        self.latencies = latencies if latencies.size else numpy.array([numpy.nan])
        self.sent = len(sent) * len(deliveries)
        self.lost = sum(delivery.lost for delivery in deliveries)
        self.disordered = sum(delivery.disordered for delivery in deliveries)
        arrived = [pairs[-1] for pairs in measurement["received"] if pairs]
        seconds = (max(arrived) - sent[0]) / 1e9 if arrived else numpy.inf
        self.throughput = (self.sent - self.lost) / len(deliveries) / seconds
        self.sender_cpu = measurement["sender_cpu"] / len(sent) * 1e6
        cpu = measurement["receiver_cpu"]
        self.receiver_cpu = None if cpu is None else cpu / self.sent * 1e6


def summarise(measurements):
    """Return the rows, sorted by Stream, and in the order of ways.WAYS."""
    grouped = collections.defaultdict(lambda: collections.defaultdict(list))
    for measurement in sorted(measurements, key=lambda measurement: measurement["round"]):
        stream = (measurement["size"], measurement["rate"])
        grouped[stream][measurement["way"]].append(_Round(measurement))
    rows = []
    for (size, rate), ways in sorted(grouped.items()):
        limits = {name: ways[name] for name in LIMITS if name in ways}
        for name in (name for name in WAYS if name in ways):
            rows.append(_row(name, size, rate, ways[name], limits))
    return rows


def _row(name, size, rate, rounds, limits):
    latencies = [round_.latencies for round_ in rounds]
    throughputs = [[round_.throughput] for round_ in rounds]
    receiver_cpus = [round_.receiver_cpu for round_ in rounds]
    return Row(
        way=name,
        size=size,
        rate=rate,
        rounds=len(rounds),
        latency=stats.percentiles(numpy.concatenate(latencies)),
        # As fast as it goes, messages wait in queues: that says nothing of the way itself.
        latency_ratio={
            limit: stats.ratio(latencies, [round_.latencies for round_ in of_limit])
            for limit, of_limit in limits.items()
            if limit != name and rate
        },
        throughput=stats.median_of_rounds(throughputs),
        throughput_ratio={
            limit: stats.ratio(throughputs, [[round_.throughput] for round_ in of_limit])
            for limit, of_limit in limits.items()
            if limit != name
        },
        sender_cpu=float(numpy.median([round_.sender_cpu for round_ in rounds])),
        receiver_cpu=None if None in receiver_cpus else float(numpy.median(receiver_cpus)),
        sent=sum(round_.sent for round_ in rounds),
        lost=sum(round_.lost for round_ in rounds),
        disordered=sum(round_.disordered for round_ in rounds),
    )
