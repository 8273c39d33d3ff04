# SPDX-License-Identifier: BSD-3-Clause
"""What an error of g++ means, in plain words, and what to do."""

from __future__ import annotations

import re
import typing
from typing import Callable, Sequence

from mrp_check.code import uses
from mrp_check.contract.finding import Change
from mrp_check.contract.names import last_part, nearest, perhaps
from mrp_check.package.package import Package

_MESSAGES = (
    "Bool Byte Char ColorRGBA Duration Empty Float32 Float64 Header Int16 Int32 Int64 Int8 String"
    " Time UInt16 UInt32 UInt64 UInt8"
).split()


class Problem(typing.NamedTuple):
    """One error of the compiler: where in the package it is, what was said, and what follows it."""

    file: str
    line: int
    text: str
    after: str


class Words(typing.NamedTuple):
    """What an error means, and what to do; the line to blame, if it is another than the compiler's;
    (old, new) in that line, if that fixes it for certain; and the entry of the page why."""

    said: str
    fix: str
    line: int | None = None
    change: Change | None = None
    why: str = ""


class Error(typing.NamedTuple):
    """A Problem that matches a shape of _WORDS."""

    package: Package
    problem: Problem
    lines: list[str]
    match: re.Match

    def suggested(self) -> str | None:
        """Return the name that the compiler itself suggests, or None."""
        found = re.search(r"did you mean '([^']+)'", _plain(self.problem.text)) or re.search(
            r"suggested alternative: '([^']+)'", _plain(self.problem.after.split("error:")[0])
        )
        return found and found.group(1)


def _plain(text: str) -> str:
    return text.replace("‘", "'").replace("’", "'")


def of(package: Package, problem: Problem) -> Words:
    """Return the Words about a Problem."""
    text, lines = _plain(problem.text), package.lines(problem.file)
    for shape, words, why in _WORDS:
        match = re.search(shape, text)
        if match:
            return words(Error(package, problem, lines, match))._replace(why=why)
    return _as_said(text)


def _as_said(text: str) -> Words:
    """Return the compiler's own words."""
    return Words(f"{_short(text)}.", "Compare the line with the one on the page.")


def _semicolon(error: Error) -> Words:
    before = error.match.group(1)
    line, change = _end_of_statement(error.lines, error.problem.line, before)
    where = "in it" if before and line is None else "at its end"
    return Words(
        f"a semicolon is missing {where}" + (f", before {before}." if before else "."),
        "Add ; at the end of the statement.",
        line,
        change,
    )


def _end_of_class(error: Error) -> Words:
    return Words("the class that ends here needs a semicolon.", "Write }; for }.")


def _end_of_statement(
    lines: Sequence[str], line: int, following: str | None
) -> tuple[int | None, Change | None]:
    """Return the line at which the statement ends that stands before a token, if the token is the
    first of its line, and the change that ends it. Comments may stand between the two."""
    if following and lines[line - 1].lstrip().startswith(following):
        for number in range(line - 1, 0, -1):
            text = lines[number - 1].strip()
            if text and not text.startswith(("//", "/*", "*")):
                return number, (text, text + ";") if "//" not in text else None
    return None, None


def _expected(error: Error) -> Words:
    what = error.match.group(1)
    unbalanced = unbalanced_brace(error.lines)
    if unbalanced and what in ("}", "unqualified-id", "declaration"):
        return _brace(*unbalanced)
    return Words(
        f"{what} is expected there. Often the mistake is in the line above it.",
        "Look for a missing ; or bracket at the end of the line above, or a brace too many.",
    )


def _brace(line: int, missing: str) -> Words:
    if missing == "}":
        sentence = f"the brace {{ that is opened on line {line} is never closed."
        return Words(sentence, "Add the missing }.", line)
    return Words(f"the brace }} on line {line} closes nothing.", "Remove one }.", line)


def _function_definition(error: Error) -> Words:
    unbalanced = unbalanced_brace(error.lines)
    if unbalanced:
        return _brace(*unbalanced)
    sentence = "a function begins inside another one: a closing brace } is missing above it."
    return Words(sentence, "Add the missing }.")


# https://www.boost.org/doc/libs/1_73_0/libs/bind/doc/html/bind.html
_PLACEHOLDERS = "this machine's Boost has it only in boost::placeholders."
_BIND = "Add #include <boost/bind/bind.hpp> and using namespace boost::placeholders;"
_INCLUDES_ROS = re.compile(r"#\s*include\s*[<\"]ros/")
_MACROS = {f"ROS_{level}{end}" for level in ("INFO", "WARN", "ERROR") for end in ("", "_STREAM")}


