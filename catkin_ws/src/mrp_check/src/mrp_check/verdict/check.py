# SPDX-License-Identifier: BSD-3-Clause
"""One package through all rules: used by the command, for a class and for the exercises."""

from __future__ import annotations

import contextlib
import copy
import functools
import itertools
import pathlib
import traceback
import typing

from mrp_check import sandbox
from mrp_check.build.catkin import missing_tool
from mrp_check.contract.errors import CannotCheck, NotHere
from mrp_check.contract.finding import ERROR, Finding
from mrp_check.contract.requirements import ANY, CONTRACT, STATIC, closure
from mrp_check.contract.spec import MORE, Spec
from mrp_check.contract.verdict import BROKEN, FINDINGS, MET, UNCHECKED, Report
from mrp_check.package.package import Package
from mrp_check.rules import REQUIREMENTS, RULES
from mrp_check.run import new_contract
from mrp_check.run.any_case import AnyCase
from mrp_check.run.case import Case
from mrp_check.run.planning import ENOUGH
from mrp_check.sandbox import confine
from mrp_check.sandbox.scratch import scratch_folder
from mrp_check.verdict import causes, diff, suppression
from mrp_check.verdict.severity import severity, weigh

# A need of a rule -> what works it out.
_KNOWN: dict[str, typing.Callable[[Case], object]] = {
    "manifest": lambda case: case.manifest,
    "model": lambda case: case.model,
    "launch": lambda case: case.launch,
    "facts": lambda case: case.facts,
    "built": lambda case: case.built,
    "nodes": lambda case: case.nodes,
}


def check(
    package: Package,
    spec: Spec | None,
    only=(),
    timeout: float = 600,
    progress: typing.Callable[[str], None] = lambda sentence: None,
    kept: pathlib.Path | None = None,
    early: typing.Callable[[Report], None] | None = None,
    write: typing.Callable[[str], None] | None = None,
    static: bool = False,
) -> Report:
    """Check one package.

    spec: its contract; None for a package that has none
    only: ids of the only requirements to check; all if empty
    timeout: seconds that all of it may take
    kept: a scratch_folder() for several checks: what has not changed since is not built again
    early: called after each stage with what is known by then
    write: called with the text of a contract for a package that has none, if nothing is wrong
    static: only read the files; what a build or a run would show is unchecked

    Raises CannotCheck if a tool is missing. What else cannot be checked, the report says.
    """
    if missing := missing_tool():
        raise CannotCheck(missing)
    rules = [rule for rule in RULES if rule.only != (ANY if spec else CONTRACT)]
    if static:
        rules = [rule for rule in rules if rule.stage in STATIC]
    asked = {id_ for rule in rules for id_ in rule.ids if not spec or spec.asks(id_)}
    ids = [id_ for id_ in REQUIREMENTS if id_ in asked and (id_ in only or not only)]
    with contextlib.nullcontext(kept) if kept else scratch_folder() as folder:
        given = package, spec, folder, timeout, progress
        case = Case(*given) if spec else AnyCase(*given)
        case.static = static
        if isinstance(case, AnyCase) and write:
            case.enough = ENOUGH
        try:
            report = _Examination(case, rules, ids, asked, early).report()
            if isinstance(case, AnyCase) and write and report.verdict == MET:
                write(new_contract.text(case))
        except BaseException:  # such as Ctrl-C
            confine.stop()
            raise
        finally:
            case.close()
    return report


_LONGEST = 2000  # characters of what was seen, such as a line without end

# What the user reads while a stage looks for mistakes.
_STAGES = {
    "files": "looking at the files",
    "static": "reading the sources",
    "build": "looking at the build",
    "run": "looking at the running nodes",
    "stop": "looking at how the nodes end",
}


