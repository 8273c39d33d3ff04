# SPDX-License-Identifier: BSD-3-Clause
"""tools/release.py, on a repository that has the packages' manifests and changelogs alone."""

import shutil
import subprocess

import pytest
from mrp_testing.workspace import WORKSPACE

pytestmark = pytest.mark.quick


@pytest.fixture
def release(tmp_path, monkeypatch):
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "me")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "me@mrp.example")
    (tmp_path / "catkin_ws/tools").mkdir(parents=True)
    script = shutil.copy(WORKSPACE / "tools/release.py", tmp_path / "catkin_ws/tools")
    for manifest in (WORKSPACE / "src").glob("*/package.xml"):
        folder = tmp_path / "catkin_ws/src" / manifest.parent.name
        folder.mkdir(parents=True)
        for name in ("package.xml", "CHANGELOG.rst"):
            shutil.copy(manifest.with_name(name), folder)
    for command in (("init", "--quiet"), ("add", "-A"), ("commit", "--quiet", "-m", "all of it")):
        subprocess.run(["git", "-C", tmp_path, *command], check=True)
    return lambda *arguments: subprocess.run(
        ["/usr/bin/python3", script, *arguments], capture_output=True, text=True
    )


def test_release_is_complete_once_tagged(release):
    before = release("--check")
    assert before.returncode == 1
    assert '[MISSING] every package.xml has <url type="repository">' in before.stdout
    version = before.stdout.split("(")[1].split(")")[0]
    done = release(version, "https://forge.example/Somebody/mrp")
    assert done.returncode == 0, done.stderr
    after = release("--check")
    assert (after.returncode, "MISSING" in after.stdout) == (0, False), after.stdout
    assert "### mrp_check\n\n* " in release("--notes").stdout


def test_release_needs_a_version_and_an_address(release):
    done = release("1.0", "https://forge.example/somebody/mrp")
    assert done.returncode == 1 and done.stderr.startswith("error: expected make release VERSION=")
