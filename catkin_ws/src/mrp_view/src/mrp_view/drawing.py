# SPDX-License-Identifier: BSD-3-Clause
"""Where everything of the graph goes: dot lays it out, the page draws it.

dot gets numbers alone: a name that a node has chosen is never part of what dot reads.
"""

import json
import subprocess

LETTER, LINE, MARGIN = 7.3, 18, 24  # of the page's font, and around a label, in points
_TIMEOUT = 20  # seconds


def _inches(points):
    return f"{points / 72:.4f}"


def _namespace(name):
    """Return the namespaces in which a name lies, the outermost first: of /a/b/c, /a and /a/b."""
    parts = name.split("/")[1:-1]
    return ["/" + "/".join(parts[: i + 1]) for i in range(len(parts))]


class Structure:
    """What has an influence on the layout: two graphs with the same key have the same layout.

    graph: as graph.build returns it
    rankdir: "LR" or "TB", dot's direction
    """

    def __init__(self, graph, rankdir):
        self.nodes = [node["name"] for node in graph["nodes"]]
        self.topics = [(topic["name"], len(topic["label"])) for topic in graph["topics"]]
        self.edges = [(edge["from"], edge["to"], edge["publishes"]) for edge in graph["edges"]]
        self.rankdir = rankdir
        self.key = (tuple(self.nodes), tuple(self.topics), tuple(self.edges), rankdir)

    def dot(self):
        """Return the graph in dot's language."""
        lines = [
            "digraph {",
            # Between a topic and a node there must be room for what is written at an edge.
            f"rankdir={self.rankdir} nodesep=0.25 ranksep={1.3 if self.rankdir == 'LR' else 0.6}",
            'fontname="monospace" fontsize=12',
            'node [fixedsize=true label=""]',
        ]
        tree = {}
        # A node with topics in its own namespace is in that box: what is private is an island.
        private = {group for name, _ in self.topics for group in _namespace(name)}
        # The last part of a name is what is written: its namespaces are the boxes around it.
        for index, name in enumerate(self.nodes):
            letters = len(name.rsplit("/", 1)[-1])
            inside = name + "/" if name in private else name
            self._put(tree, inside, self._item(f"n{index}", letters, 2, "ellipse"))
        for index, (name, label) in enumerate(self.topics):
            letters = max(len(name.rsplit("/", 1)[-1]), label)
            self._put(tree, name, self._item(f"t{index}", letters, 2, "box"))
        self._groups = []
        self._boxes(tree, lines)
        lines += ["{} -> {}".format(*pair) for pair in self._pairs()]
        return "\n".join([*lines, "}"])

    def _pairs(self):
        """Return the two ends of each edge, by the names that dot gets."""
        ids = {name: f"n{index}" for index, name in enumerate(self.nodes)}
        topic_ids = {name: f"t{index}" for index, (name, _) in enumerate(self.topics)}
        return [
            (ids[start], topic_ids[end]) if publishes else (topic_ids[start], ids[end])
            for start, end, publishes in self.edges
        ]

    @staticmethod
    def _item(item, letters, rows, shape):
        width = _inches(max(letters, 4) * LETTER + MARGIN * (1.5 if shape == "ellipse" else 1))
        return f"{item} [shape={shape} width={width} height={_inches(rows * LINE + 8)}]"

    @staticmethod
    def _put(tree, name, line):
        for group in _namespace(name):
            tree = tree.setdefault(group, {})
        tree.setdefault(None, []).append(line)

    def _boxes(self, tree, lines):
        lines += tree.get(None, [])
        for group in sorted(name for name in tree if name is not None):
            # The label only takes up room: it has as many letters as the name.
            lines.append(
                f'subgraph cluster{len(self._groups)} {{ label="{"n" * len(group)}" margin=10'
            )
            self._groups.append(group)
            self._boxes(tree[group], lines)
            lines.append("}")

    def layout(self):
        """Return where everything is: width and height; nodes and topics: name -> [x, y, width,
        height], x and y of the centre; edges: an SVG path for each; groups: name and box.

        Raises OSError or subprocess.SubprocessError if dot cannot be run, or fails.
        """
        done = subprocess.run(
            ["dot", "-Tjson0"],
            input=self.dot(),
            check=True,
            capture_output=True,
            text=True,
            timeout=_TIMEOUT,
        )
        drawn = json.loads(done.stdout)
        _, _, width, height = map(float, drawn["bb"].split(","))
        boxes, groups = {}, []
        for item in drawn.get("objects", []):
            if item["name"].startswith("cluster"):
                x1, y1, x2, y2 = map(float, item["bb"].split(","))
                name = self._groups[int(item["name"][len("cluster") :])]
                groups.append([name, *_rounded(x1, height - y2, x2 - x1, y2 - y1)])
            else:
                x, y = map(float, item["pos"].split(","))
                size = float(item["width"]) * 72, float(item["height"]) * 72
                boxes[item["name"]] = _rounded(x, height - y, *size)
        names = {item["_gvid"]: item["name"] for item in drawn.get("objects", [])}
        paths = {
            (names[item["tail"]], names[item["head"]]): _path(item["pos"], height)
            for item in drawn.get("edges", [])
        }
        return {
            "width": round(width, 1),
            "height": round(height, 1),
            "nodes": {name: boxes[f"n{index}"] for index, name in enumerate(self.nodes)},
            "topics": {name: boxes[f"t{index}"] for index, (name, _) in enumerate(self.topics)},
            "edges": [paths[pair] for pair in self._pairs()],
            "groups": groups,
        }


def _rounded(*numbers):
    return [round(number, 1) for number in numbers]


def _path(position, height):
    """Return dot's spline "e,x,y x,y x,y ..." as an SVG path that ends at the arrow's point."""
    end, points = None, []
    for part in position.split():
        numbers = part.split(",")
        x, y = float(numbers[-2]), height - float(numbers[-1])
        if numbers[0] == "e":
            end = (x, y)
        elif numbers[0] != "s":
            points.append((x, y))
    path = "M{:.1f} {:.1f}C".format(*points[0])
    path += " ".join("{:.1f} {:.1f}".format(*point) for point in points[1:])
    return path + ("L{:.1f} {:.1f}".format(*end) if end else "")
