# SPDX-License-Identifier: BSD-3-Clause
"""The private parameters of a lab's node, each checked as it is read. The twin of parameters.h."""

import copy
import json
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
        return self._get(
            name, fallback, "a string that is not empty", lambda value: _is(str, value) and value
        )

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
        choice = self.text(name, allowed[0])
        if choice not in allowed:
            raise self.wrong(name, "one of " + ", ".join(allowed))
        return choice

    def texts(self, name):
        """Return a list of strings."""
        return self._get(
            name,
            [],
            "a list of strings",
            lambda value: _is(list, value) and all(_is(str, text) for text in value),
        )

    def number_or_none(self, name, fallback):
        """Return a whole number, 0 or more; or None if it is "none", as some of rospy may be."""
        self._known.add(name)
        return None if self._all.get(name) == "none" else self.number(name, fallback)

    def number(self, name, fallback, least=0):
        """Return a whole number from `least` on."""
        allowed = "" if least == -math.inf else f", {least} or more"
        return self._get(
            name,
            fallback,
            "a whole number" + allowed,
            lambda value: _is(int, value) and value >= least,
        )

    def seconds(self, name, fallback):
        """Return seconds, 0 or more. A whole number will do."""
        return self._get(
            name,
            fallback,
            "a number of seconds, 0 or more",
            lambda value: _is((int, float), value) and math.isfinite(value) and value >= 0,
        )

    def flag(self, name, fallback):
        """Return True or False."""
        return self._get(name, fallback, "true or false", lambda value: isinstance(value, bool))

    def of_each_topic(self):
        """Return the parameters of each topic of the node.

        Without ~topics it is one topic, and all parameters are its own; with it, each topic has
        some by its name, and the node's count for all topics.
        """
        topics = self._get(
            "topics",
            None,
            "a struct of topics, each with a struct of parameters",
            lambda value: _is(dict, value) and all(_is(dict, own) for own in value.values()),
        )
        if topics is None:
            return [self]
        result = []
        for topic, own in sorted(topics.items()):
            result.append(copy.deepcopy(self))
            result[-1]._all.update({"topic": topic, **own})
        return result

    def no_others(self):
        """Call this last: a parameter that nobody has asked for is a misspelt one."""
        for name in sorted(self._all):
            if name not in self._known:
                known = ", ".join("~" + known for known in sorted(self._known))
                raise ValueError(f"parameter ~{name} is not known, only {known}")

    def wrong(self, name, allowed):
        """Return the error that says what is wrong with a parameter."""
        value = json.dumps(self._all[name])
        return ValueError(f"parameter ~{name} is {value}, but must be {allowed}")

    def _get(self, name, fallback, allowed, check):
        """Return a parameter, or the fallback if nobody has set it."""
        self._known.add(name)
        value = self._all.get(name, fallback)
        if name in self._all and not check(value):
            raise self.wrong(name, allowed)
        return value


def _is(type_, value):
    """Return whether a value is of a type. To Python, True and False are numbers, too."""
    return isinstance(value, type_) and not isinstance(value, bool)
