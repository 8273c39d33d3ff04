# SPDX-License-Identifier: BSD-3-Clause
"""Which modules Python finds on this machine, and what those of ROS have."""

from __future__ import annotations

import functools
import importlib
import importlib.util
import pathlib
import subprocess
import sys
import types
from typing import Any

from mrp_check.code import uses
from mrp_check.contract.resources import SHARES


def is_ros(name: str) -> bool:
    return uses.is_installed(name.split(".")[0])


# Modules of Python, and one that robots need, that are the same on each system; what versions of
# them have had, and this machine's have not, ends a program.
_SAME = "collections inspect itertools math numpy random string threading time".split()


def is_known(name: str) -> bool:
    """Return whether this machine knows all names that a module has."""
    return is_ros(name) or name.split(".")[0] in _SAME


def ros_modules() -> set[str]:
    return {
        path.parent.name for share in SHARES for path in pathlib.Path(share).glob("*/package.xml")
    }


# Module of Python 2 -> what Python 3 has in its place. https://peps.python.org/pep-3108/
OF_PYTHON_2 = {
    **{"Tkinter": "tkinter", "ttk": "tkinter.ttk", "tkMessageBox": "tkinter.messagebox"},
    **{"tkFileDialog": "tkinter.filedialog", "Queue": "queue", "ConfigParser": "configparser"},
    **{"SocketServer": "socketserver", "BaseHTTPServer": "http.server"},
    **{"SimpleHTTPServer": "http.server", "httplib": "http.client", "urllib2": "urllib.request"},
    **{"urlparse": "urllib.parse", "xmlrpclib": "xmlrpc.client", "StringIO": "io"},
    **{"cStringIO": "io", "cPickle": "pickle", "__builtin__": "builtins", "thread": "_thread"},
    "commands": "subprocess",
}


@functools.lru_cache(maxsize=None)
def of_rospy() -> set[str]:
    """Return the names of the modules that Python loads when a node imports rospy."""
    code = "import sys, rospy, std_msgs.msg; print(*(n for n in sys.modules if '.' not in n))"
    done = subprocess.run(["/usr/bin/python3", "-c", code], stdout=subprocess.PIPE, text=True)
    return set(done.stdout.split()) - {"__main__"}


def is_module(name: str) -> bool:
    """Return whether Python can find a module; its parents are imported if they are ROS's own."""
    if "." in name and not is_ros(name):
        return True
    try:
        return name in sys.modules or importlib.util.find_spec(name) is not None
    except (ImportError, ValueError, AttributeError):
        return False


def load(name: str) -> types.ModuleType | None:
    try:
        return importlib.import_module(name)
    except Exception:  # a module of this machine that is broken is not the student's fault
        return None


def resolve(name: str) -> tuple[Any, str | None]:
    """Return (object, None) of a dotted name in a known module, or (owner, what it lacks)."""
    parts = name.split(".")
    found = load(parts[0])
    if found is None:
        return None, None
    for index, part in enumerate(parts[1:], 1):
        if not hasattr(found, part) and isinstance(found, types.ModuleType):
            load(".".join(parts[: index + 1]))
        if not hasattr(found, part):
            # What an object has that is made at run time, nobody knows.
            if not isinstance(found, (types.ModuleType, type)):
                return None, None
            return found, part
        found = getattr(found, part)
    return found, None
