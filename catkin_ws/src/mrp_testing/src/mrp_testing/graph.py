# SPDX-License-Identifier: BSD-3-Clause
"""What the master knows: who publishes and subscribes what, and of which type."""

import rosgraph


class Graph:
    """A snapshot of the master's state, without the nodes in `ignore`.

    publishers, subscribers: topic -> sorted list of node names
    types: topic -> type
    nodes: set of all node names
    """

    def __init__(self, ignore=()):
        master = rosgraph.Master("/graph_of_test")
        publishers, subscribers, services = master.getSystemState()
        self.publishers = _without(publishers, ignore)
        self.subscribers = _without(subscribers, ignore)
        self.types = dict(master.getTopicTypes())
        self.nodes = {
            name
            for state in (self.publishers, self.subscribers, _without(services, ignore))
            for names in state.values()
            for name in names
        }


def _without(state, ignore):
    kept = {topic: sorted(set(names) - set(ignore)) for topic, names in state}
    return {topic: names for topic, names in kept.items() if names}
