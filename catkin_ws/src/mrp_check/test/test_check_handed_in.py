# SPDX-License-Identifier: BSD-3-Clause
"""Checks what students hand in: it finds the package, or one sentence says why not."""

import os
import stat
import tarfile
import tempfile
import types
import unicodedata
import zipfile

import handed_in
import pytest
from check_rules import MANIFEST, hand_in
from handed_in import FILES, below, entry, tar, zip_
from mrp_check.classroom import archive
from mrp_check.cli import check as check_command
from mrp_check.contract.finding import HINT
from mrp_check.contract.verdict import unchecked
from mrp_check.package import manifest
from mrp_check.package.package import MAX_BYTES, Package
from mrp_check.rules.files import text
from mrp_check.verdict import check
from test_check_class import Room

pytestmark = pytest.mark.quick


class Reader(Room):
    """A classroom that looks at each package in place of a check."""

    def __init__(self, folder, **options):
        super().__init__(folder, **options)
        self.seen = {}

    def report_of(self, one, name):
        self.seen[name] = {path: (one.text(path), one.is_executable(path)) for path in one.files}
        return super().report_of(one, name)


@pytest.fixture
def uploads(tmp_path, monkeypatch):
    """The class's folder. In the end it is as it was, and nothing is left in the scratch folder."""
    scratch = tmp_path / "scratch"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    (tmp_path / "class").mkdir()
    return tmp_path / "class"


def state(folder):
    """Return all that can change in a folder, but for what the checks keep."""
    found = {}
    for place, folders, names in os.walk(folder):
        if not place.endswith(".checked"):
            found.update({os.path.join(place, n): os.lstat(os.path.join(place, n)) for n in names})
            found.update({os.path.join(place, n): None for n in folders if "checked" not in n})
    return {path: info and (info.st_mtime_ns, info.st_size) for path, info in found.items()}


def read(uploads, **options):
    """Check the class; return the Reader, after a look at what has changed."""
    before, room = state(uploads.parent), Reader(uploads, **options)
    room.results_of = {one.name: one for one in room.check()}
    assert state(uploads.parent) == before
    return room


def reason(uploads, **options):
    """Return why the only submission could not be checked."""
    (one,) = read(uploads, **options).results_of.values()
    assert one.report["verdict"] == check.UNCHECKED, one.name
    assert one.report["reason"].startswith(one.name.replace("\n", " "))
    return one.report["reason"]


@pytest.mark.parametrize("name", handed_in.TAKEN)
def test_the_package_is_found(uploads, name):
    handed_in.TAKEN[name](uploads / name)
    (seen,) = read(uploads).seen.values()
    seen = {unicodedata.normalize("NFC", path): known for path, known in seen.items()}
    executable = handed_in.EXECUTABLE.get(name, ("src/node.py",))
    assert seen == {path: (content, path in executable) for path, content in FILES.items()}


@pytest.mark.slow
@pytest.mark.parametrize("what", ["HEAD", "main"])
@pytest.mark.usefixtures("open_folders")
def test_the_package_is_found_in_a_git_bundle(uploads, what):
    """With HEAD, and without."""
    handed_in.bundle(uploads / "anna.bundle", what)
    assert read(uploads).seen["anna.bundle"]["src/node.py"] == (handed_in.SCRIPT, True)


def bomb(path):
    zip_(path, {**below("mrp"), "mrp/zeros.txt": b"\0" * 3_000_000})


def lying_bomb(path):
    """Its directory says that the file has 10 bytes."""
    bomb(path)
    data = path.read_bytes()
    path.write_bytes(data.replace((3_000_000).to_bytes(4, "little"), (10).to_bytes(4, "little")))


def encrypted(path):
    zip_(path, FILES)
    data = bytearray(path.read_bytes())
    for mark, place in ((b"PK\1\2", 8), (b"PK\3\4", 6)):
        at = -1
        while (at := data.find(mark, at + 1)) >= 0:
            data[at + place] |= 1
    path.write_bytes(data)


def cut(path):
    tar(path, {**below("mrp"), "mrp/x": os.urandom(20_000)})
    path.write_bytes(path.read_bytes()[:-9000])


def huge(path):
    zip_(path, FILES)
    with open(path, "r+b") as file:
        file.truncate(10**10)


def huge_header(path):
    """A tar of which one header has 9 MB, in few bytes."""
    tar(path, {"mrp/" + "x" * 9_000_000: "", **below("mrp")})


def behind_a_link(path):
    """The links by themselves lead nowhere; one behind the other leads out of the folder."""
    links = {"mrp/d/x": "../t", "mrp/d/y": "x/../../..", "mrp/d/y/z": "/etc"}
    made = {name: entry(tarfile.SYMTYPE, target) for name, target in links.items()}
    made["mrp/d/y/z"].linkname = "q"
    tar(path, {**below("mrp"), "mrp/t/file": "", **made})


