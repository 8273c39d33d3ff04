# SPDX-License-Identifier: BSD-3-Clause
"""The folder that stays from one check to the next: what it saves, and what it must not carry."""

import os
import tempfile

import check_sets
import pytest
from mrp_check.sandbox.scratch import kept_folder

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("open_folders")]


@pytest.fixture(autouse=True)
def temporary(tmp_path, monkeypatch):
    """A folder of its own for what is temporary; returns it."""
    folder = tmp_path / "temporary"
    folder.mkdir(mode=0o711)
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.fixture
def checked(tmp_path, programs):
    """A function that checks whether the tutorial's package can be configured; it returns the ids
    of the findings, and whether CMake ran."""
    place = tmp_path / "package"
    check_sets.lay_out("mrp", place)

    def once(static=False):
        programs.clear()
        with kept_folder("this version") as kept:
            ids = [] if static else ["compile"]
            report = check_sets.check_tutorial(place, *ids, kept=kept, static=static)
        return [finding.id for finding in report.findings], "catkin_make" in programs

    return once


def test_second_check_makes_nothing_again_and_follows_no_link(checked, temporary, tmp_path):
    """A package can change its copy: the next check must not write through it into the user's
    files. What a change makes again is in test_learn.py."""
    assert checked(static=True) == ([], True)
    assert checked(static=True) == ([], False)
    assert checked() == ([], False)
    (folder,) = temporary.glob("mrp_check.*/workspace/src/package")
    victim = tmp_path / "victim"
    (folder / "src").rename(victim)
    (folder / "src").symlink_to(victim)
    source = tmp_path / "package" / "src" / "publisher_cpp_node.cpp"
    source.write_text(source.read_text() + "// changed\n")
    assert checked() == ([], True)
    assert "// changed" not in (victim / "publisher_cpp_node.cpp").read_text()


def test_two_at_the_same_time_share_nothing():
    with kept_folder("1") as first, kept_folder("1") as other:
        assert first != other
    assert first.exists() and not other.exists()


def test_another_version_trusts_nothing_of_it():
    for version, is_there in (("1", False), ("1", True), ("2", False)):
        with kept_folder(version) as folder:
            file = folder / "given" / "file"
            assert file.exists() is is_there
            file.parent.mkdir(exist_ok=True)
            file.touch()


def test_folder_that_others_can_change_is_left_alone(temporary):
    planted = temporary / f"mrp_check.{os.getuid()}"
    planted.mkdir()
    planted.chmod(0o777)
    with kept_folder("1") as folder:
        assert folder != planted
    assert not [*planted.iterdir()]
