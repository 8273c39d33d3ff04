# SPDX-License-Identifier: BSD-3-Clause
"""tools/release.py, on a repository that has README, and the manifests and changelogs; and
tools/publish_site.sh, on a bare one."""

import re
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
    shutil.copy(WORKSPACE.parent / "README.md", tmp_path)
    script = shutil.copy(WORKSPACE / "tools/release.py", tmp_path / "catkin_ws/tools")
    for manifest in (WORKSPACE / "src").glob("*/package.xml"):
        folder = tmp_path / "catkin_ws/src" / manifest.parent.name
        folder.mkdir(parents=True)
        shutil.copy(manifest.with_name("CHANGELOG.rst"), folder)
        of_release = r"  <url type=.*</url>\n"
        (folder / manifest.name).write_text(re.sub(of_release, "", manifest.read_text()))
    for command in (("init", "--quiet"), ("add", "-A"), ("commit", "--quiet", "-m", "all of it")):
        subprocess.run(["git", "-C", tmp_path, *command], check=True)
    return lambda *arguments: subprocess.run(
        ["/usr/bin/python3", script, *arguments], capture_output=True, text=True
    )


def test_release_has_notes_once_tagged(release, tmp_path):
    before = release("--notes")
    assert (before.returncode, before.stdout) == (1, "")
    version = re.search(r"the tag (\S+) here", before.stderr)[1]
    done = release(version, "https://forge.example/Somebody/mrp")
    assert done.returncode == 0, done.stderr
    assert "### mrp_check\n\n* " in release("--notes").stdout
    readme = (tmp_path / "README.md").read_text()
    assert "\ngit clone https://forge.example/Somebody/mrp mrp\n" in readme
    assert "(https://codespaces.new/Somebody/mrp)" in readme
    assert f'{{repo: "https://forge.example/Somebody/mrp", rev: {version}, hooks' in readme
    assert " ghcr.io/somebody/mrp-check " in readme
    assert not re.findall("ADDRESS|OWNER|REPO", readme)


def test_next_release_needs_its_changes_and_bumps_the_version(release, tmp_path):
    refused = release("9.0.0", "https://forge.example/somebody/mrp")
    assert refused.returncode == 1
    assert refused.stderr.startswith(
        "error: expected a section Forthcoming in CHANGELOG.rst of mrp,"
    )
    for path in tmp_path.glob("catkin_ws/src/*/CHANGELOG.rst"):
        head, text = path.read_text().split("\n\n", 1)
        path.write_text(
            f"{head}\n\nForthcoming\n-----------\n* New in {path.parent.name}\n\n{text}"
        )
    subprocess.run(["git", "-C", tmp_path, "commit", "--quiet", "-am", "changes"], check=True)
    done = release("9.0.0", "https://forge.example/somebody/mrp")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "### mrp_check\n\n* New in mrp_check\n" in release("--notes").stdout


def test_release_needs_a_version_and_an_address(release):
    done = release("1.0", "https://forge.example/somebody/mrp")
    assert done.returncode == 1 and done.stderr.startswith("error: expected make release VERSION=")


def test_site_has_the_newest_pages_and_those_of_each_version(tmp_path):
    git = ["git", "-C", tmp_path / "published"]
    subprocess.run(["git", "init", "--quiet", "--bare", git[-1]], check=True)
    (tmp_path / "pages").mkdir()
    for version in ("1.0.0", "1.1.0"):
        (tmp_path / "pages" / f"only_in_{version}.html").write_text("")
        (tmp_path / "pages" / "index.html").write_text(version)
        publish = WORKSPACE / "tools" / "publish_site.sh"
        subprocess.run([publish, tmp_path / "pages", version, git[-1]], check=True)
        (tmp_path / "pages" / f"only_in_{version}.html").unlink()

    def shown(*words):
        return subprocess.check_output([*git, *words], text=True).split()

    pages = {version: ["index.html", f"only_in_{version}.html"] for version in ("1.0.0", "1.1.0")}
    in_folders = [f"{version}/{page}" for version in pages for page in pages[version]]
    listed = shown("ls-tree", "-r", "--name-only", "gh-pages")
    assert listed == [".nojekyll", *in_folders, *pages["1.1.0"]]
    for path, version in (("index.html", "1.1.0"), ("1.0.0/index.html", "1.0.0")):
        assert shown("show", f"gh-pages:{path}") == [version]
