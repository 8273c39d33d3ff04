# SPDX-License-Identifier: BSD-3-Clause
"""When the viewer subscribes, what it reads in messages, and what it counts of them."""

import io
import struct
import types

import pytest
from mrp_labs.msg import Count
from mrp_view import fields, listener
from mrp_view.counting import SAMPLES, Gaps, Sender
from rosgraph_msgs.msg import Log
from std_msgs import msg as std_msgs

pytestmark = pytest.mark.quick


def gaps(*values, modulus=2**32):
    result = Gaps(modulus)
    for value in values:
        result.add(value)
    return result.missing(), result.restarts


def test_gaps_of_any_step():
    assert gaps(1, 3, 5, 7, 11, 13) == (1, 0)
    assert gaps(2, 4, 6, 12, 14) == (2, 0)
    assert gaps(1, 2, 3, 4, 104, 105) == (99, 0)


def test_wrap_round_is_no_gap():
    assert gaps(2**32 - 3, 2**32 - 1, 1, 3) == (0, 0)
    assert gaps(253, 254, 255, 0, 2, modulus=256) == (1, 0)


def test_publisher_that_begins_anew_has_no_gap():
    assert gaps(10, 12, 14, 2, 4, 6) == (0, 1)


def test_what_is_no_counter_has_no_gaps():
    assert gaps(1, 2) == (None, 0)
    assert gaps(5, 5, 5, 5) == (None, 0)
    assert gaps(1, 10, 12, 100, 107)[0] is None


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


@pytest.mark.parametrize("bits", [8, 16, 32, 64])
@pytest.mark.parametrize("sign", ["", "U"])
def test_integers_are_counters(bits, sign):
    message = getattr(std_msgs, f"{sign}Int{bits}")(data=100)
    read, modulus, name = fields.counter_of(message._type, message._full_text)
    assert (read(serialized(message)), modulus, name) == (100, 2**bits, "data")


def test_header_is_a_counter_and_has_a_stamp():
    message = Count(counter=7)
    message.header.seq = 12
    message.header.stamp.secs, message.header.stamp.nsecs = 3, 500_000_000
    read, _, name = fields.counter_of(Count._type, Count._full_text)
    assert (read(serialized(message)), name) == (12, "header.seq")
    assert fields.stamp_of(serialized(message)) == 3.5
    assert fields.stamp_of(serialized(Count())) is None
    assert fields.has_header(Log._type, Log._full_text)
    assert not fields.has_header("std_msgs/String", std_msgs.String._full_text)
    # A header that is not the first field lies somewhere else in the message.
    assert not fields.has_header("a/B", "uint8 X=1\nuint8 data\nHeader header\n")
    assert fields.counter_of("std_msgs/Float32", "float32 data\n") is None


@pytest.mark.parametrize(
    ("message", "text", "number"),
    [
        (std_msgs.UInt32(4), "4", ("data", 4)),
        (std_msgs.String("<b>"), "<b>", None),
        (std_msgs.Float32(0.5), "0.5", ("data", 0.5)),
        (std_msgs.Bool(True), "True", ("data", 1)),
        (std_msgs.Empty(), "empty", None),
        (
            std_msgs.UInt8MultiArray(data=b"\x01\xff"),
            "layout: dim: [], data_offset: 0, data: 2 bytes: 01 ff",
            ("layout.data_offset", 0),
        ),
        (std_msgs.ColorRGBA(1, 0, 0, 1), "r: 1, g: 0, b: 0, a: 1", ("r", 1)),
    ],
)
def test_text_and_number(message, text, number):
    assert (fields.text(message), fields.number(message)) == (text, number)


def test_text_of_a_large_message_is_short():
    large = std_msgs.Int32MultiArray(data=list(range(100_000)))
    assert len(fields.text(large)) <= fields.LONGEST
    assert "100000 in all" in fields.text(large)
    assert len(fields.text(std_msgs.String("x" * 10**6))) == fields.LONGEST


def test_header_has_no_number_but_what_follows_has():
    assert fields.number(Count(counter=7)) == ("counter", 7)


def test_types_that_cannot_be_shown():
    found, why = fields.message_class("std_msgs/UInt32", std_msgs.UInt32._md5sum)
    assert (found, why) == (std_msgs.UInt32, None)
    for name, md5sum, words in (
        ("std_msgs/UInt32", "0", "is a different one"),
        ("std_msgs/NoSuch", "0", "isn't installed"),
        ("no_such_package/A", "0", "isn't installed"),
        ("../../etc/passwd", "0", "isn't the name of a type"),
    ):
        found, why = fields.message_class(name, md5sum)
        assert found is None and words in why


def test_counts_stay_exact_while_few_messages_are_kept():
    sender = Sender(fields.counter_of("std_msgs/UInt32", ""))
    for number in range(1000):
        sender.add(0.0, struct.pack("<I", number), None)
    count, samples = sender.take()
    assert count == 1000
    assert [struct.unpack("<I", raw)[0] for _, raw in samples] == list(range(1000))[-SAMPLES:]
    assert sender.take() == (1000, [])
    assert sender.missing() == (0, 0)


def test_bytes_that_are_no_message_are_counted_all_the_same():
    sender = Sender(fields.counter_of("a/B", "Header header\n"), fields.stamp_of)
    sender.add(0.0, b"", None)
    sender.add(0.0, b"12", None)
    assert sender.take()[0] == 2
    assert sender.missing() is None


def test_rate_is_that_of_the_last_seconds():
    sender = Sender()
    for tenth in range(200):
        sender.add(0.0, b"", None)
        rate = sender.rate(tenth / 10)
    assert rate == pytest.approx(10, rel=0.05)
    for tenth in range(200, 300):
        rate = sender.rate(tenth / 10)
    assert rate == 0


def test_others_come_first(monkeypatch):
    """It subscribes to a topic only when nobody has joined or left it for a while."""
    now, topics = 100.0, []

    def subscriber(topic, *_, **__):
        topics.append(topic)
        return types.SimpleNamespace(get_num_connections=lambda: 1)

    def observation(*subscribers):
        return types.SimpleNamespace(
            viewer="/view", publishers={"/t": ["/p"]}, subscribers={"/t": [*subscribers]}
        )

    monkeypatch.setattr(listener.rospy, "Subscriber", subscriber)
    monkeypatch.setattr(listener.time, "monotonic", lambda: now)
    listener_ = listener.Listener(settle=3.0)
    listener_.follow(observation())
    now += 2.0
    listener_.follow(observation("/joins"))
    now += 2.0
    listener_.follow(observation("/joins"))
    now += 2.0
    listener_.follow(observation())  # it has left
    now += 2.9
    listener_.follow(observation())
    assert topics == [listener.LOG_TOPIC]
    now += 0.1
    listener_.follow(observation())
    assert topics == [listener.LOG_TOPIC, "/t"]
