# SPDX-License-Identifier: BSD-3-Clause
"""Prints what roslaunch makes of launch files, a Dump of each. Runs confined: a file can call
programs.

Usage: launch_dump.py FILE...
"""

import contextlib
import dataclasses
import io
import json
import os
import pathlib
import re
import sys
from typing import Any, Dict, List, Optional, Tuple

if __name__ == "__main__":
    # In place of this file's own folder: roslaunch imports others of the same names.
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[2])

from mrp_check.confined import crossing

Pair = Tuple[str, str]
_ASKED = re.compile(r"requires the .(\w+). arg to be set")


@dataclasses.dataclass
class Started:
    """A node that a launch file starts.

    env, remaps: each a name, and what it is set to; arguments, prefix: as on a command line
    file: the launch file that has its <node>, if that is known; line: of that, if it is known
    """

    package: str
    type: str
    name: str
    namespace: str
    output: str
    remaps: List[Pair]
    env: List[Pair]
    arguments: str
    prefix: str
    file: Optional[str]
    line: Optional[int] = None

    @property
    def path(self) -> str:
        """The node's full name."""
        return self.namespace.rstrip("/") + "/" + self.name


@dataclasses.dataclass
class Dump:
    """What roslaunch makes of a file.

    error: what it said instead, or an empty text. If it only asks for arguments, the rest is what
        it makes of the file with 1 for each
    warned: what it says of elements and attributes that it passes over
    """

    error: str
    nodes: List[Started] = dataclasses.field(default_factory=list)
    files: List[str] = dataclasses.field(default_factory=list)
    params: Dict[str, object] = dataclasses.field(default_factory=dict)
    warned: List[str] = dataclasses.field(default_factory=list)


def main() -> None:
    # What roslaunch and its imports print is no part of the answer.
    with contextlib.redirect_stdout(io.StringIO()):
        results = [load(path) for path in sys.argv[1:]]
    sys.stdout.write(crossing.to_json(results))


def load(path: str) -> Dump:
    """Return what roslaunch makes of a file, with a value for each argument that it asks for."""
    given: List[str] = []
    first = dump = _load(path, given)
    while dump.error and (asked := _ASKED.search(dump.error)):
        argument = f"{asked[1]}:=1"
        if argument in given:
            return first  # an included file asks for it: who includes it has to give it
        given.append(argument)
        dump = _load(path, given)
    return first if dump.error else dataclasses.replace(dump, error=first.error)


def _load(path: str, given: List[str]) -> Dump:
    import roslaunch.config
    import roslaunch.core
    import roslaunch.xmlloader

    sys.argv = ["roslaunch", path, *given]  # there roslaunch looks for the arguments
    config = roslaunch.config.ROSLaunchConfig()
    loader = roslaunch.xmlloader.XmlLoader(resolve_anon=False)
    loader.ignore_unset_args = False  # as load_config_default() has it
    try:
        loader.load(path, config, argv=given, verbose=False)
        error = ""
    except (roslaunch.core.RLException, roslaunch.xmlloader.XmlParseException) as problem:
        error = str(problem)
    except Exception as problem:  # whatever it is, the file is what caused it
        error = f"{type(problem).__name__}: {problem}"
    return Dump(
        error,
        [_started(node) for node in config.nodes],
        [os.path.realpath(name) for name in config.roslaunch_files],
        {name: param.value for name, param in config.params.items() if _is_plain(param.value)},
        config.config_errors,
    )


def _is_plain(value: object) -> bool:
    try:
        json.dumps(value)
        return True
    except (TypeError, ValueError):
        return False


def _started(node: Any) -> Started:
    return Started(
        package=node.package,
        type=node.type,
        name=node.name,
        namespace=node.namespace,
        output=node.output or "log",
        remaps=node.remap_args,
        env=node.env_args,
        arguments=node.args or "",
        prefix=node.launch_prefix or "",
        file=os.path.realpath(node.filename) if node.filename else None,
    )


if __name__ == "__main__":
    main()
