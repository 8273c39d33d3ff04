# SPDX-License-Identifier: BSD-3-Clause
"""The private parameters of a lab's node, each checked as it is read. The twin of parameters.h."""

import copy
import math

import rosgraph
import rospy


class Parameters:
    """Reads the node's private parameters.

    Whatever is wrong with one ends in a ValueError that names the parameter, its value and what is
    allowed: nothing is silently replaced.
    """

    def __init__(self):
        self._all = rospy.get_param(rospy.get_name(), {})
        self._known = set()

    def text(self, name, fallback):
        """Return a string that is not empty."""
        if not self._is_set(name):
            return fallback
        value = self._all[name]
        if not isinstance(value, str) or not value:
            raise self.wrong(name, "a string that is not empty")
        return value

    def topic(self, name, fallback):
        """Return the name of a topic."""
        topic = self.text(name, fallback)
        if not rosgraph.names.is_legal_name(topic):
            raise self.wrong(
                name, "a topic's name: letters, digits, _ and /, with a letter, / or ~ in front"
            )
        return topic

    def choice(self, name, allowed):
        """Return one of a few strings. The first one is the default."""
        if not self._is_set(name):
            return allowed[0]
        value = self._all[name]
        if value not in allowed:
            raise self.wrong(name, "one of " + ", ".join(f'"{one}"' for one in allowed))
        return value

    def texts(self, name):
        """Return a list of strings."""
        if not self._is_set(name):
            return []
        value = self._all[name]
        if not isinstance(value, list) or not all(isinstance(one, str) for one in value):
            raise self.wrong(name, "a list of strings")
        return value

    def number_or_none(self, name, fallback):
        """Return a whole number, 0 or more; or None if it is "none", as some of rospy may be."""
        if self._is_set(name) and self._all[name] == "none":
            return None
        return self.number(name, fallback)

    def number(self, name, fallback, least=0):
        """Return a whole number from `least` (None: any) on."""
        if not self._is_set(name):
            return fallback
        value = self._all[name]
        # To Python, True and False are numbers too.
        if not isinstance(value, int) or isinstance(value, bool):
            value = None
        if value is None or (least is not None and value < least):
            raise self.wrong(
                name, "a whole number" + ("" if least is None else f", {least} or more")
            )
        return value

    def seconds(self, name, fallback):
        """Return seconds, 0 or more. A whole number will do."""
        if not self._is_set(name):
            return fallback
        value = self._all[name]
        if not isinstance(value, (int, float)) or isinstance(value, bool):
            value = -1
        if not math.isfinite(value) or value < 0:
            raise self.wrong(name, "a number of seconds, 0 or more")
        return float(value)

    def flag(self, name, fallback):
        """Return True or False."""
        if not self._is_set(name):
            return fallback
        value = self._all[name]
        if not isinstance(value, bool):
            raise self.wrong(name, "true or false")
        return value

    def of_each_topic(self):
        """Return the parameters of each topic of the node.

        Without ~topics it is one topic, and all parameters are its own; with it, each topic has
        some by its name, and the node's count for all topics.
        """
        if not self._is_set("topics"):
            return [self]
        allowed = "a struct of topics, each with a struct of parameters"
        topics = self._all["topics"]
        if not isinstance(topics, dict) or not topics:
            raise self.wrong("topics", allowed)
        result = []
        for topic, own in sorted(topics.items()):
            if not isinstance(own, dict):
                raise self.wrong("topics", allowed)
            result.append(copy.deepcopy(self))
            result[-1]._all.update({"topic": topic, **own})
        return result

    def no_others(self):
        """Call this last: a parameter that nobody has asked for is a misspelt one."""
        for name in sorted(self._all):
            if name not in self._known:
                known = ", ".join("~" + one for one in sorted(self._known))
                raise ValueError(f"parameter ~{name} is not known, only {known}")

    def wrong(self, name, allowed):
        """Return the error that says what is wrong with a parameter."""
        return ValueError(f"parameter ~{name} is {_shown(self._all[name])}, but must be {allowed}")

    def _is_set(self, name):
        self._known.add(name)
        return name in self._all


def _shown(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list):
        return "[" + ", ".join(_shown(one) for one in value) + "]"
    return "no plain value"
