# SPDX-License-Identifier: BSD-3-Clause
"""The plots of what results.json says: each is a function that returns an svg.Plot, or None."""

from mrp_bench import svg
from mrp_bench.tables import ROBOTS
from mrp_bench.ways import WAYS, size_text

_WIDTH = 720

# The ways that are drawn as lines.
_LINES = {
    "raw_cpp": (svg.TEXT, "square"),
    "raw_py": (svg.GREY, "diamond"),
    "cpp_cpp": (svg.BLUE, "circle"),
    "cpp_py": (svg.SKY, "down"),
    "py_cpp": (svg.AMBER, "up"),
    "py_py": (svg.RED, "star"),
}


def write(content, folder):
    """Write each plot as a file. If the machine was too noisy, it says so across the plot."""
    for name, draw in PLOTS.items():
        plot = draw(content)
        if plot and content["verdict"]:
            across = f'opacity="0.5" transform="rotate(-20 {plot.width / 2} {plot.height / 2})"'
            words = "too noisy a machine"
            plot.parts.append(
                svg.text(plot.width / 2, plot.height / 2, words, "middle", 48, across)
            )
        if plot:
            (folder / f"{name}.svg").write_text(svg.document(plot))


def latency_by_size(content):
    """Draw the p50 of the plain ways against the size."""
    # At several rates: the one that is nearest to 1000 Hz.
    rates = {}
    for row in content["rows"]:
        if row["rate"] and row["way"] in _LINES:
            rates.setdefault(row["size"], set()).add(row["rate"])
    nearest = {size: min(of, key=lambda rate: abs(rate - 1000)) for size, of in rates.items()}
    rows = [row for row in content["rows"] if nearest.get(row["size"]) == row["rate"]]
    ticks = {size: size_text(size) for size in sorted({row["size"] for row in rows})}
    if len(ticks) < 2:
        return None
    series = []
    for way, (color, mark) in _LINES.items():
        points = sorted((row["size"], row["latency"]["p50"]) for row in rows if row["way"] == way)
        if points:
            series.append(svg.Series(WAYS[way].text, color, mark, points))
    title = "p50 in µs, by size"
    parts = svg.panel(title, series, 50, 30, 450, 260, ticks) + svg.legend(series, 50, 335, 220)
    return svg.Plot(520, 400, parts, svg.in_words(title, series, ticks))


def scale(content):
    """Draw the costs against the number of robots."""
    of = content["robots"]
    if not of["exponents"]:
        return None
    styles = {
        "up": (svg.BLUE, "circle"),
        "down": (svg.SKY, "down"),
        "cores": (svg.RED, "star"),
        "cpp": (svg.TEXT, "square"),
        "py": (svg.GREY, "diamond"),
        "p50": (svg.GREEN, "up"),
    }
    series = [
        svg.Series(
            f"{ROBOTS[name]}: ^{of['exponents'][name][0]:.2f}",
            *style,
            [(figure["robots"], figure[name]) for figure in of["figures"]],
        )
        for name, style in styles.items()
    ]
    ticks = {figure["robots"]: str(figure["robots"]) for figure in of["figures"]}
    title = "Costs by the number of robots of four nodes each (^ exponent)"
    parts = svg.panel(title, series, 50, 30, 450, 300, ticks) + svg.legend(series, 50, 375, 240)
    return svg.Plot(520, 440, parts, svg.in_words(title, series, ticks))


# What the bars of the timeline say.
_BARS = {"starts": svg.AMBER, "runs": svg.BLUE, "has the signal to end": svg.RED}


def start_and_stop(content):
    """Draw when each process starts, runs and ends, in the most usual start."""
    start = content["starts"]["timeline"]
    if not start:
        return None
    left, row, top = 160, 26, 30
    second = (_WIDTH - left - 20) / start["end"]
    bottom = top + row * len(start["bars"])
    stop = left + second * start["stop"]
    parts = [svg.text(0, 16, "Start and stop of the four nodes", more='font-weight="bold"')]
    for number, (name, spans) in enumerate(start["bars"].items()):
        y = top + row * number
        parts.append(svg.text(0, y + 16, name))
        for color, begin, end in zip(_BARS.values(), spans, spans[1:]):
            parts.append(svg.bar(left + second * begin, left + second * end, y + 2, row - 4, color))
        if name in start["first_message"]:
            x = left + second * start["first_message"][name]
            parts.append(svg.mark("up", x, y + row / 2, svg.TEXT))
    parts.append(svg.line(stop, top, stop, bottom))
    for begin, end in ((left, stop), (stop, _WIDTH - 20)):
        for half in range(int((end - begin - 12) / second * 2) + 1):
            x = begin + second * half / 2
            parts.append(svg.text(x, bottom + 16, f"{half / 2:g}", "middle", 12))
    parts.append(svg.text((left + stop) / 2, bottom + 34, "seconds since the call", "middle"))
    parts.append(svg.text((stop + _WIDTH - 20) / 2, bottom + 34, "seconds since Ctrl-C", "middle"))
    x = 0
    for words, color in _BARS.items():
        parts += [svg.bar(x, x + 20, bottom + 50, 12, color), svg.text(x + 28, bottom + 61, words)]
        x += 60 + 8 * len(words)
    parts.append(svg.mark("up", x + 10, bottom + 57, svg.TEXT))
    parts.append(svg.text(x + 28, bottom + 61, "has its first message"))
    return svg.Plot(_WIDTH, bottom + 70, parts, _start_in_words(start))


def _start_in_words(start):
    printed = [
        f"Start and stop of the four nodes. Ctrl-C comes {start['stop']:.2f} s after the call."
    ]
    for name, (*spans, end) in start["bars"].items():
        steps = [f"{what} at {when:.2f} s" for what, when in zip(_BARS, spans)]
        if name in start["first_message"]:
            steps.insert(2, f"has its first message at {start['first_message'][name]:.2f} s")
        printed.append(f"{name} {', '.join(steps)}, and has ended at {end:.2f} s.")
    return " ".join(printed)


PLOTS = {draw.__name__: draw for draw in (latency_by_size, start_and_stop, scale)}
