# SPDX-License-Identifier: BSD-3-Clause
"""The error texts that Docker prints: those of the list in catkin_ws/why that need it."""

import pathlib
import subprocess
import sys

import pytest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "catkin_ws" / "tools"
sys.path.insert(0, str(TOOLS))

import why  # noqa: E402

ENTRIES = [one for one in why.entries() if one.needs == "docker"]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_text_is_printed(entry):
    done = subprocess.run(
        ["bash", "-c", entry.try_], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    for text in entry.shows:
        for line in why.shown_on(text):
            assert why.mask(line) in why.mask(done.stdout)