def linked_zip(path):
    zip_(path, {"mrp/src/passwd": "/etc/passwd"}, unix=stat.S_IFLNK)
    with zipfile.ZipFile(path, "a") as file:
        for name, content in below("mrp").items():
            file.writestr(name, content)


def tar_with(name, content=""):
    return lambda path: tar(path, {**below("mrp"), name: content})


def of_bytes(data):
    return lambda path: path.write_bytes(data)


# The upload -> what makes it, and what the sentence says.
REFUSED = {
    "absolute.tar.gz": (tar_with("/etc/cron.d/x"), "entry /etc/cron.d/x: its path is absolute"),
    "up.tar.gz": (tar_with("mrp/../../x"), "entry mrp/../../x: its path leads out"),
    "up.zip": (lambda path: zip_(path, {r"..\x": "", **FILES}), "entry ../x: its path leads out"),
    "drive.zip": (lambda path: zip_(path, {r"C:\x": "", **FILES}), "C:/x: its path is absolute"),
    "deep.tar": (tar_with("a/" * 100 + "x"), "its path is too long"),
    "link.tgz": (tar_with("mrp/a", entry(tarfile.SYMTYPE, "../../a")), "mrp/a: it is a link out"),
    "link.zip": (linked_zip, "entry mrp/src/passwd: it is a link out of it, to /etc/passwd"),
    "same.tgz": (tar_with("mrp/a", entry(tarfile.LNKTYPE, "/etc/passwd")), "outside the package"),
    "behind.tgz": (behind_a_link, "entry mrp/d/y"),
    "device.tgz": (tar_with("sda", entry(tarfile.BLKTYPE)), "sda: it is a device or a pipe"),
    "pipe.tgz": (tar_with("mrp/p", entry(tarfile.FIFOTYPE)), "mrp/p: it is a device or a pipe"),
    "bomb.zip": (bomb, "entry mrp/zeros.txt: it unpacks to more than 100 times its size"),
    "lying.zip": (lying_bomb, "can't be unpacked"),
    "many.zip": (lambda path: zip_(path, dict.fromkeys(map(str, range(60)), "")), "50 entries"),
    # Before Python 3.14, tarfile asks for all of the header at once.
    "header.tgz": (huge_header, " is too long"),
    "encrypted.zip": (encrypted, "is encrypted, password required"),
    "cut.tgz": (cut, "can't be unpacked"),
    "huge.zip": (huge, "has 10000 MB"),
    "one.7z": (of_bytes(b"7z\xbc\xaf'\x1c"), "is a 7-Zip archive: expected"),
    "one.rar": (of_bytes(b"Rar!\x1a\x07"), "is a RAR archive: expected"),
    "one.tar.zst": (of_bytes(b"\x28\xb5\x2f\xfd"), "is a Zstandard archive: expected"),
    "report.pdf": (of_bytes(b"%PDF-1.7"), "is a PDF file: expected"),
    "node.py": (of_bytes(b"import rospy\n"), "is a single file, but not an archive"),
    "empty.zip": (of_bytes(b""), "is an empty file"),
    "wrong.zip": (of_bytes(b"PK\3\4"), "can't be unpacked: File is not a zip file"),
    "wrong.gz": (of_bytes(b"\x1f\x8b"), "can't be unpacked"),
    "wrong.bundle": (of_bytes(b"# v2 git bundle\n\n"), "git can't read it"),
    "nothing.zip": (lambda path: zip_(path, {"a/x.py": ""}), "nothing.zip has no package.xml"),
    "folder": (lambda path: handed_in.folder(path, {"a.pdf": ""}), "below it, but a.pdf: expected"),
    "pipe": (os.mkfifo, "is neither a folder nor a file"),
}


@pytest.mark.parametrize("name", REFUSED)
@pytest.mark.usefixtures("open_folders")
def test_what_is_refused_is_named(uploads, monkeypatch, name):
    monkeypatch.setattr("mrp_check.classroom.archive._FREE", 1_000_000)
    monkeypatch.setattr("mrp_check.classroom.archive._MOST_ENTRIES", 50)
    make, says = REFUSED[name]
    make(uploads / name)
    assert says in reason(uploads)


def test_all_archives_of_a_submission_are_counted_together(uploads, monkeypatch):
    """A zip of zips, as a known bomb is: each by itself is small enough."""
    monkeypatch.setattr("mrp_check.classroom.archive._MOST_UNPACKED", 10_000)
    inner = uploads / "inner"
    zip_(inner, {f"mrp/{number}": os.urandom(4000) for number in range(2)})
    zip_(uploads / "anna.zip", {f"{number}.zip": inner.read_bytes() for number in range(2)})
    inner.unlink()
    assert "what is unpacked is more than" in reason(uploads)


