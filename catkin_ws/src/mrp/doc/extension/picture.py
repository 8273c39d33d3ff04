# SPDX-License-Identifier: BSD-3-Clause
"""Directives that draw what was recorded from running nodes, and say it in words for a reader who
does not see the picture.

.. ros-graph:: NAME  the nodes and topics under NAME in recorded/graphs.json, drawn by Graphviz
.. queue:: NAME      which of the published values were received, in the lines under NAME in
                     recorded/outputs.json
"""

import html
import re
import subprocess

from docutils import nodes
from sphinx.util.docutils import SphinxDirective
from terminal import recorded


class Picture(SphinxDirective):
    required_arguments = 1
    file = "outputs.json"

    def run(self):
        found = recorded(self, self.file, self.arguments[0])
        if found is None:
            return []
        return [self.draw(found)]

    def svg(self, width, height, parts, alt):
        """Return an SVG within the page: so page.css gives it the page's colours, and its width.

        alt: what the picture shows, in words
        """
        text = "\n".join(
            [
                f'<div class="picture"><svg role="img" viewBox="0 0 {width} {height}" '
                f'style="--width: {width}px" aria-label="{html.escape(alt)}">',
                *parts,
                "</svg></div>",
            ]
        )
        return nodes.raw(text, text, format="html")


def _ends(graph):
    """Return the edges (publisher, topic), and the edges (topic, subscriber)."""
    return [[edge.split(" -> ") for edge in graph[kind]] for kind in ("publishers", "subscribers")]


class Graph(Picture):
    file = "graphs.json"

    def draw(self, graph):
        lines = ["digraph {", "rankdir=LR", "ranksep=0.35", "bgcolor=transparent"]
        lines.append('node [fontname="sans-serif"]')
        for topic, type_ in graph["topics"].items():
            lines.append(f'"topic {topic}" [shape=box label="{topic}\\n{type_}"]')
        publishers, subscribers = _ends(graph)
        for node in sorted({node for node, _ in publishers} | {node for _, node in subscribers}):
            # On two lines, so that a phone has room for all of it.
            group, _, name = node.rpartition("/")
            label = f"{group}/\\n{name}" if group else node
            lines.append(f'"{node}" [shape=ellipse label="{label}"]')
        for node, topic in publishers:
            lines.append(f'"{node}" -> "topic {topic}"')
        for topic, node in subscribers:
            lines.append(f'"topic {topic}" -> "{node}"')
        drawn = subprocess.run(
            ["dot", "-Tsvg"],
            input="\n".join([*lines, "}"]),
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        ).stdout
        width, height = map(float, re.search(r'viewBox="\S+ \S+ (\S+) (\S+)"', drawn).groups())
        parts = re.search(r"<svg[^>]*>(.*)</svg>", drawn, re.DOTALL).group(1)
        # Graphviz gives the same ids to the parts of every graph, and a page may have several. And
        # the script that marks a searched word on the page stops at an SVG's titles.
        parts = re.sub(r' id="[^"]*"|<title>.*?</title>\n', "", parts)
        return self.svg(width, height, [parts], self.alt(graph))

    def alt(self, graph):
        """Say of each topic which nodes publish it, and which ones subscribe to it."""
        sentences = []
        publishers, subscribers = _ends(graph)
        for topic, type_ in graph["topics"].items():
            publish = ", ".join(node for node, end in publishers if end == topic) or "no node"
            subscribe = (
                ", ".join(node for begin, node in subscribers if begin == topic) or "no node"
            )
            who = f"published by {publish}; subscribed to by {subscribe}"
            sentences.append(f"Topic {topic}, type {type_}: {who}.")
        return " ".join(sentences)


class Queue(Picture):
    def draw(self, lines):
        text = "\n".join(lines)
        published = re.findall(r"published (\d+)(?: to (\d+))?", text)
        last = max(int(number) for pair in published for number in pair if number)
        received = {}
        for name, number in re.findall(r"/(\w+) received \"?(\d+)", text):
            received.setdefault(name, set()).add(int(number))
        left, box, row = 140, 28, 40
        parts = []
        for index, (name, numbers) in enumerate(received.items()):
            y = row * index + 8
            parts.append(f'<text x="0" y="{y + 18}" class="label">{name}</text>')
            for number in range(1, last + 1):
                x = left + (number - 1) * box
                css_class = "received" if number in numbers else "dropped"
                parts.append(
                    f'<rect x="{x}" y="{y}" width="{box - 4}" height="26" class="{css_class}"/>'
                )
                parts.append(f'<text x="{x + 12}" y="{y + 17}" class="value">{number}</text>')
        return self.svg(left + last * box, row * len(received) + 8, parts, self.alt(last, received))

    def alt(self, last, received):
        """Say which messages each subscriber received."""
        sentences = [f"Messages 1 to {last}."]
        for name, numbers in received.items():
            runs = []  # of numbers without a gap
            for number in sorted(numbers):
                if runs and number == runs[-1][-1] + 1:
                    runs[-1].append(number)
                else:
                    runs.append([number])
            texts = [f"{run[0]} to {run[-1]}" if len(run) > 1 else f"{run[0]}" for run in runs]
            sentences.append(f"{name} received {', '.join(texts)}.")
        return " ".join(sentences)


def setup(app):
    app.add_directive("ros-graph", Graph)
    app.add_directive("queue", Queue)
    return {"parallel_read_safe": False}
