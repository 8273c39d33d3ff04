# SPDX-License-Identifier: BSD-3-Clause
"""package.xml: is it valid, and does it name what the code uses?"""

from __future__ import annotations

import re
import xml.parsers.expat
import xml.sax.saxutils

from catkin_pkg.package import InvalidPackage, parse_package_string

from mrp_check.contract.finding import Finding
from mrp_check.student.launch import elements

FILE = "package.xml"


def parse(package):
    """Return (catkin_pkg's Package or None, the Finding that says why not, or None)."""
    data = package.bytes(FILE)
    try:
        elements(data)
    except xml.parsers.expat.ExpatError as error:
        return None, xml_finding("manifest", package, FILE, error)
    try:
        return parse_package_string(data.decode("utf-8", "replace").lstrip("\ufeff"), FILE), None
    except (InvalidPackage, AssertionError, ValueError) as error:
        text = " ".join(str(error).replace(f"Error(s) in package '{FILE}':", "").split())
        return None, Finding(
            "manifest",
            f"package.xml is not valid: {text}",
            FILE,
            _line_of(package, text),
            expected="a manifest as catkin reads it",
            seen=text,
            fix="Compare it with the package.xml of the tutorial's package.",
        )


def _line_of(package, text):
    """Return the line of the first tag, attribute or value that a message names."""
    words = re.findall(r"following tags: ([\w, ]+)", text) or re.findall(r"\"([^\"]+)\"", text)
    for word in ",".join(words).replace(" ", "").split(","):
        line = package.find_line(FILE, f"<{word}") or package.find_line(FILE, f">{word}<")
        if word.strip() and line:
            return line
    return package.find_line(FILE, "<package", 1)


def xml_finding(id_, package, path, error):
    """Return the Finding about a file that is no XML."""
    what = xml.parsers.expat.ErrorString(error.code)
    line = error.lineno
    hint, cause = "", line
    if what == "mismatched tag":
        cause, hint = _unclosed(package, path, line)
    elif what == "no element found":
        cause, hint = _unclosed(package, path, None)
        cause = cause or len(package.lines(path))
    elif what == "not well-formed (invalid token)":
        cause, hint = _bad_token(package, path, line)
    return Finding(
        id_,
        f"{path} is no valid XML: {what}, noticed in line {line}. {hint}".strip(),
        path,
        cause,
        expected="XML in which each tag that is opened is closed, and each value is in quotes",
        seen=package.lines(path)[min(cause, len(package.lines(path))) - 1].strip(),
        fix="Mend this line; `xmllint --noout` says whether the file is well-formed.",
    )


def _bad_token(package, path, line):
    """Return the line that is to blame for a character that cannot stand where it does."""
    lines = package.lines(path)
    for number in range(line, 0, -1):
        text = lines[number - 1] if number <= len(lines) else ""
        if number == line and re.search(r"<!--(?:(?!-->).)*--(?!>)", text):
            return line, "Within a comment there must be no two hyphens (--)."
        # A tag that never ends swallows the lines below it.
        if number < line and text.count("<") > text.count(">"):
            return number, "The tag that begins there has no end."
        if text.count('"') % 2:
            return number, "A quotation mark is missing there."
        if number < line and ">" in text:
            break
    return line, "Perhaps a quotation mark, a > or an = is missing, or & stands for &amp;."


_TAG = re.compile(
    r"<!--.*?-->|<\?.*?\?>|<!.*?>|<(?P<close>/)?(?P<name>[\w:-]+)[^<>]*?(?P<end>/)?>", re.DOTALL
)


def _unclosed(package, path, noticed):
    """Return (line of the tag that is opened and not closed, what to say of it)."""
    text, stack = package.text(path), []
    for match in _TAG.finditer(text):
        if not match.group("name") or match.group("end"):
            continue
        name, line = match.group("name"), text.count("\n", 0, match.start()) + 1
        if not match.group("close"):
            stack.append((name, line))
            continue
        if stack and stack[-1][0] == name:
            stack.pop()
            continue
        if any(name == opened for opened, _ in stack):
            opened, where = stack[-1]
            return where, f"<{opened}> is opened there and not closed."
        if stack:
            opened, where = stack[-1]
            return line, f"<{opened}> of line {where} is closed by </{name}>."
        return line, f"</{name}> closes what is not open."
    if stack:
        return stack[-1][1], f"<{stack[-1][0]}> is opened there and not closed."
    return noticed or 1, ""


def replace(workspace, name):
    """Put a valid package.xml into the copy, so that what comes after can be checked."""
    (workspace.package_folder / FILE).write_text(
        f'<package format="3"><name>{xml.sax.saxutils.escape(name)}</name><version>0.0.0</version>'
        '<description>x</description><maintainer email="x@x.example">x</maintainer>'
        "<license>x</license><buildtool_depend>catkin</buildtool_depend>"
        + "".join(f"<depend>{one}</depend>" for one in ("roscpp", "rospy", "std_msgs"))
        + "<depend>message_generation</depend><depend>message_runtime</depend></package>"
    )


def declared(manifest):
    """Return kind -> names of the packages that a manifest declares."""
    return {
        "build": {d.name for d in manifest.build_depends},
        "exec": {d.name for d in [*manifest.exec_depends, *manifest.run_depends]},
        "export": {d.name for d in manifest.build_export_depends},
        "test": {d.name for d in manifest.test_depends},
    }


def findings(package, manifest):
    """Yield findings about a manifest that catkin_pkg can read."""
    if "catkin" not in {d.name for d in manifest.buildtool_depends}:
        yield Finding(
            "manifest",
            "package.xml does not say that the package is built with catkin.",
            FILE,
            # Where it belongs: at the first of the dependencies.
            package.find_line(FILE, "depend>", package.find_line(FILE, "<package", 1)),
            expected="<buildtool_depend>catkin</buildtool_depend>",
            seen=", ".join(d.name for d in manifest.buildtool_depends) or "no buildtool_depend",
            fix="Add the line <buildtool_depend>catkin</buildtool_depend>.",
        )