def test_a_packed_tar_is_read_up_to_a_limit(uploads, monkeypatch):
    monkeypatch.setattr("mrp_check.classroom.formats._MOST_PASSED", 1_000_000)
    tar(uploads / "anna.tgz", {"zeros": b"\0" * 2_000_000, **below("mrp")})
    assert "it unpacks to more than" in reason(uploads)


def test_each_entry_has_its_line_and_its_own_result(uploads):
    """Two of the same name are two; only what is hidden has no line."""
    hand_in(uploads, "anna")
    zip_(uploads / "anna.zip", {**FILES, "zip.py": ""})
    zip_(uploads / "anna.json", {**FILES, "json.py": ""})
    (uploads / "report.pdf").write_bytes(b"%PDF")
    (uploads / "empty").mkdir()
    for name in (".DS_Store", "._anna.zip", "__MACOSX", ".git"):
        (uploads / name).mkdir()
    verdicts = {name: one.report["verdict"] for name, one in read(uploads).results_of.items()}
    assert verdicts == {
        "anna": check.FINDINGS,
        "anna.json": check.FINDINGS,
        "anna.zip": check.FINDINGS,
        "empty": check.UNCHECKED,
        "report.pdf": check.UNCHECKED,
    }
    again = read(uploads)
    assert (again.checked, {one.kept for one in again.results_of.values()}) == ([], {True, False})
    zip_(uploads / "anna.zip", {**FILES, "zap.py": ""})
    assert read(uploads).checked == ["anna.zip"]


def test_what_is_kept_is_not_unpacked_again(uploads, monkeypatch):
    zip_(uploads / "anna.zip", FILES)
    assert read(uploads).checked == ["anna.zip"]
    monkeypatch.setattr(archive, "unpack", None)
    assert read(uploads).results_of["anna.zip"].kept


TWO = {**below("ws/src/one"), **below("ws/src/2", {"package.xml": MANIFEST.replace("some", "two")})}


@pytest.mark.parametrize("make", [handed_in.folder, zip_, tar], ids=["folder", "zip", "tar"])
def test_a_package_is_chosen_by_its_name(uploads, make):
    make(uploads / "anna", TWO)
    assert "more than one package: ws/src/2, ws/src/one. Expected one" in reason(uploads)
    assert "none called three" in reason(uploads, package="three")
    assert [*read(uploads, package="two_pkg").seen["anna"]] == ["package.xml"]
    assert "src/node.py" in read(uploads, package="one").seen["anna"]


def test_a_file_that_is_too_large_costs_nothing(uploads):
    """The check leaves it out, and says so; it is not even unpacked."""
    zip_(uploads / "anna.zip", {**FILES, "rosbag.bag": ""})
    data = bytearray((uploads / "anna.zip").read_bytes())
    at = data.rindex(b"rosbag.bag")
    data[at - 22 : at - 18] = (2**32 - 2).to_bytes(4, "little")  # its size in the directory
    (uploads / "anna.zip").write_bytes(data)
    assert "rosbag.bag" not in read(uploads).seen["anna.zip"]

    made = hand_in(uploads, "berta")
    with open(made / "rosbag.bag", "wb") as file:
        file.truncate(MAX_BYTES + 1)
    one = Package(made)
    assert ("rosbag.bag" in one.files, one.left_out) == (False, ["rosbag.bag"])
    case = types.SimpleNamespace(package=one, model=types.SimpleNamespace(relayed=list))
    (finding,) = text.RULE.ask(case)
    assert (finding.certainty, finding.file) == (HINT, "rosbag.bag")


ENTITIES = "".join(
    f'<!ENTITY {name} "{f"&{before};" * 10}">' for before, name in zip("abcdefghi", "bcdefghij")
)
BOMB = f"""<!DOCTYPE x [<!ENTITY a "0123456789">{ENTITIES}]>
<package format="3"><name>&j;</name></package>
"""


def test_an_xml_bomb_is_reported(uploads):
    handed_in.folder(uploads / "anna", {"package.xml": BOMB})
    one = Package(uploads / "anna")
    found, finding = manifest.parse(one)
    assert (found, one.name) == (None, "anna")
    assert finding.message == (
        "package.xml isn't valid XML: an entity is declared, noticed on line 1."
    )


def test_one_archive_alone(uploads, monkeypatch):
    seen = []

    def look(package, *_, **__):
        seen.extend(package.files)
        return unchecked("looked at")

    monkeypatch.setattr(check, "check", look)
    zip_(uploads / "anna.zip", TWO)
    arguments = [str(uploads / "anna.zip"), "--package", "two_pkg"]
    with pytest.raises(SystemExit):
        check_command.main(arguments)
    assert seen == ["package.xml"]
    assert [*(uploads.parent / "scratch").iterdir()] == []
