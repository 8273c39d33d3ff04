# SPDX-License-Identifier: BSD-3-Clause
"""What each browser gets: the graph as it has chosen to see it, and the newest log lines."""

import json

LOG_AT_ONCE = 200  # lines in one message


def encode(message):
    """Return a message as JSON. Raises ValueError if a number in it has none."""
    return json.dumps(message, allow_nan=False, separators=(",", ":"))


def visible(graph, options):
    """Return the graph without what a browser hides.

    options: rosout: whether to show the log's topics and node; viewer: its name, or "" to show it;
        hidden: a set of topics
    """
    hidden_topics = set(options["hidden"])
    hidden_nodes = {options["viewer"]}
    if not options["rosout"]:
        hidden_topics |= {"/rosout", "/rosout_agg"}
        hidden_nodes.add("/rosout")

    def shown(edge):
        topic, node = (
            (edge["to"], edge["from"]) if edge["publishes"] else (edge["from"], edge["to"])
        )
        return topic not in hidden_topics and node not in hidden_nodes

    edges = [edge for edge in graph["edges"] if shown(edge)]
    on_edges = {name for edge in edges for name in (edge["from"], edge["to"])}
    return {
        "nodes": [node for node in graph["nodes"] if node["name"] not in hidden_nodes],
        # A topic on which is nobody but the viewer is hidden with it.
        "topics": [
            topic
            for topic in graph["topics"]
            if topic["name"] in on_edges and topic["name"] not in hidden_topics
        ],
        "edges": edges,
        "links": [
            link
            for link in graph["links"]
            if link["topic"] not in hidden_topics and not hidden_nodes & {link["from"], link["to"]}
        ],
    }


def log_since(lines, number, most=LOG_AT_ONCE):
    """Return the last lines after that number. lines: (number, line), the numbers counting on"""
    return [line for n, line in lines if n > number][-most:]


def options_of(message, viewer):
    """Return the options in a browser's message, whatever it may hold: see visible()."""
    hidden = message.get("hidden")
    hidden = hidden if isinstance(hidden, list) else []
    return {
        "rosout": message.get("rosout") is True,
        "viewer": "" if message.get("viewer") is True else viewer,
        "hidden": frozenset(name for name in hidden[:1000] if isinstance(name, str)),
        "rankdir": "TB" if message.get("rankdir") == "TB" else "LR",
    }
