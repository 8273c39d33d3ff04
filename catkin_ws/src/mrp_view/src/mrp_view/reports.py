# SPDX-License-Identifier: BSD-3-Clause
"""What a node reports about itself: its connections, and how many messages went over each.

It comes from the slave API (http://wiki.ros.org/ROS/Slave_API): getBusInfo and getBusStats. In
getBusStats the two client libraries differ, from that page and from one another:

- roscpp counts what a subscriber has received, and what its queue has dropped, but if a topic has
  several publishers, it only reports the last one;
- rospy counts what is left after the queue has dropped, and not what it has dropped.
"""

import collections

# One end of a connection, as the node at that end reports it.
# peer: at a publisher the subscriber's name, at a subscriber the publisher's URI
# messages: sent, or received; None if the node does not say
# dropped: by the subscriber's queue; None if the node does not say
End = collections.namedtuple("End", "topic peer messages dropped")


def ends(bus_info, bus_stats):
    """Return (those of publishers, those of subscribers) of a node's connections: lists of End.

    Any node may answer anything: what has another form is left out.
    """
    sides = {"o": [], "i": []}
    try:
        stats = _stats(bus_stats)
    except (TypeError, ValueError, IndexError):
        stats = {}
    try:
        for number, peer, direction, _, topic, *_ in bus_info:
            counts = stats.get((direction, topic, str(number)), (None, None))
            if direction in sides:
                sides[direction].append(End(topic, peer, *counts))
    except (TypeError, ValueError):
        pass
    return sides["o"], sides["i"]


def _stats(bus_stats):
    """Return (direction, topic, connection) -> (messages, dropped)."""
    found = {}
    for direction, topics in zip("oi", bus_stats):
        # rospy's publishers have the bytes of all connections before the connections.
        for topic, *_, connections in topics:
            for connection in connections:
                dropped = None
                if direction == "i":
                    messages, dropped = connection[2:4]
                else:
                    # roscpp: id, bytes, bytes of messages, messages, 0; rospy: id, bytes, messages,
                    # whether it is connected
                    messages = connection[3 if len(connection) == 5 else 2]
                found[direction, topic, str(connection[0])] = _count(messages), _count(dropped)
    return found


def _count(value):
    return value if isinstance(value, int) and value >= 0 else None
