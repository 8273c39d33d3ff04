# SPDX-License-Identifier: BSD-3-Clause
"""The table of Debian's releases: those who cannot read it say the same."""

import re

import pytest
import why
from mrp_check import releases
from mrp_testing import scratch
from mrp_testing.workspace import ROOT, WORKSPACE

pytestmark = pytest.mark.quick


def test_make_why_knows_what_a_release_has_not_any_more():
    fixes = {entry.name: entry.fix for entry in why.entries()}
    for gone in releases.GONE.values():
        assert gone.instead in fixes[gone.why]


def test_the_installer_knows_the_same_releases():
    """It runs where there is no Python yet."""
    text = (WORKSPACE / "tools" / "install_packages.sh").read_text()
    names = re.search(r"^ +([\w |]+)\) printf .*make deps", text, re.MULTILINE)[1].split(" | ")
    assert names == [*(release.name for release in releases.RELEASES.values()), "jammy"]
    assert f"Debian {releases.supported()}" in text


def test_catkin_make_gets_the_variable_everywhere():
    pair = f"{releases.CMAKE_VARIABLE}={releases.CMAKE_VALUE}"
    for path in ("Makefile", "docker/Dockerfile"):
        assert pair in (ROOT / path).read_text()
    assert scratch.environment()[releases.CMAKE_VARIABLE] == releases.CMAKE_VALUE


@pytest.mark.parametrize(
    ("text", "number"),
    [
        *((f"ID=debian\nVERSION_CODENAME={o.name}\n", n) for n, o in releases.RELEASES.items()),
        ('PRETTY_NAME="Debian 11"\nID=debian\nVERSION_CODENAME="bullseye"\n', None),
        ("ID=ubuntu\nVERSION_CODENAME=jammy\n", None),
        ("", None),
    ],
)
def test_number_of_this_machines_debian(text, number, tmp_path):
    (tmp_path / "os-release").write_text(text)
    assert releases.here(str(tmp_path / "os-release")) == number
