# SPDX-License-Identifier: BSD-3-Clause
"""What is in a message: its text, its number, and what is counted in it."""

import re
import struct

import genpy
import roslib.message

LONGEST = 300  # characters of a message's text
_MOST = 20  # elements of an array

_INTEGERS = {
    f"std_msgs/{'U' if u else ''}Int{bits}": bits for u in (0, 1) for bits in (8, 16, 32, 64)
}
_UNSIGNED = {8: "<B", 16: "<H", 32: "<I", 64: "<Q"}
_TYPE = re.compile(r"[A-Za-z]\w*/[A-Za-z]\w*")
_HEADER_FIRST = re.compile(r"(std_msgs/)?Header\s+\w+")
_SEQ_AND_STAMP = struct.Struct("<III")


def counter_of(type_name, definition):
    """Return (read, modulus, name): how to read what a publisher counts in its raw messages.

    It is the number itself of the integers in std_msgs, modulo which its type wraps round; or the
    header's seq. A struct does it, so that it can be done for each message. Returns None if there
    is nothing of the kind.
    """
    if type_name in _INTEGERS:
        bits = _INTEGERS[type_name]
        unpack = struct.Struct(_UNSIGNED[bits]).unpack
        return (lambda raw: unpack(raw)[0]), 2**bits, "data"
    if has_header(type_name, definition):
        unpack_from = struct.Struct("<I").unpack_from
        return (lambda raw: unpack_from(raw)[0]), 2**32, "header.seq"
    return None


def has_header(type_name, definition):
    """Say if a raw message begins with a std_msgs/Header."""
    if type_name == "std_msgs/Header":
        return True
    for line in definition.splitlines():
        line = line.split("#")[0].strip()
        if line and "=" not in line:
            return bool(_HEADER_FIRST.fullmatch(line))
    return False


def stamp_of(raw):
    """Return the stamp of a raw message that begins with a header, in seconds; None if it is 0."""
    _, secs, nsecs = _SEQ_AND_STAMP.unpack_from(raw)
    return secs + nsecs * 1e-9 if secs or nsecs else None


def message_class(type_name, md5sum):
    """Return (class, None), or (None, why messages of that type cannot be shown here)."""
    if not _TYPE.fullmatch(type_name):
        return None, f"{type_name} isn't the name of a type"
    try:
        found = roslib.message.get_message_class(type_name)
    except Exception as error:  # whatever the module of another package does when it is loaded
        return None, f"{type_name} can't be loaded here: {error}"
    if found is None:
        return None, f"{type_name} isn't installed where the viewer runs"
    if found._md5sum != md5sum:
        return None, f"the {type_name} that's installed here is a different one"
    return found, None


def text(message):
    """Return what is in a message on one line, of at most LONGEST characters."""
    if message.__slots__ == ["data"]:
        shown = _text(message.data, LONGEST)
    else:
        shown = _text(message, LONGEST)
    return shown if len(shown) <= LONGEST else shown[: LONGEST - 1] + "…"


def _text(value, room):
    """Return a value's text. Of what does not fit into the room nothing more is looked at."""
    if isinstance(value, genpy.Message):
        parts = []
        for name in value.__slots__:
            parts.append(f"{name}: {_text(getattr(value, name), room)}")
            room -= len(parts[-1])
            if room <= 0:
                break
        return ", ".join(parts) or "empty"
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return f"{value.secs}.{value.nsecs:09}"
    if isinstance(value, str):
        return value[: room + 1]
    if isinstance(value, bytes):
        return f"{len(value)} bytes: " + value[:_MOST].hex(" ")
    if isinstance(value, (list, tuple)):
        parts = [_text(item, room // _MOST) for item in value[:_MOST]]
        more = [f"… {len(value)} in all"] if len(value) > _MOST else []
        return "[" + ", ".join(parts + more) + "]"
    if isinstance(value, float):
        return f"{value:.7g}"
    return str(value)


def number(message):
    """Return (name, value) of the first number in a message, or None. A header has none."""
    for name in message.__slots__:
        value = getattr(message, name)
        if isinstance(value, (bool, int, float)):
            return name, value + 0
        if isinstance(value, (genpy.Time, genpy.Duration)):
            return name, value.to_sec()
        if isinstance(value, genpy.Message) and value._type != "std_msgs/Header":
            inner = number(value)
            if inner:
                return f"{name}.{inner[0]}", inner[1]
    return None
