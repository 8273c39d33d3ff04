# SPDX-License-Identifier: BSD-3-Clause
"""Which ROS packages the sources use: by their #include and import lines."""

from __future__ import annotations

import ast
import functools
import pathlib
import re
import subprocess
import sys
import typing
from typing import Callable, Iterator

from mrp_check.contract.names import last_part, line_of, nearest
from mrp_check.contract.resources import SHARES
from mrp_check.package.cmake import Model
from mrp_check.package.package import Package

# Headers whose folder is not called like the package that has them.
_HEADERS = {"ros/package.h": "roslib", "ros/package.hpp": "roslib"}
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([\w./+-]+)[>"]', re.MULTILINE)
_IMPORT = re.compile(r"^[ \t]*(?:from|import)[ \t]+([A-Za-z_][\w.]*)", re.MULTILINE)
_LAUNCHED = re.compile(r'\bpkg\s*=\s*"([A-Za-z]\w*)"|\$\(find\s+([A-Za-z]\w*)\s*\)')
_XML_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_PYTHON_COMMENT = re.compile(r"^[ \t]*#[^\n]*", re.MULTILINE)
# The tokens of C++ in which others may seem to begin: a comment, a raw text, a text, a character.
_TOKEN = re.compile(
    r"(?P<comment>/\*.*?\*/|//[^\n]*)"
    r'|R"(?P<end>[^()\\\s]{0,16})\(.*?\)(?P=end)"'
    r'|"(?:\\.|[^"\\\n])*"'
    r"|'(?:\\.|[^'\\\n])+'",
    re.DOTALL,
)

# They come with roscpp or rospy: whoever does not name them has them all the same.
_LOOSE = set(
    (
        "roslib rosgraph rosconsole rostime roscpp_serialization genpy roscpp_traits"
        " rosnode rostopic rosservice roslaunch rosunit rostest rospkg message_filters"
        " xmlrpcpp cpp_common rosgraph_msgs"
    ).split()
)


DEFINITIONS = ("message", "service", "action")  # kinds of files
# The ending of a definition -> what is added to its name for what is made of it.
_MADE = {
    "msg": ("",),
    "srv": ("", "Request", "Response"),
    "action": (
        *("Action", "ActionGoal", "ActionResult", "ActionFeedback"),
        *("Goal", "Result", "Feedback"),
    ),
}


def generated(path: str) -> list[str]:
    """Return the names of the messages that are made of a .msg, .srv or .action file."""
    name, _, ending = last_part(path).rpartition(".")
    return [name + added for added in _MADE[ending]]


def made(package: Package) -> set[str]:
    """Return the names of all that is made of a package's own definitions."""
    return {name for path in package.of_kind(*DEFINITIONS) for name in generated(path)}


class Use(typing.NamedTuple):
    file: str
    line: int
    language: str
    firm: bool  # whether not to declare it is an error: of some, others bring them along


_ALL = 20000  # a Debian release has more packages; without its lists, apt knows the installed ones
# Python modules, and folders of headers, whose Debian package is called otherwise.
_DEBIAN = {
    **{"cv2": "python3-opencv", "PIL": "python3-pil", "OpenGL": "python3-opengl"},
    "tkinter": "python3-tk",
}
_LIBRARIES = {
    **{"opencv2": "libopencv-dev", "Eigen": "libeigen3-dev", "GL": "libgl-dev"},
    **{"SDL2": "libsdl2-dev", "nlohmann": "nlohmann-json3-dev", "json": "libjsoncpp-dev"},
    **{"curl": "libcurl4-openssl-dev", "gazebo": "libgazebo-dev"},
}
# Python's own modules: Debian keeps some of them in packages of their own.
STANDARD: frozenset[str] = getattr(sys, "stdlib_module_names", frozenset(("tkinter",)))


def _guesses(name: str, language: str) -> list[str]:
    """Return how Debian may call the package that has a package, a module or a definition."""
    plain = name.lower().replace("_", "-")
    python = _DEBIAN.get(name, f"python3-{plain}")
    if language in ("msg", "program"):
        return [f"ros-{plain}" if language == "msg" else name]
    library = _LIBRARIES.get(name, f"lib{plain}-dev")
    return [library, f"ros-{plain}", python, plain] if language == "cpp" else [python]


def absent(name: str, language: str) -> str:
    """Return the name of a package or a module that this machine lacks, and where Debian has it."""
    guesses, debian = _guesses(name, language), debian_packages()
    guess = next((guess for guess in guesses if guess in debian), None if debian else guesses[0])
    perhaps = "" if debian else "perhaps "
    where = f"{perhaps}Debian package {guess}" if guess else "not in Debian"
    return f"{name} ({where})"


def is_of_debian(module: str) -> bool:
    """Return whether Debian has a Python module of that name, on this machine or not."""
    return module in STANDARD or _guesses(module, "python")[0] in debian_packages()


@functools.lru_cache(maxsize=None)
def debian_packages() -> set[str]:
    """Return the names of all packages that apt knows of; none where it knows only a part."""
    try:
        done = subprocess.run(["apt-cache", "pkgnames"], stdout=subprocess.PIPE, text=True)
    except OSError:
        return set()
    names = set(done.stdout.split())
    return names if len(names) >= _ALL else set()


def is_sibling(package: Package, name: str) -> bool:
    """Return whether a package of that name is built with the package."""
    return any(sibling.name == name for sibling in package.siblings)


def is_here(package: Package, name: str) -> bool:
    """Return whether a ROS package of that name is on this machine, or beside the package."""
    return is_installed(name) or is_sibling(package, name)


@functools.lru_cache(maxsize=None)
def is_installed(name: str) -> bool:
    """Return whether this machine has a ROS package of that name."""
    return any((pathlib.Path(share) / name / "package.xml").is_file() for share in SHARES)


def _includes() -> list[pathlib.Path]:
    return [pathlib.Path(share).parent / "include" for share in SHARES]


def _has_headers(folder: str) -> bool:
    return any(next((place / folder).glob("*.h*"), None) for place in _includes())


def is_header(header: str) -> bool:
    """Return whether a package of this machine has a header, as written after #include."""
    folders = ("", header.split("/")[0])
    return any((place / folder / header).is_file() for place in _includes() for folder in folders)


def without_comments(text: str) -> str:
    """Return a C++ source in which spaces stand for comments."""
    return _TOKEN.sub(lambda match: blank(match) if match["comment"] else match.group(), text)


def blank(match: re.Match[str]) -> str:
    """Return spaces for what was matched, in as many lines."""
    return re.sub(r"[^\n]", " ", match.group())


def code(package: Package, file: str) -> str:
    """Return the text of a source or launch file, with spaces, or nothing, for its comments."""
    text, kind = package.text(file), package.kind(file)
    if kind == "python":
        return _PYTHON_COMMENT.sub("", text)
    return _XML_COMMENT.sub(blank, text) if kind == "launch" else without_comments(text)


def includes(package: Package, file: str) -> Iterator[tuple[str, int]]:
    """Yield (header, line) of each #include that is no comment."""
    text = without_comments(package.text(file))
    for match in _INCLUDE.finditer(text):
        yield match.group(1), line_of(match, 1)


def package_of_header(header: str) -> str:
    if header in _HEADERS:
        return _HEADERS[header]
    folder = header.split("/")[0] if "/" in header else ""
    return "roscpp" if folder == "ros" else folder


def absent_header(package: Package, header: str) -> str | None:
    """Return the ROS package, or the library of Debian's, that has a header and is not on this
    machine; None if the header is the package's own, or the name of what has it is misspelt."""
    name = package_of_header(header)
    if not name or name == package.name:
        return None
    is_debian = _guesses(name, "cpp")[0] in debian_packages()
    if is_here(package, name):  # Debian may keep its headers in a package of their own
        return name if is_debian and not _has_headers(header.split("/")[0]) else None
    asked = rf"(?m)^[^#\n]*\b{re.escape(name)}\b"
    cmake = package.text("CMakeLists.txt") if "CMakeLists.txt" in package.files else ""
    is_named = package.find_line("package.xml", f">{name}<") or re.search(asked, cmake)
    is_known = is_debian or name in _LIBRARIES or is_called_so(package, name)
    return name if is_named or is_known else None


def is_test(path: str) -> bool:
    return path.split("/")[0] in ("test", "tests")


# What many packages use, and is not in Debian, or need not be on this machine.
_WELL_KNOWN = set(
    (
        "turtlesim actionlib tf tf2_ros cv_bridge image_transport dynamic_reconfigure pcl_ros"
        " moveit_commander rviz gazebo_ros controller_manager actionlib_tutorials roscpp_tutorials"
        " rospy_tutorials turtle_tf turtlebot3_gazebo tf_conversions laser_geometry"
        " tf2_geometry_msgs tf2_sensor_msgs learning_tf"
    ).split()
)


def is_called_so(package: Package, name: str) -> bool:
    """Return whether a name is that of a ROS package: on this machine, beside the package, or
    elsewhere."""
    is_messages = name.endswith(("_msgs", "_srvs")) and not nearest(name, ["std_msgs"], 0.85)
    return is_messages or name in _WELL_KNOWN or is_here(package, name)


def of(
    package: Package, model: Model, is_known: Callable[[str], bool] = is_installed
) -> dict[str, Use]:
    """Return name -> Use of the ROS packages that the sources use; tests are left out.

    is_known: says of a name whether it is that of a ROS package
    """
    built = {s for target in model.targets.values() for s in target.sources}
    found: dict[str, Use] = {}
    for file in package.of_kind("cpp", "header"):
        # What is compiled into nothing needs nothing.
        if is_test(file) or package.kind(file) == "cpp" and model.complete and file not in built:
            continue
        for header, line in includes(package, file):
            name = package_of_header(header)
            if is_known(name):
                _add(found, package, name, Use(file, line, "cpp", True))
    for file in package.of_kind("python"):
        if is_test(file) or file == "setup.py":
            continue
        for name, line in imports(package, file):
            name = name.split(".")[0]
            if is_known(name):
                _add(found, package, name, Use(file, line, "python", True))
    return found


def of_all(package: Package, model: Model, is_contract: bool) -> dict[str, Use]:
    """Return name -> Use of what the sources use; without a contract, of what need not be on this
    machine and of what the launch files start, too."""
    if is_contract:
        return of(package, model)
    is_known = functools.partial(is_called_so, package)
    return {**of_launch(package), **of(package, model, is_known)}


def of_launch(package: Package) -> dict[str, Use]:
    """Return name -> Use of the packages that the launch files name; tests are left out."""
    found: dict[str, Use] = {}
    for file in package.of_kind("launch"):
        text = code(package, file)
        for match in _LAUNCHED.finditer("" if is_test(file) else text):
            line = line_of(match)
            _add(found, package, match[1] or match[2], Use(file, line, "launch", False))
    return found


def imports(package: Package, file: str) -> Iterator[tuple[str, int]]:
    """Yield (module, line) of each import that names it in full."""
    tree = package.tree(file)
    if not tree.body:  # such as of Python 2
        text = code(package, file)
        for match in _IMPORT.finditer(text):
            yield match[1], line_of(match, 1)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            yield node.module, node.lineno


def _add(found: dict[str, Use], package: Package, name: str, use: Use) -> None:
    if name == package.name or not name:
        return
    is_loose = name in _LOOSE and not (use.language == "cpp" and name == "roslib")
    use = use._replace(firm=use.firm and not is_loose)
    if name not in found or found[name].language == "python" and use.language == "cpp":
        found[name] = use