def _undeclared(error: Error) -> Words:
    name, text = error.match.group(1), "\n".join(error.lines)
    if name == "ros" or name.startswith("ROS_") and not _INCLUDES_ROS.search(text):
        return _header(name, "ros/ros.h")
    if uses.is_here(error.package, name):
        used = re.search(rf"\b{re.escape(name)}::(\w+)", text)
        return _header(name, f"{name}/{used.group(1)}.h" if used else f"{name}/....h")
    if re.fullmatch(r"_[1-9]", name):
        return Words(f"nothing is called {name} here: {_PLACEHOLDERS}", _BIND)
    if name in _MESSAGES:
        sentence = f"nothing is called {name} here; the type is std_msgs::{name}."
        return Words(sentence, f"Write std_msgs::{name}.", None, (name, f"std_msgs::{name}"))
    if re.fullmatch(r"u?int(8|16|32|64)_t", name):
        return _header(name, "cstdint")
    own = set(re.findall(r"\b[A-Za-z_]\w*\b", text)) - {name}
    near = error.suggested() or nearest(name, own | _MACROS, 0.8)
    return Words(
        f"nothing is called {name} here: it's misspelled, declared nowhere, or declared further"
        f" down.{perhaps(near)}",
        f"Write {near} for {name}." if near else f"Declare {name}, or correct its name.",
    )


def _header(name: str, header: str) -> Words:
    sentence = f"{name} isn't known: the line #include <{header}> is missing."
    return Words(sentence, f"Add #include <{header}>.")


def _no_member(error: Error, owner_group: int = 1, member_group: int = 2) -> Words:
    owner = re.sub(r"_<std::allocator<void> ?>", "", error.match.group(owner_group))
    member, suggested = error.match.group(member_group), error.suggested()
    if suggested == last_part(owner.replace("::", "/")):  # its constructor
        suggested = nearest(member, _METHODS)
    if re.search(r"(::(Const)?Ptr|shared_ptr<.*>)&?$", owner):
        return Words(
            f"this is a pointer to a message, so {member} needs -> in front of it, not a dot.",
            f"Write ->{member} for .{member}.",
            None,
            (f".{member}", f"->{member}"),
        )
    if owner in ("ros", "std_msgs") and not suggested and member in _MESSAGES:
        return _header(f"{owner}::{member}", f"{owner}/{member}.h")
    hint = perhaps(suggested)
    if not hint and ("UInt32" in owner or re.search(r"std_msgs::\w+$", owner)):
        hint = " Its field is called data."
    fix = f"Write {suggested}." if suggested else f"Correct the name {member}."
    return Words(f"{owner} has no {member}.{hint}", fix)


_METHODS = "advertise call getNumSubscribers getTopic ok publish shutdown sleep subscribe".split()
_CALLS = {
    "subscribe": (
        "the arguments of subscribe() don't fit: the topic's name, the queue's size, the"
        " callback, and for a method of a class also the object, as in &CLASS::METHOD, this. The"
        " callback must take the message, and return nothing."
    ),
    "advertise": "advertise<TYPE>() takes the topic's name and the queue's size.",
    "createTimer": (
        "the arguments of createTimer() don't fit: a ros::Duration, the callback, and for a"
        " method of a class also the object. The callback must take a const ros::TimerEvent&."
    ),
    "publish": "publish() takes a message of the type that was advertised.",
    "init": "ros::init() takes argc, argv and the node's name, in this order.",
}


def _no_match(error: Error) -> Words:
    called = error.match.group(1)
    sentence = _CALLS.get(called.split("(")[0].split("::")[-1].split("<")[0])
    return Words(
        sentence or f"{called} is called with arguments that don't fit.",
        "Compare the call with the one on the page.",
    )


def _missing_header(error: Error) -> Words:
    header, package = error.match.group(1), error.package
    folder = uses.package_of_header(header)
    is_other = folder != package.name and uses.is_called_so(package, folder)
    if is_other and not uses.is_here(package, folder):
        return Words(
            f"there's no header {header} on this machine: {uses.absent(folder, 'cpp')}.",
            "Install it.",
        )
    newer = f"{header}pp"
    if uses.is_header(newer):
        sentence = f"there's no header {header}: here it's called {newer}."
        return Words(sentence, f"Write {newer}.", None, (header, newer))
    if header.split("/")[0] != package.name:
        near = nearest(header, [f"std_msgs/{name}.h" for name in _MESSAGES] + ["ros/ros.h"], 0.7)
        fix = f"Write {near}." if near else "Correct the name, or install and declare its package."
        return Words(f"there's no header {header}.{perhaps(near)}", fix)
    paths = package.of_kind(*uses.DEFINITIONS)
    own = {name: path for path in paths for name in uses.generated(path)}
    # dynamic_reconfigure's wiki: a header is called like the file it's generated from.
    cfg = [path for path in package.files if path.endswith(".cfg")]
    own.update((f"{last_part(path)[:-4]}Config", path) for path in cfg)
    name = last_part(header)[:-2]
    copy = f"include/{header}"
    if name in own and copy in package.files:  # gencpp-extras.cmake, "user-provided header"
        return Words(
            f"{copy} is in the package, so {header} isn't generated from {last_part(own[name])};"
            " and include_directories() has no include.",
            f"Remove {copy}: then the header is generated.",
        )
    if name in own:
        calls = f"add_{package.kind(own[name])}_files(), generate_messages()"
        if own[name] in cfg:
            calls = "generate_dynamic_reconfigure_options()"
        return Words(
            f"there's no {header} yet: it's generated from {last_part(own[name])}, but the target"
            " doesn't wait for that, or nothing generates it.",
            f"Look at {calls} and add_dependencies().",
        )
    near = nearest(name, own, 0.5)
    hint = perhaps(near and f"{package.name}/{near}.h")
    return Words(f"there's no header {header}.{hint}", "Correct the name of the header.")


