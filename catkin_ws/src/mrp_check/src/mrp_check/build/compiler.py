# SPDX-License-Identifier: BSD-3-Clause
"""What g++ prints, as findings: the first error of each source, its line, and plain words."""

from __future__ import annotations

import difflib
import os
import re

from mrp_check.contract.finding import Finding
from mrp_check.sources import uses
from mrp_check.student.cmake import relative

_ERROR = re.compile(
    r"^(?P<file>[^\s:][^:]*):(?P<line>\d+):(?:\d+:)? (?:fatal )?error: (?P<text>.*)$"
)
_FROM = re.compile(r"^(?P<file>[^\s:][^:]*):(?P<line>\d+):\d+:\s+required from")
_INCLUDED = re.compile(r"^(?:In file included from| +from) (?P<file>[^:]+):(?P<line>\d+)")

_MESSAGES = (
    "Bool Byte Char ColorRGBA Duration Empty Float32 Float64 Header Int16 Int32 Int64 Int8 String"
    " Time UInt16 UInt32 UInt64 UInt8"
).split()


class Problem:
    """One error of the compiler: where in the package it is, what was said, and what follows it."""

    def __init__(self, file, line, text, after):
        self.file, self.line, self.text, self.after = file, line, text, after


def problems(output, copy):
    """Return, for each source of the package, the first error that the compiler found in it."""
    lines = output.splitlines()
    found, chain, included = [], [], []
    for index, line in enumerate(lines):
        if _INCLUDED.match(line):
            if line.startswith("In file"):
                included, chain = [], []
            included.append(_place(_INCLUDED.match(line), copy))
            continue
        required = _FROM.match(line)
        if required:
            chain.append(_place(required, copy))
            continue
        error = _ERROR.match(line)
        if not error:
            if line.startswith("[") or "In function" in line or "At global scope" in line:
                chain, included = [], []
            continue
        after = "\n".join(lines[index + 1 : index + 40])
        # An error in a header of ROS's was caused where the package uses it: the last place of
        # "required from" that is the package's own.
        own = _place(error, copy)
        if own is None:
            places = [place for place in chain if place] or [p for p in included if p]
            later = [_place(m, copy) for m in map(_FROM.match, lines[index + 1 : index + 12]) if m]
            places += [place for place in later if place]
            own = places[-1] if chain else places[0] if places else None
        chain, included = [], []
        if own is not None:
            found.append(Problem(*own, error.group("text"), after))
    first = {}
    for problem in found:
        first.setdefault(problem.file, problem)
    return list(first.values())


def _place(match, copy):
    # ccache hands the compiler paths that are relative to where it runs.
    path = os.path.join(copy.parents[1] / "build" / copy.name, match.group("file"))
    file = relative(path, copy)
    return (file, int(match.group("line"))) if file else None


def finding(package, problem):
    """Return the Finding about a Problem."""
    file, line = problem.file, problem.line
    lines = package.lines(file)
    line = max(1, min(line, len(lines)))
    standard = re.search(r"support for the ISO C\+\+ (?:20)?(\d+) standard", problem.text)
    if standard:
        return _old_standard(package, standard.group(1), problem)
    said, fix, better, *change = _in_words(package, problem, lines)
    line = better or line
    return Finding(
        "compile",
        f"The compiler stops at line {line} of {file}: {said}",
        file,
        line,
        expected="C++ that the compiler accepts",
        seen=f"{lines[line - 1].strip()}  (g++: {problem.text})",
        fix=fix,
        change=change[0] if change else None,
    )


def _old_standard(package, needed, problem):
    """Return the Finding about a standard of C++ that is too old, as CMakeLists.txt sets it."""
    file = "CMakeLists.txt"
    line = package.find_line(file, "CXX_STANDARD") or package.find_line(file, "-std=") or 1
    return Finding(
        "compile",
        f"The compiler is told to take a standard of C++ that is older than C++{needed}, which the"
        " code or ROS's headers need.",
        file,
        line,
        expected="set(CMAKE_CXX_STANDARD 17), or no such line",
        seen=f"{package.lines(file)[line - 1].strip()}  (g++: {problem.text})",
        fix="Set the standard to 17.",
    )


