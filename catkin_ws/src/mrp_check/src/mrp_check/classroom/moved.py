# SPDX-License-Identifier: BSD-3-Clause
"""Which marks changed since an earlier call, and why.

A file beside the reports keeps the marks of the last call, and of the last one before it that had
others: the same command says the same again. With that file of an earlier hand-in, it is said what
each student has gained and lost since then.
"""

from __future__ import annotations

import collections
import pathlib
import unicodedata

from mrp_check.classroom import archive, moodle
from mrp_check.contract.errors import CannotCheck
from mrp_check.contract.verdict import UNCHECKED, WORDS
from mrp_check.report import json_
from mrp_check.rules import OF_CONTRACT

_FILE = ".marks.json"  # hidden, as no submission is
_MOST_IDS = 5  # in one sentence


def compare(folder, submissions, spec):
    """Say in each submission's `moved` how its mark has moved; keep the marks in the folder."""
    file, now = folder / _FILE, _marks(submissions, spec)
    last, before = json_.kept(file) or (None, None)
    if last:
        same = all(now["students"].get(name) == one for name, one in last["students"].items())
        if not same or last["points"] != now["points"]:  # not only others have been added
            before = last
    json_.keep(file, [now, before])
    for one in submissions:
        if before and one.name in before["students"]:
            one.moved = _moved(before, now, one.name)


def before(folder):
    """Return the last marks in the folder of an earlier hand-in's reports. Raises CannotCheck."""
    kept = json_.kept(pathlib.Path(folder) / _FILE)
    if not kept:
        raise CannotCheck(
            f"{folder} has no marks of a class: expected an earlier hand-in's DIR.checked."
        )
    return kept[0]


def since(marks, submissions):
    """Give each submission, as its `before`, what the same student had in an earlier hand-in."""
    earlier, now = (
        _by_student(marks["students"]),
        _by_student(submission.name for submission in submissions),
    )
    most = sum(marks["points"].values())
    for one in submissions:
        name = earlier.get(_student(one.name))
        if name and _student(one.name) in now:
            one.before = {**marks["students"][name], "most": most}


def _by_student(names):
    """Return student -> the name of a submission, for those who have one alone."""
    found = collections.defaultdict(list)
    for name in names:
        found[_student(name)].append(name)
    return {student: names[0] for student, names in found.items() if len(names) == 1}


def _student(name):
    """Return what stays the same of a name: an archive is called by its suffix, too, and Moodle has
    another number for each hand-in."""
    match = moodle.DOWNLOADED.fullmatch(name)
    return unicodedata.normalize("NFC", match[1] if match else archive.without_suffix(name))


def _marks(submissions, spec):
    students = {
        submission.name: {
            "verdicts": submission.report["requirements"],
            "mark": submission.mark(spec),
            "by_hand": str(submission.by_hand),
            "reason": submission.report.get("reason", ""),
            "depends_on": submission.depends_on,
        }
        for submission in submissions
    }
    return {"points": {id_: spec.points_of(id_) for id_ in OF_CONTRACT}, "students": students}


def _moved(before, now, name):
    """Return how somebody's mark has moved, and why: empty if it has not."""
    old, new = before["students"][name], now["students"][name]
    most = [sum(marks["points"].values()) for marks in (before, now)]
    if (old["mark"], most[0]) == (new["mark"], most[1]):
        return ""
    of = "" if most[0] == most[1] else f" of {most[0]:g}"
    said = [*_of_points(before["points"], now["points"])]
    said += _of_verdicts(old["verdicts"], new["verdicts"], now["points"])
    if old["by_hand"] != new["by_hand"]:
        said.append("by hand")
    if new["reason"] != old["reason"]:
        said += filter(None, [new["reason"].rstrip(".")])
    changed = [
        what for what in new["depends_on"] if old["depends_on"].get(what) != new["depends_on"][what]
    ]
    if old["verdicts"] != new["verdicts"] and changed:
        said.append(f"changed: {', '.join(changed)}")
    return f"{old['mark']:g}{of} -> {new['mark']:g} of {most[1]:g}: {'; '.join(said)}"


def _of_points(old, new):
    """Yield what has changed in the points of requirements."""
    said: dict[str, list[str]] = {}
    for id_ in OF_CONTRACT:
        was, now = old.get(id_, 0), new[id_]
        what = f"required now, with {now:g}" if not was else f"worth {now:g} now, before {was:g}"
        if was != now:
            said.setdefault(what if now else "no longer required", []).append(id_)
    return _sentences(said)


def _of_verdicts(old, new, points):
    """Yield which requirements that count have another verdict."""
    said: dict[str, list[str]] = {}
    for id_ in OF_CONTRACT:
        was, now = old.get(id_, UNCHECKED), new.get(id_, UNCHECKED)
        if was != now and points[id_]:
            said.setdefault(f"{WORDS[now]} now, before {WORDS[was]}", []).append(id_)
    return _sentences(said)


def _sentences(said):
    for what, ids in said.items():
        more = [f"{len(ids) - _MOST_IDS} more"] if len(ids) > _MOST_IDS else []
        yield f"{', '.join([*ids[:_MOST_IDS], *more])} {'are' if ids[1:] else 'is'} {what}"