def _short(name: str) -> str:
    return re.sub(r"_<std::allocator<void> ?>|std::__cxx11::|, std::allocator<char>", "", name)


def _not_const(error: Error) -> Words:
    message = _short(error.match.group(1))
    parameter = re.compile(rf"(?<!const )\b{re.escape(message)}\s*&")
    found = [number for number, text in enumerate(error.lines, 1) if parameter.search(text)]
    return Words(
        f"a callback takes a {message}& that isn't const, and no subscriber can give it one.",
        f"Write const {message}&, or const {message}::ConstPtr&.",
        found[0] if found else None,
        (f"{message}&", f"const {message}&") if found else None,
    )


def _in_words(template: str, fix: str) -> Callable[[Error], Words]:
    """Return the function of an Error that says this, with the groups of its shape."""
    return lambda error: Words(template.format(*error.match.groups()), fix)


_no_message = _in_words(
    "{0} isn't a message type, and only messages can be published and received.",
    "A callback takes a message, such as const std_msgs::UInt32::ConstPtr&; what it holds are its"
    " members.",
)


def _own_words(error: Error) -> Words:
    return _as_said(error.match.string)


# What the compiler says -> the function of an Error that says it in plain words, and the entry of
# the page why.
_WORDS: Sequence[tuple[str, Callable[[Error], Words], str]] = (
    (
        r"reference of type 'ros::ParameterAdapter<([\w:]+(?:_<[^>]*> ?>)?)\s*&>.* discards",
        _not_const,
        "",
    ),
    (r"expected ';'(?: before '?([^']+?)'?(?: token)?)?$", _semicolon, "expected-semicolon"),
    (r"expected ',' or ';'(?: before '?([^']+?)'?(?: token)?)?", _semicolon, "expected-semicolon"),
    (r"expected ';' after (?:class|struct|union) definition", _end_of_class, "expected-semicolon"),
    (
        r"a function-definition is not allowed here|qualified-id in declaration",
        _function_definition,
        "",
    ),
    (r"expected '?([^' ]+)'?", _expected, "expected-semicolon"),
    (r"(\S+): No such file or directory", _missing_header, "header-not-found"),
    (
        r"'([\w:]+)' (?:was not declared in this scope|has not been declared|does not name a type"
        r"|is not a (?:class|namespace))",
        _undeclared,
        "not-declared",
    ),
    (r"'([^']+)' (?:\{aka '[^']*'\} )?has no member named '(\w+)'", _no_member, "no-member-named"),
    # What roscpp asks of each message.
    (r"'__s_get\w+' is not a member of '([^']+)'", _no_message, "not-a-message"),
    (
        r"'(\w+)' (?:is not a member of|in namespace) '([^']+)'",
        lambda error: _no_member(error, owner_group=2, member_group=1),
        "not-declared",
    ),
    (r"no match(?:ing function)? for call to '([^']+)'", _no_match, "no-matching-function"),
    (r"too (many|few) arguments to function", _own_words, "no-matching-function"),
    (r"invalid conversion from 'char\*\*' to 'int'", _own_words, "cpp-init-arguments"),
    (r"cannot convert '|invalid conversion from '", _own_words, "cannot-convert"),
)


_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'|(?P<brace>[{}])', re.DOTALL
)


def unbalanced_brace(lines: Sequence[str]) -> tuple[int, str] | None:
    """Return (line, what is missing or "{" if there is one } too many), or None if all are closed.

    The brace that lacks its partner is found by the indentation: the first block whose end is not
    indented as its beginning. A } too many is the one before, if indented code follows that.
    """
    text, stack, suspects = "\n".join(lines), [], []
    closed = 0  # the line of the last } that closed all
    for match in _CODE.finditer(text):
        if not match.group("brace"):
            continue
        number = text.count("\n", 0, match.start())
        indent = len(lines[number]) - len(lines[number].lstrip())
        if match.group() == "{":
            stack.append((number + 1, indent))
        elif not stack:
            goes_on = any(line.strip() and line[0] in " \t" for line in lines[closed:number])
            return (closed if closed and goes_on else number + 1), "{"
        else:
            opened, opened_indent = stack.pop()
            if opened_indent != indent and opened != number + 1:
                suspects.append(opened)
            closed = closed if stack else number + 1
    if not stack:
        return None
    # Of blocks whose ends do not fit, the innermost was closed by the brace of the one around it.
    return (suspects[0] if suspects else stack[-1][0]), "}"
