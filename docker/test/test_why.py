# SPDX-License-Identifier: BSD-3-Clause
"""Has Docker print its error texts: those of the list in mrp/doc/why that need it."""

import os
import pathlib
import subprocess
import sys

import pytest
from containers import PREFIX

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "catkin_ws" / "tools"
sys.path.insert(0, str(TOOLS))

import why_entries  # noqa: E402
import why_search  # noqa: E402

ENTRIES = [entry for entry in why_entries.entries() if entry.needs == "docker"]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_text_is_printed(entry, image):
    done = subprocess.run(
        ["bash", "-c", entry.try_],
        env={**os.environ, "IMAGE": image, "NAME": PREFIX + "why"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    printed = why_search.mask(done.stdout.replace(PREFIX + "why", "mrp"))
    for text in entry.shows:
        # Which Docker runs is no matter of this machine's Debian.
        texts = [why_entries.shown_on(text, release) for release in ("12", "13")]
        assert any(all(why_search.mask(line) in printed for line in lines) for lines in texts), text
