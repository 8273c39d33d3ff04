# SPDX-License-Identifier: BSD-3-Clause
"""The command `check`: its arguments, its progress and its exit codes."""

from __future__ import annotations

import argparse
import contextlib
import pathlib
import signal
import sys

from mrp_check import sandbox
from mrp_check.classroom import (
    by_hand,
    class_table,
    classroom,
    cluster,
    gradescope,
    mail,
    marking,
    moodle,
    submissions,
)
from mrp_check.contract import spec
from mrp_check.contract.errors import CannotCheck, ClusterError, PackageError, SpecError
from mrp_check.contract.finding import ERROR
from mrp_check.contract.names import printable
from mrp_check.contract.verdict import FINDINGS, MET, UNCHECKED, public, unchecked
from mrp_check.package import siblings
from mrp_check.package.package import Package
from mrp_check.report import github, html, json_, junit, sarif, terminal
from mrp_check.rules import REQUIREMENTS
from mrp_check.sandbox.scratch import kept_folder, scratch_folder
from mrp_check.verdict import check

EXIT_CODES = {MET: 0, FINDINGS: 1, UNCHECKED: 2}

# Option -> what --help says of it, and what makes the file's text.
OF_PACKAGE = {  # of the report and the contract
    "json": ("write the report as JSON", lambda report, _: json_.text(report)),
    "junit": ("write the report as JUnit XML", lambda report, _: junit.text(report)),
    "sarif": ("write the report as SARIF 2.1.0", lambda report, _: sarif.text(report)),
    "gradescope": ("write the report as Gradescope's results.json", gradescope.text),
    "html": (
        "write the report as a page; with --class: the table",
        lambda report, _: html.text(report),
    ),
}
OF_CLASS = {  # of the submissions, the contract, and the folder of their pages
    "html": (OF_PACKAGE["html"][0], class_table.html_text),
    "csv": (
        "with --class: write the table as CSV",
        lambda checked, contract, _: class_table.csv_text(checked, contract),
    ),
    "moodle": (
        "with --class: write Moodle's grading worksheet, with each report as feedback",
        lambda checked, contract, _: moodle.text(checked, contract),
    ),
}
FLAGS = {  # what --help says of each
    "any": "check a package that has no contract: report what fails",
    "static": "only read the files: don't compile the package or run its nodes",
    "write_contract": "run a correct package, and write NAME.yaml: a contract for it, to be edited",
    "public": "leave the contract's hidden requirements out of the reports",
    "github": "print the findings as annotations of GitHub Actions, too",
    "all": "show notes, what follows from other findings, and every requirement, too",
}


def main(arguments=None, contract="pub_sub"):
    """Check what the command line says, and exit: 0 no errors, 1 errors, 2 could not check.

    contract: the one if the command line names none; None: check without a contract then
    """
    # As with Ctrl-C, nothing is left behind then.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    options = parser(contract).parse_args(arguments)
    options.any = options.any or not (options.spec or options.class_)
    try:
        sys.exit(run(options))
    except KeyboardInterrupt:
        sys.exit("check: stopped early; everything it started has ended, too.")