class _Examination:
    """The findings of all rules that are needed, and the ids of what they could not check."""

    def __init__(self, case, rules, ids, asked, early):
        self.case, self.ids, self.asked = case, ids, asked
        self.findings: list[Finding] = []
        self.failed: dict[str, str] = {}
        self.reasons: list[str] = []
        self.not_here: list[str] = []
        self.lost: dict[str, Exception] = {}
        needs = needs_of(ids, rules)
        if "nodes" in needs:
            case.sessions.begin()
        if "facts" in needs and case.package.of_kind("cpp"):
            _ = case.headers  # they are read while CMake configures
        # Others that need no more are asked, too: they may know the cause.
        chosen = [rule for rule in rules if needs.issuperset(rule.needs)]
        for rule in chosen:
            if rule.begins:
                self._guarded(rule.ids, functools.partial(rule.begins, case))
        for stage, rules in itertools.groupby(chosen, lambda rule: rule.stage):
            case.progress(_STAGES[stage])
            for rule in rules:
                self._ask(rule)
            if early:
                early(self.report())
        facts = vars(case).get("facts")
        if facts and facts.absent():
            self._lose(("python-names",), NotHere(facts.absent().values()))
        self._guarded(ids, lambda: self.failed.update(unseen(case, self._open())))

    def _ask(self, rule):
        def findings():
            for need in rule.needs:
                self._provide(need)
            for finding in rule.ask(self.case):
                if self.case.package.is_cut(finding.file):
                    continue  # what its end would say is unknown
                finding.seen = finding.seen[:_LONGEST]
                finding.severity = severity(finding.certainty, has_contract=True)
                self.findings.append(finding)

        self._guarded(rule.ids, findings)

    def _provide(self, need):
        """Have the case know what is needed. What once failed is not tried again."""
        for missing in closure({need}) & {*self.lost}:
            raise self.lost[missing]
        try:
            _KNOWN[need](self.case)
        except Exception as error:
            self.lost[need] = error
            raise

    def _guarded(self, ids, function):
        """Call a function; if it fails, these ids could not be checked."""
        try:
            function()
        except CannotCheck as error:
            self._lose(ids, error)
        except confine.ConfineError as error:
            self._lose(ids, CannotCheck(f"A command couldn't be run confined: {error}."))
        except Exception as error:  # the checker's own fault: no finding, and no end of it all
            place = traceback.extract_tb(error.__traceback__)[-1]
            file = pathlib.Path(place.filename).name
            reason = (
                f"The checker itself failed, in {place.name}() of {file}:{place.lineno}:"
                f" {type(error).__name__}: {error}. Please report it."
            )
            self._lose(ids, CannotCheck(reason))

    def _lose(self, ids, error):
        self.failed.update({id_: str(error) for id_ in ids if id_ in self.ids})
        if isinstance(error, NotHere):
            self.not_here += [name for name in error.names if name not in self.not_here]
        elif str(error) not in self.reasons:
            self.reasons.append(str(error))

    def _open(self):
        return [id_ for id_ in self.ids if id_ not in self.failed]

    def _only_tools(self):
        """Return what has run, if no node has; an empty text if one has, or may yet."""
        if self.case.static:
            return "CMake"
        seen = vars(self.case).get("observed")
        return "CMake and the compiler" if seen and not seen.executables else ""

    def report(self):
        package, known = self.case.package, vars(self.case)
        is_any = isinstance(self.case, AnyCase)
        found = copy.deepcopy(self.findings)  # more may be found: then it is asked for again
        findings = causes.without_repeats(found, known.get("facts"), known.get("nodes"), not is_any)
        for finding in findings:
            diff.add(package, finding)
        findings, suppressed = suppression.applied(package, findings, self._open(), not is_any)
        weigh(findings, has_contract=not is_any)
        findings = [f for f in findings if f.id in self.ids]
        errors = [finding for finding in findings if finding.severity == ERROR]
        broken = {f.id for f in errors if not f.consequence_of}
        unseen = {id_: why for id_, why in self.failed.items() if id_ not in broken}
        unseen.update(
            {f.id: f"it follows from {f.consequence_of}" for f in errors if f.id not in broken}
        )
        reasons = [*self.reasons, *([str(NotHere(self.not_here))] if self.not_here else ())]
        requirements = {
            id_: BROKEN if id_ in broken else UNCHECKED if id_ in unseen else MET
            for id_ in self.ids
        }
        # Without a contract, what could be judged counts; with one, somebody asked for the rest.
        judged = {*requirements.values()} - {UNCHECKED} if is_any else not reasons
        return Report(
            package=package.name,
            spec=self.case.spec.title,
            verdict=FINDINGS if errors else MET if judged else UNCHECKED,
            findings=findings,
            requirements=requirements,
            reason=" ".join(reasons),
            unseen={id_: unseen[id_] for id_ in self.ids if id_ in unseen},
            left_out=[id_ for id_ in REQUIREMENTS if is_any and id_ not in {*self.asked, *MORE}],
            console=_console(known.get("observed")),
            tools=_failed_step(known.get("catkin")),
            suppressed=[finding for finding in suppressed if finding.id in self.ids],
            isolation=sandbox.isolation_text(self._only_tools()),
            folder=package.root.resolve(),
        )


def _console(observed):
    """Return the lines that roslaunch and its nodes printed, as far as they ran."""
    launched = observed.launch if observed else None
    return [line for _, _, line in launched.lines] if launched else []


def _failed_step(catkin):
    """Return the lines of the step of building that failed, as far as one has."""
    steps = [vars(catkin).get(name) for name in ("configured", "built")] if catkin else []
    return [line for step in steps if step and not step.ok for line in step.output.splitlines()]


def unseen(case, ids):
    """Return id -> why nobody can say that the requirement is met, of those for which it is so."""
    ran = [id_ for id_ in ids if not case.static or REQUIREMENTS[id_].stage in STATIC]
    found = {id_: "only the files were read" for id_ in ids}
    found.update({id_: REQUIREMENTS[id_].why_unseen(case) for id_ in ran})
    return {id_: why for id_, why in found.items() if why}


def needs_of(ids, rules=RULES):
    """Return all that must be known to check these requirements."""
    return closure({need for rule in rules if {*rule.ids} & {*ids} for need in rule.needs})
