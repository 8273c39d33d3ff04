#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How large the image is, against what it was before.

Usage: image_size.py check|record IMAGE

`record` appends the size to image_sizes.csv; `check` fails if it has grown by more than 5 % since.
Where no Docker engine answers, or the image is not there, it is neither: a line says so.
"""

import pathlib
import subprocess
import sys

import history

HISTORY = pathlib.Path(__file__).resolve().parents[1] / "image_sizes.csv"
_TOLERATED = 1.05


def fault(rows, image, driver, megabytes):
    """Return a line on an image that has grown, or None; rows: of image_sizes.csv."""
    before = history.last(rows, image=image, driver=driver)
    if not before or megabytes <= _TOLERATED * float(before["megabytes"]):
        return None
    return (
        f"{image}: expected about {float(before['megabytes']):.1f} MB, as at {before['commit']}, "
        f"found {megabytes:.1f} MB"
    )


def _ask(*arguments):
    """Return what docker says, or None."""
    try:
        done = subprocess.run(
            ["docker", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
    except FileNotFoundError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def main(action, image):
    # Two drivers do not count the same.
    driver = _ask("info", "--format", "{{.Driver}}")
    if not driver:
        print(f"{image}: not measured: no Docker engine answers")
        return None
    size = _ask("image", "inspect", "--format", "{{.Size}}", image)
    if not size:
        print(f"{image}: not measured: there is no such image: make docker-build")
        return None
    megabytes = int(size) / 1e6
    print(f"{image}: {megabytes:.1f} MB")
    if action == "check":
        return fault(history.read(HISTORY), image, driver, megabytes)
    figures = {"image": image, "driver": driver, "megabytes": f"{megabytes:.1f}"}
    history.append(HISTORY, [{"commit": history.commit(), **figures}])
    return None


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("check", "record"):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
