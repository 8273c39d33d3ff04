# SPDX-License-Identifier: BSD-3-Clause
"""Observes a ROS graph from its first moment on: a master, and a subscriber to every topic.

The master is this process's own. A node that announces a topic has to wait for the master's
answer; the master gives it when this observer is connected. So not even the first message is
missed, however busy the machine is.

    with Observer() as observer:
        subprocess.Popen([...], env={**os.environ, variables.MASTER: observer.uri})
        ...
        observer.seen.messages, observer.seen.logs, observer.seen.publications, ...
"""

import collections
import dataclasses
import importlib.metadata
import io
import logging
import os
import socket
import threading
import time
import xmlrpc.client
from typing import Any, DefaultDict, Dict, Iterable, List, Optional, Tuple, TypeVar

import genpy
import rosgraph
import rosgraph.network
import rosgraph.xmlrpc
import rosmaster.master_api
import rospy
import rospy.impl.masterslave
from rosgraph_msgs.msg import Log as LogMessage

from mrp_check.confined import messages, variables
from mrp_check.confined.seen import Log, Message, Registration, Seen

NAME = "/mrp_check_observer"

# Seconds at most, for which the master lets a publisher wait. A rospy node that logs something
# meanwhile lets nobody in: it asks the master for a parameter, and waits until it has its answer.
_HOLD = 4.0
_ANSWER = 5.0  # seconds within which a node must answer
_KEEP = 3000  # messages of one publisher on one topic: of more, only the number is kept
_TEXT = 2000  # characters of a line
_LAG_TICK = 0.05  # seconds
_HEADER = 2048  # bytes that are read at once of what a publisher says of itself

# The parameters that roscore sets, as its roscore.xml says.
_OF_ROSCORE = {
    "/rosdistro": os.environ.get("ROS_DISTRO", "Debian") + "\n",
    "/rosversion": importlib.metadata.version("rosmaster") + "\n",
}
# rospy asks for this parameter before each line of log, until it is set. If Ctrl-C comes meanwhile,
# rospy doesn't end: so the nodes run as with a master at which somebody has set it.
_NOT_ASKED_AGAIN = "/rosout_disable_topics_generation"
_LEVELS = {
    LogMessage.DEBUG: "DEBUG",
    LogMessage.INFO: "INFO",
    LogMessage.WARN: "WARN",
    LogMessage.ERROR: "ERROR",
    LogMessage.FATAL: "FATAL",
}


Record = TypeVar("Record", Registration, Message, Log)
MasterReply = Tuple[int, str, Any]  # of ROS's master: a code, a sentence, a value


def _bad_rotation(transforms: List[Any]) -> str:
    """Return the frame of a transform whose rotation tf2 refuses, if there is one: its quaternion
    has another length than 1 (QUATERNION_NORMALIZATION_TOLERANCE of tf2's buffer_core.cpp)."""
    for tf in transforms:
        q = tf.transform.rotation
        if abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1) > 0.01:
            return str(tf.child_frame_id)
    return ""


