# SPDX-License-Identifier: BSD-3-Clause
"""The environment variables that the checker reads or sets: the name of each stands here alone."""

import pathlib
import typing

# What may be set for the checker: a folder for ccache, with which what is equal in many packages is
# compiled once (a package that means harm could put something wrong into it: it is for tests).
CCACHE = "MRP_CHECK_CCACHE"

# What the checker hands to its own programs: how the observer starts the nodes, an apart.Apart;
# what marks the processes of one run; and the plans.Hook of a Python node.
APART = "MRP_CHECK_APART"
MARK = "MRP_CHECK_RUN"
HOOK = "MRP_CHECK_HOOK"  # hook/sitecustomize.py has it, too: it can import nothing of this
CALLBACKS = "MRP_CHECK_CALLBACKS"  # the same of hook/callbacks.cpp

HOSTNAME = "ROS_HOSTNAME"
MASTER = "ROS_MASTER_URI"
NAMESPACE = "ROS_NAMESPACE"
PACKAGES = "ROS_PACKAGE_PATH"
PYTHONPATH = "PYTHONPATH"

# A command's own folders, and what they are called.
FOLDERS = {"HOME": "home", "TMPDIR": "tmp", "ROS_HOME": "ros_home", "ROS_LOG_DIR": "ros_log"}

# Has a node write each line at once, also into a pipe. Whether the launch file does so is another
# question.
AT_ONCE = {"ROSCONSOLE_STDOUT_LINE_BUFFERED": "1", "PYTHONUNBUFFERED": "1"}


def environment(scratch: typing.Union[str, pathlib.Path], **more: str) -> typing.Dict[str, str]:
    """Return the environment of a confined command, and make the folders that it names.

    It takes over nothing of the user's own. The names in `more` come on top.
    """
    env = {
        "PATH": "/usr/bin:/bin:/usr/sbin:/sbin",
        "LANG": "C.UTF-8",
        "LC_ALL": "C.UTF-8",
        "SHELL": "/bin/bash",
        "TERM": "dumb",
        "USER": "student",
        "PYTHONDONTWRITEBYTECODE": "1",
        # ROS 1 has no authentication: nothing listens beyond this machine that need not.
        HOSTNAME: "localhost",
    }
    return {**env, **folders(scratch), **more}


def folders(scratch: typing.Union[str, pathlib.Path]) -> typing.Dict[str, str]:
    """Return the variables that name a command's own folders, and make these."""
    made = {name: pathlib.Path(scratch).resolve() / folder for name, folder in FOLDERS.items()}
    for folder in made.values():
        folder.mkdir(parents=True, exist_ok=True)
    return {name: str(folder) for name, folder in made.items()}
