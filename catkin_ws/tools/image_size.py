#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""How large the image is, against what it was before.

Usage: image_size.py check|record IMAGE

`record` appends the size to image_sizes.csv; `check` fails if it has grown by more than 5 % since.
`make docker-size` has built the image.
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
    """Return what docker says."""
    done = subprocess.run(["docker", *arguments], check=True, stdout=subprocess.PIPE, text=True)
    return done.stdout.strip()


def main(action, image):
    # Two drivers do not count the same.
    driver = _ask("info", "--format", "{{.Driver}}")
    megabytes = int(_ask("image", "inspect", "--format", "{{.Size}}", image)) / 1e6
    print(f"{image}: {megabytes:.1f} MB")
    if action == "check":
        rows = history.read(HISTORY)
        if not history.last(rows, image=image, driver=driver):
            print(f"nothing to compare with: {HISTORY.name} has no size with the driver {driver}")
        return fault(rows, image, driver, megabytes)
    figures = {"image": image, "driver": driver, "megabytes": f"{megabytes:.1f}"}
    history.append(HISTORY, [{"commit": history.commit(), **figures}])
    return None


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("check", "record"):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
