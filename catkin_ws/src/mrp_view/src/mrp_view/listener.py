# SPDX-License-Identifier: BSD-3-Clause
"""Subscribe to everything that is published, count what comes, and look into some of it."""

import collections
import threading
import time

import rosgraph
import rospy
from rosgraph_msgs.msg import Log

from mrp_view import fields, rpc
from mrp_view.counting import Sender
from mrp_view.graph import refusal

LOG_TOPIC = "/rosout"
LOG_LINES = 500  # that are kept
_LEVELS = {1: "DEBUG", 2: "INFO", 4: "WARN", 8: "ERROR", 16: "FATAL"}
_LONGEST_LINE = 2000  # characters
_LARGE = 100_000  # bytes: larger messages are looked into only once a second
_STILL = 1.0  # seconds after which a publisher that the master no longer knows has not just ended
_FORGET = 60  # seconds for which what a topic's senders sent is shown after the topic has gone


class _Heard:
    """A Sender, and what its messages are."""

    def __init__(self, header):
        self.type = header.get("type", "")
        self.md5sum = header.get("md5sum", "")
        self.latched = header.get("latching") == "1"
        definition = header.get("message_definition", "")
        has_header = fields.has_header(self.type, definition)
        self.sender = Sender(
            fields.counter_of(self.type, definition), fields.stamp_of if has_header else None
        )
        self.message_class, self.why = fields.message_class(self.type, self.md5sum)
        self.value = self.why or ""
        self.number = None
        self.inspected = 0.0  # when its last large message was read
        self.unknown_since = None  # when the master no longer knew it