def parser(contract="pub_sub"):
    parser = argparse.ArgumentParser(
        prog="check" if contract else "mrp-check",
        description="Runs a package, against its contract or without, and says what is wrong.",
        epilog="exit code: 0 no errors; 1 errors; 2 it couldn't check",
    )
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("path", metavar="PATH", nargs="?", help="the package's folder or archive")
    each = "check each folder or archive in DIR as one submission; DIR.checked keeps the reports"
    what.add_argument("--class", dest="class_", metavar="DIR", help=each)
    which = "check the package NAME where there are several"
    parser.add_argument("--package", default="", metavar="NAME", help=which)
    parser.add_argument(
        "--spec", default=contract, metavar="FILE", help="the contract (default: %(default)s)"
    )
    for option, (text, _) in {**OF_PACKAGE, **OF_CLASS}.items():
        parser.add_argument(f"--{option}", metavar="FILE", help=text)
    for flag, text in FLAGS.items():
        parser.add_argument(f"--{flag.replace('_', '-')}", action="store_true", help=text)
    set_ = "with --class: take the points of some students from this CSV"
    parser.add_argument("--by-hand", metavar="FILE", help=set_)
    number = (
        f"with --class: run N checks in parallel, 1 to {classroom.MOST_JOBS} (default:"
        f" {classroom.JOBS}; with --scheduler, as many as its workers have threads)"
    )
    jobs = range(1, classroom.MOST_JOBS + 1)
    parser.add_argument("--jobs", type=int, choices=jobs, metavar="N", help=number)
    where = "with --class: check on the workers of the Dask scheduler at ADDRESS"
    parser.add_argument("--scheduler", metavar="ADDRESS", help=where)
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
    of_package = {*OF_PACKAGE, *FLAGS, "only"} - {*OF_CLASS}
    of_class = {*OF_CLASS, "by_hand", "scheduler"} - {*OF_PACKAGE}
    try:
        for name in sorted(of_package if options.class_ else of_class):
            if getattr(options, name):
                needed = "without" if options.class_ else "with"
                name = name.replace("_", "-")
                raise CannotCheck(f"--{name} goes {needed} --class.")
        if options.gradescope and options.any:
            raise CannotCheck("--gradescope needs the points of a contract: leave out --any.")
        if options.class_ and not options.spec:
            raise CannotCheck("--class needs a contract: --spec FILE.")
        run_one = write_contract if options.write_contract else run_packages
        result = run_class(options) if options.class_ else run_one(options)
    except (PackageError, SpecError, CannotCheck, ClusterError, OSError) as error:
        print(f"check: {error}", file=sys.stderr)
        result = UNCHECKED
    return EXIT_CODES[result]


def say_how_apart(machines=None):
    """Say what the package's programs can reach, if that is more than the scratch folder.

    machines: the Cluster, if it is not this machine
    """
    isolations = machines.isolations if machines else {sandbox.isolation_text()}
    for isolation in sorted(isolations - {sandbox.Isolation.NAMESPACES.value}):
        print(f"check: {isolation}", file=sys.stderr)


def run_class(options):
    """Check a class, write its table, and return MET or FINDINGS.

    Raises PackageError, SpecError, CannotCheck, ClusterError, or OSError if it cannot be checked.
    """
    spec_file = spec.find(options.spec)
    contract = spec.read(spec_file, REQUIREMENTS)
    progress = terminal.Progress(sys.stderr)
    room = classroom.Classroom(
        options.class_, spec_file, options.jobs, options.timeout, progress.show, options.package
    )
    set_ = {}
    if options.by_hand:
        names = [printable(entry.name) for entry in room.entries]
        set_ = by_hand.read(options.by_hand, names, class_table.most(contract))
    try:
        with cluster.reached(options.scheduler, progress.show) as machines:
            say_how_apart(machines)
            checked = room.check(machines)
    finally:
        progress.clear()
    for result in checked:
        result.by_hand = set_.get(result.name)
    for name, (_, text) in OF_CLASS.items():
        write(getattr(options, name), text, checked, contract, room.results)
    for sentence in mail.write(room.results, checked, contract):
        print(f"check: {sentence}", file=sys.stderr)
    for name in moodle.left_out(checked) if options.moodle else ():
        print(
            f"check: {terminal.plain(name)} isn't in {options.moodle}: its name has no participant"
            " number of its own, as 'Full Name_12345_assignsubmission_file_' has.",
            file=sys.stderr,
        )
    print(class_table.text(checked, contract))
    all_met = all(submission.report["verdict"] == MET for submission in checked)
    return MET if all_met else FINDINGS


def unpacked(options, scratch):
    """Return the package's folder: an archive is unpacked into the scratch folder.

    Gradescope unpacks what a student uploads: the package may be in a folder of it.
    """
    path = pathlib.Path(options.path)
    if path.is_file() or options.package or options.gradescope:
        return submissions.package_in(path.resolve(), scratch, options.package)
    return path


