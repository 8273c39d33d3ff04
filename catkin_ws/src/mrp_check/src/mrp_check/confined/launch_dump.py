# SPDX-License-Identifier: BSD-3-Clause
"""Prints, as JSON, what roslaunch makes of a launch file. Runs confined: a file can call programs.

Usage: launch_dump.py FILE [ARG:=VALUE...]
"""

import contextlib
import io
import json
import os
import sys


def main():
    path, *arguments = sys.argv[1:]
    # This file's folder, in which modules have names that roslaunch imports from elsewhere.
    del sys.path[0]
    # What roslaunch and its imports print is no part of the answer.
    with contextlib.redirect_stdout(io.StringIO()):
        result = load(path, arguments)
    json.dump(result, sys.stdout)


def load(path, arguments):
    import roslaunch.config
    import roslaunch.core
    import roslaunch.xmlloader

    sys.argv = ["roslaunch", path, *arguments]  # there roslaunch looks for the arguments
    config = roslaunch.config.ROSLaunchConfig()
    loader = roslaunch.xmlloader.XmlLoader(resolve_anon=False)
    loader.ignore_unset_args = False  # as load_config_default() has it
    try:
        loader.load(path, config, argv=arguments, verbose=False)
        error = ""
    except (roslaunch.core.RLException, roslaunch.xmlloader.XmlParseException) as problem:
        error = str(problem)
    except Exception as problem:  # whatever it is, the file is what caused it
        error = f"{type(problem).__name__}: {problem}"
    return {
        "error": error,
        "warnings": list(config.config_errors),
        "files": [os.path.realpath(name) for name in config.roslaunch_files],
        "nodes": [node(one) for one in config.nodes],
        "params": {name: one.value for name, one in config.params.items() if is_plain(one.value)},
    }


def is_plain(value):
    try:
        json.dumps(value)
        return True
    except (TypeError, ValueError):
        return False


def node(one):
    return {
        "package": one.package,
        "type": one.type,
        "name": one.name,
        "namespace": one.namespace,
        "output": one.output or "log",
        "remaps": [list(pair) for pair in one.remap_args],
        "file": os.path.realpath(one.filename) if one.filename else None,
        "env": [list(pair) for pair in one.env_args],
        "prefix": one.launch_prefix or "",
        "arguments": one.args or "",
    }


if __name__ == "__main__":
    main()