def _in_words(package, problem, lines):
    """Return (what it means, what to do, the line that is to blame if it is another one), and what
    to change in that line if it is certain."""
    text = problem.text.replace("‘", "'").replace("’", "'")
    for shape, function in _WORDS:
        match = re.search(shape, text)
        if match:
            return function(package, problem, lines, match)
    return f"{text}.", "Compare the line with the one on the page.", None


def _semicolon(package, problem, lines, match):
    return (
        "a semicolon is missing at its end"
        + (f", before {match.group(1)}." if match.group(1) else "."),
        "Add ; at the end of the statement.",
        *_end_of_statement(lines, problem.line, match.group(1)),
    )


def _end_of_statement(lines, line, following):
    """Return the line at which the statement ends that stands before a token, if the token is the
    first of its line, and the change that ends it. Comments may stand between the two."""
    if following and lines[line - 1].lstrip().startswith(following):
        for number in range(line - 1, 0, -1):
            text = lines[number - 1].strip()
            if text and not text.startswith(("//", "/*", "*")):
                return number, (text, text + ";") if "//" not in text else None
    return None, None


def _expected(package, problem, lines, match):
    what = match.group(1)
    unbalanced = unbalanced_brace(lines)
    if unbalanced and what in ("}", "unqualified-id", "declaration"):
        return _brace(unbalanced)
    words = {
        ")": "a closing bracket ) is missing.",
        "(": "an opening bracket ( is missing.",
        "}": "a closing brace } is missing.",
        "{": "an opening brace { is missing.",
        "]": "a closing bracket ] is missing.",
        ">": "a closing > is missing.",
    }
    if what in words:
        return words[what], "Close what was opened.", None
    return (
        f"{what} is expected there. Often something is missing or too much in the line above it.",
        "Look for a missing ; or bracket at the end of the line above, or a brace too many.",
        None,
    )


def _brace(unbalanced):
    line, missing = unbalanced
    if missing == "}":
        return (
            f"the brace {{ that is opened in line {line} is never closed.",
            "Add the missing }.",
            line,
        )
    return f"the brace }} of line {line} closes nothing.", "Take one } out.", line


def _function_definition(package, problem, lines, match):
    unbalanced = unbalanced_brace(lines)
    if unbalanced:
        return _brace(unbalanced)
    return (
        "a function begins inside another one: a closing brace } is missing above it.",
        "Add the missing }.",
        None,
    )


def _undeclared(package, problem, lines, match):
    name = match.group(1)
    suggested = re.search(
        r"did you mean '([^']+)'", problem.text.replace("‘", "'").replace("’", "'")
    )
    after = problem.after.replace("‘", "'").replace("’", "'")
    suggested = suggested or re.search(
        r"suggested alternative: '([^']+)'", after.split("error:")[0]
    )
    if name == "ros" or name.startswith("ROS_"):
        return _header(name, "ros/ros.h")
    if uses.is_ros_package(name):
        used = re.search(rf"\b{re.escape(name)}::(\w+)", "\n".join(lines))
        return _header(name, f"{name}/{used.group(1)}.h" if used else f"{name}/....h")
    if name in _MESSAGES:
        return (
            f"nothing is called {name} here; the type is std_msgs::{name}.",
            f"Write std_msgs::{name}.",
            None,
            (name, f"std_msgs::{name}"),
        )
    if re.fullmatch(r"u?int(8|16|32|64)_t", name):
        return _header(name, "cstdint")
    if name in ("cout", "cin", "endl", "string", "vector"):
        said = f"nothing is called {name} here; it is std::{name}."
        return said, f"Write std::{name}.", None, (name, f"std::{name}")
    own = set(re.findall(r"\b[A-Za-z_]\w*\b", "\n".join(lines))) - {name}
    near = [suggested.group(1)] if suggested else difflib.get_close_matches(name, own, 1, 0.8)
    hint = f" Perhaps {near[0]} is meant." if near else ""
    return (
        f"nothing is called {name} here: it is misspelt, or declared nowhere, or further"
        f" down.{hint}",
        f"Write {near[0]} for {name}." if near else f"Declare {name}, or mend its name.",
        None,
    )


