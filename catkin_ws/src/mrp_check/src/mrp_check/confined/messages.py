# SPDX-License-Identifier: BSD-3-Clause
"""Classes of messages, made from their definitions: nothing of a package is imported for them."""

import pathlib
import re
from typing import Any, Dict, List, Optional, Sequence, Union

import genmsg
import genmsg.gentools
import genpy.dynamic
import roslib.message

Plain = Union[bool, int, float, str]

_FIELDS = 30  # of a message
_TEXT = 500  # characters of a text in it
_TYPE = r"[A-Za-z]\w*/[A-Za-z]\w*"
# The lines of a definition that say what is sent. genpy makes Python of a definition: a constant
# could be more than that.
_FIELD = re.compile(r"\s*([A-Za-z]\w*(?:/[A-Za-z]\w*)?(?:\[\d*\])?)\s+([A-Za-z]\w*)\s*(?:#.*)?")
_BETWEEN = re.compile(rf"={{80}}|MSG: {_TYPE}")


def definitions(
    package: str, folders: Sequence[pathlib.Path], shares: Sequence[str]
) -> Dict[str, List[str]]:
    """Return type -> [md5sum, definition] of the messages that a package defines; of its services
    the definitions of request and response.

    folders: those with its .msg and .srv files; shares: those with ROS's own packages,
        the first before the others. What cannot be read is left out: the build reports it.
    """
    of_ros = (path for share in reversed(shares) for path in pathlib.Path(share).glob("*/msg"))
    search = {path.parent.name: [str(path)] for path in of_ros}
    search[package] = [str(folder) for folder in folders]
    found = {}
    for path in (path for folder in folders for path in sorted(folder.glob("*.[ms][sr][gv]"))):
        context = genmsg.MsgContext.create_default()
        type_ = f"{package}/{path.stem}"
        try:
            if path.suffix == ".srv":
                spec = genmsg.msg_loader.load_srv_from_file(context, str(path), type_)
            else:
                spec = genmsg.load_msg_by_type(context, type_, search)
            genmsg.load_depends(context, spec, search)
            halves = [spec.request, spec.response] if path.suffix == ".srv" else [spec]
            texts = [genmsg.gentools.compute_full_text(context, half) for half in halves]
            found[type_] = [genmsg.gentools.compute_md5(context, spec), *texts]
        except (genmsg.InvalidMsgSpec, genmsg.MsgNotFound, OSError, ValueError):
            continue
    return found


def of_definition(type_: str, text: str) -> Any:
    """Return the class of a type, with which messages can be read. Raises ValueError."""
    if not re.fullmatch(_TYPE, type_):
        raise ValueError(f"expected a type such as std_msgs/UInt32; found {type_!r}")
    lines = []
    for line in text.splitlines():
        field = _FIELD.fullmatch(line)
        if field:
            lines.append(" ".join(field.groups()))
        elif _BETWEEN.fullmatch(line):
            lines.append(line)
    return genpy.dynamic.generate_dynamic(type_, "\n".join(lines))[type_]


def of_service(type_: str, own: Dict[str, List[str]]) -> Any:
    """Return the class of a service's type; None if there is no such type. own: as below"""
    if len(own.get(type_, ())) != 3:
        return roslib.message.get_service_class(type_)
    md5sum, *texts = own[type_]
    names = type_ + "Request", type_ + "Response"
    request, response = (of_definition(name, text) for name, text in zip(names, texts))
    known = {"_type": type_, "_md5sum": md5sum}
    return type("Service", (), {**known, "_request_class": request, "_response_class": response})


def flatten(message: Any) -> Dict[str, Plain]:
    """Return the plain fields of a message, by their paths."""
    result: Dict[str, Plain] = {}
    _flatten(message, "", result)
    return result


def _flatten(message: Any, prefix: str, result: Dict[str, Plain]) -> None:
    for name in message.__slots__:
        value = getattr(message, name)
        if len(result) >= _FIELDS:
            return
        if isinstance(value, (bool, int, float)):
            result[prefix + name] = value
        elif isinstance(value, str):
            result[prefix + name] = value[:_TEXT]
        elif hasattr(value, "__slots__"):
            _flatten(value, prefix + name + ".", result)


def set_field(message: Any, path: str, value: Plain) -> None:
    """Set a field, as a value of the type that it has."""
    *above, name = path.split(".")
    for part in above:
        message = getattr(message, part)
    setattr(message, name, type(getattr(message, name))(value))


def of_fields(kind: Any, fields: Dict[str, Plain]) -> Any:
    """Return a message of a class, with these fields."""
    message = kind()
    for path, value in fields.items():
        set_field(message, path, value)
    return message


def of_type(type_: Optional[str], own: Dict[str, List[str]]) -> Any:
    """Return the class of a type, with which messages can be sent; None if there is no such type.

    own: the definitions() of the package under check
    """
    if type_ is None or type_ not in own:
        return roslib.message.get_message_class(type_)
    md5sum, text = own[type_]
    made = of_definition(type_, text)
    made._md5sum = md5sum
    return made
