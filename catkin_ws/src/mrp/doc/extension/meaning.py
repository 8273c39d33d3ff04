# SPDX-License-Identifier: BSD-3-Clause
"""What an output must show: the values that matter, and the order of lines.

Each text is a regular expression, and must be in a line; " ... " stands for lines between. So

    received (?P<ten>\\d*)4$ ... received (?P=ten)6$

is in an output in which a line ends with 4, or 14, and a later one with 6, or 16. What differs from
run to run is no number in the text but a group, which may stand in it again.
"""

import re


def missing(texts, lines):
    """Return those of the texts that are not in an output's lines."""
    output = "\n".join(lines) + "\n"
    return [text for text in texts if not re.search(_pattern(text), output, re.MULTILINE)]


def _pattern(text):
    return r"\n(?:.*\n)*?".join(f"^.*(?:{part}).*$" for part in text.split(" ... "))
