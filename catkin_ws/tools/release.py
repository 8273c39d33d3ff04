#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Release all packages in one version, by the rules of catkin_prepare_release.

release.py VERSION REPOSITORY [WEBSITE]   write the addresses, commit, and tag
release.py --check                        list what a release still lacks
release.py --notes                        print the changelogs of a complete release as Markdown
"""

import contextlib
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


def changes(folder, version):
    """Return the lines of a package's changelog about a version, or None."""
    changelog = get_changelog_from_path(folder)
    try:
        return [str(item) for item in changelog.get_content_of_version(version)]
    except (AttributeError, KeyError):
        return None


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


def check():
    """Print what is there and what is missing; return whether all is there."""
    packages = {folder.name: parse_package(folder) for folder in FOLDERS}
    versions = {package.version for package in packages.values()}
    version = min(versions)
    results = {f"all packages have one version ({', '.join(sorted(versions))})": len(versions) == 1}
    for folder in FOLDERS:
        title = f"{folder.name}/CHANGELOG.rst has a section {version}"
        results[title] = bool(changes(folder, version))
    for kind in URLS:
        has = all(kind in {url.type for url in p.urls} for p in packages.values())
        results[f'every package.xml has <url type="{kind}">'] = has
    results["everything is committed"] = not git("status", "--porcelain", "--untracked-files=no")
    results[f"the tag {version} is here"] = version in git("tag", "--points-at", "HEAD").split()
    for title, is_there in results.items():
        print("[OK]     " if is_there else "[MISSING]", title)
    if not all(results.values()):
        print(f"fix: make release VERSION={version} REPOSITORY=https://github.com/OWNER/NAME")
    return all(results.values())


def notes():
    """Print the release notes."""
    version = parse_package(FOLDERS[0]).version
    for folder in FOLDERS:
        print(f"### {folder.name}\n")
        print("\n".join(changes(folder, version) or []) + "\n")


def main():
    arguments = sys.argv[1:]
    if arguments == ["--check"]:
        sys.exit(not check())
    if arguments == ["--notes"]:
        with contextlib.redirect_stdout(sys.stderr):
            is_complete = check()
        return notes() if is_complete else sys.exit(1)
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
