# SPDX-License-Identifier: BSD-3-Clause
"""The command `check`: its arguments, its progress and its exit codes."""

from __future__ import annotations

import argparse
import signal
import sys

from mrp_check import check, confine
from mrp_check.cli import classroom
from mrp_check.contract import spec, verdict
from mrp_check.contract.errors import CannotCheck, PackageError, SpecError
from mrp_check.report import console, html, json_, junit
from mrp_check.rules import REQUIREMENTS

MET, FINDINGS, UNCHECKED = 0, 1, 2


def main(arguments=None):
    """Check what the command line says, and exit: 0 all met, 1 findings, 2 could not check."""
    # As with Ctrl-C, nothing is left behind then.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    options = parser().parse_args(arguments)
    not_apart = confine.isolation().value
    if not_apart:
        print(f"check: {not_apart}.", file=sys.stderr)
    try:
        sys.exit(run(options))
    except KeyboardInterrupt:
        sys.exit("check: stopped before its end; what it ran has ended, too.")


def parser():
    parser = argparse.ArgumentParser(
        prog="check",
        description="Runs a package against its contract, and says what is wrong and where.",
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
    parser.add_argument(
        "--spec", default="pub_sub", metavar="FILE", help="the contract (default: %(default)s)"
    )
    parser.add_argument("--json", metavar="FILE", help="write the report as JSON")
    parser.add_argument("--junit", metavar="FILE", help="write the report as JUnit XML")
    parser.add_argument("--html", metavar="FILE", help="write the report as a page")
    parser.add_argument("--csv", metavar="FILE", help="with --class: write the table as CSV")
    parser.add_argument(
        "--jobs",
        type=int,
        choices=range(1, 65),
        default=classroom.JOBS,
        metavar="N",
        help="with --class: check N at the same time (default: %(default)s)",
    )
    parser.add_argument(
        "--timeout",
        type=_seconds,
        default=600,
        metavar="S",
        help="seconds that the check of a package may take (default: %(default)s)",
    )
    parser.add_argument(
        "--only",
        nargs="+",
        default=[],
        choices=list(REQUIREMENTS),
        metavar="ID",
        help="check these requirements alone",
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
    of_package, of_class = ("json", "junit", "only"), ("csv",)
    for name in of_package if options.class_ else of_class:
        if getattr(options, name):
            print(
                f"check: --{name} goes " + ("without" if options.class_ else "with") + " --class.",
                file=sys.stderr,
            )
            return UNCHECKED
    return run_class(options) if options.class_ else run_package(options)


def run_class(options):
    progress = console.Progress(sys.stderr)
    try:
        spec_file = spec.find(options.spec)
        contract = spec.read(spec_file, REQUIREMENTS)
        room = classroom.Classroom(
            options.class_,
            contract,
            spec_file,
            jobs=options.jobs,
            timeout=options.timeout,
            progress=progress.show,
        )
        submissions = room.check()
    except (classroom.ClassError, SpecError, OSError) as error:
        progress.clear()
        print(f"check: {error}", file=sys.stderr)
        return UNCHECKED
    progress.clear()
    try:
        if options.csv:
            with open(options.csv, "w", encoding="utf-8", newline="") as file:
                classroom.write_csv(submissions, contract, file)
        if options.html:
            with open(options.html, "w", encoding="utf-8") as file:
                classroom.write_html(submissions, contract, file, room.results)
    except OSError as error:
        print(
            f"check: the table {error.filename} cannot be written: {error.strerror}.",
            file=sys.stderr,
        )
        return UNCHECKED
    print(classroom.summary(submissions, contract))
    all_met = all(one.report["verdict"] == verdict.MET for one in submissions)
    return MET if all_met else FINDINGS


def run_package(options):
    progress = console.Progress(sys.stderr)
    try:
        contract = spec.read(spec.find(options.spec), REQUIREMENTS)
        report = check.check(options.path, contract, options.only, options.timeout, progress.show)
    except (PackageError, SpecError, CannotCheck) as error:
        report = verdict.Report("", "", verdict.UNCHECKED, [], {}, reason=str(error))
    progress.clear()
    try:
        for path, text_of in (
            (options.json, json_.text),
            (options.junit, junit.text),
            (options.html, html.text),
        ):
            if path:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text_of(report))
    except OSError as error:
        print(
            f"check: the report {error.filename} cannot be written: {error.strerror}.",
            file=sys.stderr,
        )
        return UNCHECKED
    if report.requirements:
        print(console.text(report, colours=console.has_colours(sys.stdout)))
    if report.reason:
        print(f"check: {report.reason}", file=sys.stderr)
    return {verdict.MET: MET, verdict.FINDINGS: FINDINGS}.get(report.verdict, UNCHECKED)
