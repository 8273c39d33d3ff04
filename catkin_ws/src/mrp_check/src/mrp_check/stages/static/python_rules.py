# SPDX-License-Identifier: BSD-3-Clause
"""What a Python source proves to be wrong. What is only likely is left to later stages."""

from __future__ import annotations

import ast
import difflib
import importlib
import importlib.util
import inspect
import re
import sys
import types

from pyflakes import checker, messages

from mrp_check.finding import NOTE, Finding
from mrp_check.stages import uses
from mrp_check.stages.static.python_facts import argument, last_line
from mrp_check.stages.static.python_source import UNKNOWN, Source

# Names of Python 2, which old code mentions where Python 3 does not come by.
_PYTHON2 = {"unicode", "xrange", "raw_input", "long", "basestring", "reduce", "unichr", "file"}


def read(package, file):
    """Return (the Source or None, the Finding that says why there is none, or None)."""
    data = package.bytes(file)
    try:
        if b"\0" not in data:
            data.decode("utf-8")
        return Source(file, package.text(file)), None
    except UnicodeDecodeError:
        try:
            return Source(file, data), None  # Python itself reads the coding line
        except (SyntaxError, ValueError, UnicodeDecodeError):
            return None, None  # the stage files has said it
    except SyntaxError as error:
        return None, _syntax(package, file, error)
    except (ValueError, RecursionError, MemoryError) as error:
        return None, Finding(
            "python-syntax",
            f"Python cannot read {file}: {error}.",
            file,
            1,
            expected="Python",
            seen=str(error),
        )


_SYNTAX = (
    (r"was never closed|unexpected EOF", "A bracket is opened there and never closed."),
    (r"unmatched|does not match opening", "A bracket is closed that is not open, or another one."),
    (r"expected ':'", "A colon is missing at the end of the line."),
    (r"unterminated|EOL while", "A text is begun with a quotation mark and not ended with one."),
    (r"expected an indented block", "The lines that belong to this one must be indented."),
    (r"unindent does not match|unexpected indent", "The line is not indented as those around it."),
    (r"inconsistent use of tabs", "Tabs and spaces are mixed: use four spaces for each level."),
    (r"Missing parentheses in call to 'print'", "In Python 3, print is a function: print(...)."),
    (r"Maybe you meant '=='|cannot assign to", "= gives a value, == compares."),
    (r"forgot a comma", "A comma is missing, or a bracket is not closed."),
    (
        r"invalid character|invalid non-printable",
        "A character stands there that is no part of Python:"
        " perhaps it was copied from a page or a document.",
    ),
)


def _syntax(package, file, error):
    text, line = error.msg or "invalid syntax", error.lineno or 1
    lines = package.lines(file)
    line = min(line, len(lines))
    shown = lines[line - 1].strip()
    hint = next((said for shape, said in _SYNTAX if re.search(shape, text)), "")
    if text == "invalid syntax":
        if shown.startswith("//"):
            hint = "A comment begins with # in Python, not with //."
        elif re.match(r"global\s+\w+\s*=", shown):
            hint = "'global NAME' and 'NAME = ...' are two statements, on two lines."
        elif re.match(r"(def|class|if|for|while|else|elif|try|with)\b", shown) and ":" not in shown:
            hint = "A colon is missing at the end of the line."
        elif line > 1 and _opens_bracket(lines[line - 2]):
            line, hint = line - 1, "A bracket is opened there and never closed."
    return Finding(
        "python-syntax",
        f"Python cannot read {file}: {text}, in line {line}. {hint}".strip(),
        file,
        line,
        expected="valid Python 3",
        seen=lines[line - 1].strip(),
        fix=f"Mend the line; `python3 -m py_compile {file}` says whether Python can read the file.",
    )


def _opens_bracket(text):
    text = re.sub(r"\"[^\"]*\"|'[^']*'|#.*", "", text)
    return sum(map(text.count, "([{")) > sum(map(text.count, ")]}"))


