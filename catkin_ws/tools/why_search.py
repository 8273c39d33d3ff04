# SPDX-License-Identifier: BSD-3-Clause
"""Find the entries of `make why` that are nearest to a text, by the words they share.

A word counts the more the fewer entries have it, and two words side by side count as one more word.
Names, paths and numbers are the reader's own: only an entry about a certain name, such as rospy,
asks for it.
"""

import collections
import dataclasses
import itertools
import math
import re

from why_entries import shown_on

ANSWERS = 3

# A colour code may have lost its first character on its way through a browser.
COLOURS = re.compile(
    r"(?:\x1b|\^\[|\\x1b|\\033|\\u001b|\\e|\uFFFD)\[[0-9;]*[mK]|\[\d[0-9;]*m"
    r"|\x1b\][^\x07\n]{0,120}\x07"
)
# What differs from one run to the next, and from one machine to another. An exit code stays: it
# says what happened.
_MASKS = (
    (COLOURS, ""),
    (re.compile("[‘’`´]"), "'"),
    (re.compile("[“”]"), '"'),
    (re.compile(r"\bCMake [\w ]{1,30}(?: \(dev\))? at \S+:\d+ \(\w+\):"), ""),
    (re.compile(r"(?<!\S)\S+\.(?:cpp|cc|cxx|c|hpp|hh|h):\d+(?::\d+)?:"), ""),
    (re.compile(r" ?\{aka [^}]*\}|\b_Z\w+"), ""),
    (re.compile(r"(?<![\w.])~?/[^\s:;,'\"()\[\]<>]+"), "/#"),
    (re.compile(r"\b(?:0x[0-9a-f]+|[0-9a-f]{32,})\b"), "#"),
    (re.compile(r"(?<!exit code )(?<!exit code -)(?<!\d)(?:(?<=\s)-)?\d+(?:\.\d+)*"), "#"),
)
# What the system, the shell and g++ say in other languages: Chinese, Japanese, German, Spanish,
# French and Portuguese. Longer texts come first.
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
# Only the last part of a path counts, and whether the path is one of ROS's own.
_FOLDERS = re.compile(r"(?<![\w.])~?(/opt/ros/\w+)?/(?:[^\s/:;,'\"()\[\]<>]+/)*")
# What a text of ROS 2 has: advice for ROS 1 would send its reader astray. The names of packages,
# such as ament_cmake, turn up in what ROS 1 prints.
_ROS2 = re.compile(
    r"(?<![\w/@-])ros2(?![\w/.-])|\brosbag2(?:_[a-z]\w*)?\b(?!\.)"
    r"|\brcl(?:cpp|py)?\b|\brmw_\w+|\bcolcon\b|\blaunch_ros\b|\] \[launch\]: |\[rviz2"
    r"|/opt/ros/(?:foxy|galactic|humble|iron|jazzy)\b"
    r"|(?<![\w/])[a-z]\w*/(?:msg|srv|action)/[A-Z]\w*\b(?!\.)"
)
_OF_ROS2 = "rosii"  # the word that stands for it
_ROS2_ENTRY = "package-of-ros2"  # the answer to it, if none is nearer
# Other languages and programs, and what shows that a text is about ROS all the same.
_OTHERS = re.compile(
    r"\.(?:[cm]?js|jsx|tsx?|java|kt|rs|rb|php|cs|swift|c):[\d(]|\.go:\d+:\d"
    r"|\bat \S+ \(\S+:\d|^ +at [\w.]+\(|^goroutine |^panic: |^configure: |\bgit@"
    r"|\bgithub\.com|nodesource|docker-ce|/lib/modules/|\bfixture '"
    r"|\b(?:npm|yarn|node_modules|webpack|java|gradle|maven|cargo|rustc|PHP|CUDA|pytest)\b"
    r"|\b(?:ENOENT|EACCES|EPERM|EADDRINUSE)\b"
    r"|\b(?:nvidia-(?!container|docker)|cuda-)\w|\blibcu\w+\.so"
    r"|\[(?:Err|Wrn)\] \[\w+\.cc\b|\b(?:lib)?(?:ign(?:ition)?|gz)-\w|^fatal: \["
    r"|\b(?:django|flask|pandas|tensorflow|jinja2|sqlalchemy|selenium|requests\.exceptions)\."
    r"|(?:dist|site)-packages/(?!numpy|cv2|yaml|serial|setuptools|pkg_resources|matplotlib|tf|gen)"
    r"|\b(?:systemd(?:-\w+)?\[|systemctl|journalctl|kubelet|kubectl|ansible|terraform)"
    r"|(?<![\w/.-])(?i:psql|postgres\w*|psycopg\w*|mysql|mongodb?|redis|amqp|nginx|apache2?)(?![\w/])"
    r"|\b[A-Z]:\\\w|[A-Z]:/(?:Program|Users|Windows)|^fatal: Could not "
    r"|\berror: (?:linker|linking with|could not compile) `|\*\*\* \[makefile:",  # not CMake's
    re.MULTILINE,
)
_ROS = re.compile(
    r"\bros(?:_|\b|bag|bash|build|cd|clean|comm|console|core|cpp|dep|distro|graph|install|launch"
    r"|lib|make|master|msg|node|out|pack|param|pkg|py|run|serial|service|srv|test|topic|version)"
    r"|(?:[a-z]_|lib)ros|catkin|\.launch\b|package\.xml|_msgs\b|\bxacro|\bgazebo|\brviz|actionlib"
    r"|nodelet|pluginlib|/devel/|\brqt_|genmsg|genpy|cv_bridge|image_transport|move_?base|moveit"
    r"|\btf2?(?:_ros|_geometry|_sensor|::|\.\w+Exception|\.transform)|\bbag\b|beginner_tutorials"
    r"|generate_distutils|RLException|__name:=|process has died|\.(?:msg|srv|action)\b|11311"
    r"|turtle|robot_|base_link|\b(?:kinetic|melodic|noetic)",
    re.IGNORECASE,
)
_WORD = re.compile(r"[^\W\d_]+|\d+")
# A name in quotes or brackets is somebody's own: that of a package, a topic, a parameter. So is a
# command that isn't found.
_NAME = re.compile(
    r"""'[^'\s]+'|"[^"\s]+"|\[[^][\s]+\]|'(?:[\w:]+ )?~?\w+(?:::|[(<])[^'\n]*'"""
    r"|\b[A-Z]+(?:_[A-Z]+){2,}\b|\b(?:ros|python3?|lib\w+)-[\w.-]+"
    r"|(?<![^\s:])[^\s:]+(?=: command not found)|(?<=: #: )[^\s:]+(?=: not found)"
    r"|(?<=command not found: )\S+"
)
_CMAKE_RULE = re.compile(r"'[^'\s]*CMakeFiles/[^'\s]+\.dir/build'")  # no name of the reader's
# Python 2 has other errors, and no quotes. The module of generated code isn't only a name.
_NO_MODULE = re.compile(r"(?:\w+Error: )?No module named '?([\w.]+?)(\.msg|\.srv)?(?![\w.])'?")
_OS_ERROR = re.compile(r"\b(?:[A-Z]\w*Error|socket\.error): (?=\[Errno)")
_KIND = re.compile("'(module|NoneType)' object")  # no name, though in quotes
# How much of an entry's words a text must have, or how much of the text's words the entry must
# explain; and the least sum of the two.
_OF_ENTRY, _OF_TEXT, _BOTH = 0.55, 0.6, 1.1
_LEAST = 11  # the weight of the words that both have
_NEAR = 0.9  # of the score of a better answer to the same lines
_FAR = 0.45  # of the score of the first answer, to other lines
_RARE, _CANDIDATES = 80, 60  # texts of entries
_TOGETHER = 2  # lines: messages are broken into that many
_LONG = 2000  # characters: a line is cut there
_MANY = 500  # lines: of a longer text, only those around an error are searched, and as many errors
_NO_DIGITS = dict.fromkeys(map(ord, "0123456789"))
_PROBLEM = re.compile(r"[Ee]rror|ERROR|xception|[Ff]ail|atal|FATAL|arning|WARN|not |died")
# Why the system refuses something, or which signal ended a program. A text and an entry that give
# different reasons aren't near, and a reason that both have doesn't make them so.
_REASON = re.compile(
    r"permission denied|no such file or directory|operation not permitted|connection refused"
    r"|address already in use|no space left|exec format error|executable file not found"
    r"|exit code -\d+"
)
# The last lines of roslaunch, make and catkin: the cause is above them. A negative exit code, or
# one of a shell (128 and the signal), does say something.
_ENDING = re.compile(
    r".*process has died(?: \[pid \d+, exit code (?!-|13[2-9])\d+\b.*)?|log files?: .*"
    r"|.*process has finished cleanly"
    r"|=*(?:REQUIRED )?process \[.*\] has died!|(?i:initiating shutdown)!?|=+"
    r"|=*REQUIRED process \[.*\] .*initiating shutdown!?"
    r"|.*make(?:\[\d+\])?: \*\*\* .*(?:Error \d+|Waiting for unfinished jobs.*)"
    r"|.*recipe for target .* failed|compilation terminated\.?"
    r"|.*collect2: error: ld returned \d+ exit status|-- Configuring incomplete, errors occurred!"
    r'|Invoking "(?:make|cmake)\b.*" failed'
)
# Lines around any error, which say nothing of it.
_EVERYWHERE = re.compile(
    r"Traceback \(most recent call last\):|\.\.\. logging to .*|Checking log directory .*"
    r"|Press Ctrl-C to interrupt|Done checking log file .*|The traceback for the exception .*"
    r"|auto-starting new master|started (?:roslaunch server|core service) .*|ROS_MASTER_URI=.*"
    r"|process\[.*\]: started with pid .*|\[\S+\] killing on exit|done"
    r"|all processes on machine have died, roslaunch will exit"
    r"|(?:\.\.\. )?shutting down processing monitor(?:\.\.\.| complete)"
    r"|[\w-]+@[\w.-]+:\S*[$#] .*|-- (?:\+\+\+|==>|Using \w+:) .*|\S+:\d+ \(\w+\)"
    r"|.*: [Ii]n (?:\w+ )*(?:function|constructor) .*:"
)
# What begins a warning; empty and indented lines below belong to it. That the standard of C++ is
# too old is a cause, though g++ only warns.
_WARNING = re.compile(
    r"\b(?:warning:(?!.* only available with )|\w*Warning\b|WARN(?:ING)?\b|It's recommended"
    r"|nosetests not found)"
)


