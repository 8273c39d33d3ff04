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

    What does not have the form that it should have is left out: any node may answer anything.
    """
    stats = _stats(bus_stats)
    outbound, inbound = [], []
    for connection in _lists(bus_info, 5):
        number, peer, direction, _, topic = connection[:5]
        if not isinstance(peer, str) or not isinstance(topic, str):
            continue
        if direction == "o":
            outbound.append(End(topic, peer, *stats.get(("o", topic, _key(number)), (None, None))))
        elif direction == "i":
            inbound.append(End(topic, peer, *stats.get(("i", topic, _key(number)), (None, None))))
    return outbound, inbound


def _stats(bus_stats):
    """Return (direction, topic, connection) -> (messages, dropped)."""
    found = {}
    parts = bus_stats if isinstance(bus_stats, list) else []
    for direction, part in zip("oi", parts):
        for topic in _lists(part, 2):
            # rospy's publishers have the bytes of all connections before the connections.
            for connection in _lists(topic[-1], 4):
                key = (direction, str(topic[0]), _key(connection[0]))
                if direction == "i":
                    dropped = connection[3] if _is_count(connection[3]) else None
                    messages = connection[2]
                else:
                    # roscpp: id, bytes, bytes of messages, messages, 0; rospy: id, bytes, messages,
                    # whether it is connected
                    dropped = None
                    messages = connection[3] if len(connection) == 5 else connection[2]
                found[key] = (messages if _is_count(messages) else None, dropped)
    return found


def _lists(value, length):
    """Return the lists of at least that length in a list."""
    value = value if isinstance(value, list) else []
    return [item for item in value if isinstance(item, list) and len(item) >= length]


def _key(number):
    return str(number)


def _is_count(value):
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0
