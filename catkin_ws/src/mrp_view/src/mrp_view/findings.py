# SPDX-License-Identifier: BSD-3-Clause
"""Find what there is to learn from the screen, and which page of the tutorial explains it."""

import collections

# Kind -> where the tutorial explains it: a page, and a section of it.
PAGES = {
    "dead": "pages/faults.html",
    "mismatch": "pages/message_types.html#both-sides-must-agree",
    "none": "pages/wrong.html",
    "dropped": "pages/queues.html#the-subscriber-s-queue",
    "missing": "pages/queues.html#the-subscriber-s-queue",
    "latched": "pages/latch.html#latch",
    "islands": "pages/namespaces.html#private-to-the-node",
    "forgotten": "pages/faults.html",
    "gap": "pages/queues.html#the-publisher-s-queue",
}
MOST = 30  # findings of a kind
_LOG = ("/rosout", "/rosout_agg")


def findings(graph, counts, rows, viewer):
    """Return a list of dicts: kind, text, and page, which is that of PAGES.

    graph: as graph.build returns it; counts: as graph.counts does; rows: as Listener.look does
    """
    # Of the log, and of the viewer itself, there is nothing to learn.
    counts = [count for count in counts if count["topic"] not in _LOG and count["to"] != viewer]
    rows = [row for row in rows if row["topic"] not in _LOG]
    edges = [edge for edge in graph["edges"] if viewer not in (edge["from"], edge["to"])]
    found, number = [], collections.Counter()
    for kind, text in _reported(graph, counts, rows, edges):
        number[kind] += 1
        if number[kind] <= MOST:
            found.append({"kind": kind, "page": PAGES[kind], "text": text})
    return found


def _reported(graph, counts, rows, edges):
    """Yield (kind, text) of each finding."""
    dead = [node["name"] for node in graph["nodes"] if node["state"] == "dead"]
    if dead:
        yield "dead", f"{_names(dead)} died without telling the master"
    for state in ("mismatch", "none"):
        yield from ((state, link["why"]) for link in graph["links"] if link["state"] == state)
    for count in counts:
        where = f"from {count['from']} to {count['to']} on {count['topic']}"
        if count["dropped"]:
            yield (
                "dropped",
                f"{count['to']} dropped {count['dropped']} of {count['received']} messages, "
                f"because its queue was full ({where})",
            )
        elif count["missing"]:
            yield (
                "missing",
                f"{count['missing']} of {count['sent']} messages {where} haven't reached the "
                "callback: they were dropped, or are still on their way",
            )
    latched = [topic["name"] for topic in graph["topics"] if topic["latched"]]
    latched = [name for name in latched if name not in _LOG]
    if latched:
        yield "latched", f"{_names(latched)} is latched: a late subscriber gets the last message"
    for names in _islands(edges):
        yield "islands", f"{len(names)} islands, because their topics are private: {_names(names)}"
    for row in rows:
        if row["forgotten"]:
            yield (
                "forgotten",
                f"{row['from']} still publishes {row['topic']}, but the master doesn't know it. "
                "Was the master restarted?",
            )
        if row["missing"] and row["missing"][0]:
            yield (
                "gap",
                f"{row['missing'][0]} values are missing from what {row['from']} counts on "
                f"{row['topic']}",
            )


def _names(names):
    return ", ".join(sorted(names))


def _islands(edges):
    """Return the lists of nodes that have topics which nobody else is on, by namespace.

    One alone is nothing to learn from: many a node publishes what nobody hears yet.
    """
    on_topic = collections.defaultdict(set)
    for edge in edges:
        topic, node = (
            (edge["to"], edge["from"]) if edge["publishes"] else (edge["from"], edge["to"])
        )
        on_topic[topic].add(node)
    alone = collections.defaultdict(set)
    for topic, nodes in on_topic.items():
        (node, *others) = sorted(nodes)
        # A private name: in the node's own namespace.
        if not others and topic.startswith(node + "/"):
            alone[node.rpartition("/")[0]].add(node)
    return [sorted(nodes) for _, nodes in sorted(alone.items()) if len(nodes) > 1]