def mask(text):
    """Return a text without what differs from run to run: paths, numbers, colours."""
    for pattern, stand_in in _MASKS:
        text = pattern.sub(stand_in, text)
    return " ".join(text.split())


@dataclasses.dataclass(frozen=True)
class Answer:
    """An entry that is near to a text, the lines it explains, and how near it is. doubtful: the two
    have little in common. warns: the lines are only a warning. below: the line after a colon."""

    entry: object
    lines: tuple
    score: float
    doubtful: bool
    warns: bool = False
    below: str = ""


@dataclasses.dataclass(frozen=True, eq=False)
class _Text:
    """One text of an entry, or some lines of what the reader asks about. words: outside of names.
    reasons: of the system. ends: only the last lines of roslaunch or make."""

    words: frozenset
    names: frozenset
    reasons: frozenset
    ends: bool
    entry: object = None
    lines: tuple = ()
    warns: bool = False
    below: str = ""


class Index:
    """All entries, to be searched by the words of a text."""

    def __init__(self, entries):
        self._texts = [
            _text("\n".join(shown_on(text)), entry=entry)
            for entry in entries
            for text in (*entry.shows, *entry.also)
        ]
        entries_of, self._having = collections.defaultdict(set), collections.defaultdict(list)
        for text in self._texts:
            for word in text.words | text.names:
                entries_of[word].add(text.entry.name)
            for word in text.words:
                self._having[word].append(text)
        self._weight = {
            word: math.log(1 + len(entries) / len(having)) * (0.6 if " " in word else 1)
            for word, having in entries_of.items()
        }
        # A text that says what a general entry says, and names somebody, such as a package of
        # ROS 2: it needs this name, or what else it says.
        general = [text for text in self._texts if text.entry.general]
        self._special = {}
        for text in self._texts:
            within = [other for other in general if other.words <= text.words]
            if text.names and not text.entry.general and (within or text.entry.name == _ROS2_ENTRY):
                names = text.names.difference(*(other.names for other in within))
                words = text.words.difference(*(other.words for other in within))
                self._special[text] = names, words if within else frozenset()
        self._sums = {text: self._sum(text.words) for text in self._texts}
        of_ros2 = [text.entry for text in self._texts if _OF_ROS2 in text.words]
        self._of_ros2 = {entry.name: entry for entry in of_ros2}

    def nearest(self, text, count=ANSWERS):
        """Return the answers to a text, the nearest one first. Entries that only say that the cause
        is above come last."""
        text = COLOURS.sub("", "\n".join(_near_problems(text)))
        ros2 = next((line.strip() for line in text.splitlines() if _ROS2.search(line)), None)
        if ros2:
            found = [a for a in self._answers(text.splitlines()) if a.entry.name in self._of_ros2]
            return found[:1] or [Answer(self._of_ros2[_ROS2_ENTRY], (ros2,), 0.0, False)]
        shows_ros = _ROS.search(text)
        if _OTHERS.search(text) and not shows_ros:
            return []
        for words, others in _ENGLISH.items():
            text = re.sub(others, f" {words} ", text)
        lines = text.splitlines()
        found = self._answers(line for line in lines if not _ENDING.fullmatch(line.strip()))
        found = found or self._answers(lines)
        found = [answer for answer in found if shows_ros or not answer.entry.ros]
        found = [a for a in found if not any(_outdoes(better, a) for better in found)]
        causes = [answer for answer in found if not answer.entry.above]
        causes = [answer for answer in causes if answer.score >= _FAR * causes[0].score]
        of_errors = [answer for answer in causes if not answer.warns]
        last = [a for a in found if a.entry.above == "yes" or (a.entry.above and not of_errors)][:1]
        return [*causes[: count - len(last)], *last]

    def _answers(self, lines):
        """Return all answers, the best one first, and those to warnings last."""
        best = {}
        for passage in _passages(lines):
            for answer in self._scored(passage):
                rank = (not passage.warns, answer.score)
                if rank > best.get(answer.entry.name, ((False, 0.0), None))[0]:
                    best[answer.entry.name] = rank, answer
        return [
            answer for _, answer in sorted(best.values(), key=lambda item: item[0], reverse=True)
        ]

    def _scored(self, passage):
        """Yield an answer for each text that is near to a passage."""
        all_words = self._sum(passage.words)
        reason = _words(" ".join(passage.reasons))
        for text in self._candidates(passage.words):
            shared = self._sum(passage.words & text.words)
            of_entry, of_text = shared / self._sums[text], shared / all_words
            same = passage.names & text.names
            if _OF_ROS2 in text.words - passage.words:
                continue
            if text in self._special:
                own_names, own_words = self._special[text]
                if same.isdisjoint(own_names) and not frozenset() < own_words <= passage.words:
                    continue
            if passage.ends != text.ends:
                continue
            if passage.reasons and text.reasons and passage.reasons.isdisjoint(text.reasons):
                continue
            if (passage.words & text.words) <= reason < passage.words:
                continue
            if (of_entry < 0.99 or of_text < 0.7) and not passage.ends:
                if max(of_entry / _OF_ENTRY, of_text / _OF_TEXT) < 1 or shared < _LEAST:
                    continue
                if of_entry + of_text < _BOTH:
                    continue
            score = shared * (0.3 + 0.7 * of_entry) * (0.3 + 0.7 * of_text)
            score += sum(self._weight[word] for word in same)
            if text in self._special and own_names:
                score *= 0.7 + 0.3 * len(same & own_names) / len(own_names)
            doubtful = min(of_entry, of_text) < 0.3 or of_entry + of_text < 0.9
            yield Answer(text.entry, passage.lines, score, doubtful, passage.warns, passage.below)

    def _candidates(self, words):
        """Return the texts that share the rarest words: all of them would take too long."""
        having = sorted((self._having[word] for word in words if word in self._having), key=len)
        rare = [texts for texts in having if len(texts) <= _RARE] or having[:2]
        shared = collections.Counter(itertools.chain.from_iterable(rare))
        return [text for text, _ in shared.most_common(_CANDIDATES)]

    def _sum(self, words):
        return sum(self._weight.get(word, 0) for word in words) or 1.0


