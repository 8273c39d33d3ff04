# SPDX-License-Identifier: BSD-3-Clause
"""The labs' types of message, and the text of a message. The twin of message_text.h."""

import rospy
from std_msgs import msg as std_msgs

from mrp_labs.msg import Count

# The first one is the default.
_CLASSES = (
    *(std_msgs.UInt32, std_msgs.Bool, std_msgs.Byte, std_msgs.Char),
    *(std_msgs.ColorRGBA, std_msgs.Duration, std_msgs.Empty, std_msgs.Float32),
    *(std_msgs.Float64, std_msgs.Header, std_msgs.Int8, std_msgs.Int16),
    *(std_msgs.Int32, std_msgs.Int32MultiArray, std_msgs.Int64, std_msgs.String),
    *(std_msgs.Time, std_msgs.UInt8, std_msgs.UInt16, std_msgs.UInt64, Count),
)

# Name, such as "std_msgs/UInt32", -> class.
MESSAGE_TYPES = {class_._type: class_ for class_ in _CLASSES}


def from_text(text, message):
    """Put what a text says into a message.

    A number out of range goes in as it is: rospy finds out when it publishes the message.

    Raises ValueError if the text does not fit.
    """
    if isinstance(message, std_msgs.Empty):
        pass
    elif isinstance(message, std_msgs.String):
        message.data = text
    elif isinstance(message, (std_msgs.Float32, std_msgs.Float64)):
        message.data = float(text)
    elif isinstance(message, std_msgs.ColorRGBA):
        message.r, message.g, message.b, message.a = map(float, text.split())
    elif isinstance(message, std_msgs.Duration):
        message.data = rospy.Duration(*map(int, text.split()))
    elif isinstance(message, std_msgs.Time):
        message.data = rospy.Time(*map(int, text.split()))
    elif isinstance(message, std_msgs.Header):
        seq, secs, nsecs, message.frame_id = text.split()
        message.seq = int(seq)
        message.stamp = rospy.Time(int(secs), int(nsecs))
    elif isinstance(message, std_msgs.Int32MultiArray):
        message.data = [int(word) for word in text.split()]
    elif isinstance(message, Count):
        message.header.stamp = rospy.Time.now()
        message.counter = int(text)
        message.language = "Python"
    else:
        message.data = int(text)


def pad_to(size, message):
    """Fill a message up with spaces to a size in bytes, if it is one that can have any size."""
    if isinstance(message, std_msgs.String):
        message.data += " " * (size - len(message.data.encode()))


def to_text(message):
    """Return what is in a message as text, a float with as many digits as it takes to tell it."""
    if isinstance(message, std_msgs.Empty):
        return "nothing"
    if isinstance(message, std_msgs.String):
        # Spaces at the end, which make a message large, are shown by their number.
        text = message.data.rstrip(" ")
        size = len(message.data.encode())
        return f'"{text}"' + (f" ({size} bytes)" if text != message.data else "")
    if isinstance(message, std_msgs.Float32):
        return f"{message.data:.9g}"
    if isinstance(message, std_msgs.Float64):
        return f"{message.data:.17g}"
    if isinstance(message, std_msgs.ColorRGBA):
        return f"{message.r:.9g} {message.g:.9g} {message.b:.9g} {message.a:.9g}"
    if isinstance(message, (std_msgs.Duration, std_msgs.Time)):
        return f"{message.data.secs} {message.data.nsecs}"
    if isinstance(message, std_msgs.Header):
        return f"{message.seq} {message.stamp.secs} {message.stamp.nsecs} {message.frame_id}"
    if isinstance(message, std_msgs.Int32MultiArray):
        return "[" + " ".join(map(str, message.data)) + "]"
    if isinstance(message, Count):
        milliseconds = (rospy.Time.now() - message.header.stamp).to_sec() * 1000
        return f"{message.counter}, counted in {message.language}, sent {milliseconds:.1f} ms ago"
    return str(int(message.data))