class Observer:
    """A master, and what is seen at it. Times are those of time.monotonic().

    uri: of the master
    seen: all so far, also of what has ended since
    counts: (node, topic) -> number of messages, also of those that are not kept

    There can be one in a process: it is rospy's node.
    """

    def __init__(self) -> None:
        self.seen = Seen()
        self.counts: Dict[Tuple[str, str], int] = {}
        self._subscribers: Dict[str, rospy.Subscriber] = {}
        self._types: Dict[Tuple[str, str], Any] = {}
        self._lock = threading.Lock()
        self._held: List[str] = []
        self._is_released = False
        self._lag: List[float] = []
        os.environ.setdefault(variables.HOSTNAME, "localhost")
        # rosmaster says much to the root logger, which writes it to standard error.
        logging.getLogger("rosmaster").setLevel(logging.CRITICAL)
        self._handler = _Master(self)
        for name, value in _OF_ROSCORE.items():
            self._handler.param_server.set_param(name, value)
        self._handler.param_server.set_param(_NOT_ASKED_AGAIN, False)
        self._server = rosgraph.xmlrpc.XmlRpcNode(0, self._handler)
        self._server.start()
        while not self._server.uri:
            time.sleep(0.01)
        self.uri = self._server.uri
        os.environ[variables.MASTER] = self.uri
        _ROSHandler.shutdown = _refuse
        _ROSHandler._connect_topic = _connect_once
        rospy.init_node(NAME[1:], anonymous=False, disable_signals=True, disable_rosout=True)
        self.subscribe("/rosout")
        threading.Thread(target=self._measure_lag, daemon=True).start()

    def __enter__(self) -> "Observer":
        return self

    def __exit__(self, *_: object) -> None:
        rospy.signal_shutdown("the observation has ended")
        self._handler._shutdown("the observation has ended")
        self._server.shutdown("the observation has ended")

    # --- What the master hears

    def hold(self, node: str, topic: str) -> bool:
        """Wait until this observer is connected to a publisher, or for _HOLD seconds; return
        whether it is."""
        end = time.monotonic() + _HOLD
        self._held.append(node)
        while not self._is_connected(node, topic):
            if self._is_released or time.monotonic() > end:
                break
            time.sleep(0.002)
        else:
            # A publisher answers a subscriber before it begins to send to it. It lets in one after
            # the other: where the next one is answered, it sends to the one before.
            self._shake_hands(node, topic)
        self._held.remove(node)
        return self._is_connected(node, topic)

    def is_held(self, node: str) -> bool:
        """Return whether a node waits for the master's answer: it has done no more as yet."""
        return node in self._held

    def release(self) -> None:
        """Let no publisher wait from now on: one that waits cannot end."""
        self._is_released = True

    def _is_connected(self, node: str, topic: str) -> bool:
        impl = self._subscribers[topic].impl
        connections = impl.connections if impl else []
        return any(getattr(c, "callerid_pub", None) == node for c in list(connections))

    def is_registered(self, node: str) -> bool:
        """Return whether the master still knows anything of a node."""
        handler = self._handler
        kinds = (handler.publishers, handler.subscribers, handler.services)
        return any(node in nodes for kind in kinds for nodes in handler.registered(kind).values())

    def is_subscribed(self, node: str, topic: str) -> bool:
        """Return whether the master knows a node as a subscriber of a topic."""
        handler = self._handler
        return node in handler.registered(handler.subscribers).get(topic, ())

    def offers(self, node: str, service: str) -> bool:
        """Return whether a node has announced a service."""
        return any((s.node, s.topic) == (node, service) for s in list(self.seen.services))

    def most_of(self, node: str) -> int:
        """Return how many messages a node has published on the topic where it published most."""
        counts = [count for (name, _), count in list(self.counts.items()) if name == node]
        return max(counts, default=0)

    def seen_since(self, began: float) -> Seen:
        """Return what was seen, with times from the beginning on."""

        def records(items: Iterable[Record]) -> List[Record]:
            found = [dataclasses.replace(item, time=item.time - began) for item in list(items)]
            for record in found:
                if isinstance(record, Registration) and record.answered:
                    record.answered -= began
            return found

        found = self.seen
        return Seen(
            records(found.publications),
            records(found.subscriptions),
            records(found.messages),
            records(found.logs),
            self.lag(),
            records(found.services),
            records(found.lookups),
        )

    # --- What is published

    def subscribe(self, topic: str) -> None:
        callback = self._log if topic == "/rosout" else self._message
        with self._lock:
            if topic not in self._subscribers:
                self._subscribers[topic] = rospy.Subscriber(
                    topic, rospy.AnyMsg, callback, callback_args=topic, queue_size=None
                )

    def _message(self, message: Any, topic: str) -> None:
        now, header = time.monotonic(), message._connection_header
        node = header.get("callerid", "")
        if node == NAME:
            return
        count = self.counts[node, topic] = self.counts.get((node, topic), 0) + 1
        if count <= _KEEP:
            fields = self._fields(message, header)
            self.seen.messages.append(Message(node, topic, fields, now))

    def _fields(self, message: Any, header: Dict[str, str]) -> Optional[Dict[str, messages.Plain]]:
        key = header.get("type", ""), header.get("md5sum", "")
        try:
            if key not in self._types:
                self._types[key] = messages.of_definition(key[0], header["message_definition"])
            found = self._types[key]().deserialize(message._buff)
            if key[0] == "tf2_msgs/TFMessage":
                pairs = [(tf.header.frame_id, tf.child_frame_id) for tf in found.transforms]
                frames = " ".join(name.lstrip("/") for pair in pairs for name in pair)
                return {"frames": frames, "bad_rotation": _bad_rotation(found.transforms)}
            return messages.flatten(found)
        except Exception:  # whatever a package sends: it is no reason to stop
            return None

    def _log(self, message: Any, topic: str) -> None:
        try:
            log = LogMessage().deserialize(message._buff)
        except genpy.DeserializationError:
            return
        if len(self.seen.logs) < 10 * _KEEP:
            level, text = _LEVELS.get(log.level, str(log.level)), log.msg[:_TEXT]
            now = time.monotonic()
            self.seen.logs.append(Log(log.name, level, text, log.file, log.line, now))

    def is_latched(self, node: str, topic: str) -> bool:
        """Return whether a node latches a topic, as one who subscribes now is told; None if it does
        not answer.

        What it tells its first subscribers may be too early: rospy latches after it has announced.
        """
        answer = self._shake_hands(node, topic)
        return answer is not None and answer.get("latching") == "1"

    def latched(self) -> Dict[str, List[str]]:
        """Return topic -> the nodes that latch it."""
        found: Dict[str, List[str]] = {}
        known = {(record.topic, record.node) for record in list(self.seen.publications)}
        for topic, node in known:
            if topic != "/rosout" and self.is_registered(node) and self.is_latched(node, topic):
                found.setdefault(topic, []).append(node)
        return found

    def _shake_hands(self, node: str, topic: str) -> Optional[Dict[str, str]]:
        """Subscribe for a moment; return what the publisher says of it, or None."""
        try:
            publishers = self._handler.registered(self._handler.publishers)
            with xmlrpc.client.ServerProxy(publishers[topic][node]) as proxy:
                answer: Any = proxy.requestTopic(NAME, topic, [["TCPROS"]])
            code, _, found = answer
            if code != 1 or not found:
                return None
            header = {"topic": topic, "md5sum": "*", "type": "*", "callerid": NAME + "_late"}
            return _answer(tuple(found[1:3]), header)
        except (KeyError, OSError, xmlrpc.client.Error, rosgraph.network.ROSHandshakeException):
            return None

    def ask_types(self) -> None:
        """Find out the types of the services that were announced: the master does not know them."""
        for service in self.seen.services:
            service.type = service.type or self._type_of(service.topic)

    def _type_of(self, service: str) -> str:
        header = {"probe": "1", "md5sum": "*", "callerid": NAME, "service": service}
        try:
            address = self._handler.lookupService(NAME, service)[2]
            place = rosgraph.network.parse_http_host_and_port(address)
            return _answer(place, header).get("type", "")
        except (OSError, ValueError, rosgraph.network.ROSHandshakeException):
            return ""  # it has ended

    # --- How busy the machine is

    def _measure_lag(self) -> None:
        while True:
            before = time.monotonic()
            time.sleep(_LAG_TICK)
            self._lag.append(time.monotonic() - before - _LAG_TICK)

    def lag(self) -> float:
        """Return by how many seconds this process was scheduled late, of all times the worst but
        one in ten."""
        lag = sorted(self._lag)
        return lag[len(lag) * 9 // 10] if lag else 0.0


def _answer(place: Tuple[Any, ...], header: Dict[str, str]) -> Dict[str, str]:
    """Return what a publisher, or a service, answers to a header."""
    with socket.create_connection(place, _ANSWER) as connection:
        rosgraph.network.write_ros_handshake_header(connection, header)
        answer = rosgraph.network.read_ros_handshake_header(connection, io.BytesIO(), _HEADER)
        return dict(answer)


def _refuse(self: object, caller_id: str, reason: str = "") -> MasterReply:
    """Answer to one who asks the observer, or its master, to shut down."""
    return -1, "the observation is not over", 0


_ROSHandler = rospy.impl.masterslave.ROSHandler
_connect = _ROSHandler._connect_topic
_turns: DefaultDict[Tuple[str, str], threading.Lock] = collections.defaultdict(threading.Lock)


def _connect_once(self: object, topic: str, publisher: str) -> Any:
    """Connect to a publisher as rospy does, but never twice at the same time.

    The master often tells of one publisher twice in a row. rospy then drops one of two connections,
    and may leave it open, but say nothing: the publisher waits for that, and lets in nobody else.
    """
    with _turns[topic, publisher]:
        return _connect(self, topic, publisher)


class _Master(rosmaster.master_api.ROSMasterHandler):  # type: ignore[misc]  # it has no types
    """A master that tells the observer what it hears, and lets publishers wait for it."""

    shutdown = _refuse

    def __init__(self, observer: Observer) -> None:
        super().__init__()
        self._observer = observer

    def registered(self, kind: Any) -> Dict[str, Dict[str, str]]:
        """Return topic or service -> node -> its address, of the publishers, for example.

        Kept from changing meanwhile: nodes register from other threads, while this one reads."""
        with self.ps_lock:
            return {name: dict(nodes) for name, nodes in kind.map.items()}

    @staticmethod
    def _note(records: List[Registration], node: str, name: str, type_: str = "") -> None:
        """Note what another one than this observer has registered, or looked for."""
        if node != NAME:
            records.append(Registration(node, name, type_, time.monotonic()))

    def registerPublisher(  # noqa: N802
        self, caller_id: str, topic: str, topic_type: str, caller_api: str
    ) -> MasterReply:
        is_other = caller_id != NAME
        if is_other:
            self._observer.subscribe(topic)
        answer: MasterReply = super().registerPublisher(caller_id, topic, topic_type, caller_api)
        if answer[0] == 1 and is_other:
            now = time.monotonic()
            registration = Registration(caller_id, topic, topic_type, now, heard=False)
            self._observer.seen.publications.append(registration)
            registration.heard = self._observer.hold(caller_id, topic)
            registration.answered = time.monotonic()
        return answer

    def registerSubscriber(  # noqa: N802
        self, caller_id: str, topic: str, topic_type: str, caller_api: str
    ) -> MasterReply:
        answer: MasterReply = super().registerSubscriber(caller_id, topic, topic_type, caller_api)
        if answer[0] == 1:
            self._note(self._observer.seen.subscriptions, caller_id, topic, topic_type)
        return answer

    def registerService(  # noqa: N802
        self, caller_id: str, service: str, service_api: str, caller_api: str
    ) -> MasterReply:
        answer: MasterReply = super().registerService(caller_id, service, service_api, caller_api)
        if answer[0] == 1:
            self._note(self._observer.seen.services, caller_id, service)
        return answer

    def lookupService(self, caller_id: str, service: str) -> MasterReply:  # noqa: N802
        lookups = self._observer.seen.lookups
        known = any((lookup.node, lookup.topic) == (caller_id, service) for lookup in list(lookups))
        if not known and len(lookups) < _KEEP:
            self._note(lookups, caller_id, service)
        answer: MasterReply = super().lookupService(caller_id, service)
        return answer