def _outdoes(better, answer):
    """Say whether an answer explains lines of another one much better, or the line below them."""
    if not {*better.lines}.isdisjoint(answer.lines):
        return answer.score < _NEAR * better.score
    return answer.below in better.lines and answer.score < better.score / 2


def _text(text, **more):
    """Return the words of a text, with pairs of words, and the words of its names."""
    readable = _NO_MODULE.sub(r"ModuleNotFoundError: No module named '\1' \2", text)
    readable = _OS_ERROR.sub("OSError: ", readable)
    readable = _KIND.sub(r"\1 object", readable)
    readable = _CMAKE_RULE.sub("CMakeFiles dir build", readable)
    readable = _ROS2.sub(f" {_OF_ROS2} ", readable)
    readable = mask(_FOLDERS.sub(lambda match: " optros " if match[1] else "", readable))
    names = {name.strip("'\"[]").lower() for name in _NAME.findall(readable)} - {""}
    names |= {name.partition(".")[0] for name in names}
    words = {_OF_ROS2} if _OF_ROS2 in readable else set()
    for part in _NAME.split(readable):
        words |= _words(part.lower())
    reasons = frozenset(_REASON.findall(text.lower()))
    ends = all(_ENDING.fullmatch(line.strip()) for line in text.splitlines())
    return _Text(frozenset(words), frozenset(names), reasons, ends, **more)


