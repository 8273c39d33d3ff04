# SPDX-License-Identifier: BSD-3-Clause
"""The results in files: results.json and table.md.

results.json says all that the tables show. The tutorial's pages are made of it, too.
"""

import json

from mrp_bench import launches, machine, summary, tables

_ABOUT_MESSAGES = (
    "A latency is the time from just before a message is published until its callback begins. "
    '"x" is the ratio to raw TCP in the same rounds, and in brackets its confidence interval of '
    "95 %. CPU is in seconds per million messages."
)


def measured(results):
    """Return what results.json says of a folder of results (rounds.Results)."""
    probes = results.noise()
    return {
        "machine": machine.describe(),
        "noise": {"least": min(probes), "most": max(probes), "probes": len(probes)},
        "verdict": machine.verdict(probes),
        "rows": [row._asdict() for row in summary.summarise(results.measurements())],
        "robots": launches.summarise(launches.load(results)),
    }


def write(results, say):
    """Write all files of a folder of results (rounds.Results)."""
    content = measured(results)
    (results.folder / "results.json").write_text(as_text(content))
    text = markdown(content)
    (results.folder / "table.md").write_text(text)
    print(text)
    say(f"tables and all samples are in {results.folder}")


def as_text(content):
    """Return results.json: one record per line, so that a change shows which ones it changed."""
    others = {name: value for name, value in content.items() if name != "rows"}
    parts = [f"{json.dumps(name)}: {json.dumps(value)}" for name, value in others.items()]
    rows = ",\n".join(map(json.dumps, content["rows"]))
    return "{\n" + ",\n".join(parts) + ',\n"rows": [\n' + rows + "\n]\n}\n"


def markdown(content):
    """Return table.md. On too noisy a machine, it says so instead of figures."""
    parts = [*tables.machine(content), _ABOUT_MESSAGES]
    for name in ("latency", "throughput", "robots"):
        for table in tables.TABLES[name](content):
            parts += _table(table)
    return "\n\n".join(parts) + "\n"


def _table(table):
    lines = [_line(table.header), "| --- " + "| ---: " * (len(table.header) - 1) + "|"]
    lines += map(_line, table.rows)
    return [f"### {table.title}", *table.before, "\n".join(lines)]


def _line(cells):
    return "| " + " | ".join(cells) + " |"