def findings(package, source):
    """Yield findings about one source."""
    rules = _Rules(package, source)
    imports = list(rules.imports())
    undefined = list(rules.undefined_names())
    for finding in undefined:
        # What was to be imported under its right name is not there under it, either.
        if difflib.get_close_matches(finding.expected, rules.not_imported, 1, 0.6):
            finding.consequence_of = "python-names"
    found = [*imports, *undefined]
    for rule in (
        rules.attributes,
        rules.own_attributes,
        rules.message_fields,
        rules.calls,
        rules.useless,
        rules.kept,
    ):
        found += rule()
    taken = {}
    for finding in found:
        # Of several findings about one line, the first is the cause.
        cause = taken.setdefault((finding.line, finding.severity), finding)
        if cause is not finding and finding.severity != NOTE:
            finding.consequence_of = cause.id
        yield finding


def _near(name, names, text="Perhaps {} is meant."):
    found = difflib.get_close_matches(name, list(names), 1, 0.6)
    return (found[0], " " + text.format(found[0])) if found else (None, "")


class _Rules:
    def __init__(self, package, source):
        self.package = package
        self.source = source
        self.file = source.file
        self.not_imported = []  # names whose import fails
        self.message_names = {path.rsplit("/", 1)[-1][:-4] for path in package.of_kind("message")}

    def finding(self, id_, message, node, **more):
        line = node if isinstance(node, int) else node.lineno
        more.setdefault("seen", self.package.lines(self.file)[line - 1].strip())
        return Finding(id_, message, self.file, line, **more)

    # Names

    def undefined_names(self):
        try:
            found = checker.Checker(self.source.tree, self.file).messages
        except RecursionError:
            return
        said = set()
        for message in sorted(found, key=lambda message: message.lineno):
            if not isinstance(message, (messages.UndefinedName, messages.UndefinedLocal)):
                continue
            name = message.message_args[0]
            if name in _PYTHON2 or name in said or self.source.has_star:
                continue
            said.add(name)
            yield self._undefined(name, message)

    def _undefined(self, name, message):
        names = {
            node.id
            for node in ast.walk(self.source.tree)
            if isinstance(node, ast.Name) and node.id != name
        }
        names |= set(self.source.imports) | {"print", "range", "str", "int", "len", "True", "False"}
        names |= {
            n.name
            for n in ast.walk(self.source.tree)
            if isinstance(n, (ast.FunctionDef, ast.ClassDef))
        }
        _, hint = _near(name, names)
        fix = "Mend the name, or define it before it is used."
        if isinstance(message, messages.UndefinedLocal):
            return self.finding(
                "python-names",
                f"{name} is used in this function before the function gives it a value: as it"
                " assigns to it further down, Python takes it for a variable of the function.",
                message.lineno,
                expected=f"self.{name}, or 'global {name}' at the beginning of the function",
                fix=f"Make it a member of the class (self.{name}), or declare it global.",
            )
        attributes = {
            node.attr
            for node in ast.walk(self.source.tree)
            if isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name)
            and node.value.id == "self"
        }
        methods = {
            n.name
            for n in ast.walk(self.source.tree)
            if isinstance(n, ast.FunctionDef) and self.source.class_(n)
        }
        if name in attributes | methods:
            hint, fix = f" Perhaps self.{name} is meant.", f"Write self.{name}."
        elif name == "self":
            return self._no_self(message)
        elif uses.is_ros_package(name) or _is_module(name):
            hint, fix = f" The import of {name} is missing.", f"Add the line: import {name}"
        elif re.fullmatch(r"U?Int\d+|Float\d+|String|Bool|Empty|Header|Char|Byte", name):
            hint = f" The import of {name} is missing."
            fix = f"Add the line: from std_msgs.msg import {name}"
        return self.finding(
            "python-names",
            f"Nothing is called {name}: Python ends with a NameError when it comes here.{hint}",
            message.lineno,
            expected=name,
            fix=fix,
        )

    def _no_self(self, message):
        """Return the finding about a method without self: its def line is to blame."""
        around = [
            node
            for node in ast.walk(self.source.tree)
            if isinstance(node, ast.FunctionDef)
            and node.lineno <= message.lineno <= last_line(node)
        ]
        method = max(around, key=lambda node: node.lineno, default=None)
        return self.finding(
            "python-names",
            "Nothing is called self here: a method's first parameter has to be self.",
            method.lineno if method else message.lineno,
            expected=f"def {method.name}(self, ...)" if method else "self as the first parameter",
            fix="Write self as the first parameter of the method.",
            change=_self_first(method) if method else None,
        )

    def imports(self):
        for node in self.source.import_nodes:
            if self.source.is_guarded(node, "ImportError", "ModuleNotFoundError"):
                continue
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield from self._module(node, alias.name)
            elif not node.level and node.module:
                problem = list(self._module(node, node.module))
                yield from problem
                if not problem:
                    yield from self._imported(node)

    def _is_own(self, name):
        """Return whether a module is the package's own (made, or generated of its messages)."""
        top = name.split(".")[0]
        paths = {p for p in self.package.of_kind("python")}
        return top == self.package.name or any(
            path.endswith((f"/{top}.py", f"/{top}/__init__.py"))
            or path == f"{top}.py"
            or f"/{top}/" in f"/{path}"
            for path in paths
        )

    def _module(self, node, name):
        if self._is_own(name):
            return
        missing, parent = None, None
        for length in range(1, name.count(".") + 2):
            part = ".".join(name.split(".")[:length])
            # Only ROS's own packages are imported: importing runs what is imported.
            if length > 1 and not _is_ros(part):
                break
            if not _is_module(part):
                missing = part
                break
            parent = part
        if missing is None:
            return
        self.not_imported.append(name.split(".")[-1])
        if parent is None:
            known = set(sys.modules) | _ros_modules()
            near, hint = _near(missing, {n for n in known if "." not in n})
        else:
            near, hint = _near(missing.rsplit(".", 1)[-1], {"msg", "srv", "exceptions"})
        yield self.finding(
            "python-names",
            f"There is no Python module {missing}: Python ends with a ModuleNotFoundError.{hint}",
            node,
            expected="a module that is installed",
            fix=f"Write {near}." if near else "Mend the name of the module.",
        )

    def _imported(self, node):
        if node.module == f"{self.package.name}.msg":
            names = self.message_names
        elif self._is_own(node.module) or not _is_ros(node.module):
            return
        else:
            module = _module(node.module)
            if module is None:
                return
            names = set(dir(module))
        for alias in node.names:
            if alias.name == "*" or alias.name in names:
                continue
            if _is_module(f"{node.module}.{alias.name}"):
                continue
            self.not_imported.append(alias.name)
            near, hint = _near(alias.name, {n for n in names if not n.startswith("_")})
            messages_ = _module(f"{node.module}.msg") if _is_module(f"{node.module}.msg") else None
            if hasattr(messages_, alias.name):
                hint = f" It is in {node.module}.msg."
            yield self.finding(
                "python-names",
                f"{node.module} has no {alias.name}: Python ends with an ImportError.{hint}",
                node,
                expected=f"a name that {node.module} has",
                fix=f"Write {near} for {alias.name}." if near else "Mend the name.",
            )

    def attributes(self):
        """Names of ROS's own modules that do not exist, such as rospy.spln."""
        for node in ast.walk(self.source.tree):
            if not isinstance(node, ast.Attribute) or isinstance(
                self.source.parents.get(node), ast.Attribute
            ):
                continue
            name = self.source.dotted(node)
            if not name or not _is_ros(name) or self._is_own(name):
                continue
            if self.source.is_guarded(node, "AttributeError") or isinstance(node.ctx, ast.Store):
                continue
            owner, missing = _resolve(name)
            if missing is None:
                continue
            near, hint = _near(missing, [n for n in dir(owner) if not n.startswith("_")])
            called = getattr(owner, "__name__", name.rsplit(".", 1)[0])
            yield self.finding(
                "python-names",
                f"{called} has no {missing}: Python ends with an AttributeError when it comes"
                f" here.{hint}",
                node,
                expected=f"a name that {called} has",
                fix=f"Write {near} for {missing}." if near else "Mend the name.",
            )

    def own_attributes(self):
        """self.NAME that no method ever sets."""
        for class_ in ast.walk(self.source.tree):
            if not isinstance(class_, ast.ClassDef) or class_.keywords or class_.decorator_list:
                continue
            if any(not isinstance(b, ast.Name) or b.id != "object" for b in class_.bases):
                continue
            inside = list(ast.walk(class_))
            if any(
                isinstance(n, ast.Name)
                and n.id in ("setattr", "vars", "globals")
                or isinstance(n, ast.Attribute)
                and n.attr in ("__dict__", "update")
                or isinstance(n, ast.FunctionDef)
                and n.name in ("__getattr__", "__getattribute__")
                for n in inside
            ):
                continue
            yield from self._of_class(class_, inside)

    def _of_class(self, class_, inside):
        known = set(dir(object)) | {"__dict__", "__class__", "__name__", "__module__"}
        # Whoever sets an attribute of any object may set it of this one.
        known |= {
            n.attr
            for n in ast.walk(self.source.tree)
            if isinstance(n, ast.Attribute) and isinstance(n.ctx, ast.Store)
        }
        for node in class_.body:
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
                known.add(node.name)
            for one in ast.walk(node):
                if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store):
                    known.add(one.id)
        said = set()
        for node in inside:
            if not (
                isinstance(node, ast.Attribute)
                and isinstance(node.value, ast.Name)
                and node.value.id == "self"
                and isinstance(node.ctx, ast.Load)
            ):
                continue
            if node.attr in known or node.attr in said or self.source.class_(node) is not class_:
                continue
            if self.source.is_guarded(node, "AttributeError"):
                continue
            said.add(node.attr)
            near, hint = _near(f"self.{node.attr}", {f"self.{n}" for n in known - set(dir(object))})
            yield self.finding(
                "python-names",
                f"No method of {class_.name} ever sets self.{node.attr}: Python ends with an"
                f" AttributeError when it comes here.{hint}",
                node,
                expected="a member that is set, or a method that is defined",
                fix=f"Write {near}." if near else f"Set self.{node.attr} in __init__.",
            )

    # Messages

    def message_class(self, node):
        """Return the class of a message that an expression names, or None."""
        name = self.source.dotted(node) if isinstance(node, (ast.Name, ast.Attribute)) else None
        if not name or ".msg." not in name or not _is_ros(name) or self._is_own(name):
            return None
        found, missing = _resolve(name)
        return found if missing is None and hasattr(found, "__slots__") else None

    def message_fields(self):
        for key, class_ in self._messages().items():
            for node in ast.walk(self.source.tree):
                if (
                    isinstance(node, ast.Attribute)
                    and self.source.key(node.value) == key
                    and not hasattr(class_, node.attr)
                ):
                    near, hint = _near(node.attr, class_.__slots__)
                    if not near and len(class_.__slots__) == 1:
                        near = class_.__slots__[0]
                        hint = f" Its only field is {near}."
                    yield self.finding(
                        "python-names",
                        f"A message {class_._type} has no field {node.attr}: Python ends with an"
                        f" AttributeError when it comes here.{hint}",
                        node,
                        expected=", ".join(class_.__slots__) or "no field at all",
                        fix=f"Write {near} for {node.attr}." if near else "Mend the name.",
                    )

    def _messages(self):
        """Return variable -> class, for the variables that hold a message of a known class."""
        found = {}
        for node in ast.walk(self.source.tree):
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
                class_ = self.message_class(node.value.func)
                for target in node.targets:
                    key = self.source.key(target)
                    if class_ and key and len(self.source.stored(key)) == 1:
                        found[key] = class_
            elif isinstance(node, ast.Call) and self.source.dotted(node.func) == "rospy.Subscriber":
                class_ = self.message_class(argument(node, 1, "data_class"))
                callback = argument(node, 2, "callback")
                function = self.source.definition(callback) if callback is not None else None
                if class_ is None or not isinstance(function, (ast.FunctionDef, ast.Lambda)):
                    continue
                names = function.args.args
                first = 1 if isinstance(callback, ast.Attribute) else 0
                if len(names) > first and not self._called(function):
                    key = (function, names[first].arg)
                    if len(self.source.stored(key)) == 1:
                        found[key] = class_
        return found

    def _called(self, function):
        """Return whether a function is called, or handed over, in more than one place."""
        name = getattr(function, "name", None)
        uses_ = [
            n
            for n in ast.walk(self.source.tree)
            if isinstance(n, ast.Name)
            and n.id == name
            and isinstance(n.ctx, ast.Load)
            or isinstance(n, ast.Attribute)
            and n.attr == name
        ]
        return name is not None and len(uses_) > 1

    # Calls of rospy

    def calls(self):
        for node in ast.walk(self.source.tree):
            if not isinstance(node, ast.Call):
                continue
            name = self.source.dotted(node.func)
            if name and name.startswith("rospy.") and not self._is_own("rospy"):
                yield from self._call(node, name)
            class_ = self.message_class(node.func)
            if class_ is not None:
                yield from self._message(node, class_)

    def _message(self, node, class_):
        for keyword in node.keywords:
            if keyword.arg and keyword.arg not in class_.__slots__:
                near, hint = _near(keyword.arg, class_.__slots__)
                yield self.finding(
                    "python-names",
                    f"A message {class_._type} has no field {keyword.arg}: Python ends with an"
                    f" AttributeError when it comes here.{hint}",
                    node,
                    expected=", ".join(class_.__slots__),
                    fix=f"Write {near} for {keyword.arg}." if near else "Mend the name.",
                )

    def _call(self, node, name):
        function, missing = _resolve(name)
        if missing is not None or not callable(function):
            return
        problem = _cannot_bind(function, node)
        if problem:
            near = ""
            match = re.search(r"unexpected keyword argument '(\w+)'", problem)
            if match:
                _, near = _near(match.group(1), inspect.signature(function).parameters)
            yield self.finding(
                "callbacks" if name == "rospy.Timer" else "python-names",
                f"{name}() is called with the wrong arguments: {problem}.{near}",
                node,
                expected=f"{name}{_signature(function)}",
                fix="Compare the call with the one on the page.",
            )
            return
        check = getattr(self, "_" + name.split(".")[-1].lower(), None)
        if check:
            yield from check(node)

    def _init_node(self, node):
        given = argument(node, 0, "name")
        value = self.source.value(given)
        if value is not UNKNOWN and not isinstance(value, str) or self._is_type(given):
            yield self.finding(
                "node-start",
                "rospy.init_node() takes the node's name, a text, as its first argument.",
                node,
                expected='rospy.init_node("NAME")',
                fix="Hand the node's name over first.",
            )

    def _is_type(self, node):
        return self.message_class(node) is not None or isinstance(
            self.source.definition(node), (ast.FunctionDef, ast.ClassDef)
        )

    def _topic_and_type(self, node, what):
        topic, class_ = argument(node, 0, "name"), argument(node, 1, "data_class")
        value = self.source.value(class_)
        is_text = isinstance(value, str)
        swapped = self.message_class(topic) is not None
        own = self.source.definition(class_) if class_ is not None else None
        if (
            swapped
            or is_text
            or isinstance(own, (ast.FunctionDef, ast.Lambda))
            or isinstance(class_, ast.Call)
            and self.message_class(class_.func)
        ):
            why = (
                "the topic's name comes first, and then the type"
                if swapped
                else "the second argument has to be the type of the message, a class"
            )
            yield self.finding(
                "type",
                f"rospy.{what}() gets its arguments wrong: {why}.",
                node,
                expected=f'rospy.{what}("TOPIC", UInt32, ...)',
                fix="Compare the call with the one on the page.",
            )

    def _publisher(self, node):
        yield from self._topic_and_type(node, "Publisher")

    def _subscriber(self, node):
        yield from self._topic_and_type(node, "Subscriber")
        class_ = self.message_class(argument(node, 1, "data_class"))
        extra = argument(node, 3, "callback_args")
        more = 0 if extra is None or self.source.value(extra) is None else 1
        callback = argument(node, 2, "callback")
        if callback is not None:
            given = f"a message {class_._type}" if class_ else "a message"
            yield from self._callback(callback, 1 + more, "rospy.Subscriber", given)
        elif not any(keyword.arg is None for keyword in node.keywords):
            parent = self.source.parents.get(node)
            if not self._callback_added(parent):
                yield self.finding(
                    "callbacks",
                    "rospy.Subscriber() is given no callback: nothing happens when a message"
                    " arrives.",
                    node,
                    expected="the callback as the third argument",
                    fix="Hand the callback over, without calling it.",
                )

    def _callback_added(self, parent):
        names = {n.attr for n in ast.walk(self.source.tree) if isinstance(n, ast.Attribute)}
        return bool(names & {"add_callback", "registerCallback"}) or not isinstance(
            parent, (ast.Assign, ast.Expr)
        )

    def _timer(self, node):
        period, callback = argument(node, 0, "period"), argument(node, 1, "callback")
        is_number = isinstance(period, ast.Constant) and isinstance(period.value, (int, float))
        if (
            is_number
            or isinstance(self.source.value(period), (int, float))
            and isinstance(period, (ast.BinOp, ast.UnaryOp))
        ):
            yield self.finding(
                "callbacks",
                "rospy.Timer() takes a rospy.Duration, not a number: the timer's thread ends with"
                " an error, and nothing is ever called.",
                node,
                expected="rospy.Timer(rospy.Duration(0.5), ...)",
                fix="Write rospy.Duration(...) around the number.",
                change=(self._written(period) + ",", f"rospy.Duration({self._written(period)}),"),
            )
        yield from self._callback(callback, 1, "rospy.Timer", "a TimerEvent")

    def _written(self, node):
        """Return an expression as it is written."""
        return ast.get_source_segment(self.package.text(self.file), node)

    def _callback(self, callback, count, taker, given):
        """Yield a finding if what is handed over as a callback cannot be called with `count`."""
        if isinstance(callback, ast.Call):
            called = self.source.definition(callback.func)
            if isinstance(called, ast.FunctionDef) and not _returns(called):
                yield self.finding(
                    "callbacks",
                    f"{called.name}() is called here, once, and what it returns, nothing, is handed"
                    f" over to {taker}(): it is never called again.",
                    callback,
                    expected=f"{ast_text(callback.func)}, without brackets",
                    fix=f"Write {ast_text(callback.func)} for {ast_text(callback.func)}(...).",
                    change=(self._written(callback), self._written(callback.func)),
                )
            return
        value = self.source.value(callback)
        if isinstance(value, (str, int, float)):
            yield self.finding(
                "callbacks",
                f"{taker}() takes a function to call, and is given a plain value.",
                callback,
                expected="the name of a function",
                fix="Hand the function over, without quotation marks and without calling it.",
            )
            return
        function = self.source.definition(callback)
        if not isinstance(function, (ast.FunctionDef, ast.Lambda)):
            return
        if getattr(function, "decorator_list", None):
            decorators = {getattr(d, "id", "") for d in function.decorator_list}
            if decorators - {"staticmethod"}:
                return
            bound = 0 if "staticmethod" in decorators else 1
        else:
            bound = 1
        is_method = isinstance(callback, ast.Attribute)
        gets = count + (
            bound
            if is_method
            and isinstance(function, ast.FunctionDef)
            and isinstance(self.source.parents.get(function), ast.ClassDef)
            else 0
        )
        takes = function.args
        most = len(getattr(takes, "posonlyargs", [])) + len(takes.args)
        least = most - len(takes.defaults)
        if (
            (gets > most and not takes.vararg)
            or gets < least
            or any(default is None for default in takes.kw_defaults)
        ):
            name = getattr(function, "name", "the lambda")
            yield self.finding(
                "callbacks",
                f"{taker}() calls {name}() with {given}; {name}() takes"
                f" {_count(max(0, least - (gets - count)))}. Python ends the call with a TypeError,"
                " each time.",
                function,
                expected=f"{count} parameter{'s' if count > 1 else ''}"
                + (" besides self" if gets > count else ""),
                fix=f"Give {name} the parameter{'s' if count > 1 else ''} that it is called with.",
            )

    # Statements that do nothing

    def useless(self):
        for node in ast.walk(self.source.tree):
            if not isinstance(node, ast.Expr) or not isinstance(
                node.value, (ast.Attribute, ast.Name)
            ):
                continue
            name = self.source.dotted(node.value)
            own = self.source.definition(node.value)
            is_ros = name and _is_ros(name) and not self._is_own(name)
            found, missing = _resolve(name) if is_ros else (None, "")
            is_function = missing is None and callable(found) or isinstance(own, ast.FunctionDef)
            if isinstance(node.value, ast.Attribute) and node.value.attr == "publish":
                is_function = True
            if is_function:
                text = ast_text(node.value)
                yield self.finding(
                    "spin"
                    if name == "rospy.spin"
                    else "node-start"
                    if not is_ros
                    else "python-names",
                    f"{text} is named here and not called: the brackets are missing.",
                    node,
                    expected=f"{text}()" if not text.endswith("publish") else f"{text}(...)",
                    fix=f"Write {text}() with brackets.",
                    change=(text, f"{text}()") if not text.endswith("publish") else None,
                )

    def kept(self):
        """A timer or a subscriber that nobody keeps works in rospy; but nobody can stop it."""
        for node in ast.walk(self.source.tree):
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
                name = self.source.dotted(node.value.func)
                if name in ("rospy.Timer", "rospy.Subscriber"):
                    yield self.finding(
                        "lifetime",
                        f"What {name}() returns is not kept. rospy keeps it going all the same; but"
                        " nothing can stop it.",
                        node,
                        severity=NOTE,
                        expected="a member, such as self.timer or self.subscriber",
                        fix="Keep it as a member.",
                    )


