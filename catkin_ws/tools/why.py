#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Says what an error text means, why it is printed, and how to fix it.

Usage: why.py [TEXT]; without a text it reads what is piped into it, such as a whole log.

An entry stands in a file of the folder why/, below its name in brackets, or in the head of a patch
in defects/. Its fields:

    Shows: [rospack] Error: ...    a text as it is printed; lines that belong together stand below
    Also: rospack: ...             the same in another version; nothing here prints it
    Why: The terminal ...          the cause, in one or two sentences
    Fix: Source ...                what to do, in one or two sentences
    Page: wrong#there-is-no-master where the pages say more
    Above: yes                     the cause stands above: one of such entries is enough
    Try: rostopic list             the commands that make ROS print it
    Needs: master                  what they need: see tests/test_why.py, or docker/test/test_why.py

There may be several fields Shows and Also. A line of Shows that begins with "12| " or "13| " is
that of one Debian release. tests/test_why.py runs Try, and holds Shows against what is printed.
`make claims WRITE=1` puts Why and Fix into the list of the page's sentences.
"""

import dataclasses
import itertools
import os
import pathlib
import re
import sqlite3
import sys

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
SITE = WORKSPACE / "build" / "docs"
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract import defects  # noqa: E402

FOLDER = WORKSPACE / "why"
ANSWERS = 3
REQUIRED, SEVERAL = ("Shows", "Why", "Fix", "Try"), ("Shows", "Also")
FIELDS = (*REQUIRED, "Also", "Page", "Above", "Needs")

# What differs from one run to the next, and from one machine to another.
_MASKS = (
    (re.compile(r"\x1b\[[0-9;]*m|\x1b\][^\x07]*\x07"), ""),
    (re.compile("[‘’`´]"), "'"),
    (re.compile("[“”]"), '"'),
    (re.compile(r"(?<![\w.])~?/[^\s:;,'\"()\[\]<>]+"), "/#"),
    # An exit code says what happened.
    (re.compile(r"\b(?:0x[0-9a-f]+|[0-9a-f]{32,})\b"), "#"),
    (re.compile(r"(?<!exit code )(?<!exit code -)(?<!\d)(?:(?<=\s)-)?\d+(?:\.\d+)*"), "#"),
)
# What the system, the shell and g++ say in other languages: Chinese, Japanese, German, Spanish,
# French and Portuguese. What is longer stands first.
_ENGLISH = {
    ": ": "：",
    ", ": "，",
    "No such file or directory": "没有那个文件或目录|そのようなファイルやディレクトリはありません"
    "|Datei oder Verzeichnis nicht gefunden|No existe el (?:archivo|fichero) o el directorio"
    "|Aucun fichier ou dossier de ce (?:type|nom)|(?:Arquivo|Ficheiro) ou \\w+ inexistente",
    "Permission denied": "权限不够|許可がありません|Keine Berechtigung|Permiso denegado"
    "|Permission non accordée|Permissão (?:negada|recusada)",
    "command not found": "未找到命令|コマンドが見つかりません|(?:Kommando|Befehl) nicht gefunden"
    "|(?:orden|comando) no encontrad[oa]|commande introuvable|comando não encontrado",
    "Unable to locate package": "无法定位软件包|No se ha podido localizar el paquete"
    "|Impossible de trouver le paquet|(?:Não foi possível|Impossível) encontrar o pacote",
    "Segmentation fault": "段错误|セグメンテーション違反|Speicherzugriffsfehler"
    "|Violación de segmento|Erreur de segmentation|Falha de segmentação",
    "core dumped": "核心已转储|コアダンプ|Speicherabzug geschrieben|.core. generado"
    "|imagem do núcleo gravada",
    "Aborted": "已放弃|Abgebrochen|Abortado",
    "Killed": "已杀死|Getötet",
    "Connection refused": "拒绝连接|接続を拒否されました|Verbindungsaufbau abgelehnt"
    "|Conexión rehusada|Connexion refusée|Conexão recusada",
    "No space left on device": "设备上没有空间|Auf dem Gerät ist kein Speicherplatz mehr verfügbar",
    "was not declared in this scope": "在此作用域中(?:尚未|未)声明"
    "|はこのスコープで宣言されていません|wurde in diesem Gültigkeitsbereich nicht definiert"
    "|no se declaró en este ámbito|n.a pas été déclaré dans cette portée",
    "undefined reference to": "未定义的引用|に対する定義されていない参照"
    "|Nicht definierter Verweis auf|référence indéfinie vers",
    "Waiting for unfinished jobs": "正在等待未完成的任务",
    "fatal error": "致命错误|致命的エラー|schwerwiegender Fehler|erreur fatale|error fatal",
    "error": "错误|エラー|\\bFehler\\b|\\berreur\\b|\\berro\\b",
    "warning": "警告|\\bWarnung\\b|\\bavertissement\\b",
}
# Of a path, only the last part counts, and whether it is that of ROS's own packages.
_FOLDERS = re.compile(r"(?<![\w.])~?(/opt/ros/\w+)?/(?:[^\s/:;,'\"()\[\]<>]+/)*")
# What ROS 2 alone prints: only an entry with most of the words, and with such a word, can be right.
# The names of its packages, such as ament_cmake, stand in what ROS 1 prints, too.
_ROS2 = re.compile(
    r"(?<![\w/-])ros2(?![\w/.-])|rosbag2|\brcl(?:cpp|py)?\b|\brmw_\w+|\bcolcon\b"
    r"|/opt/ros/(?:foxy|galactic|humble|iron|jazzy)\b"
    r"|(?<![\w/])[a-z]\w*/(?:msg|srv|action)/[A-Z]\w*\b(?!\.)"
)
_OF_ROS2 = "rosii"  # the word that stands for it
_WORD = re.compile(r"[^\W\d_]+|\d+")
# A name in quotes or brackets is somebody's own: that of a package, a topic, a parameter.
_NAME = re.compile(r"""'[^'\s]+'|"[^"\s]+"|\[[^][\s]+\]""")
# A text is near an entry if it has this part of the entry's words, or the entry this part of its.
_OF_ENTRY, _OF_TEXT = 0.5, 0.7
# It also shares two words with the entry beside "does not exist" and the like, or has all of its.
_SCORE = 15
_COMMON = set(
    "a an and are as be been by does error exist for from has in is it no not of on or such that"
    " the this to was with".split()
)
_TOGETHER = 3  # lines: long messages are broken into that many
# Lines around any error, which say nothing of it.
_EVERYWHERE = re.compile(
    r'\s*(?:Traceback \(most recent call last\):|File "[^"]*", line \d+, in \S+'
    r"|During handling of the above exception, another exception occurred:"
    r"|The traceback for the exception was written to the log file"
    r"|\.\.\. logging to .*|Checking log directory .*|Press Ctrl-C to interrupt"
    r"|Done checking log file .*|started roslaunch server .*|ROS_MASTER_URI=.*"
    r"|log file: .*|auto-starting new master|setting /run_id .*|started core service .*"
    r"|process\[.*\]: started with pid .*"
    r"|all processes on machine have died.*|(?:\.\.\. )?shutting down processing monitor.*"
    r"|-- (?:Using|Found) .*|\[ *\d+%\] .*)\s*"
)
# What begins a warning; lines below it that are indented belong to it. That the standard of C++ is
# too old is a cause, though g++ only warns.
_WARNING = re.compile(r"\b(?:warning:(?!.* only available with )|\w*Warning\b|WARN(?:ING)?\b)")
# A line of code in a traceback, below the line that names its file: the error stands further below,
# unless the text was cut off there.
_CODE = re.compile(r'^([ \t]*)File "[^"\n]*", line \d+.*\n\1[ \t]+\S.*$', re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Entry:
    """What is printed, why, and what to do. theme: the heading under which it stands."""

    name: str
    theme: str
    shows: tuple
    why: str
    fix: str
    try_: str
    also: tuple = ()
    page: str = ""
    above: str = ""
    needs: str = ""
    defect: defects.Defect = None

    @property
    def address(self):
        """Its place on the pages: that of the page that explains it, or of the list."""
        return self.page or f"why#{self.name}"


class EntryError(Exception):
    """An entry is not as it must be; the text is one sentence."""


def entries():
    """Return all entries: those of the files, by theme, and then those of defects."""
    found = [one for path in sorted(FOLDER.glob("*.txt")) for one in _of_file(path)]
    for defect in defects.read_all():
        if defect.why:
            found.append(_of_defect(defect))
    return found


def _of_file(path):
    theme, *parts = re.split(r"^\[([\w-]+)\]\n", path.read_text(), flags=re.MULTILINE)
    for name, text in zip(parts[::2], parts[1::2]):
        found = defects.fields_of(text, f"{path.name}, {name}")
        yield _entry(name, theme.strip("# \n"), found)


def _of_defect(defect):
    name = defect.name.replace("_", "-")
    return _entry(name, "Mistakes in a package", defect.why, defect=defect)


def _entry(name, theme, found, **more):
    missing = [field for field in REQUIRED if field not in found]
    unknown = [field for field in found if field not in FIELDS]
    twice = [field for field in found if len(found[field]) > 1 and field not in SEVERAL]
    if missing or unknown or twice:
        what = f"missing {missing}, unknown {unknown}, more than once {twice}"
        raise EntryError(f"{name}: expected each of {', '.join(FIELDS)} as it must be; {what}.")
    one = {field: values[0] for field, values in found.items() if field not in SEVERAL}
    several = {field.lower(): tuple(found.get(field, ())) for field in SEVERAL}
    several = {field: tuple(map(_dedent, values)) for field, values in several.items()}
    plain = {field.lower(): " ".join(one[field].split()) for field in one if field != "Try"}
    return Entry(name=name, theme=theme, try_=one["Try"], **several, **plain, **more)


def _dedent(text):
    return "\n".join(line.strip() for line in text.splitlines())


def shown_on(text, release=None):
    """Return the lines of a text that is printed, on one Debian release or on any."""
    lines = [re.fullmatch(r"(?:(\d+)\| )?(.*)", line).groups() for line in text.splitlines()]
    return [line for debian, line in lines if not debian or release in (None, debian)]


def mask(text):
    """Return a text without what differs from run to run: paths, numbers, colours."""
    for pattern, stand_in in _MASKS:
        text = pattern.sub(stand_in, text)
    return " ".join(text.split())


class Index:
    """All entries, to be searched by the words of a text: SQLite's full-text search ranks them.

    A word counts the more the fewer entries have it, and two words side by side count as one more.
    """

    def __init__(self, found):
        self._entries = found
        self._table = sqlite3.connect(":memory:")
        self._table.execute("CREATE VIRTUAL TABLE texts USING fts5(words, entry UNINDEXED)")
        self._known = set()
        self._sure = []  # for each text: its words, without names if there are others
        for number, one in enumerate(found):
            for text in (*one.shows, *one.also):
                line = " ".join(shown_on(text))
                words = _words(line)
                self._known.update(words)
                sure = set(_words(_NAME.sub(" ", mask(line))) or words)
                self._sure.append(sure | set(words) & {_OF_ROS2})
                self._table.execute("INSERT INTO texts VALUES (?, ?)", (" ".join(words), number))

    def nearest(self, text, count=ANSWERS):
        """Return the entries that are near to a text, the nearest one first."""
        for words, others in _ENGLISH.items():
            text = re.sub(others, f" {words} ", text)
        best = self._scores(_CODE.sub("", text)) or self._scores(text)
        ranked = [self._entries[one] for one in sorted(best, key=best.get, reverse=True)]
        ends = [one for one in ranked if one.above][1:]
        return [one for one in ranked if one not in ends][:count]

    def _scores(self, text):
        """Return, by the numbers of the entries that are near to a text, whether they are an error,
        their best score, and how many of their texts have it: the most general entry does if only
        names differ."""
        best = {}
        for words, warning in _passages(text):
            for row, number, score in self._search(words):
                *highest, count = best.get(number, (False, 0, 0))
                found = [not warning, score]
                if found >= highest and _is_near(set(words), self._sure[row - 1], score):
                    best[number] = (*found, count + 1 if found == highest else 1)
        return best

    def _search(self, words):
        """Yield (row, number of the entry, score) of all texts that have one of the words."""
        words = [word if word in self._known else "" for word in words]
        terms = {f'"{one} {two}"' for one, two in itertools.pairwise(words) if one and two}
        terms |= {f'"{word}"' for word in words if word}
        if terms:
            query = (
                "SELECT rowid, entry, -rank FROM texts WHERE texts MATCH ? ORDER BY rank LIMIT 40"
            )
            yield from self._table.execute(query, (" OR ".join(sorted(terms)),))


def _is_near(words, others, score):
    shared = words & others
    if _OF_ROS2 in words and (_OF_ROS2 not in others or len(shared) / len(others) < _OF_TEXT):
        return False
    enough = others <= words or (score >= _SCORE and len(shared - _COMMON) > 1)
    enough = enough and (len(shared) > 1 or len(others) == 1)
    return enough and (
        len(shared) / len(others) >= _OF_ENTRY or len(shared) / len(words) >= _OF_TEXT
    )


def _words(text):
    text = _ROS2.sub(f" {_OF_ROS2} ", text)
    text = _FOLDERS.sub(lambda match: " optros " if match[1] else " ", text)
    return [word.lower() for word in _WORD.findall(mask(text))]


def _passages(text):
    """Yield the words of each line of a text, and of lines that follow each other, and whether one
    of them warns: an error counts more."""
    lines, warns = [], False
    for line in text.splitlines():
        warns = bool(_WARNING.search(line)) or (warns and line.startswith(" "))
        words = [] if _EVERYWHERE.fullmatch(line) else _words(line)
        if words:
            lines.append((words, warns))
    seen = set()
    for length in range(1, _TOGETHER + 1):
        for begin in range(max(len(lines) - length, 0) + 1):
            together = lines[begin : begin + length]
            passage = tuple(itertools.chain(*(words for words, _ in together)))
            if passage and passage not in seen:
                seen.add(passage)
                yield passage, any(warns for _, warns in together)


def answer(found):
    """Return what is said to the user of the entries that were found."""
    if not found:
        return (
            "No entry is near this text. Look for the first line that says 'error', and ask for "
            "that line alone.\nAll texts: " + _link("why")
        )
    parts = []
    for number, one in enumerate(found, 1):
        shows = shown_on(one.shows[0])
        lines = [f"{number}. {shows[0]}", *("   " + line for line in shows[1:])]
        lines += [f"   why:  {one.why}", f"   fix:  {one.fix}", f"   page: {_link(one.address)}"]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def _link(address):
    """Return where the pages are, or will be, in this folder: `make docs` builds them."""
    page, _, anchor = address.partition("#")
    path = SITE / "pages" / f"{page}.html"
    unbuilt = "" if path.exists() else " (make docs builds it)"
    return path.as_uri() + ("#" + anchor if anchor else "") + unbuilt


def main(arguments):
    text = " ".join(arguments).strip()
    if not text and not sys.stdin.isatty():
        text = sys.stdin.buffer.read().decode(errors="replace")
    if not text.strip():
        usage = 'error: expected make why TEXT="...", or a text that is piped into it'
        print(usage, file=sys.stderr)
        return 2
    found = Index(entries()).nearest(text)
    print(answer(found))
    return 0 if found else 1


if __name__ == "__main__":
    os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
    sys.exit(main(sys.argv[1:]))
