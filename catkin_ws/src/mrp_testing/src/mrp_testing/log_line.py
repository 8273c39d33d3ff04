# SPDX-License-Identifier: BSD-3-Clause
"""What a node logs, as a line of the console."""

import collections
import re

# "[ INFO] [1795222168.680630550, 12.5]: text"; the second number is there under /use_sim_time.
_LINE = re.compile(
    r"\[ ?(?P<level>DEBUG|INFO|WARN|ERROR|FATAL)\]"
    r" \[(?P<wall>\d+\.\d+)(?:, (?P<simulated>\d+\.\d+))?\]: (?P<text>.*)"
)

# wall, simulated: the times in the line, in seconds; simulated is None without /use_sim_time
LogLine = collections.namedtuple("LogLine", "level wall simulated text")


def texts(lines):
    """Return the text of each line that a node has logged as INFO, of all these lines."""
    return [line.text for line in filter(None, map(parse, list(lines))) if line.level == "INFO"]


def parse(line):
    """Return the LogLine of a line of the console, or None if no node has logged it."""
    match = _LINE.fullmatch(line)
    if not match:
        return None
    simulated = match["simulated"] and float(match["simulated"])
    return LogLine(match["level"], float(match["wall"]), simulated, match["text"])
