#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares `check --any` with other checkers, on public packages whose defects somebody has listed.

Usage: compare_checkers.py LABELS FOLDER TABLE    (in a shell with the workspace's setup.bash)

LABELS is a CSV file such as mrp_check/test/strangers.csv: a row for each defect, with its places.
FOLDER/OWNER__NAME has each repository; what is not there is cloned from GitHub, at that commit.
What each checker said is kept in FOLDER.said: a second call asks only what is missing.
TABLE is written: for each checker, how many of the listed errors and warnings it names, at each of
their places, and how many errors it reports where nobody has listed any.

A place is met by a report on the same file, at most 2 lines away. Whether the report names the
right cause, this program cannot say: only who reads it.
"""

import csv
import dataclasses
import fnmatch
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

_NEAR = 2  # lines between a report and the place that it means
_SECONDS = 600  # that one checker may take with one package
_ERROR = "error"
_NEEDS = "catkin_lint clang-tidy pyflakes3 pylint roswtf".split()
_LINE = re.compile(r"^(?P<file>[^\s:][^:\n]*):(?P<line>\d+):(?:\d+:)? *(?P<text>.*)$", re.MULTILINE)
# An error, or a line of the call stack that led to one.
_CMAKE = re.compile(
    r"^(?:CMake Error at|  ?) ?(?P<file>[^\s:]+):(?P<line>\d+) (?P<text>\(.*)", re.MULTILINE
)


@dataclasses.dataclass(frozen=True)
class Report:
    """What a checker reports. file: relative to the package; line: 0 for the whole file"""

    file: str
    line: int
    is_error: bool


def run(command, folder, **env):
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, **env}, capture_output=True, text=True,
        errors="replace", timeout=_SECONDS,
    )  # fmt: skip
    return done.stdout + done.stderr


def of_lines(output, package, is_error, pattern=_LINE):
    """Return the Reports in lines such as FILE:LINE: TEXT, but for those on other files."""
    found = []
    for match in pattern.finditer(output):
        path = pathlib.Path(package, match["file"])
        if path.is_relative_to(package) and path.exists():
            file = str(path.relative_to(package))
            found.append(Report(file, int(match["line"]), is_error(match["text"])))
    return found


def sources(package, *endings):
    return [str(path) for end in endings for path in sorted(package.rglob(f"*{end}"))]


# --- The checkers: each is given a package's folder, and returns its Reports.


def mrp_check(package):
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        run(["rosrun", "mrp_check", "check", package, "--any", "--json", file.name], package)
        findings = json.load(file)["findings"]
    own = [one for one in findings if not one["consequence_of"] and one["severity"] != "note"]
    return [Report(f["file"], f["line"] or 0, f["severity"] == _ERROR) for f in own]


def catkin_lint(package):
    script = pathlib.Path(__file__).with_name("with_rosdep.sh")
    output = run([script, "catkin_lint", "--rosdistro", "Debian", "--json", package], package)
    said, found = json.loads(output[output.index("{") :].splitlines()[0]), []
    for kind in ("errors", "warnings"):
        for place in (one["location"] for one in said[kind]):
            file, line = place.get("file", "package.xml"), place.get("line", 0)
            found.append(Report(file, line, kind == "errors"))
    return found


def built(package, folder):
    """Build a package with all of gcc's warnings; return what CMake and make say."""
    flags = ["-DCMAKE_CXX_FLAGS=-Wall -Wextra", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]
    said = run(["cmake", *flags, package], folder)
    return said + run(["make", "--keep-going"], folder)


def gcc(package):
    with tempfile.TemporaryDirectory() as folder:
        said = built(package, folder)
    found = of_lines(said, package, lambda text: "error: " in text)
    return found + of_lines(said, package, lambda _: True, _CMAKE)


def clang_tidy(package):
    with tempfile.TemporaryDirectory() as folder:
        built(package, folder)
        files = sources(package, ".cpp", ".cc", ".cxx")
        said = run(["clang-tidy", "--quiet", "-p", folder, *files], package) if files else ""
    return of_lines(said, package, lambda text: "error: " in text)


def pyflakes(package):
    files = sources(package, ".py")
    return of_lines(run(["pyflakes3", *files], package), package, _is_syntax) if files else []


def _is_syntax(text):
    return any(word in text for word in ("undefined name", "yntax", "ndent", "Missing parentheses"))


def pylint(package):
    files = sources(package, ".py")
    if not files:
        return []
    said = run(["pylint", "--disable=C,R,I", "--msg-template={path}:{line}: {C}", *files], package)
    return of_lines(said, package, lambda text: text[:1] in "EF")


def roswtf(package):
    """It names no line: a report is on each file that the text of an error or warning names."""
    files = sources(package, ".launch")
    paths = f"{package.parent}:{os.environ.get('ROS_PACKAGE_PATH', '')}"
    said = "".join(run(["roswtf", file], package, ROS_PACKAGE_PATH=paths) for file in files)
    own = [path.relative_to(package) for path in package.rglob("*") if path.is_file()]
    lines = [line for line in said.splitlines() if re.match(r"\s*(ERROR|WARNING)", line)]
    return [Report(str(f), 0, "ERROR" in line) for line in lines for f in own if f.name in line]


CHECKERS = {
    "check --any": mrp_check,
    "catkin_lint": catkin_lint,
    "CMake and gcc -Wall -Wextra": gcc,
    "clang-tidy": clang_tidy,
    "pyflakes": pyflakes,
    "pylint": pylint,
    "roswtf": roswtf,
}

# --- What they are measured by


@dataclasses.dataclass
class Defect:
    """A row of the labels. places: (pattern of files, line, or 0 for a whole file)"""

    package: tuple
    label: str
    places: list

    def met(self, reports, near=_NEAR):
        """Return how many of its places one of the reports means."""

        def means(report, file, line):
            is_near = not line or not report.line or abs(report.line - line) <= near
            return fnmatch.fnmatch(report.file, file) and is_near

        return sum(any(means(one, *place) for one in reports) for place in self.places)


def defects(rows):
    """Return the Defects of the labels: what must fail, and what should be better."""
    found = []
    for row in rows:
        places = []
        for place in re.findall(r"(?:[^\s:]| (?=\.))+(?::\d+)?", row["place"]):
            file, _, line = place.partition(":")
            places.append((file, int(line or 0)))
        found.append(Defect((row["repository"], row["folder"]), row["label"], places))
    return found


def table(listed, said):
    """Return the rows of the table. said: checker -> package -> Reports"""
    rows = []
    for checker, of_package in said.items():
        row = {"checker": checker}
        for label in (_ERROR, "warning"):
            own = [one for one in listed if one.label == label]
            met = [one.met(of_package.get(one.package, [])) for one in own]
            row[f"of {len(own)} {label}s"] = sum(n == len(d.places) for n, d in zip(met, own))
        wrong = [one for one in listed if one.label in (_ERROR, "warning")]
        elsewhere = [
            report
            for package, reports in of_package.items()
            for report in {one for one in reports if one.is_error}
            if not any(one.met([report]) for one in wrong if one.package == package)
        ]
        rows.append({**row, "errors elsewhere": len(elsewhere)})
    return rows


# --- The packages


def checked_out(repository, commit, folder):
    """Return the folder of a repository at a commit; clone it if it is not there."""
    path = folder / repository.replace("/", "__")
    if not path.exists():
        run(["git", "clone", "--quiet", f"https://github.com/{repository}", path], folder)
        said = run(["git", "-C", path, "checkout", "--quiet", commit], folder)
        if said:
            sys.exit(f"error: {repository} could not be had at {commit}: {said}")
    return path


def asked(checker, package, kept):
    """Return what a checker says of a package, from the file in which it is kept."""
    if not kept.exists():
        try:
            reports = CHECKERS[checker](package)
        except (subprocess.TimeoutExpired, ValueError) as error:
            print(f"{checker} says nothing of {package}: {error}", file=sys.stderr)
            reports = []
        kept.write_text(json.dumps([dataclasses.astuple(one) for one in reports]))
    return [Report(*one) for one in json.loads(kept.read_text())]


def main(labels, folder, target):
    rows = list(csv.DictReader(labels.read_text().splitlines()))
    packages = {(row["repository"], row["folder"]): row["commit"] for row in rows}
    said = {checker: {} for checker in CHECKERS}
    for number, ((repository, below), commit) in enumerate(packages.items(), 1):
        package = (checked_out(repository, commit, folder) / below).resolve()
        for checker in CHECKERS:
            name = re.sub(r"\W+", "_", f"{checker} {repository} {below}") + ".json"
            print(f"[{number}/{len(packages)}] {repository}: {checker}", flush=True)
            kept = folder.with_name(folder.name + ".said") / name
            kept.parent.mkdir(exist_ok=True)
            said[checker][repository, below] = asked(checker, package, kept)
    first, *others = said
    said["all the others together"] = {
        package: [report for one in others for report in said[one][package]]
        for package in said[first]
    }
    result = table(defects(rows), said)
    with target.open("w", newline="") as file:
        writer = csv.DictWriter(file, result[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(result)
    print(target.read_text(), end="")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    missing = [name for name in _NEEDS if not any(
        pathlib.Path(folder, name).exists() for folder in os.environ["PATH"].split(":")
    )]  # fmt: skip
    if missing:
        sys.exit(f"error: expected {', '.join(missing)}; install them with apt-get")
    main(*map(pathlib.Path, sys.argv[1:]))
