# SPDX-License-Identifier: BSD-3-Clause
"""Which services and parameters the sources of a package ask for, and which they give."""

from __future__ import annotations

import re
import typing
from typing import Iterable, Iterator, Sequence

from mrp_check.code import uses
from mrp_check.contract.finding import Line
from mrp_check.contract.words import last_part, line_of
from mrp_check.package.package import Package

_NAME = r"""\(\s*[rf]?["']([~/\w]+)["']"""
_PYTHON = {
    "asks": r"\b(?:wait_for_service|ServiceProxy)\s*" + _NAME,
    "offers": r"\brospy\.Service\s*" + _NAME,
    "reads": r"\bget_param\s*" + _NAME + r"\s*\)",
    "knows": r"\b(?:get_param|has_param|search_param|get_param_cached)\s*" + _NAME,
    "sets": r"\bset_param\s*" + _NAME,
    "commands": r"\bSimpleActionClient\s*" + _NAME,
    "serves": r"\bSimpleActionServer\s*" + _NAME,
}
_CPP = {
    "asks": r"\b(?:serviceClient\s*<[^;()]*>|waitForService)\s*" + _NAME,
    "offers": r"\badvertiseService\s*(?:<[^;()]*>\s*)?" + _NAME,
    "reads": r"\bgetParam\s*" + _NAME,
    "knows": r"\b(?:getParam|getParamCached|hasParam|searchParam|param(?:\s*<[^;()]*>)?|get)\s*"
    + _NAME,
    "sets": r"\bsetParam\s*" + _NAME,
    "commands": r"\bSimpleActionClient\s*<[^;()]*>\s*\w+\s*" + _NAME,
    "serves": r"\bSimpleActionServer\s*<[^;()]*>\s*\w+\s*\(\s*\w+\s*,\s*[\"']([~/\w]+)[\"']",
}
# Another name for the class of an action.
_TYPEDEF = re.compile(
    r"\b(?:typedef|using\s+(?P<before>\w+)\s*=)\s+(?:actionlib::)?(?P<class>SimpleAction(?:Client|Server))"
    r"\s*<(?P<of>[^;()]*)>\s*(?P<after>\w*)\s*;"
)
_TYPE = re.compile(r"<\s*([\w:]+)\s*>")
_AFTER = re.compile(r"\s*,\s*&?(?:\w+::)*([\w.]+)")


class Said(typing.NamedTuple):
    """Where a source names a service or a parameter.

    what: "asks" or "offers", of a service; "commands" or "serves", of an action; "reads" (without a
        default), "knows" or "sets", of a parameter
    """

    what: str
    name: str
    file: str
    line: int
    type: str = ""  # its last part, of a service or an action, if that is plain

    @property
    def base(self) -> str:
        """The name's last part: whatever namespace it is in."""
        return last_part(self.name.strip("~/"))


# What calls a service; and what waits for one, or looks whether it is there.
_CALLS = r"(\.|->)call\s*\(", r"\bserviceClient\b", r"\bServiceProxy\b"
_WAITS = r"\b(wait_for_serv(?:ice|er)|waitForServ(?:ice|er)|waitForExistence|exists)\s*\("


def unwaited(package: Package, files: Sequence[str]) -> Line | None:
    """Return where these sources call a service, if they never wait for any."""
    if package.first_match(files, _WAITS) or not package.first_match(files, "|".join(_CALLS[1:])):
        return None
    return next(filter(None, (package.first_match(files, one) for one in _CALLS)))


def of(package: Package, files: Iterable[str]) -> Iterator[Said]:
    """Yield what these sources say, in order."""
    for file in files:
        text = _TYPEDEF.sub(uses.blank, code := uses.code(package, file))
        for match in _TYPEDEF.finditer(code):  # such as: Client client("name")
            name, of = match["before"] or match["after"], match["of"]
            text = re.sub(rf"\b{name}\b(?=\s+\w+\s*\()", f"{match['class']}<{of}>", text)
        for what, shape in (_PYTHON if package.kind(file) == "python" else _CPP).items():
            for match in re.finditer(shape, text):
                yield Said(what, match[1], file, line_of(match, 1), _type(text, match))


def _type(text: str, match: re.Match[str]) -> str:
    """Return the last part of the type that a call names, or whose request its callback takes."""
    written = _TYPE.search(match[0]) or _AFTER.match(text, match.end())
    if written and "advertiseService" in match[0]:
        callback = rf"\b{written[1]}\s*\(\s*(?:const\s+)?([\w:]+)::Request\b"
        written = re.search(callback, text)
    return re.split(r"\.|::", written[1])[-1] if written else ""
