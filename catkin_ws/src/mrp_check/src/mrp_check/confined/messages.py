# SPDX-License-Identifier: BSD-3-Clause
"""Classes of messages, made from their definitions: nothing of a package is imported for them."""

import pathlib
import re
from typing import Any, Dict, List, Optional, Sequence

import genmsg
import genmsg.gentools
import genpy.dynamic
import roslib.message

_TYPE = r"[A-Za-z]\w*/[A-Za-z]\w*"
# The lines of a definition that say what is sent. genpy makes Python of a definition: a constant
# could be more than that.
_FIELD = re.compile(r"\s*([A-Za-z]\w*(?:/[A-Za-z]\w*)?(?:\[\d*\])?)\s+([A-Za-z]\w*)\s*(?:#.*)?")
_BETWEEN = re.compile(rf"={{80}}|MSG: {_TYPE}")


def definitions(
    package: str, folders: Sequence[pathlib.Path], shares: Sequence[str]
) -> Dict[str, List[str]]:
    """Return type -> [md5sum, definition] of the messages that a package defines.

    folders: those with its .msg files; shares: those with ROS's own packages,
        the first before the others. What cannot be read is left out: the build reports it.
    """
    of_ros = (path for share in reversed(shares) for path in pathlib.Path(share).glob("*/msg"))
    search = {path.parent.name: [str(path)] for path in of_ros}
    search[package] = [str(folder) for folder in folders]
    found = {}
    for path in (path for folder in folders for path in sorted(folder.glob("*.msg"))):
        context = genmsg.MsgContext.create_default()
        type_ = f"{package}/{path.stem}"
        try:
            spec = genmsg.load_msg_by_type(context, type_, search)
            genmsg.load_depends(context, spec, search)
            text = genmsg.gentools.compute_full_text(context, spec)
            found[type_] = [genmsg.gentools.compute_md5(context, spec), text]
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
