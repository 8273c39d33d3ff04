#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command, and keeps in build/times.json how long it took: `make own-times` reads that.

Usage: timed.py STAGE COMMAND...

Exit code: the command's, or 128 and the signal's number.
"""

import json
import pathlib
import resource
import subprocess
import sys
import time

TIMES = pathlib.Path(__file__).resolve().parents[1] / "build" / "times.json"


def run(*command):
    """Run a command; return its exit code, its seconds, and those of the processors.

    The latter are of all its descendants for which somebody has waited.
    """
    begin, before = time.monotonic(), _processor_seconds()
    process = subprocess.Popen(command)
    try:
        code = process.wait()
    except KeyboardInterrupt:  # it has the signal, too: let it end in its own way
        code = process.wait()
    return code, time.monotonic() - begin, _processor_seconds() - before


def _processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def keep(stage, seconds, processor):
    """Write what a stage took into TIMES, beside the other stages."""
    times = json.loads(TIMES.read_text()) if TIMES.exists() else {}
    times[stage] = {"seconds": round(seconds, 1), "processor": round(processor, 1)}
    TIMES.parent.mkdir(exist_ok=True)
    TIMES.write_text(json.dumps(times, indent=1) + "\n")


def main(stage, *command):
    code, seconds, processor = run(*command)
    keep(stage, seconds, processor)
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
