#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sends every type of message, with its smallest and largest values, and values out of range.

And headers: seq is overwritten on the way, and stamp arrives as it was set.
"""

import unittest

import rospy
import rostest
from mrp_labs.msg import Count
from mrp_testing.lab import PACKAGE, Lab, path_of
from mrp_testing.nodes import program
from mrp_testing.process import LIVE, Process
from mrp_testing.waiting import wait_until

LANGUAGES = ("cpp", "py")
LONG_TEXT = "Ein Topic ist ein Thema, über das Knoten reden: トピックはノードが話すテーマです 🤖"

# The lab: type -> what arrives, in any of the four directions.
INTEGERS = {
    "std_msgs/Bool": ["0", "1"],
    "std_msgs/Byte": ["-128", "127"],
    "std_msgs/Char": ["0", "255"],
    "std_msgs/Int8": ["-128", "127"],
    "std_msgs/Int16": ["-32768", "32767"],
    "std_msgs/Int32": ["-2147483648", "2147483647"],
    "std_msgs/Int64": ["-9223372036854775808", "9223372036854775807"],
    "std_msgs/UInt8": ["0", "255"],
    "std_msgs/UInt16": ["0", "65535"],
    "std_msgs/UInt32": ["0", "4294967295"],
    "std_msgs/UInt64": ["0", "18446744073709551615"],
}
FLOATS = {
    "std_msgs/Float32": [
        *("0.100000001", "0", "-0", "1.40129846e-45", "-1.40129846e-45"),
        *("1.17549435e-38", "-1.17549435e-38", "3.40282347e+38", "-3.40282347e+38"),
        *("inf", "-inf", "nan"),
    ],
    "std_msgs/Float64": [
        *("0.10000000000000001", "0", "-0", "4.9406564584124654e-324", "-4.9406564584124654e-324"),
        *("2.2250738585072014e-308", "-2.2250738585072014e-308"),
        *("1.7976931348623157e+308", "-1.7976931348623157e+308", "inf", "-inf", "nan"),
    ],
}
STRUCTURES = {
    "std_msgs/Empty": ["nothing", "nothing"],
    # Of two topics, a short and a long one each.
    "std_msgs/String": [
        *('""', '"Grüße, Welt: 世界 🤖"', '"äöüß" (100000 bytes)'),
        f'"{LONG_TEXT}" (100000 bytes)',
    ],
    "std_msgs/Time": ["0 0", "4294967295 999999999"],
    "std_msgs/Duration": ["-2147483648 0", "2147483647 999999999"],
    "std_msgs/Header": ["0 0 0 map", "4294967295 4294967295 999999999 Größe"],
    "std_msgs/ColorRGBA": ["0 0 0 0", "1 0.5 3.40282347e+38 -1.40129846e-45"],
    "std_msgs/Int32MultiArray": ["[]", "[-2147483648 0 2147483647]"],
}

# What arrives of the same four values from C++ and, at each subscriber, from Python.
WRAPPED = {
    "std_msgs/Byte": ["1", "127", "-128", "2"],
    "std_msgs/Char": ["1", "255", "0", "2"],
    "std_msgs/Int8": ["1", "127", "-128", "2"],
    "std_msgs/Int16": ["1", "32767", "-32768", "2"],
    "std_msgs/Int32": ["1", "2147483647", "-2147483648", "2"],
    "std_msgs/Int64": ["1", "-9223372036854775808", "-1", "2"],
    "std_msgs/UInt8": ["1", "255", "0", "2"],
    "std_msgs/UInt16": ["1", "65535", "0", "2"],
    "std_msgs/UInt32": ["1", "4294967295", "0", "2"],
    "std_msgs/UInt64": ["1", "18446744073709551615", "9223372036854775808", "2"],
    "std_msgs/Float32": ["1", "inf", "-inf", "2"],
}
OUT_OF_RANGE = {
    ("cpp", "cpp"): {
        **WRAPPED,
        "std_msgs/Bool": ["1", "2", "0", "0"],
        "std_msgs/Time": ["1 0", "2 1000000000", "4294967295 1000000000", "4 0"],
        "std_msgs/Duration": ["1 0", "2 -1", "2147483647 1000000000", "4 0"],
        "std_msgs/Int32MultiArray": ["[1]", "[2 -2147483648]", "[2147483647]", "[3]"],
    },
    # rospy carries nanoseconds over into seconds as it receives them, even past the range.
    ("cpp", "py"): {
        **WRAPPED,
        "std_msgs/Bool": ["1", "1", "0", "0"],
        "std_msgs/Time": ["1 0", "3 0", "4294967296 0", "4 0"],
        "std_msgs/Duration": ["1 0", "1 999999999", "2147483648 0", "4 0"],
        "std_msgs/Int32MultiArray": ["[1]", "[2 -2147483648]", "[2147483647]", "[3]"],
    },
    # Half an array had been written when it was refused, which breaks the stream.
    ("py", "cpp"): {
        **{type_: ["1", "2"] for type_ in WRAPPED},
        "std_msgs/Bool": ["1", "2", "0"],
        "std_msgs/Time": ["1 0", "3 0", "4 0"],
        "std_msgs/Duration": ["1 0", "1 999999999", "4 0"],
        "std_msgs/Int32MultiArray": ["[1]"],
    },
    # See refused_value.launch.
    ("py", "py"): {
        **{type_: ["1"] for type_ in WRAPPED},
        "std_msgs/Bool": ["1", "1"],
        "std_msgs/Time": ["1 0", "3 0"],
        "std_msgs/Duration": ["1 0", "1 999999999"],
        "std_msgs/Int32MultiArray": ["[1]"],
    },
}

# type -> the values that rospy refuses, and its words.
UNSIGNED = "ROSSerializationException: field data must be unsigned integer type"
TOO_WIDE = "ROSSerializationException: field data exceeds specified width"
REFUSED = {
    "std_msgs/Bool": {"256": "ROSSerializationException: field data is not a bool"},
    "std_msgs/Byte": {"-129": f"{TOO_WIDE} [byte]", "128": f"{TOO_WIDE} [byte]"},
    "std_msgs/Char": {"-1": UNSIGNED, "256": f"{TOO_WIDE} [char]"},
    "std_msgs/Int8": {"-129": f"{TOO_WIDE} [int8]", "128": f"{TOO_WIDE} [int8]"},
    "std_msgs/Int16": {"-32769": f"{TOO_WIDE} [int16]", "32768": f"{TOO_WIDE} [int16]"},
    "std_msgs/Int32": {
        **{"-2147483649": f"{TOO_WIDE} [int32]", "2147483648": f"{TOO_WIDE} [int32]"},
    },
    "std_msgs/Int64": {
        "9223372036854775808": f"{TOO_WIDE} [int64]",
        "18446744073709551615": f"{TOO_WIDE} [int64]",
    },
    "std_msgs/UInt8": {"-1": UNSIGNED, "256": f"{TOO_WIDE} [uint8]"},
    "std_msgs/UInt16": {"-1": UNSIGNED, "65536": f"{TOO_WIDE} [uint16]"},
    "std_msgs/UInt32": {"-1": UNSIGNED, "4294967296": f"{TOO_WIDE} [uint32]"},
    "std_msgs/UInt64": {"-1": UNSIGNED, "-9223372036854775808": UNSIGNED},
    "std_msgs/Float32": {
        "3.5e+38": "OverflowError: float too large to pack with f format",
        "-1e+39": "OverflowError: float too large to pack with f format",
    },
    "std_msgs/Int32MultiArray": {
        "2 2147483648": "ROSSerializationException: field data[] exceeds specified width [int32]",
        "-2147483649": "ROSSerializationException: field data[] exceeds specified width [int32]",
    },
    "std_msgs/Time": {
        "4294967295 1000000000": "ROSSerializationException: <class 'struct.error'>: "
        "''I' format requires 0 <= number <= 4294967295' when writing 'data: ",
    },
    "std_msgs/Duration": {
        "2147483647 1000000000": "ROSSerializationException: <class 'struct.error'>: "
        "''i' format requires -2147483648 <= number <= 2147483647' when writing 'data: ",
    },
}


def headers_on(test, topic):
    """Return a list, to which each header is added that somebody publishes on a topic."""
    headers = []
    subscriber = rospy.Subscriber(topic, Count, lambda msg: headers.append(msg.header))
    test.addCleanup(subscriber.unregister)
    return headers


class TestMessageTypes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("test_message_types")

    def test_extremes(self):
        groups = {"integers": INTEGERS, "floats": FLOATS, "structures": STRUCTURES}
        with Lab(
            "message_types_integers.launch",
            path_of("message_types_floats.launch"),
            path_of("message_types_structures.launch"),
        ) as lab:
            for group, expected in groups.items():
                for publisher in LANGUAGES:
                    for subscriber in LANGUAGES:
                        self.check(lab, group, publisher, subscriber, expected)

    def test_out_of_range(self):
        with Lab("message_types_out_of_range.launch") as lab:
            # First those that hear the last value of each topic, which others must not.
            for (publisher, subscriber), expected in OUT_OF_RANGE.items():
                self.check(lab, "out_of_range", publisher, subscriber, expected)

            wanted = [
                f"cannot publish {type_} {value}: {words}"
                for type_, refused in REFUSED.items()
                for value, words in refused.items()
            ]
            lab.wait_for(
                lambda: len(errors(lab, "/out_of_range/publisher_py")) >= len(wanted),
                lambda: f"{len(wanted)} values are refused",
            )
            self.assertEqual(sorted(errors(lab, "/out_of_range/publisher_py")), sorted(wanted))
            self.assertEqual(errors(lab, "/out_of_range/publisher_cpp"), [])

    def check(self, lab, group, publisher, subscriber, expected):
        """Check what a subscriber receives of a publisher: type -> values, in that order."""
        publisher, subscriber = (
            f"/{group}/publisher_{publisher}",
            f"/{group}/subscriber_{subscriber}",
        )
        texts = [f"{type_} {value}" for type_, values in expected.items() for value in values]
        received = lab.wait_until_received(subscriber, *texts, publisher=publisher)
        pair = f"{subscriber} from {publisher}"
        self.assertEqual(sorted(received), sorted(texts), pair)
        for type_, values in expected.items():
            in_order = [f"{type_} {value}" for value in values]
            # Two topics of the same type take turns as they like.
            for texts in (in_order[:2], in_order[2:]) if "String" in type_ else (in_order,):
                self.assertEqual([text for text in received if text in texts], texts, pair)

    def test_header_py(self):
        headers = headers_on(self, "/count")
        publisher = rospy.Publisher("/count", Count, queue_size=10)
        self.addCleanup(publisher.unregister)
        wait_until(publisher.get_num_connections, "it is connected")
        for _ in range(3):
            msg = Count()
            msg.header.seq = 77
            publisher.publish(msg)
        wait_until(lambda: len(headers) == 3, lambda: f"three, not {headers}")
        self.assertEqual([header.seq for header in headers], [1, 2, 3])
        self.assertEqual([header.stamp for header in headers], [rospy.Time(0)] * 3)

    def test_header_cpp(self):
        headers = headers_on(self, "/great_topic")
        # It sets stamp, and leaves seq alone.
        node = (
            program(PACKAGE, "lab_publisher_cpp_node"),
            "_type:=mrp_labs/Count",
            "_period:=0.05",
        )
        with Process(*node, extra_env=LIVE):
            wait_until(lambda: len(headers) >= 3, lambda: f"three, not {headers}")
        numbers = [header.seq for header in headers]
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))))
        self.assertNotIn(rospy.Time(0), [header.stamp for header in headers])


def errors(lab, node):
    return lab.logged(node, levels=("WARN", "ERROR"))


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "message_types", TestMessageTypes)
