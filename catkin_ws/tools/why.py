#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Say what an error text means, why it is printed, and how to fix it.

Usage: why.py [TEXT]; without a text it reads what is pasted or piped into it, such as a whole log.

An entry stands in a file of mrp/doc/why/, below its name in brackets, or in the head of a patch
in mrp_check/defects/. Its fields:

    Shows: [rospack] Error: ...    a text as it is printed; lines that belong together stand below
    Also: rospack: ...             the same in another version; nothing here prints it
    Why: The terminal ...          the cause, in one or two sentences
    Fix: Source ...                what to do, in one or two sentences
    Page: wrong#there-is-no-master where the pages say more
    Above: yes                     the cause stands above: such an entry comes last
    General: yes                   right for any name, where other entries need a certain one
    Try: rostopic list             the commands that make ROS print it
    Needs: master                  what they need: see tests/test_why.py, or docker/test/test_why.py

There may be several fields Shows and Also. A line of Shows that begins with "12| " or "13| " is
that of one Debian release. tests/test_why.py runs Try, and holds Shows against what is printed.
"""

import codecs
import collections
import dataclasses
import itertools
import math
import os
import pathlib
import re
import sys

WORKSPACE = pathlib.Path(__file__).resolve().parents[1]
SITE = WORKSPACE / "build" / "docs"
sys.path.insert(0, str(WORKSPACE / "src" / "mrp_check" / "src"))

from mrp_check.contract import defects  # noqa: E402

FOLDER = WORKSPACE / "src" / "mrp" / "doc" / "why"
ANSWERS = 3
REQUIRED, SEVERAL = ("Shows", "Why", "Fix", "Try"), ("Shows", "Also")
FIELDS = (*REQUIRED, "Also", "Page", "Above", "General", "Needs")

# What differs from one run to the next, and from one machine to another. A colour code may have
# lost its first character on its way through a browser.
_COLOURS = re.compile(
    r"(?:\x1b|\^\[|\\x1b|\\033|\\u001b|\\e|\uFFFD)\[[0-9;]*[mK]|\[\d[0-9;]*m|\x1b\][^\x07]*\x07"
)
_MASKS = (
    (_COLOURS, ""),
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
# What ROS 2 alone prints: only an entry with such a word can be right. The names of its packages,
# such as ament_cmake, stand in what ROS 1 prints, too.
_ROS2 = re.compile(
    r"(?<![\w/-])ros2(?![\w/.-])|rosbag2|\brcl(?:cpp|py)?\b|\brmw_\w+|\bcolcon\b|\[rviz2"
    r"|/opt/ros/(?:foxy|galactic|humble|iron|jazzy)\b"
    r"|(?<![\w/])[a-z]\w*/(?:msg|srv|action)/[A-Z]\w*\b(?!\.)"
)
_OF_ROS2 = "rosii"  # the word that stands for it
_WORD = re.compile(r"[^\W\d_]+|\d+")
# A name in quotes or brackets is somebody's own: that of a package, a topic, a parameter.
_NAME = re.compile(
    r"""'[^'\s]+'|"[^"\s]+"|\[[^][\s]+\]|'(?:[\w:]+ )?~?\w+(?:::|[(<])[^'\n]*'"""
    r"|\b[A-Z]+(?:_[A-Z]+){2,}\b|\b(?:ros|python3?|lib\w+)-[\w.-]+"
)
_NO_MODULE = re.compile(r"No module named ([\w.]+)")  # Python 2 has no quotes
# Names that the entries take for examples: no text needs them.
_EXAMPLES = re.compile(
    r"\b(?:a|b|you|user|home|catkin_ws|my_package|beginner_tutorials|talker|listener|chatter"
    r"|great_topic|add_two_ints|move_base|robot|src|other)\b"
)
# A name of a program's own in the middle of a sentence: unknown words in it say nothing.
_IDENTIFIER = re.compile(r"[\w.:~-]*(?:[a-z\d][_:/.~][\w:/.~-]+|[a-z][A-Z]\w*)")
# The class of an exception, or the program, at the beginning of a line.
_EXCEPTION = re.compile(
    r"^\s*(?:\w+: )?(?:[a-z_][\w.]*\.)?([A-Z]\w*(?:Error|Exception|Warning|Interrupt|Fault))"
    r"(?:: |:?$)",
    re.MULTILINE,
)
_PROGRAM = re.compile(r"\s*([A-Za-z]{3,})(?:: | ERR!)")
_FAMILIES = {
    "ModuleNotFoundError": "ImportError",
    "IOError": "OSError",
    "FileNotFoundError": "OSError",
    "PermissionError": "OSError",
    "ConnectionRefusedError": "OSError",
    "ConnectionResetError": "OSError",
    "TimeoutError": "OSError",
    "IndentationError": "SyntaxError",
    "TabError": "SyntaxError",
    "RLException": "XmlParseException",
    "UnboundLocalError": "NameError",
}
_COMMON = set(
    "a an and are as at be been but by can do does error exist failed fatal for from has have i if"
    " in is it my no not of on or such that the this to was when while will with you".split()
)
# How much of an entry's words a text must have, or how much of the text's words the entry must
# explain; and the weight of the words that both have.
_OF_ENTRY, _OF_TEXT, _BOTH, _WEIGHT = 0.55, 0.6, 1.1, 11.0
# Answers with less than this part of the first one's score are left out.
_FAR = 0.45
_LEAST = 7.0  # even if a text has all words of an entry
_RARE, _CANDIDATES = 80, 60  # texts of entries
_STRANGE = 3.0  # the weight of a word that no entry has
_WIDE = 300  # characters of a line that is quoted
_HITS = 300  # lines of each kind of error in a very long text
_TOGETHER = 3  # lines: long messages are broken into that many
_MANY = 500  # lines: of a longer text, only those around an error are searched
_LONG = 2000  # characters: a line is cut there
_LARGE = 1 << 20  # bytes that are read from the end of a longer file
_PROBLEM = re.compile(
    "error|exception|fail|fatal|warn|cannot|can't|could ?n[o']t|unable|not found|no such|invalid"
    "|undefined|died|denied|refused|missing|not been|no module|abort|core dumped",
    re.IGNORECASE,
)
# What an error itself begins with, rather than what is said about it.
_ERROR = re.compile(r"(?i:error|exception): |\[(?:ERROR|FATAL)\]|^E: ")
# Lines around any error, which say nothing of it.
_EVERYWHERE = re.compile(
    r'\s*(?:Traceback \(most recent call last\):|File "[^"]*", line \d+, in \S+'
    r"|During handling of the above exception, another exception occurred:"
    r"|The traceback for the exception was written to the log file"
    r"|\.\.\. logging to .*|Checking log directory .*|Press Ctrl-C to interrupt"
    r"|Done checking log file .*|started roslaunch server .*|ROS_MASTER_URI=.*"
    r"|auto-starting new master|setting /run_id .*|started core service .*"
    r"|process\[.*\]: started with pid .*"
    r"|all processes on machine have died.*|(?:\.\.\. )?shutting down processing monitor.*"
    r"|-- (?:Using|Found) .*|\[ *\d+%\] .*)\s*"
)
# The last lines of roslaunch, make and catkin: the cause stands above them. A negative exit code,
# or one of a shell (128 and the signal), does say something.
_ENDING = re.compile(
    r".*process has died \[pid \d+, exit code (?!-|13[2-9])\d+\b.*|log file: .*"
    r"|=*(?:REQUIRED )?process \[.*\] has died!|Initiating shutdown!"
    r"|.*make(?:\[\d+\])?: \*\*\* .*(?:Error \d+|Waiting for unfinished jobs.*)"
    r"|.*recipe for target .* failed|compilation terminated\.?"
    r"|.*collect2: error: ld returned \d+ exit status|-- Configuring incomplete, errors occurred!"
    r'|Invoking "(?:make|cmake)\b.*" failed'
)
# What begins a warning; lines below it that are indented belong to it. That the standard of C++ is
# too old is a cause, though g++ only warns.
_WARNING = re.compile(r"\b(?:warning:(?!.* only available with )|\w*Warning\b|WARN(?:ING)?\b)")
# A line of code in a traceback, below the line that names its file: the error stands further below,
# unless the text was cut off there.
_CODE = re.compile(r'^([ \t]*)File "[^"\n]*", line \d+.*\n\1[ \t]+\S.*$', re.MULTILINE)
# The last place of a traceback is in a file of ROS: what was given to it is wrong, not its code.
_IN_ROS = re.compile(
    r'File "[^"\n]*/(?:dist|site)-packages/((?:ros\w+|genpy|genmsg|tf2?\w*|actionlib|\w+_msgs)/'
    r'[^"\n]*)", line \d+[^\n]*\n(?:(?![ \t]*File ")[^\n]*\n?)*\Z'
)
_OF_PYTHON = {"IndexError", "KeyError", "TypeError", "ValueError", "AttributeError"}
# What lines with an error have, the surest first.
_SIGNS = ("error: ", "exception: ", "[error]", "[fatal]", "error", "fatal", "died", "not found")


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
    general: str = ""
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


@dataclasses.dataclass(frozen=True)
class Answer:
    """An entry that is near to a text, and the lines of the text that it is about. doubtful: it has
    little in common with them."""

    entry: Entry
    lines: tuple
    score: float
    doubtful: bool


@dataclasses.dataclass(frozen=True, eq=False)
class _Text:
    """The words of one text of an entry. names: those in quotes or brackets. free: the words
    outside of names and identifiers. ends: only the last lines of roslaunch or make."""

    entry: int
    words: frozenset
    free: frozenset
    names: frozenset
    speakers: frozenset
    ends: bool


@dataclasses.dataclass(frozen=True)
class _Passage:
    """The words of up to three lines of what is asked."""

    lines: tuple
    words: frozenset
    free: frozenset
    names: frozenset
    speakers: frozenset
    ends: bool
    warns: bool


class Index:
    """All entries, to be searched by the words of a text.

    A word counts the more the fewer entries have it, and two words side by side count as one more.
    Names count only where an entry is about that very name, such as rospy.
    """

    def __init__(self, found):
        self._entries = found
        texts = [
            (number, "\n".join(shown_on(text)))
            for number, one in enumerate(found)
            for text in (*one.shows, *one.also)
        ]
        self._texts = [_Text(number, *_parts(text)) for number, text in texts]
        entries_of, self._having = collections.defaultdict(set), collections.defaultdict(list)
        for text in self._texts:
            for word in text.words | text.names:
                entries_of[word].add(text.entry)
            for word in text.words:
                self._having[word].append(text)
        self._weight = {
            word: math.log(1 + len(found) / len(having)) * (0.6 if " " in word else 1)
            for word, having in entries_of.items()
        }
        # A text that says what a general entry says, and names somebody: it needs this name.
        general = {text.words for text in self._texts if found[text.entry].general}
        self._special = {
            text
            for text in self._texts
            if text.names and not found[text.entry].general
            if any(words <= text.words for words in general)
        }
        self._sums = {text: self._sum(text.words) for text in self._texts}

    def nearest(self, text, count=ANSWERS):
        """Return the answers to a text, the nearest one first. Entries that only say that the cause
        stands above come last."""
        text = "\n".join(line[:_LONG] for line in _COLOURS.sub("", text).splitlines())
        for words, others in _ENGLISH.items():
            text = re.sub(others, f" {words} ", text)
        without_code = _CODE.sub("", text)
        found = []
        for part in dict.fromkeys((_without_ending(without_code), without_code, text)):
            found = found or self._answers(part)
        last = [one for one in found if one.entry.above][:1]
        causes = [one for one in found if not one.entry.above and not _is_better(last, one)]
        causes = [one for one in causes if one.score >= _FAR * causes[0].score]
        return [*causes, *last][:count]

    def _answers(self, text):
        """Return all answers to a text, the best one first: errors before warnings. Of several
        texts of an entry, the best one counts; if only names differ between entries, the most
        general one does, which has the most texts."""
        best = {}
        for passage in _passages(text):
            for number, (score, doubtful, count) in self._scores(passage).items():
                rank = (not passage.warns, score, count)
                if rank > best.get(number, ((False, 0.0, 0),))[0]:
                    best[number] = (rank, passage.lines, doubtful)
        ranked = sorted(best.items(), key=lambda item: item[1][0], reverse=True)
        return [
            Answer(self._entries[number], lines, rank[1], doubtful)
            for number, (rank, lines, doubtful) in ranked
        ]

    def _scores(self, passage):
        """Return, for each entry that is near to a passage, its score, whether it is doubtful, and
        how many of its texts have this score."""
        all_words = self._of_passage(passage)
        best = {}
        for text in self._candidates(passage.words):
            shared = self._sum(passage.words & text.words)
            if text.speakers and passage.speakers and not text.speakers & passage.speakers:
                continue
            score, doubtful = self._score(passage, text, shared, all_words)
            if score:
                highest, _, count = best.get(text.entry, (0.0, False, 0))
                if score >= highest:
                    best[text.entry] = (score, doubtful, count + 1 if score == highest else 1)
        return best

    def _candidates(self, words):
        """Return the texts that share the rarest words: all of them would take too long."""
        having = sorted((self._having[word] for word in words if word in self._having), key=len)
        rare = [texts for texts in having if len(texts) <= _RARE] or having[:2]
        shared = collections.Counter(itertools.chain.from_iterable(rare))
        return [text for text, _ in shared.most_common(_CANDIDATES)]

    def _score(self, passage, text, shared, all_words):
        """Return how near a text of an entry is to a passage (0: not at all), and whether that is
        doubtful."""
        of_entry = shared / self._sums[text]
        of_text = shared / all_words
        words = (passage.words & text.words) - _COMMON
        if _OF_ROS2 in passage.words and _OF_ROS2 not in text.words:
            return 0, False
        same = passage.names & text.names
        if passage.ends != text.ends or (text in self._special and not same):
            return 0, False
        if passage.ends and shared < _LEAST / 2:
            return 0, False
        if not passage.ends and (of_entry < 0.99 or of_text < 0.7):
            if sum(" " not in word for word in words) < 2:
                return 0, False
            if max(of_entry / _OF_ENTRY, of_text / _OF_TEXT) < 1 or of_entry + of_text < _BOTH:
                return 0, False
            if shared < _WEIGHT and (of_entry < 0.95 or shared < _LEAST):
                return 0, False
        score = shared * (0.3 + 0.7 * of_entry) * (0.3 + 0.7 * of_text)
        score += sum(self._weight[word] for word in same)
        if text in self._special:
            score *= 0.7 + 0.3 * len(same) / len(text.names)
        if _OF_ROS2 in text.words and _OF_ROS2 not in passage.words:
            score *= 0.6
        return round(score, 6), min(of_entry, of_text) < 0.3 or of_text + of_entry < 0.9

    def _sum(self, words):
        return sum(self._weight.get(word, 0) for word in words) or 1.0

    def _of_passage(self, passage):
        """Return the weight of all words of a passage. A word that no entry has counts as a rare
        one."""
        strange = sum(
            word not in self._weight and word.isascii() and len(word) > 2 for word in passage.free
        )
        speaker = _PROGRAM.match(passage.lines[0])
        if speaker and speaker[1].lower() not in self._weight:
            strange += 2
        return self._sum(passage.words) + _STRANGE * strange


def _parts(text):
    """Return the words of a text outside of names, with pairs of words, the words of the names, and
    who speaks."""
    speakers = frozenset(_FAMILIES.get(name, name) for name in _EXCEPTION.findall(text))
    masked = _EXAMPLES.sub("", _readable(text))
    parts = _NAME.split(masked)
    names = {name.strip("'\"[]").lower() for name in _NAME.findall(masked)} - {""}
    names |= {name.partition(".")[0] for name in names}
    words = set()
    for part in parts:
        found = _WORD.findall(part.lower())
        words.update(found)
        words.update(f"{one} {two}" for one, two in itertools.pairwise(found))
    if _OF_ROS2 in masked:
        words.add(_OF_ROS2)
    free = _WORD.findall(" ".join(_IDENTIFIER.sub(" ", part) for part in parts).lower())
    ends = all(_ENDING.fullmatch(line.strip()) for line in text.splitlines())
    return frozenset(words), frozenset(free), frozenset(names), speakers, ends


def _readable(text):
    text = _NO_MODULE.sub(r"No module named '\1'", text)
    text = _ROS2.sub(f" {_OF_ROS2} ", text)
    return mask(_FOLDERS.sub(lambda match: " optros " if match[1] else " ", text))


def _passages(text):
    """Yield each line of a text, and lines that follow each other."""
    lines, warns = [], False
    for line in _near_errors(text.splitlines()):
        warns = bool(_WARNING.search(line)) or (warns and line.startswith(" "))
        if line.strip() and not _EVERYWHERE.fullmatch(line):
            lines.append((line.strip(), warns))
    if not lines:  # roslaunch stands still, and printed nothing else
        lines = [(line.strip(), False) for line in text.splitlines() if "disk usage" in line]
    seen = set()
    for length in range(1, _TOGETHER + 1):
        for begin in range(max(len(lines) - length, 0) + 1):
            together = lines[begin : begin + length]
            passage = "\n".join(line for line, _ in together)
            key = mask(passage)
            if key and key not in seen:
                seen.add(key)
                warning = any(warns for _, warns in together)
                yield _Passage(tuple(line for line, _ in together), *_parts(passage), warning)


def _is_better(others, answer):
    """Say whether one of the others explains the same line of the text much better."""
    return any(
        one.score > 1.2 * answer.score and set(one.lines) & set(answer.lines) for one in others
    )


def _near_errors(lines):
    """Return the lines of a text; of a very long one, those with an error and those around them."""
    if len(lines) <= _MANY:
        return lines
    near = [at for at, line in enumerate(lines) if _PROBLEM.search(line)]
    near.sort(key=lambda at: not _ERROR.search(lines[at]))
    seen, kept = set(), set()
    for at in near:
        key = mask(lines[at])
        if key not in seen and len(kept) < _MANY:
            seen.add(key)
            kept.update(range(max(at - 2, 0), min(at + 3, len(lines))))
    return [lines[at] for at in sorted(kept)]


def _without_ending(text):
    """Return a text without the last lines of roslaunch, make and catkin."""
    return "\n".join(line for line in text.splitlines() if not _ENDING.fullmatch(line.strip()))


def answer(found, text=""):
    """Return what is said to the user about the answers to a text."""
    if not found:
        return (
            "No text I know is close to this one. Look for the first line that says 'error', and "
            "try that line on its own.\nAll the texts I know: " + _link("why")
        )
    parts, before = [], ()
    for number, one in enumerate(found, 1):
        shown = ["Or, for the same lines:"] if one.lines == before else one.lines
        parts.append(_one_answer(number, one, shown, text))
        before = one.lines
    return "\n\n".join(parts)


def _one_answer(number, one, shown, text):
    shown = [line if len(line) <= _WIDE else line[:_WIDE] + " ..." for line in shown]
    lines = [f"{number}. {shown[0]}", *("   " + line for line in shown[1:])]
    if one.doubtful:
        lines.append(f"   I'm not sure, but it looks like: {shown_on(one.entry.shows[0])[0]}")
    lines += [f"   why:  {one.entry.why}", f"   fix:  {one.entry.fix}"]
    inside = _IN_ROS.search(text[: text.find(one.lines[0])])
    if inside and _OF_PYTHON & set(_EXCEPTION.findall("\n".join(one.lines))):
        lines.append(f"   note: It happened in ROS's own {inside[1]}: look at what you gave to it.")
    return "\n".join([*lines, f"   page: {_link(one.entry.address)}"])


def _link(address):
    """Return where the pages are, or will be, in this folder: `make docs` builds them."""
    page, _, anchor = address.partition("#")
    path = SITE / "pages" / f"{page}.html"
    unbuilt = "" if path.exists() else " (make docs builds it)"
    return path.as_uri() + ("#" + anchor if anchor else "") + unbuilt


def decoded(data):
    """Return the text of what was piped in. PowerShell's `>` writes UTF-16. Of a very long text,
    return the end and the lines before it that have an error."""
    marks = {
        codecs.BOM_UTF16_LE: "utf-16",
        codecs.BOM_UTF16_BE: "utf-16",
        codecs.BOM_UTF8: "utf-8-sig",
    }
    encoding = next((marks[mark] for mark in marks if data.startswith(mark)), "utf-8")
    text = data.decode(encoding, errors="replace")
    if len(text) <= _LARGE:
        return text
    begin, end = text[:-_LARGE], text[-_LARGE:]
    lower, kept = begin.lower(), {}
    for word in _SIGNS:
        at = lower.find(word)
        for _ in range(_HITS):
            if at < 0:
                break
            first, last = begin.rfind("\n", 0, at) + 1, begin.find("\n", at)
            last = last if last >= 0 else len(begin)
            line = begin[first : min(last, first + _LONG)]
            kept.setdefault(re.sub(r"\d+", "#", line), (first, line))
            at = lower.find(word, last)
    return "\n".join([*(line for _, line in sorted(kept.values())), end])


def _read():
    if sys.stdin.isatty():
        print("Paste the error text, then press Enter and Ctrl-D:", file=sys.stderr)
    return decoded(sys.stdin.buffer.read())


def main(arguments):
    text = " ".join(arguments).strip() or _read()
    if not text.strip():
        print("error: expected an error text, found nothing", file=sys.stderr)
        return 2
    found = Index(entries()).nearest(text)
    print(answer(found, text), flush=True)
    return 0 if found else 1


if __name__ == "__main__":
    os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:  # such as: make why | head -3
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
