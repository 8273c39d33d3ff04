# SPDX-License-Identifier: BSD-3-Clause
"""The command `check`: its arguments, its progress and its exit codes."""

from __future__ import annotations

import argparse
import signal
import sys

from mrp_check import check, sandbox
from mrp_check.cli import classroom
from mrp_check.contract import spec
from mrp_check.contract.errors import CannotCheck, PackageError, SpecError
from mrp_check.contract.verdict import FINDINGS, MET, UNCHECKED, unchecked
from mrp_check.report import class_table, console, html, json_, junit
from mrp_check.rules import REQUIREMENTS
from mrp_check.student.package import Package

EXIT_CODES = {MET: 0, FINDINGS: 1, UNCHECKED: 2}


def main(arguments=None):
    """Check what the command line says, and exit: 0 all met, 1 findings, 2 could not check."""
    # As with Ctrl-C, nothing is left behind then.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    options = parser().parse_args(arguments)
    try:
        sys.exit(run(options))
    except KeyboardInterrupt:
        sys.exit("check: stopped before its end; what it ran has ended, too.")


def parser():
    parser = argparse.ArgumentParser(
        prog="check",
        description="Runs a package, against its contract or without, and says what is wrong.",
        epilog="exit code: 0 all requirements are met; 1 findings; 2 it could not check",
    )
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("path", metavar="PATH", nargs="?", help="the package's folder")
    what.add_argument(
        "--class",
        dest="class_",
        metavar="DIR",
        help="check each folder in DIR as one submission; DIR.checked keeps their reports",
    )
    without = "check a package that has no contract: report what fails"
    parser.add_argument("--any", action="store_true", help=without)
    parser.add_argument(
        "--spec", default="pub_sub", metavar="FILE", help="the contract (default: %(default)s)"
    )
    for option, text in (
        ("--json", "write the report as JSON"),
        ("--junit", "write the report as JUnit XML"),
        ("--html", "write the report as a page; with --class: the table"),
        ("--csv", "with --class: write the table as CSV"),
    ):
        parser.add_argument(option, metavar="FILE", help=text)
    number = "with --class: check N at the same time, 1 to 64 (default: %(default)s)"
    most, jobs = range(1, 65), classroom.JOBS
    parser.add_argument("--jobs", type=int, choices=most, default=jobs, metavar="N", help=number)
    seconds = "stop the check of a package after S seconds (default: %(default)s)"
    parser.add_argument("--timeout", type=_seconds, default=600, metavar="S", help=seconds)
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        choices=list(REQUIREMENTS),
        metavar="ID",
        help="check only these requirements",
    )
    return parser


def _seconds(text):
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0
    if not 0 < seconds <= 3600:
        raise argparse.ArgumentTypeError(f"expected seconds, up to 3600; found '{text}'")
    return seconds


def run(options):
    """Check what the options say, write the reports, and return the exit code."""
    of_package, of_class = ("json", "junit", "only", "any"), ("csv",)
    try:
        for name in of_package if options.class_ else of_class:
            if getattr(options, name):
                needed = "without" if options.class_ else "with"
                raise CannotCheck(f"--{name} goes {needed} --class.")
        result = run_class(options) if options.class_ else run_package(options)
    except (PackageError, SpecError, CannotCheck, OSError) as error:
        print(f"check: {error}", file=sys.stderr)
        result = UNCHECKED
    return EXIT_CODES[result]


def say_how_apart():
    """Say what the package's programs can reach, if that is more than the scratch folder."""
    not_apart = sandbox.isolation().value
    if not_apart:
        print(f"check: {not_apart}.", file=sys.stderr)


def run_class(options):
    """Check a class, write its table, and return MET or FINDINGS.

    Raises PackageError, SpecError, CannotCheck, or OSError if it cannot be checked.
    """
    spec_file = spec.find(options.spec)
    contract = spec.read(spec_file, REQUIREMENTS)
    progress = console.Progress(sys.stderr)
    room = classroom.Classroom(
        options.class_, spec_file, options.jobs, options.timeout, progress.show
    )
    say_how_apart()
    try:
        submissions = room.check()
    finally:
        progress.clear()
    write(options.csv, lambda: class_table.csv_text(submissions, contract))
    write(options.html, lambda: class_table.html_text(submissions, contract, room.results))
    print(class_table.text(submissions, contract))
    all_met = all(one.report["verdict"] == MET for one in submissions)
    return MET if all_met else FINDINGS


def run_package(options):
    """Check a package, write its reports, and return its verdict. Raises CannotCheck."""
    progress = console.Progress(sys.stderr)
    try:
        contract = None if options.any else spec.read(spec.find(options.spec), REQUIREMENTS)
        package = Package(options.path)
        say_how_apart()
        report = check.check(package, contract, options.only, options.timeout, progress.show)
    except (PackageError, SpecError, CannotCheck) as error:
        report = unchecked(str(error))
    finally:
        progress.clear()
    write(options.json, lambda: json_.text(report))
    write(options.junit, lambda: junit.text(report))
    write(options.html, lambda: html.text(report))
    if report.requirements:
        print(console.text(report, colours=console.has_colours(sys.stdout)))
    if report.reason:
        print(f"check: {report.reason}", file=sys.stderr)
    return report.verdict


def write(path, text_of):
    """Write what a function returns to a file, if there is a path. Raises CannotCheck."""
    if not path:
        return
    try:
        with open(path, "w", encoding="utf-8", errors="replace", newline="") as file:
            file.write(text_of())
    except OSError as error:
        raise CannotCheck(f"{path} cannot be written: {error.strerror}.") from None
