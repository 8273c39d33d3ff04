#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: make_stubs.py FOLDER
Writes the fields of all messages and services that ROS finds into FOLDER, as stubs (.pyi): from
them an editor knows what comes after `msg.`, and what is no field.
"""

import pathlib
import re
import shutil
import sys

import genmsg
import rospkg
from genmsg import msg_loader, msgs

HEAD = "# Made by make build from the .msg or .srv files: do not edit.\n"

PLAIN = {
    **dict.fromkeys((f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)), "int"),
    **{"byte": "int", "char": "int", "float32": "float", "float64": "float"},
    **{"bool": "bool", "string": "str", "time": "genpy.Time", "duration": "genpy.Duration"},
}


def python_type(ros_type):
    """Return the Python type of a field."""
    base, is_array, _ = msgs.parse_type(ros_type)
    if is_array and base in ("uint8", "char"):
        return "bytes"
    element = PLAIN.get(base) or base.replace("/", ".msg.")
    return f"list[{element}]" if is_array else element


def stub_of(spec):
    """Return the class of a message, or of one half of a service."""
    fields = [(field.name, python_type(field.type)) for field in spec.parsed_fields()]
    lines = [f"class {spec.short_name}(genpy.Message):"]
    lines += [f"    {c.name}: {PLAIN[c.type]}" for c in spec.constants]
    lines += [f"    {name}: {kind}" for name, kind in fields]
    arguments = "".join(f", {name}: {kind} = ..." for name, kind in fields)
    return "\n".join([*lines, f"    def __init__(self{arguments}) -> None: ...\n"])


def stubs_of(file, package):
    """Return the text for a .msg file, or for a .srv file: that has a request and a response."""
    context = genmsg.MsgContext.create_default()
    name = f"{package}/{file.stem}"
    if file.suffix == ".msg":
        return stub_of(msg_loader.load_msg_from_file(context, str(file), name))
    spec = msg_loader.load_srv_from_file(context, str(file), name)
    return "\n".join([stub_of(spec.request), stub_of(spec.response), f"class {file.stem}: ...\n"])


def module(files, package):
    """Return the text of the stub for all messages, or for all services, of a package."""
    text = "\n".join(stubs_of(file, package) for file in files)
    modules = sorted({"genpy", *re.findall(r"\w+\.msg(?=\.)", text)})
    return HEAD + "".join(f"import {name}\n" for name in modules) + "\n" + text


# No __init__.pyi is beside msg and srv: a package may have Python modules of its own, too.
def main(folder):
    shutil.rmtree(folder, ignore_errors=True)
    found = rospkg.RosPack()
    for package in found.list():
        for kind in ("msg", "srv"):
            files = sorted(pathlib.Path(found.get_path(package), kind).glob(f"*.{kind}"))
            if files:
                target = folder / package / kind / "__init__.pyi"
                target.parent.mkdir(parents=True)
                target.write_text(module(files, package))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
