# SPDX-License-Identifier: BSD-3-Clause
"""The private parameters of a lab's node, each checked as it is read. The twin of parameters.h."""

import copy

import rospy

_ALLOWED = {
    bool: "true or false",
    dict: "a struct of topics",
    float: "a number of seconds, 0 or more",
    int: "a whole number, 0 or more",
    list: "a list",
    str: "a text",
}


class Parameters:
    """Reads the node's private parameters.

    Whatever is wrong with one ends in a ValueError that names the parameter, its value and what is
    allowed: nothing is silently replaced.
    """

    def __init__(self):
        self._all = rospy.get_param(rospy.get_name(), {})
        self._known = set()

    def get(self, name, fallback):
        """Return a parameter, which must be of the fallback's type and not negative; or the
        fallback. As seconds, a whole number will do."""
        self._known.add(name)
        value = self._all.get(name, fallback)
        type_ = type(fallback)
        if type_ is float and type(value) is int:
            value = float(value)
        if type(value) is not type_ or (type_ in (int, float) and value < 0):
            raise self._wrong(name, _ALLOWED[type_])
        return value

    def choice(self, name, allowed):
        """Return one of a few texts. The first one is the default."""
        choice = self.get(name, allowed[0])
        if choice not in allowed:
            raise self._wrong(name, "one of " + " ".join(allowed))
        return choice

    def number_or_none(self, name, fallback):
        """Return a whole number, 0 or more; or None if it is "none", as some of rospy may be."""
        self._known.add(name)
        return None if self._all.get(name) == "none" else self.get(name, fallback)

    def of_each_topic(self):
        """Return the parameters of each topic of the node.

        Without ~topics it is one topic, and all parameters are its own; with it, each topic has
        some by its name, and the node's count for all topics.
        """
        result = []
        for topic, own in sorted(self.get("topics", {}).items()):
            result.append(copy.deepcopy(self))
            result[-1]._all.update({"topic": topic, **own})
        return result or [self]

    def no_others(self):
        """Call this last: a parameter that nobody has asked for is a misspelt one."""
        for name in sorted(self._all):
            if name not in self._known:
                known = " ".join("~" + known for known in sorted(self._known))
                raise ValueError(f"parameter ~{name} is not known, only {known}")

    def _wrong(self, name, allowed):
        return ValueError(f"parameter ~{name} is {self._all[name]}, but must be {allowed}")
