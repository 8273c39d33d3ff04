# SPDX-License-Identifier: BSD-3-Clause
"""Read the entries of `make why`: error texts, each with its cause and its fix.

An entry is in a file of mrp/doc/why/, below its name in brackets, or in the head of a patch in
mrp_check/defects/. Its fields:

    Shows: [rospack] Error: ...    a text as it is printed; lines that belong together follow
    Also: rospack: ...             the same in another version; nothing here prints it
    Why: The terminal ...          the cause, in one or two sentences
    Fix: Source ...                what to do, in one or two sentences
    Page: wrong#there-is-no-master where the pages say more
    Above: yes                     the cause is above: such an entry comes last; with "only", it's
                                   left out if there is another
    General: yes                   right for any name, where other entries need a certain one
    Ros: yes                       other programs print this, too: only right if the text shows ROS
    Try: rostopic list             the commands that make ROS print it
    Launch: <launch><nod/></launch>   or a file with which roslaunch prints it; Python has a script,
                                   Cpp what g++ reads, CMake what follows project() in a
                                   CMakeLists.txt (and find_package(catkin), if it needs a package)
    Needs: master                  what they need, of: a master; roscpp's headers; the manifest of a
                                   package; a robot, a package with a node; docker, an engine

There may be several fields Shows and Also, and several files. A line of Shows that begins with
"12| " or "13| " is from one Debian release. tests/test_why.py runs Try, gives each file to its
program, and compares Shows with what is printed.
"""

import dataclasses
import pathlib
import re
import sys

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract import defects  # noqa: E402

FOLDER = WORKSPACE / "src" / "mrp" / "doc" / "why"
# The file that a field's text is written into, and the command that reads it.
FILES = {
    "Python": ("a.py", "/usr/bin/python3 a.py"),
    "Cpp": ("a.cpp", "g++ -fsyntax-only a.cpp"),
    "CMake": ("CMakeLists.txt", "cmake -B build ."),
    "Launch": ("a.launch", "roslaunch -p $PORT a.launch"),
}
_PROJECT = "cmake_minimum_required(VERSION 3.10)\nproject(a C)\n"
_FIND_CATKIN = "find_package(catkin REQUIRED)\n"
REQUIRED, TEXTS = ("Shows", "Why", "Fix"), ("Shows", "Also")
SEVERAL = (*TEXTS, *FILES)
FIELDS = (*REQUIRED, "Also", "Page", "Above", "General", "Ros", "Needs", "Try", *FILES)


@dataclasses.dataclass(frozen=True)
class Entry:
    """What is printed, why, and what to do. theme: the heading under which it is listed."""

    name: str
    theme: str
    shows: tuple
    why: str
    fix: str
    try_: str
    also: tuple = ()
    page: str = ""
    above: str = ""
    general: str = ""
    ros: str = ""
    needs: str = ""
    defect: defects.Defect = None

    @property
    def address(self):
        """Its place on the pages: that of the page that explains it, or of the list."""
        return self.page or f"why#{self.name}"


class EntryError(Exception):
    """An entry is malformed; the text is one sentence."""


def entries():
    """Return all entries: those of the files, by theme, and then those of defects."""
    found = [entry for path in sorted(FOLDER.glob("*.txt")) for entry in _of_file(path)]
    for defect in defects.read_all():
        if defect.why:
            name = defect.name.replace("_", "-")
            found.append(_entry(name, "Mistakes in a package", defect.why, defect=defect))
    return found


def _of_file(path):
    theme, *parts = re.split(r"^\[([\w-]+)\]\n", path.read_text(), flags=re.MULTILINE)
    for name, text in zip(parts[::2], parts[1::2]):
        yield _entry(name, theme.strip("# \n"), defects.fields_of(text, f"{path.name}, {name}"))


def _entry(name, theme, found, **more):
    missing = [field for field in REQUIRED if field not in found]
    missing += [] if {"Try", *FILES} & {*found} else ["Try"]
    unknown = [field for field in found if field not in FIELDS]
    twice = [field for field in found if len(found[field]) > 1 and field not in SEVERAL]
    if missing or unknown or twice:
        what = f"missing {missing}, unknown {unknown}, more than once {twice}"
        raise EntryError(f"{name}: expected fields among {', '.join(FIELDS)}; {what}.")
    once = {field: values[0] for field, values in found.items() if field not in SEVERAL}
    texts = {field.lower(): tuple(map(_dedent, found.get(field, ()))) for field in TEXTS}
    plain = {field.lower(): " ".join(once[field].split()) for field in once if field != "Try"}
    commands = once.get("Try", "") + _commands(found, plain.get("needs", ""))
    return Entry(name=name, theme=theme, try_=commands, **texts, **plain, **more)


def _commands(found, needs):
    """Return the commands that write each file of an entry, and give it to its program."""
    project = _PROJECT + (_FIND_CATKIN if "package" in needs.split() else "")
    commands = ""
    for field, (path, command) in FILES.items():
        above = project if field == "CMake" else ""
        for text in found.get(field, ()):
            commands += f"\ncat > {path} << 'END'\n{above}{text}\nEND\n{command}"
    return commands


def _dedent(text):
    return "\n".join(line.strip() for line in text.splitlines())


def shown_on(text, release=None):
    """Return the lines of a text that is printed, on one Debian release or on any."""
    lines = [re.fullmatch(r"(?:(\d+)\| )?(.*)", line).groups() for line in text.splitlines()]
    return [line for debian, line in lines if not debian or release in (None, debian)]