class Listener:
    """The viewer as a subscriber.

    settle: the viewer subscribes to a topic once nobody has joined or left it for this many
        seconds. A publisher that waits for its subscribers counts the viewer, too: so the others
        go first.

    lines: the last log lines, (number, dict), the number counting from 1
    refusals: as in graph.Observation
    """

    def __init__(self, settle):
        self._settle = settle
        self._subscribers = {}  # topic -> rospy.Subscriber
        self._since = {}  # topic -> (its publishers and subscribers, since when)
        self._gone = {}  # topic -> since when it is not subscribed to
        self._known = set()  # (topic, publisher) that the master knows
        self._lock = threading.Lock()
        self._heard = {}  # (topic, publisher) -> _Heard
        self.lines = collections.deque(maxlen=LOG_LINES)
        self.lines_count = 0
        self.refusals = {}

    def follow(self, observation):
        """Subscribe to what is published, and to nothing else. Takes an Observation."""
        now = time.monotonic()
        name = observation.viewer
        others = {}
        for topic in {*observation.publishers, *observation.subscribers}:
            publishers = tuple(
                publisher
                for publisher in observation.publishers.get(topic, ())
                if publisher != name
            )
            subscribers = tuple(
                subscriber
                for subscriber in observation.subscribers.get(topic, ())
                if subscriber != name
            )
            if publishers:
                others[topic] = (publishers, subscribers)
        # The log from the first line on: it tells who refuses whom.
        others.setdefault(LOG_TOPIC, ((), ()))
        for topic in sorted(others):
            who, since = self._since.get(topic, (None, 0))
            if who != others[topic]:
                self._since[topic] = (others[topic], now)
                since = now
            if topic not in self._subscribers and (
                topic == LOG_TOPIC or now - since >= self._settle
            ):
                self._subscribe(topic)
        for topic in set(self._subscribers) - set(others):
            # After a restart the master does not know those who go on publishing.
            if not self._subscribers[topic].get_num_connections():
                self._subscribers.pop(topic).unregister()
                self._since.pop(topic, None)
        self._forget(others, now)
        self._known = {
            (topic, known) for topic, names in observation.publishers.items() for known in names
        }

    def end(self):
        """Take over that all publishers have ended."""
        self._known = set()

    def _subscribe(self, topic):
        callback = self._log_line if topic == LOG_TOPIC else self._count
        # It must not lose what it counts: neither a queue that drops, nor a small buffer.
        self._subscribers[topic] = rospy.Subscriber(
            topic, rospy.AnyMsg, callback, callback_args=topic, buff_size=2**18
        )

    def _forget(self, topics, now):
        with self._lock:
            for topic in self._subscribers:
                self._gone.pop(topic, None)
            for topic, publisher in list(self._heard):
                silent = topic not in self._subscribers
                if silent and now - self._gone.setdefault(topic, now) > _FORGET:
                    del self._heard[topic, publisher]
            self.refusals = {
                key: refusal for key, refusal in self.refusals.items() if refusal.topic in topics
            }

    def register_again(self, observation, master):
        """Register with a master that knows the viewer no more, as it was restarted: rospy does so
        only once. The connections stay, so that no count has a gap.

        master: its rpc.Proxy. Raises one of rpc.ERRORS.
        """
        uri = rospy.get_node_uri()
        for topic in list(self._subscribers):
            wanted = topic == LOG_TOPIC or topic in observation.publishers
            if wanted and observation.viewer not in observation.subscribers.get(topic, ()):
                publishers = master.call("registerSubscriber", topic, rosgraph.names.ANYTYPE, uri)
                # As the master says it to a subscriber that it knows.
                rpc.Proxy(uri, 5).call("publisherUpdate", topic, publishers)

    def _count(self, message, topic):
        now = time.time()
        header = message._connection_header
        heard = self._heard.get((topic, header.get("callerid")))
        if heard is None or heard.md5sum != header.get("md5sum"):
            heard = self._new(topic, header)
        heard.sender.add(now, message._buff, rospy.get_time)

    def _new(self, topic, header):
        with self._lock:
            heard = _Heard(header)
            self._heard[topic, header.get("callerid", "?")] = heard
            return heard

    def _log_line(self, message, topic):
        self._count(message, topic)
        if message._connection_header.get("md5sum") != Log._md5sum:
            return
        log = Log().deserialize(message._buff)
        refused = refusal(log.name, log.msg)
        with self._lock:
            if refused:
                self.refusals[refused[:3]] = refused
            self.lines_count += 1
            self.lines.append(
                (
                    self.lines_count,
                    {
                        "t": log.header.stamp.to_sec(),
                        "node": log.name,
                        "level": _LEVELS.get(log.level, str(log.level)),
                        "text": log.msg[:_LONGEST_LINE],
                    },
                )
            )

    def observe(self, observation):
        """Put into an Observation what the connections say."""
        with self._lock:
            observation.sender_types = {
                key: publisher.type for key, publisher in self._heard.items()
            }
            observation.latched = {
                key for key, publisher in self._heard.items() if publisher.latched
            }
            observation.refusals = dict(self.refusals)

    def look(self, now):
        """Return what has been sent, and look into the newest messages: a list of dicts.

        now: seconds since the epoch
        """
        with self._lock:
            all_heard = sorted(self._heard.items())
            known = set(self._known)
        return [
            self._row(topic, publisher, heard, (topic, publisher) in known, now)
            for (topic, publisher), heard in all_heard
        ]

    def _row(self, topic, publisher, heard, known, now):
        sender = heard.sender
        if known:
            heard.unknown_since = None
        elif heard.unknown_since is None:
            heard.unknown_since = now
        forgotten = not known and sender.last - heard.unknown_since > _STILL
        count, raw_samples = sender.take()
        if sender.size > _LARGE and now - heard.inspected < 1:
            raw_samples = []
        samples = [self._sample(heard, at, raw) for at, raw in raw_samples]
        if samples:
            heard.inspected = now
        return {
            "topic": topic,
            "from": publisher,
            "type": heard.type,
            "gone": not known,
            "forgotten": forgotten,
            "count": count,
            "size": sender.size,
            "rate": round(sender.rate(now), 2),
            "missing": sender.missing(),
            "counted": sender.counted,
            "latency": sender.latency,
            "value": heard.value,
            "number": heard.number,
            "samples": samples,
        }

    def _sample(self, heard, at, raw):
        """Return (time, number or None) of a raw message, and remember what it says."""
        if isinstance(raw, int):
            heard.value, heard.number = f"{raw / 1e6:.0f} MB, not decoded", None
            return round(at, 4), None
        if heard.message_class is None:
            return round(at, 4), None
        try:
            message = heard.message_class().deserialize(raw)
            named = fields.number(message)
            heard.value = (
                message.msg[: fields.LONGEST] if isinstance(message, Log) else fields.text(message)
            )
        except Exception as error:  # what genpy raises of bytes that are no such message
            heard.value = f"no {heard.type}: {error}"
            named = None
        heard.number = named and named[0]
        number = named and named[1]
        # JSON has no number for these.
        finite = isinstance(number, (int, float)) and abs(number) < float("inf")
        return round(at, 4), number if finite else None