def ast_text(node):
    """Return the source of a short expression."""
    if isinstance(node, ast.Attribute):
        return f"{ast_text(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else "..."


def _count(number):
    return {0: "no argument", 1: "one argument"}.get(number, f"{number} arguments")


def _returns(function):
    """Return whether a function returns or yields anything."""
    return any(
        isinstance(n, ast.Return)
        and n.value is not None
        or isinstance(n, (ast.Yield, ast.YieldFrom))
        for n in ast.walk(function)
    ) or bool(function.decorator_list)


def _is_ros(name):
    return uses.is_ros_package(name.split(".")[0])


def _ros_modules():
    import pathlib

    return {
        path.parent.name
        for share in uses.SHARES
        for path in pathlib.Path(share).glob("*/package.xml")
    }


def _is_module(name):
    """Return whether Python can find a module; its parents are imported if they are ROS's own."""
    if "." in name and not _is_ros(name):
        return True
    try:
        return name in sys.modules or importlib.util.find_spec(name) is not None
    except (ImportError, ValueError, AttributeError):
        return False


def _module(name):
    try:
        return importlib.import_module(name)
    except Exception:  # a module of this machine that is broken is not the student's fault
        return None


def _resolve(name):
    """Return (object, None) of a dotted name in ROS's own modules, or (owner, what it lacks)."""
    parts = name.split(".")
    found = _module(parts[0])
    if found is None:
        return None, None
    for index, part in enumerate(parts[1:], 1):
        if not hasattr(found, part) and isinstance(found, types.ModuleType):
            _module(".".join(parts[: index + 1]))
        if not hasattr(found, part):
            # What an object has that is made at run time, nobody knows.
            if not isinstance(found, (types.ModuleType, type)):
                return None, None
            return found, part
        found = getattr(found, part)
    return found, None


def _cannot_bind(function, call):
    """Return why a function cannot be called with a call's arguments, or None."""
    if any(isinstance(a, ast.Starred) for a in call.args) or any(
        k.arg is None for k in call.keywords
    ):
        return None
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return None
    try:
        signature.bind(*call.args, **{keyword.arg: keyword.value for keyword in call.keywords})
    except TypeError as error:
        return str(error)
    return None


def _signature(function):
    try:
        return str(inspect.signature(function))
    except (TypeError, ValueError):
        return "(...)"


def _self_first(method):
    rest = ", " if method.args.args or method.args.vararg or method.args.kwarg else ""
    return f"def {method.name}(", f"def {method.name}(self{rest}"
