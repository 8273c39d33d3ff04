# SPDX-License-Identifier: BSD-3-Clause
"""Draws plots as SVG, for files and for the tutorial's pages.

matplotlib would be larger than all else that the pages are built with. A plot has no background and
takes its text's colour from what is around it: so it fits a dark page, too.
"""

import html
import math
from typing import NamedTuple

# Each stands out from white and from black alike, and the colour-blind can tell them apart (Okabe
# and Ito's, two of them darker). The marks tell them apart in print.
TEXT = "currentColor"
GREY, BLUE, SKY, RED, AMBER, GREEN = (
    "#777777",
    "#0072b2",
    "#3d8fc4",
    "#d55e00",
    "#b07800",
    "#009e73",
)

# As paths around the point.
_MARKS = {
    "circle": "M-4,0a4,4 0 1,0 8,0a4,4 0 1,0 -8,0z",
    "square": "M-4,-4h8v8h-8z",
    "diamond": "M0,-5.5l5.5,5.5l-5.5,5.5l-5.5,-5.5z",
    "up": "M0,-5l5,9h-10z",
    "down": "M0,5l5,-9h-10z",
    "star": "M0,-6l1.8,4.2h4.2l-3.2,3l1.3,4.8l-4.1,-2.8l-4.1,2.8l1.3,-4.8l-3.2,-3h4.2z",
}

ROW = 20  # the height of a line of text, in px


class Plot(NamedTuple):
    """width, height: in px. parts: what is in the SVG. alt: its values, for who does not see it."""

    width: int
    height: int
    parts: list
    alt: str


class Series(NamedTuple):
    """points: pairs of numbers above 0. label: what the legend says."""

    label: str
    color: str
    mark: str
    points: list


def document(plot):
    """Return a plot as the text of a file, on white."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {plot.width} {plot.height}" '
        f'width="{plot.width}" height="{plot.height}" font-family="sans-serif" color="black">\n'
        '<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(plot.parts) + "\n</svg>\n"
    )


def text(x, y, words, anchor="start", size=13, more=""):
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" '
        f'fill="{TEXT}" {more}>{html.escape(words)}</text>'
    )


def line(x1, y1, x2, y2, color=TEXT, width=1.0, more=""):
    return (
        f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{color}" '
        f'stroke-width="{width}" {more}/>'
    )


def mark(name, x, y, color):
    return f'<path d="{_MARKS[name]}" transform="translate({x:.1f},{y:.1f})" fill="{color}"/>'


def bar(x1, x2, y, height, color):
    return (
        f'<rect x="{x1:.1f}" y="{y:.1f}" width="{x2 - x1:.1f}" height="{height}" fill="{color}"/>'
    )


def legend(entries, x, y, width):
    """Return the parts of a legend in two columns. entries: Series. width: of a column, in px."""
    parts = []
    for number, entry in enumerate(entries):
        left, middle = x + width * (number % 2), y + ROW * (number // 2)
        parts += [_stroke(entry, [(left, middle), (left + 28, middle)])]
        parts += [mark(entry.mark, left + 14, middle, entry.color)]
        parts += [text(left + 36, middle + 4, entry.label)]
    return parts


def _stroke(series, points):
    path = "M" + "L".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<path d="{path}" fill="none" stroke="{series.color}" stroke-width="1.8"/>'


class Scale:
    """A logarithmic scale: it turns a number above 0 into px.

    numbers: all that it has to hold. begin, end: in px
    """

    def __init__(self, numbers, begin, end):
        low, high = math.log(min(numbers)), math.log(max(numbers))
        gap = 0.05 * (high - low) or 1
        self._low, self._high = low - gap, high + gap
        self._begin, self._end = begin, end

    def __call__(self, number):
        share = (math.log(number) - self._low) / (self._high - self._low)
        return self._begin + share * (self._end - self._begin)

    def ticks(self):
        """Return the numbers to write: 1, 2 and 5 of each power of ten, or 1 alone if many."""
        low, high = self._low / math.log(10), self._high / math.log(10)
        powers = range(math.floor(low), math.ceil(high))
        steps = (1, 2, 5) if high - low < 3 else (1,)
        ticks = [step * 10**power for power in powers for step in steps]
        return [tick for tick in ticks if self._low <= math.log(tick) <= self._high]


def in_words(title, series, ticks):
    """Say where each line of a panel begins and ends."""
    lines = []
    for curve in series:
        ends = [
            f"{float(f'{y:.3g}'):g} at {ticks[x]}" for x, y in (curve.points[0], curve.points[-1])
        ]
        lines.append(f"{curve.label}: {' to '.join(ends)}")
    return f"{title}. {'; '.join(lines)}."


def panel(title, series, x, y, width, height, ticks):
    """Return the parts of lines on logarithmic scales.

    x, y, width, height: where its axes are, in px. ticks: number on the x axis -> its text
    """
    points = [point for curve in series for point in curve.points]
    across = Scale([number for number, _ in points], x, x + width)
    up = Scale([value for _, value in points], y + height, y)
    parts = [text(x, y - 8, title, more='font-weight="bold"')]
    for number, words in ticks.items():
        parts += [line(across(number), y, across(number), y + height, more='opacity="0.15"')]
        parts += [text(across(number), y + height + 16, words, "middle", 12)]
    for value in up.ticks():
        parts += [line(x, up(value), x + width, up(value), more='opacity="0.15"')]
        parts += [text(x - 6, up(value) + 4, f"{value:g}", "end", 12)]
    parts += [line(x, y + height, x + width, y + height), line(x, y, x, y + height)]
    for curve in series:
        drawn = [(across(number), up(value)) for number, value in curve.points]
        parts += [
            _stroke(curve, drawn),
            *(mark(curve.mark, *point, curve.color) for point in drawn),
        ]
    return parts
