# SPDX-License-Identifier: BSD-3-Clause
"""The results in files: results.json, results.csv, table.md and the plots."""

import csv
import json

from mrp_bench import (
    fan_report,
    fans,
    launch_report,
    launches,
    machine,
    noise,
    plots,
    start_report,
    starts,
    summary,
)
from mrp_bench.rounds import size_text
from mrp_bench.stats import PERCENTILES
from mrp_bench.ways import WAYS

NOISY = "too noisy"


def write(results, say):
    """Write all files of a folder of results (rounds.Results)."""
    rows = summary.summarise(results.measurements())
    probes = results.noise()
    facts = machine.describe()
    verdict = noise.verdict(probes)
    started, missing = starts.load(results)
    robots = launches.load(results)
    spread = fans.load(results)
    content = {
        "machine": facts,
        "noise": probes,
        "verdict": verdict,
        "rows": [row._asdict() for row in rows],
        "starts": started,
        "robots": robots,
        "fans": fan_report.rows(spread),
    }
    (results.folder / "results.json").write_text(json.dumps(content, indent=1) + "\n")
    _write_csv(results.folder / "results.csv", rows)
    noisy, cores = NOISY if verdict else None, int(facts["cores"])
    text = markdown(rows, facts, probes) + "\n".join(
        [
            "",
            *start_report.markdown(started, missing, noisy),
            *launch_report.markdown(robots, cores, 1e3 * int(facts["gigabytes"]), noisy),
            *fan_report.markdown(spread, cores, noisy),
        ]
    )
    (results.folder / "table.md").write_text(text)
    plots.draw(rows, started, robots, spread, cores, verdict, results.folder)
    print(text)
    say(f"tables, plots and all samples are in {results.folder}")


def _write_csv(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.writer(file)
        percentiles = [f"{name}_us" for name in PERCENTILES]
        ratios = [
            f"{what}_ratio_{limit}_{bound}"
            for what in ("latency", "throughput")
            for limit in summary.LIMITS
            for bound in ("value", "low", "high")
        ]
        plain = (
            "throughput",
            "sender_cpu",
            "receiver_cpu",
            "sender_switches",
            "sent",
            "lost",
            "disordered",
        )
        table.writerow(["way", "size", "rate", "rounds", *percentiles, *plain, *ratios])
        for row in rows:
            estimates = [
                estimates.get(limit, ("", "", ""))
                for estimates in (row.latency_ratio, row.throughput_ratio)
                for limit in summary.LIMITS
            ]
            table.writerow(
                [row.way, row.size, row.rate, row.rounds]
                + [f"{row.latency[name]:.2f}" for name in PERCENTILES]
                + [getattr(row, name) for name in plain]
                + [bound for estimate in estimates for bound in estimate]
            )


def markdown(rows, facts, probes):
    """Return the text on messages. On too noisy a machine, it says so instead of figures."""
    verdict = noise.verdict(probes)
    lines = [
        f"Measured on {facts['cores']} cores of {facts['processor']}, {facts['gigabytes']} GB, "
        f"{facts['system']}, Linux {facts['kernel']}, roscpp {facts['roscpp']}, "
        f"Python {facts['python']}.",
        "",
        f"Noise: others took {_percent(min(probes))} to {_percent(max(probes))} of the processors' "
        f"time, in {len(probes)} probes.",
        "",
    ]
    if verdict:
        lines += [
            f"**{verdict[0].upper()}{verdict[1:]}.** The samples are kept all the same.",
            "",
        ]
    lines += [
        "A latency is the time from just before a message is published until its callback begins, "
        'in microseconds. "x" is the ratio to raw TCP in the same rounds, and in brackets its '
        'confidence interval of 95 %. CPU is in seconds per million messages; "waits" is how often '
        "a thread of the sender waited for another one or for the kernel, per message.",
        "",
    ]
    for size, rate in sorted({(row.size, row.rate) for row in rows}, key=_title_order):
        of_slice = [row for row in rows if (row.size, row.rate) == (size, rate)]
        lines += _latency_table(of_slice, verdict) if rate else _burst_table(of_slice, verdict)
    return "\n".join(lines)


def _title_order(piece):
    size, rate = piece
    return (rate == 0, size, rate)


def _latency_table(rows, verdict):
    return [
        f"### {size_text(rows[0].size)} at {rows[0].rate} Hz",
        "",
        "| way | p50 | p90 | p99 | max | x C++ | x Python | lost | order | CPU: sender "
        "| receiver |",
        "| --- " + "| ---: " * 10 + "|",
        *(
            _line(
                WAYS[row.way].text,
                *(NOISY if verdict else f"{row.latency[name]:.1f}" for name in PERCENTILES),
                *(_ratio(row.latency_ratio.get(limit), verdict) for limit in summary.LIMITS),
                *_delivered(row, verdict),
            )
            for row in rows
        ),
        "",
    ]


def _burst_table(rows, verdict):
    return [
        f"### {size_text(rows[0].size)} as fast as it goes",
        "",
        "| way | per second | x C++ | x Python | lost | order | CPU: sender | receiver | waits |",
        "| --- " + "| ---: " * 8 + "|",
        *(
            _line(
                WAYS[row.way].text,
                NOISY if verdict else f"{row.throughput:,.0f}".replace(",", " "),
                *(_ratio(row.throughput_ratio.get(limit), verdict) for limit in summary.LIMITS),
                *_delivered(row, verdict),
                NOISY if verdict else f"{row.sender_switches:.2f}",
            )
            for row in rows
        ),
        "",
    ]


def _delivered(row, verdict):
    """Return the last cells: what was lost is no matter of noise, but processor time is."""
    lost = f"{row.lost} of {row.sent}" if row.lost else "0"
    order = f"{row.disordered} wrong" if row.disordered else "kept"
    if verdict:
        return (lost, order, NOISY, NOISY)
    if row.receiver_cpu is None:
        return (lost, order, f"{row.sender_cpu:.2f}", "the same")
    return (lost, order, f"{row.sender_cpu:.2f}", f"{row.receiver_cpu:.2f}")


def _ratio(estimate, verdict):
    if estimate is None:
        return ""
    if verdict or summary.is_noisy(estimate):
        return NOISY
    return "{:.2f} [{:.2f}, {:.2f}]".format(*estimate)


def _line(*cells):
    return "| " + " | ".join(cells) + " |"


def _percent(share):
    return f"{share:.1%}".replace("%", " %")