def _header(name, header):
    return (
        f"{name} is not known: the line #include <{header}> is missing.",
        f"Add #include <{header}>.",
        None,
    )


def _no_member(package, problem, lines, match):
    owner, member = match.group(1), match.group(2)
    owner = re.sub(r"_<std::allocator<void> ?>", "", owner)
    suggested = re.search(
        r"did you mean '([^']+)'", problem.text.replace("‘", "'").replace("’", "'")
    )
    hint = f" Perhaps {suggested.group(1)} is meant." if suggested else ""
    if re.search(r"(::(Const)?Ptr|shared_ptr<.*>)&?$", owner):
        return (
            f"{member} is asked of a pointer to a message, which has it behind ->.",
            f"Write ->{member} for .{member}.",
            None,
            (f".{member}", f"->{member}"),
        )
    if owner in ("ros", "std_msgs") and not suggested and member in _MESSAGES:
        return _header(f"{owner}::{member}", f"{owner}/{member}.h")
    if "UInt32" in owner or re.search(r"std_msgs::\w+$", owner):
        hint = hint or " Its field is called data."
    return (
        f"{owner} has no {member}.{hint}",
        f"Write {suggested.group(1)}." if suggested else f"Mend the name {member}.",
        None,
    )


def _no_match(package, problem, lines, match):
    name = match.group(1).split("(")[0].split("::")[-1].split("<")[0]
    said = {
        "subscribe": (
            "the arguments of subscribe() do not fit: the topic's name, the queue's size, the"
            " callback, and for a method of a class also the object, as in &CLASS::METHOD, this."
            " The callback must take the message, and return nothing."
        ),
        "advertise": "advertise<TYPE>() takes the topic's name and the queue's size.",
        "createTimer": (
            "the arguments of createTimer() do not fit: a ros::Duration, the callback, and for a"
            " method of a class also the object. The callback must take a const ros::TimerEvent&."
        ),
        "publish": "publish() takes a message of the type that was advertised.",
        "init": "ros::init() takes argc, argv and the node's name, in this order.",
    }.get(name)
    return (
        said or f"{match.group(1)} is called with arguments that do not fit.",
        "Compare the call with the one on the page.",
        None,
    )


def _missing_header(package, problem, lines, match):
    header = match.group(1)
    folder = header.split("/")[0]
    if folder == package.name:
        own = [path.rsplit("/", 1)[-1][:-4] for path in package.of_kind("message")]
        name = header.rsplit("/", 1)[-1][:-2]
        near = difflib.get_close_matches(name, own, 1, 0.5)
        if name in own:
            return (
                f"there is no {header} yet: it is made of {name}.msg, and the target does not wait"
                " for that, or nothing makes it.",
                "Look at add_message_files(), generate_messages() and add_dependencies().",
                None,
            )
        hint = f" Perhaps {package.name}/{near[0]}.h is meant." if near else ""
        return f"there is no header {header}.{hint}", "Mend the name of the header.", None
    known = [f"std_msgs/{name}.h" for name in _MESSAGES] + ["ros/ros.h"]
    near = difflib.get_close_matches(header, known, 1, 0.7)
    hint = f" Perhaps {near[0]} is meant." if near else ""
    return (
        f"there is no header {header}.{hint}",
        f"Write {near[0]}." if near else "Mend the name, or install and declare its package.",
        None,
    )


def _convert(package, problem, lines, match):
    return (
        f"a {_short(match.group(1))} cannot be used where a {_short(match.group(2))} is needed.",
        "Compare the types with those on the page.",
        None,
    )


def _short(name):
    return re.sub(r"_<std::allocator<void> ?>|std::__cxx11::|, std::allocator<char>", "", name)


