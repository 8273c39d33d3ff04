# SPDX-License-Identifier: BSD-3-Clause
"""Checks when the viewer subscribes to a topic: all others go first."""

import types

import pytest
from mrp_view import listener

pytestmark = pytest.mark.quick


def test_others_come_first(monkeypatch):
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
    one = listener.Listener(settle=3.0)
    one.follow(observation())
    now += 2.0
    one.follow(observation("/joins"))
    now += 2.0
    one.follow(observation("/joins"))
    now += 2.0
    one.follow(observation())  # it has left
    now += 2.9
    one.follow(observation())
    assert topics == [listener.LOG_TOPIC]
    now += 0.1
    one.follow(observation())
    assert topics == [listener.LOG_TOPIC, "/t"]
