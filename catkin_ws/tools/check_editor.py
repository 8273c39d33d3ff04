#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Opens the four nodes as an editor does: the C++ ones in clangd, the Python ones in pyright.

Neither may report an error. In a copy of each publisher, which has a wrong field of the message,
each must report that one. The workspace is built.
"""

import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
NODES = sorted((WORKSPACE / "src" / "mrp" / "src").glob("*_node.*"))
WRONG = WORKSPACE / "build" / "wrong_field"
LINT = WORKSPACE / "build" / "lint"
PYRIGHT = (LINT / "bin" / "node", LINT / "node_modules" / "pyright" / "index.js")


def run(*command):
    done = subprocess.run(command, cwd=WORKSPACE, capture_output=True, text=True)
    return done.stdout + done.stderr


def clangd(file):
    """Return file -> the errors that clangd reports; it finds compile_commands.json by itself."""
    printed = run("clangd", f"--check={file}")
    assert "Loaded compilation database" in printed and "Building AST" in printed, printed
    return {file: re.findall(r"^E\[.*?\] (\[.*)$", printed, re.MULTILINE)}


def pyright(*files):
    """Return file -> the errors that pyright reports; pyproject.toml names the stubs."""
    report = json.loads(run(*PYRIGHT, "--outputjson", *files))
    assert report["summary"]["filesAnalyzed"] == len(files), report
    errors = {file: [] for file in files}
    for diagnostic in report["generalDiagnostics"]:
        errors[pathlib.Path(diagnostic["file"])].append(diagnostic["message"])
    return errors


def wrong_copies():
    """Write a copy of each publisher with a wrong field; return their paths."""
    WRONG.mkdir(exist_ok=True)
    for node in NODES:
        if node.stem.startswith("publisher"):
            (WRONG / node.name).write_text(node.read_text().replace("msg.data", "msg.daat"))
            yield WRONG / node.name


def main():
    wrong = set(wrong_copies())
    files = [*NODES, *wrong]
    errors = {}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(clangd, file) for file in files if file.suffix == ".cpp"]
        jobs.append(pool.submit(pyright, *(file for file in files if file.suffix == ".py")))
        for job in jobs:
            errors.update(job.result())
    faults = [f"{node}: {error}" for node in NODES for error in errors[node]]
    for file in wrong:
        if len(errors[file]) != 1 or "daat" not in errors[file][0]:
            faults.append(f"{file}: expected one error about the field daat: {errors[file]}")
    print(*faults, sep="\n", end="\n" if faults else "")
    return int(bool(faults) or len(files) != 6)


if __name__ == "__main__":
    sys.exit(main())
