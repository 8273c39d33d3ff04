#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Release all packages in one version, by the rules of catkin_prepare_release.

release.py VERSION REPOSITORY [WEBSITE]   write the addresses, commit, and tag
release.py --notes                        print the changelogs of a release as Markdown
"""

import pathlib
import re
import subprocess
import sys

from catkin_pkg.changelog import get_changelog_from_path
from catkin_pkg.package import parse_package

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = sorted(path.parent for path in (ROOT / "catkin_ws/src").glob("*/package.xml"))
URLS = ("website", "repository", "bugtracker")


def git(*arguments):
    """Return what git prints."""
    return subprocess.check_output(["git", "-C", ROOT, *arguments], text=True).strip()


def has_forthcoming(folder):
    """Say if a package's changelog has the section that becomes the next version's."""
    return "\nForthcoming\n---" in (folder / "CHANGELOG.rst").read_text()


def write_urls(addresses):
    """Write each package.xml's <url>s anew: type -> address."""
    lines = "".join(f'  <url type="{kind}">{addresses[kind]}</url>\n' for kind in URLS)
    for folder in FOLDERS:
        path = folder / "package.xml"
        text = re.sub(r"\n?  <url type=.*</url>\n", "", path.read_text())
        path.write_text(text.replace("</package>", f"\n{lines}</package>"))


def write_readme(version, repository, owner, name):
    """Name the version and the repository in README.md, and let GitHub open it in a Codespace."""
    path, badge = ROOT / "README.md", "https://github.com/codespaces/badge.svg"
    codespace = f"[![Open in GitHub Codespaces]({badge})](https://codespaces.new/OWNER/REPO)"
    here = "Replace `ADDRESS` with the address of this page."
    text = path.read_text().replace(here, f"Or try it in your browser:\n{codespace}")
    for before, value, after in (
        (r"git clone ", repository, " mrp\n"),
        (r"https://codespaces\.new/", f"{owner}/{name}", r"\)"),
        (r"ghcr\.io/", owner.lower(), "/mrp-check"),
        (r'repo: "', repository, '"'),
        (r"rev: ", version, ","),
    ):
        text = re.sub(rf"(?<={before})\S+?(?={after})", value, text)
    path.write_text(text)


def release(version, repository, website=""):
    """Commit and tag a version. Raises CalledProcessError if git or catkin refuses."""
    is_new = parse_package(FOLDERS[0]).version != version
    if missing := [f.name for f in FOLDERS if is_new and not has_forthcoming(f)]:
        sys.exit(
            f"error: expected a section Forthcoming in CHANGELOG.rst of {', '.join(missing)}\n"
            "fix: catkin_generate_changelog, and rewrite for people what it takes from the commits"
        )
    owner, name = repository.rstrip("/").split("/")[-2:]
    website = website or f"https://{owner.lower()}.github.io/{name}"
    addresses = (website, repository, f"{repository}/issues")
    write_urls(dict(zip(URLS, addresses)))
    write_readme(version, repository, owner, name)
    if git("status", "--porcelain", "--untracked-files=no"):
        git("commit", "--quiet", "--all", "--message", f"release: publish at {repository}")
    if is_new:
        prepare = ("catkin_prepare_release", "--no-push", "--non-interactive", "--version", version)
        subprocess.run(prepare, cwd=ROOT, check=True)
    else:
        git("tag", version)


def notes():
    """Print the release notes; exit if `make release` hasn't made this commit a release."""
    package = parse_package(FOLDERS[0])
    if not package.urls or package.version not in git("tag", "--points-at", "HEAD").split():
        sys.exit(
            f"error: expected the addresses in package.xml, and the tag {package.version} here\n"
            f"fix: make release VERSION={package.version} REPOSITORY=https://github.com/OWNER/NAME"
        )
    for folder in FOLDERS:
        changes = get_changelog_from_path(folder).get_content_of_version(package.version)
        print(f"### {folder.name}\n")
        print("\n".join(map(str, changes)) + "\n")


def main():
    arguments = sys.argv[1:]
    if arguments == ["--notes"]:
        return notes()
    is_version = bool(arguments) and re.fullmatch(r"\d+\.\d+\.\d+", arguments[0])
    if not is_version or len(arguments) not in (2, 3) or "://" not in arguments[1]:
        sys.exit(
            "error: expected make release VERSION=1.2.3 REPOSITORY=https://github.com/OWNER/NAME"
        )
    try:
        release(*arguments)
    except subprocess.CalledProcessError as error:
        sys.exit(f"error: {error.cmd[0]} has failed; its own words are above")
    print(f"Tagged {arguments[0]}. To publish it: git push origin HEAD {arguments[0]}")


if __name__ == "__main__":
    main()