def _many_arguments(package, problem, lines, match):
    return (
        f"{match.group(2)} is called with too {match.group(1)} arguments.",
        "Compare the call with the function's parameters.",
        None,
    )


def _string(package, problem, lines, match):
    return (
        "a text is begun with a quotation mark and not ended with one.",
        "Add the missing quotation mark.",
        None,
    )


def _no_message(package, problem, lines, match):
    return (
        f"{match.group(1)} is no message type, and only messages can be published and received.",
        "A callback takes a message, such as const std_msgs::UInt32::ConstPtr&; what it holds are"
        " its members.",
        None,
    )


def _not_const(package, problem, lines, match):
    message = _short(match.group(1))
    parameter = re.compile(rf"(?<!const )\b{re.escape(message)}\s*&")
    found = [number for number, text in enumerate(lines, 1) if parameter.search(text)]
    return (
        f"a callback takes a {message}& that is not const, and no subscriber can give it one.",
        f"Write const {message}&, or const {message}::ConstPtr&.",
        found[0] if found else None,
        *([(f"{message}&", f"const {message}&")] if found else []),
    )


_WORDS = (
    (
        r"reference of type 'ros::ParameterAdapter<([\w:]+(?:_<[^>]*> ?>)?)\s*&>.* discards",
        _not_const,
    ),
    (r"expected ';'(?: before '?([^']+?)'?(?: token)?)?$", _semicolon),
    (r"expected ',' or ';'(?: before '?([^']+?)'?(?: token)?)?", _semicolon),
    (r"missing terminating", _string),
    (r"a function-definition is not allowed here", _function_definition),
    (r"qualified-id in declaration", _function_definition),
    (r"expected '?([^' ]+)'?", _expected),
    (r"(\S+): No such file or directory", _missing_header),
    (r"'([\w:]+)' was not declared in this scope", _undeclared),
    (r"'([\w:]+)' has not been declared", _undeclared),
    (r"'([\w:]+)' does not name a type", _undeclared),
    (r"'([\w:]+)' is not a (?:class|namespace)", _undeclared),
    (r"'([^']+)' (?:\{aka '[^']*'\} )?has no member named '(\w+)'", _no_member),
    # What roscpp asks of each message.
    (r"'__s_get\w+' is not a member of '([^']+)'", _no_message),
    (
        r"'(\w+)' is not a member of '([^']+)'",
        lambda p, e, lines, m: _no_member(p, e, lines, _Swapped(m)),
    ),
    (
        r"'(\w+)' in namespace '([^']+)' does not name",
        lambda p, e, lines, m: _no_member(p, e, lines, _Swapped(m)),
    ),
    (r"no matching function for call to '([^']+)'", _no_match),
    (r"no match for call to '([^']+)'", _no_match),
    (r"too (many|few) arguments to function '([^']+)'", _many_arguments),
    (r"cannot convert '([^']+)'.* to '([^']+)'", _convert),
    (r"invalid conversion from '([^']+)' to '([^']+)'", _convert),
)


class _Swapped:
    """A match whose first two groups have changed places."""

    def __init__(self, match):
        self.match = match

    def group(self, number):
        return self.match.group(3 - number)


_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'|(?P<brace>[{}])', re.DOTALL
)


def unbalanced_brace(lines):
    """Return (line, what is missing or "{" if there is one } too many), or None if all are closed.

    The brace that lacks its partner is found by the indentation: the first block whose end is not
    indented as its beginning.
    """
    text, stack, suspects = "\n".join(lines), [], []
    for match in _CODE.finditer(text):
        if not match.group("brace"):
            continue
        number = text.count("\n", 0, match.start())
        indent = len(lines[number]) - len(lines[number].lstrip())
        if match.group() == "{":
            stack.append((number + 1, indent))
        elif not stack:
            return number + 1, "{"
        else:
            opened, opened_indent = stack.pop()
            if opened_indent != indent and opened != number + 1:
                suspects.append(opened)
    if not stack:
        return None
    # Of blocks whose ends do not fit, the innermost was closed by the brace of the one around it.
    return (suspects[0] if suspects else stack[-1][0]), "}"