def run_packages(options):
    """Check a package, or each package of a workspace; return the worst verdict."""
    path = pathlib.Path(options.path)
    is_one = not path.is_dir() or options.package or (path / "package.xml").exists()
    paths = [] if is_one or not options.any else siblings.packages_in(path)
    if len(paths) < 2:
        options.path = paths[0] if paths else options.path
        return run_package(options)
    verdicts = []
    for number, root in enumerate(paths):
        print("\n" * bool(number) + f"{terminal.plain(str(root))}:")
        named = {}  # the reports' files, with the package's name in theirs
        for name in OF_PACKAGE:
            if file := getattr(options, name):
                file = pathlib.Path(file)
                named[name] = file.with_name(f"{file.stem}-{printable(root.name)}{file.suffix}")
        verdicts.append(run_package(argparse.Namespace(**{**vars(options), **named, "path": root})))
    return max(verdicts, key=(MET, UNCHECKED, FINDINGS).index)


def run_package(options):
    """Check a package, write its reports, and return its verdict. Raises CannotCheck."""
    progress = terminal.Progress(sys.stderr)
    contract, advice = None, ""
    try:
        contract = None if options.any else spec.read(spec.find(options.spec), REQUIREMENTS)
        with scratch_folder() as scratch, contextlib.ExitStack() as stack:
            package = Package(unpacked(options, scratch))
            if options.any:
                package.siblings = siblings.needed(package)
            for sibling in package.siblings:
                print(f"check: builds {sibling.name} with {package.name}.", file=sys.stderr)
            say_how_apart()
            if contract and not _names_a_node(package, contract):
                advice = (
                    f"check: {package.name} has none of the contract's nodes. If it's a package of"
                    " your own, add --any (with make: ANY=1)."
                )
            kept = None
            if scratch not in package.root.parents:  # what was unpacked is not there again
                kept = stack.enter_context(kept_folder(marking.checker()))
            report = check.check(
                package,
                contract,
                options.only,
                options.timeout,
                progress.show,
                kept,
                static=options.static,
            )
    except (PackageError, SpecError, CannotCheck) as error:
        report = unchecked(printable(str(error)))
    finally:
        progress.clear()
    if options.public and contract:
        report = public(report, contract.hidden)
    for name, (_, text) in OF_PACKAGE.items():
        write(getattr(options, name), text, report, contract)
    if report.requirements:
        shown = terminal.text(report, terminal.has_colours(sys.stdout), options.all)
        print(github.stopped(shown) if options.github else shown)
    if options.github:
        print(github.text(report))
    if report.reason:
        print(f"check: {report.reason}", file=sys.stderr)
    if advice:  # last: above the report nobody would see it
        sys.stdout.flush()
        print(advice, file=sys.stderr)
    return report.verdict


def _names_a_node(package, contract):
    """Return whether a node of the contract is in a package: as a file, or in CMakeLists.txt."""
    stems = {pathlib.Path(path).stem for path in package.files}
    built = package.text("CMakeLists.txt") if "CMakeLists.txt" in package.files else ""
    return any(name in stems or name in built for name in contract.nodes)


def write_contract(options):
    """Write a contract of what a package does, and return MET. Raises CannotCheck, PackageError."""
    progress = terminal.Progress(sys.stderr)
    texts: list[str] = []
    try:
        with scratch_folder() as scratch:
            package = Package(unpacked(options, scratch))
            path = pathlib.Path(f"{package.name}.yaml")
            if path.exists():
                raise CannotCheck(
                    f"{path} already exists: rename it, or call check in another folder."
                )
            say_how_apart()
            report = check.check(
                package, None, timeout=options.timeout, progress=progress.show, write=texts.append
            )
    finally:
        progress.clear()
    if not texts:
        errors = [finding for finding in report.findings if finding.severity == ERROR]
        why = report.reason or f"{errors[0].message} Fix what check --any {options.path} reports."
        raise CannotCheck(f"no contract was written, because {package.name} isn't correct: {why}")
    with open(path, "x", encoding="utf-8") as file:
        file.write(texts[0])
    print(f"Wrote {path}: edit it, and call check with --spec {path}.")
    return MET


def write(path, text_of, *arguments):
    """Write what a function returns to a file, if there is a path. Raises CannotCheck."""
    if not path:
        return
    try:
        with open(path, "w", encoding="utf-8", errors="replace", newline="") as file:
            file.write(text_of(*arguments))
    except OSError as error:
        raise CannotCheck(f"{path} can't be written: {error.strerror}.") from None
