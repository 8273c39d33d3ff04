#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Write a package to start from: one node, its launch file, its test, and a CI file.

The templates are in new_package/: my_package, MyPackage, PACKAGE_PATH and CHECKER in them are
replaced. A line that begins with "py|" is only there with Python, "cpp|" with C++, "both|" with
both, "one|" with one of them, "no_py|" without Python, and "no_cpp|" without C++.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys

TEMPLATES = pathlib.Path(__file__).resolve().with_name("new_package")
ROOT = TEMPLATES.parents[2]
# language -> the marks of its lines
LANGUAGES = {
    "python": {"py", "no_cpp", "one"},
    "cpp": {"cpp", "no_py", "one"},
    "both": {"py", "cpp", "both"},
}
GOOD_NAME = re.compile(r"[a-z][a-z0-9]+(_[a-z0-9]+)*|[a-z](_[a-z0-9]+)+")


def fault_of(folder, language):
    """Return what keeps a package from being written there, as a sentence; None if nothing does."""
    if language not in LANGUAGES:
        return f"expected LANGUAGE=python, cpp or both; found LANGUAGE={language}"
    if not GOOD_NAME.fullmatch(folder.name):
        return (
            "expected a name of lowercase letters, digits and single underscores that begins with a"
            f" letter, such as laser_filter; found {folder.name}. Choose another name"
        )
    if pathlib.Path("/usr/share", folder.name, "package.xml").exists():
        return (
            f"expected a name of your own; {folder.name} is a package of ROS. Choose another name"
        )
    if folder.exists():
        return (
            f"expected a new folder; {folder} exists already. Choose another name, or move it away"
        )
    if folder.parent.name != "src":
        return (
            "expected a folder in the src of a workspace, such as ~/catkin_ws/src/"
            f"{folder.name}; found {folder}"
        )
    return None


def checker():
    """Return the action of this clone, if it comes from GitHub; otherwise one to fill in."""
    command = ["git", "-C", str(ROOT), "remote", "get-url", "origin"]
    url = subprocess.run(command, capture_output=True, text=True).stdout.strip()
    match = re.search(r"github\.com[:/]([\w.-]+/[\w.-]+?)(\.git)?$", url)
    repository = match[1] if match else "OWNER/mrp"
    manifest = (ROOT / "catkin_ws/src/mrp/package.xml").read_text()
    version = re.search("<version>(.*)</version>", manifest)[1]
    return f"{repository}/.github/actions/check@{version}"


def text_of(template, words, marks):
    """Return a template's text: the lines of the chosen language, with the words replaced."""
    lines = []
    for line in template.read_text().splitlines():
        match = re.fullmatch(r"(py|cpp|both|one|no_py|no_cpp)\|(.*)", line)
        if match is None or match[1] in marks:
            lines.append(match[2] if match else line)
    text = "\n".join([*lines, ""])
    for word, value in words.items():
        text = text.replace(word, value)
    return text


def write(folder, language):
    """Write the package into a folder, which is made."""
    marks = LANGUAGES[language]
    words = {
        "my_package": folder.name,
        "MyPackage": "".join(part.capitalize() for part in folder.name.split("_")),
        "PACKAGE_PATH": str(folder),
        "CHECKER": checker(),
    }
    for template in sorted(path for path in TEMPLATES.rglob("*") if path.is_file()):
        path = str(template.relative_to(TEMPLATES))
        if ("_py_node" in path and "py" not in marks) or (
            "_cpp_node" in path and "cpp" not in marks
        ):
            continue
        target = folder / path.replace("my_package", folder.name).replace("dot_", ".")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text_of(template, words, marks))
        if target.suffix == ".py":
            target.chmod(0o755)


def main():
    parser = argparse.ArgumentParser(description="Write a package to start from.")
    parser.add_argument("folder", help="such as ~/catkin_ws/src/laser_filter")
    parser.add_argument("--language", default="python")
    options = parser.parse_args()
    if not options.folder:
        sys.exit("error: expected make new PKG=PATH, such as PKG=~/catkin_ws/src/laser_filter")
    folder = pathlib.Path(options.folder).expanduser().resolve()
    fault = fault_of(folder, options.language)
    if fault:
        sys.exit(f"error: {fault}.")
    try:
        write(folder, options.language)
    except OSError as error:
        shutil.rmtree(folder, ignore_errors=True)
        sys.exit(f"error: cannot write {error.filename}: {error.strerror}.")
    print(f"""Your new package is in {folder}. Build it and run it:

  make deps    # once: what building and testing need
  cd {folder.parents[1]}
  catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3
  source devel/setup.bash
  roslaunch {folder.name} {folder.name}.launch

Its README.md shows how to talk to the node, test it and check it.""")


if __name__ == "__main__":
    main()
