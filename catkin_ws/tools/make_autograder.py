#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes autograder.zip, with which Gradescope checks packages against a contract.

Usage: make_autograder.py ZIP [SPEC]. Without SPEC, it is the tutorial's contract.

What must be in it: https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

import pathlib
import sys
import zipfile

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
CHECKER = WORKSPACE / "src" / "mrp_check"

# As `make check` has them.
LISTS = ("run", "tools", "check")


def entries(spec):
    """Return (name in the zip, path) of all files."""
    yield "spec.yaml", spec
    for name in ("setup.sh", "run_autograder"):
        yield name, WORKSPACE / "tools" / "gradescope" / name
    yield "install_packages.sh", WORKSPACE / "tools" / "install_packages.sh"
    for name in LISTS:
        yield f"apt/{name}.txt", WORKSPACE / "apt" / f"{name}.txt"
    yield "mrp_check/package.xml", CHECKER / "package.xml"  # with the address of the pages
    for folder in ("contracts", "schema", "scripts", "src", "templates"):
        for path in sorted((CHECKER / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                yield f"mrp_check/{path.relative_to(CHECKER)}", path


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(f"error: expected {__doc__.splitlines()[2]}")
    target, spec = map(pathlib.Path, [*sys.argv[1:], CHECKER / "contracts" / "pub_sub.yaml"][:2])
    if not spec.is_file():
        sys.exit(f"error: expected the file of a contract; there is no file {spec}")
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, path in entries(spec):
            archive.write(path, name)


if __name__ == "__main__":
    main()
