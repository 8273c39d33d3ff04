# SPDX-License-Identifier: BSD-3-Clause
"""The results in files: results.json, results.csv, table.md and the plots.

results.json says all that the tables and the plots show. The tutorial's pages are made of it, too.
"""

import csv
import json

from mrp_bench import (
    fan_figures,
    fans,
    launch_figures,
    launches,
    machine,
    noise,
    plots,
    start_figures,
    starts,
    summary,
    tables,
)
from mrp_bench.stats import PERCENTILES
from mrp_bench.ways import LIMITS

_ABOUT_MESSAGES = (
    "A latency is the time from just before a message is published until its callback begins. "
    '"x" is the ratio to raw TCP in the same rounds, and in brackets its confidence interval of '
    '95 %. CPU is in seconds per million messages; "waits" is how often a thread of the sender '
    "waited for another one or for the kernel, per message."
)


def measured(results):
    """Return what results.json says of a folder of results (rounds.Results)."""
    probes = results.noise()
    facts = machine.describe()
    cores, megabytes = int(facts["cores"]), 1e3 * int(facts["gigabytes"])
    return {
        "machine": facts,
        "noise": {"least": min(probes), "most": max(probes), "probes": len(probes)},
        "verdict": noise.verdict(probes),
        "rows": [row._asdict() for row in summary.summarise(results.measurements())],
        "starts": start_figures.summarise(*starts.load(results)),
        "robots": launch_figures.summarise(launches.load(results), cores, megabytes),
        "fans": fan_figures.summarise(fans.load(results), cores),
    }


def write(results, say):
    """Write all files of a folder of results (rounds.Results)."""
    content = measured(results)
    (results.folder / "results.json").write_text(json.dumps(content, indent=1) + "\n")
    _write_csv(results.folder / "results.csv", content["rows"])
    text = markdown(content)
    (results.folder / "table.md").write_text(text)
    plots.write(content, results.folder)
    print(text)
    say(f"tables, plots and all samples are in {results.folder}")


def _write_csv(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.writer(file)
        percentiles = [f"{name}_us" for name in PERCENTILES]
        ratios = [
            f"{what}_ratio_{limit}_{bound}"
            for what in ("latency", "throughput")
            for limit in LIMITS
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
                for estimates in (row["latency_ratio"], row["throughput_ratio"])
                for limit in LIMITS
            ]
            table.writerow(
                [row["way"], row["size"], row["rate"], row["rounds"]]
                + [f"{row['latency'][name]:.2f}" for name in PERCENTILES]
                + [row[name] for name in plain]
                + [bound for estimate in estimates for bound in estimate]
            )


def markdown(content):
    """Return table.md. On too noisy a machine, it says so instead of figures."""
    parts = [*tables.machine(content), _ABOUT_MESSAGES]
    for name in ("latency", "throughput", "starts", "robots", "fans"):
        for table in tables.TABLES[name](content):
            parts += _table(table)
    return "\n\n".join(parts) + "\n"


def _table(table):
    lines = [_line(table.header), "| --- " + "| ---: " * (len(table.header) - 1) + "|"]
    lines += map(_line, table.rows)
    return [f"### {table.title}", *table.before, "\n".join(lines), *table.after]


def _line(cells):
    return "| " + " | ".join(cells) + " |"