def _words(text):
    """Return the words of a text, and its pairs of words side by side."""
    found = _WORD.findall(text)
    return {*found, *(f"{first} {second}" for first, second in itertools.pairwise(found))}


def _near_problems(text):
    """Return the lines of a text, none of them long: the patterns would take minutes. Of a very
    long text, only those with an error and those around them."""
    lines = [line[:_LONG] for line in text.splitlines()]
    if len(lines) <= _MANY:
        return lines
    near = {}  # what differs only in its numbers is searched once
    for at, line in enumerate(lines):
        if _PROBLEM.search(line):
            near.setdefault(line.translate(_NO_DIGITS), lines[max(at - 2, 0) : at + 3])
    parts = [*near.values()] or [lines[-_MANY:]]
    ends = parts if len(parts) <= _MANY else parts[: _MANY // 2] + parts[-_MANY // 2 :]
    return [*itertools.chain.from_iterable(ends)]


def _passages(lines):
    """Yield each line of a text, and lines that follow each other."""
    kept, warns, lines = [], False, list(lines)
    for line in lines:
        warns = bool(_WARNING.search(line)) or (warns and line[:1].strip() == "")
        if line.strip() and not _EVERYWHERE.fullmatch(line.strip()):
            kept.append((line.strip(), warns))
    kept = kept or [(line.strip(), False) for line in lines[-1:]]
    seen = set()
    for length in range(1, _TOGETHER + 1):
        for begin in range(max(len(kept) - length, 0) + 1):
            together = kept[begin : begin + length]
            passage = "\n".join(line for line, _ in together)
            key = mask(passage)
            if key and key not in seen:
                seen.add(key)
                warning = any(warns for _, warns in together)
                shown = tuple(line for line, _ in together)
                after = kept[begin + length : begin + length + 1] if key.endswith(":") else []
                below = after[0][0] if after else ""
                yield _text(passage, lines=shown, warns=warning, below=below)
