# SPDX-License-Identifier: BSD-3-Clause
"""The exercises: `make learn` shows and follows them, `make exercise` shows or checks one."""

from __future__ import annotations

import argparse
import os
import pathlib
import signal
import sys

from mrp_check.contract.defects import DefectError
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.packages import PatchError
from mrp_check.learning import plain
from mrp_check.learning.exercise import Course
from mrp_check.learning.watch import Watched
from mrp_check.sandbox.scratch import scratch_folder

FAILED = 2


def main(arguments=None):
    """Do what the command line says, and exit: 0 ended, shown or passed, 1 not yet, 2 failed."""
    options = parser().parse_args(arguments)
    # As with Ctrl-C, nothing is left behind then.
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    try:
        if options.once:
            sys.exit(plain.run_once(options.folder, options.hint, options.reset))
        learn(options.folder)
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}." if error.filename else error)
    except (PatchError, DefectError, CannotCheck) as error:
        fail(error)
    except KeyboardInterrupt:
        sys.exit("Stopped. Everything it started has ended; your changes are kept.")


def fail(why):
    print(f"learn: {why}", file=sys.stderr)
    sys.exit(FAILED)


def parser():
    parser = argparse.ArgumentParser(prog="learn", description="Shows and checks the exercises.")
    parser.add_argument("folder", type=pathlib.Path, help="the folder of your copies")
    parser.add_argument("--once", action="store_true", help="show the next one, or check it")
    parser.add_argument("--hint", action="store_true", help="with --once: show the hint instead")
    parser.add_argument("--reset", action="store_true", help="with --once: start it again")
    return parser


def learn(folder):
    """Show and follow the exercises on the screen of a terminal. Raises CannotCheck without one."""
    course = Course(folder)
    if not is_terminal():
        raise CannotCheck("this needs a terminal. Without one, go step by step: make exercise")
    # It needs a package more, which the one-shot form does not.
    from mrp_check.learning import screen

    with scratch_folder() as scratch:
        watched = Watched(course, scratch)
        try:
            screen.show(watched)
        finally:
            watched.stop()


def is_terminal():
    both = sys.stdin.isatty() and sys.stdout.isatty()
    return both and os.environ.get("TERM", "dumb") != "dumb"


if __name__ == "__main__":
    main()
