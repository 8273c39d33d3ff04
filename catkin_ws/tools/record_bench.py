#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts what `make bench` measured into the pages: its tables, as reStructuredText, and its plots.

Usage: record_bench.py FOLDER
"""

import json
import pathlib
import shutil
import sys

RECORDED = pathlib.Path(__file__).resolve().parents[1] / "src/mrp/doc/recorded/bench"

# Fewer rounds than that are a quick look, and no record.
_ROUNDS = 6

# The plots, in the order of the page: what each shows, in words.
_PLOTS = {
    "latency": "The latency of 8 bytes for every way: p50, p90 and p99.",
    "latency_by_size": "The p50 of the latency against the size of the message.",
    "latency_by_rate": "The p50 of the latency against the messages per second.",
    "throughput": "How many messages of 8 bytes arrive in a second, for every way.",
    "start_and_stop": "When each of the four nodes is started, ready, and told to end.",
    "scale": "Start, stop, processor time and memory against the number of robots.",
    "fans": "Start, processor time, memory and latency against the publishers or subscribers.",
}


def tables(markdown):
    """Return a text of Markdown's paragraphs, headings and tables as lines of reStructuredText."""
    lines = []
    in_table = False
    for line in markdown.splitlines():
        if line.startswith("| ---"):
            continue
        if line.startswith("|"):
            if not in_table:
                lines += [".. list-table::", "   :header-rows: 1", ""]
            for number, cell in enumerate(line.strip("|").split("|")):
                lines.append(("   * - " if number == 0 else "     - ") + cell.strip())
        elif line.startswith("### "):
            lines.append(".. rubric:: " + line[4:])
        else:
            lines.append(line)
        in_table = line.startswith("|")
    return [line.rstrip() for line in lines]


def record(folder, recorded):
    """Write the page's part `measured.inc` and the plots from a folder of results.

    Exits with a message if there are none that are worth it.
    """
    try:
        results = json.loads((folder / "results.json").read_text())
    except FileNotFoundError:
        sys.exit(f"error: expected the results of a run in {folder}, found none: run make bench")
    if results["verdict"]:
        sys.exit(f"error: {results['verdict']}")
    rounds = min(row["rounds"] for row in results["rows"])
    if rounds < _ROUNDS:
        sys.exit(
            f"error: expected {_ROUNDS} rounds, found {rounds}: run make bench without QUICK=1"
        )
    lines = tables((folder / "table.md").read_text())
    plots = {name: alt for name, alt in _PLOTS.items() if (folder / f"{name}.svg").exists()}
    recorded.mkdir(parents=True, exist_ok=True)
    for name, alt in plots.items():
        shutil.copy(folder / f"{name}.svg", recorded)
        lines += ["", f".. image:: /recorded/bench/{name}.svg", f"   :alt: {alt}"]
    shutil.copy(folder / "results.csv", recorded)
    (recorded / "measured.inc").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    record(pathlib.Path(sys.argv[1]), RECORDED)
