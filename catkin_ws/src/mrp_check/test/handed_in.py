# SPDX-License-Identifier: BSD-3-Clause
"""What students hand in, as the programs that they pack with write it."""

import io
import os
import stat
import subprocess
import tarfile
import unicodedata
import zipfile

from check_rules import MANIFEST

SCRIPT = "#!/usr/bin/env python3\n"
FILES = {
    "package.xml": MANIFEST,
    "CMakeLists.txt": "# x\n",
    "doc/Übung 1.txt": "x",
    "src/module": SCRIPT,
    "src/node.py": SCRIPT,
}
COMMIT = b"0123456789abcdef0123456789abcdef01234567"


def below(folder, files=FILES):
    """Return the files with a folder before their names."""
    return {f"{folder}/{name}": content for name, content in files.items()}


def bytes_of(content):
    return content if isinstance(content, bytes) else content.encode()


class Named(zipfile.ZipInfo):
    """An entry of a zip whose name is in the bytes of an old encoding, and does not say so."""

    encoding = "utf-8"

    def _encodeFilenameFlags(self):  # noqa: N802 (zipfile's name)
        return self.filename.encode(self.encoding), self.flag_bits & ~0x800


class OfWindows(Named):
    encoding = "cp850"


def mode_of(name):
    return 0o755 if name.endswith(".py") else 0o644


def zip_(path, files, entry=zipfile.ZipInfo, unix=stat.S_IFREG):
    """Write a zip; unix: the kind of its entries there, or 0 for Windows, which has no modes."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            info = entry("x")
            info.filename, info.create_system = name, 3 if unix else 0
            info.external_attr = (unix | mode_of(name)) << 16 if unix else 0x20
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, bytes_of(content))


def tar(path, files, kind="gz"):
    """Write a tar; a content may be a TarInfo, such as that of a link."""
    with tarfile.open(path, f"w:{kind}") as archive:
        for name, content in files.items():
            info = content if isinstance(content, tarfile.TarInfo) else tarfile.TarInfo(name)
            info.name, info.mode = name, mode_of(name)
            data = b"" if info is content else bytes_of(content)
            info.size = len(data)
            archive.addfile(info, io.BytesIO(data))


def entry(kind, target=""):
    """Return what tar() writes for a link, a device or a pipe."""
    info = tarfile.TarInfo()
    info.type, info.linkname = kind, target
    return info


def folder(path, files):
    for name, content in files.items():
        file = path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(bytes_of(content))
        file.chmod(mode_of(name))


def git(place, *arguments):
    env = {"PATH": os.environ["PATH"], "HOME": str(place), "GIT_CONFIG_NOSYSTEM": "1"}
    who = ("-c", "user.name=a", "-c", "user.email=a@a.example", "-c", "init.defaultBranch=main")
    subprocess.run(["git", *who, *arguments], cwd=place, env=env, check=True, capture_output=True)


def clone(path, files=FILES):
    """Make a git repository with a work tree."""
    folder(path, files)
    git(path, "init")
    git(path, "add", ".")
    git(path, "commit", "-m", "x")


def seven_zip(path):
    files = path.parent.parent / "files"
    folder(files, below("mrp"))
    command = ["cmake", "-E", "tar", "cf", path, "--format=7zip", "mrp"]
    subprocess.run(command, cwd=files, check=True)


def bundle(path, what):
    repository = path.parent.parent / "repository"
    clone(repository, below("my_ws/src/mrp"))
    git(repository, "bundle", "create", str(path), what)


def finder(path):
    """macOS: UTF-8 that does not say so (and decomposed), and its own files beside each."""
    own = {"__MACOSX/Ä/mrp/._package.xml": b"\0\5\x16\7", "Ä/.DS_Store": b"\0"}
    files = {**below("Ä/mrp"), **own, "Ä/mrp/src/._node.py": b"\0\5\x16\7"}
    files = {unicodedata.normalize("NFD", name): content for name, content in files.items()}
    zip_(path, files, entry=Named)


def github(path, executable=("mrp-main/src/node.py",)):
    """GitHub's "Download ZIP", as git makes it: only what is executable has a mode."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.comment = COMMIT
        for name, content in below("mrp-main").items():
            info = zipfile.ZipInfo(name)
            info.create_system = 3 if name in executable else 0
            info.external_attr = 0o100755 << 16 if name in executable else 0
            archive.writestr(info, content)


def nested(path):
    """A zip of a zip, as a platform packs what was packed already."""
    inner = path.with_name("inner")
    zip_(inner, FILES)
    zip_(path, {"handed in/mrp.zip": inner.read_bytes(), "handed in/report.pdf": b"%PDF"})
    inner.unlink()


def moodle(path):
    """Moodle's "Download all submissions", unpacked: a folder of each student with the files."""
    path.mkdir()
    zip_(path / "hand in.zip", below("mrp"))
    (path / "onlinetext.html").write_text("<p>see the zip</p>")


WORKSPACE = {
    **below("src/mrp"),
    "build/CMakeCache.txt": "",
    "build/mrp/package.xml": MANIFEST,
    "devel/.catkin": "",
    "install/.catkin": "",
    "install/share/mrp/package.xml": MANIFEST,
}
TOPLEVEL = "/usr/share/catkin/cmake/toplevel.cmake"


def workspace(path):
    folder(path, WORKSPACE)
    (path / "src" / "CMakeLists.txt").symlink_to(TOPLEVEL)


def workspace_tar(path):
    link = entry(tarfile.SYMTYPE, TOPLEVEL)
    tar(path, {**below("./ws", WORKSPACE), "./ws/src/CMakeLists.txt": link})


def dotnet(path):
    """Windows' PowerShell, for long: backslashes between the folders."""
    zip_(path, {name.replace("/", "\\"): text for name, text in below("ws/mrp").items()}, unix=0)


BUILT = {**below("mrp"), "mrp/build/CMakeCache.txt": "", "mrp/build/node.py": ""}
# Which files are executable, if not node.py alone: Windows has no modes.
EXECUTABLE = dict.fromkeys(
    ("explorer.zip", "dotnet.zip", "seven_zip.zip"), ("src/module", "src/node.py")
)
EXECUTABLE["none_executable.zip"] = ()

# The entry of the class's folder -> what makes it.
TAKEN = {
    "finder.zip": finder,
    "explorer.zip": lambda path: zip_(path, below("Übung 1/mrp"), entry=OfWindows, unix=0),
    "dotnet.zip": dotnet,
    "seven_zip.zip": lambda path: zip_(path, {"Übung/": "", **below("Übung/mrp")}, unix=0),
    "github.zip": github,
    "none_executable.zip": lambda path: github(path, ()),
    "nested.zip": nested,
    "Anna Müller_12345_assignsubmission_file_": moodle,
    "Bert Ä_12346_assignsubmission_file_mrp.zip": lambda path: zip_(path, FILES),
    "one.tar": lambda path: tar(path, below("./mrp"), ""),
    "one.tar.gz": lambda path: tar(path, below("mrp")),
    "no suffix": lambda path: tar(path, below("mrp"), "xz"),
    "clone": clone,
    "one.7z": seven_zip,
    "anna.bundle": lambda path: bundle(path, "HEAD"),
    "berta.bundle": lambda path: bundle(path, "main"),
    "workspace": workspace,
    "workspace.tgz": workspace_tar,
    "built": lambda path: folder(path, BUILT),
    "built.zip": lambda path: zip_(path, BUILT),
    "deep": lambda path: folder(path / "/".join("abcdefg"), FILES),
}
