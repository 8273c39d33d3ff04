# SPDX-License-Identifier: BSD-3-Clause
"""Python starts with this file, in a confined run of a Python node, and tells what the node does.

The variable MRP_CHECK_HOOK has a plans.Hook as JSON. Each line that is written to its file `events`
is a seen.Event as JSON, with places in the package's own code:

    event: init, publisher, subscriber, publish or timer, with file, line and perhaps a topic
    event: exit, with file and line: sys.exit() with another code than 0

If the hook has a `wrap`, it looks for the counter of what is published, after three messages sets
it near its end, and tells what follows:

    event: set, with the names of what holds the counter; or not_found
    event: after, with a value; or error, with its text, file and line

On SIGUSR1 it prints where the main thread stands, and on SIGUSR2 where each thread does.
"""

import ctypes
import faulthandler
import fractions
import functools
import importlib.abc
import importlib.util
import json
import os
import signal
import sys
import types
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Tuple

_HOOK = json.loads(os.environ.get("MRP_CHECK_HOOK", "{}"))
_SOURCES = os.path.realpath(_HOOK.get("sources", "/nowhere")) + "/"
_WRAP = _HOOK.get("wrap")

_LOOK = 3  # messages after which the counter should be known
_GIVE_UP = 8
_FRAMES = 8
_DEEPEST = 2  # attributes of attributes in which a counter is looked for


def _tell(event: str, **what: object) -> None:
    try:
        with open(_HOOK["events"], "a") as file:
            file.write(json.dumps({"event": event, **what}) + "\n")
    except (OSError, TypeError, ValueError):
        pass  # the node goes on in any case


def _is_own(frame: types.FrameType) -> bool:
    return os.path.realpath(frame.f_code.co_filename).startswith(_SOURCES)


def _own_frames() -> List[types.FrameType]:
    """Return the frames of the package's own code that led here, the innermost first."""
    frame: Optional[types.FrameType] = sys._getframe(2)
    frames: List[types.FrameType] = []
    while frame and len(frames) < _FRAMES:
        if _is_own(frame):
            frames.append(frame)
        frame = frame.f_back
    return frames


def _place(frames: List[types.FrameType]) -> Dict[str, object]:
    """Return the file, relative to the sources, and the line of the innermost frame."""
    if not frames:
        return {"file": None, "line": None}
    path = os.path.realpath(frames[0].f_code.co_filename)
    return {"file": path[len(_SOURCES) :], "line": frames[0].f_lineno}


# --- What the node calls


def _tell_calls(rospy: Any) -> None:
    reported = set()

    def tell_once(event: str, **what: object) -> None:
        key = (event, what.get("file"), what.get("line"))
        # What rospy does by itself is no news.
        if key not in reported and what["file"] and what.get("topic") != "/rosout":
            reported.add(key)
            _tell(event, **what)

    def before(
        owner: Any, name: str, event: str, describe: Callable[..., Dict[str, object]]
    ) -> None:
        original = getattr(owner, name)

        def called(*arguments: Any, **keywords: Any) -> Any:
            frames = _own_frames()
            try:
                tell_once(event, **_place(frames), **describe(arguments, keywords))
            except Exception:  # the node decides itself what it makes of its mistake
                pass
            return original(*arguments, **keywords)

        called.__name__, called.__doc__ = name, original.__doc__
        setattr(owner, name, called)

    def topic(arguments: Any, keywords: Any) -> Dict[str, object]:
        return {"topic": arguments[1] if len(arguments) > 1 else keywords.get("name")}

    before(rospy, "init_node", "init", lambda a, k: {})
    before(rospy.Publisher, "__init__", "publisher", topic)
    before(rospy.Subscriber, "__init__", "subscriber", topic)
    before(rospy.Timer, "__init__", "timer", lambda a, k: {})
    before(rospy.Rate, "__init__", "timer", lambda a, k: {})
    _watch_publish(rospy, tell_once)


def _watch_publish(rospy: Any, tell_once: Callable[..., None]) -> None:
    original = rospy.Publisher.publish
    wrap = _Wrap(_WRAP) if _WRAP else None

    def publish(self: Any, *arguments: Any, **keywords: Any) -> Any:
        frames = _own_frames()
        place = _place(frames)
        tell_once("publish", topic=self.resolved_name, **place)
        value = None
        if wrap:
            try:
                message = rospy.msg.args_kwds_to_message(self.data_class, arguments, keywords)
                for name in _WRAP["field"].split("."):
                    message = getattr(message, name)
                value = message if type(message) is int else None
            except Exception:
                pass  # original() fails on it, too
        try:
            result = original(self, *arguments, **keywords)
        except BaseException as error:
            if wrap:
                wrap.failed(error, place)
            raise
        if wrap and value is not None:
            wrap.published(value, frames)
        return result

    publish.__doc__ = original.__doc__
    rospy.Publisher.publish = publish


def _tell_exits() -> None:
    for module, name in ((sys, "exit"), (os, "_exit")):
        original = getattr(module, name)

        def leave(code: object = 0, _original: Callable[[Any], object] = original) -> None:
            if code not in (0, None):
                _tell("exit", **_place(_own_frames()))
            _original(code)

        setattr(module, name, leave)


class _AfterRospy(importlib.abc.MetaPathFinder):
    """Has _tell_calls done as soon as the node has imported rospy, not before."""

    def find_spec(
        self, name: str, path: Any, target: object = None
    ) -> Optional[importlib.machinery.ModuleSpec]:
        if name != "rospy":
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        if spec and spec.loader:
            load = spec.loader.exec_module

            def exec_module(module: types.ModuleType) -> None:
                load(module)
                _tell_calls(module)

            setattr(spec.loader, "exec_module", exec_module)  # noqa: B010 (no method's place)
        return spec


# --- The counter


Key = Tuple[object, ...]  # of a slot


class _Wrap:
    """Finds what follows the published values, sets it, and tells what is published then.

    Each whole number that the publishing code can see in a variable, in an attribute of an object
    of its own, or in a message that it keeps, is compared with the published values: what is an
    affine function of them (as x = 2 * value + 1), at three messages, follows them. All that
    follows is set; so it does not matter which of it is only a copy.
    """

    def __init__(self, rule: Dict[str, int]) -> None:
        start, step, modulus = rule["start"], rule["step"], rule["modulus"]
        self.step, self.told = step, rule["told"]
        self.last = start + (modulus - 1 - start) // step * step  # before it wraps round
        self.seen: List[Tuple[int, Dict[Key, Optional[int]]]] = []
        self.after: Optional[int] = None
        self.done = False

    def published(self, value: int, frames: List[types.FrameType]) -> None:
        if self.done:
            return
        if self.after is not None:
            _tell("after", value=value)
            self.after += 1
            self.done = self.after >= self.told
            return
        slots = {slot.key: slot for slot in _slots(frames)}
        self.seen.append((value, {key: slot.value for key, slot in slots.items()}))
        if len(self.seen) >= _LOOK:
            self._set(slots)
        if self.after is None and len(self.seen) >= _GIVE_UP:
            self.done = True
            _tell("not_found")

    def _set(self, slots: Dict[Key, "_Slot"]) -> None:
        recent = self.seen[-_LOOK:]
        names = []
        for key, slot in slots.items():
            relation = _relation([(v, found.get(key)) for v, found in recent])
            if relation is None:
                continue
            # As if the last value but one had just been published.
            number = relation(self.last - self.step)
            if number is not None:
                try:
                    slot.put(number)
                except Exception:  # the node's own, such as of a property
                    continue
                names.append(slot.name)
        if names:
            self.after = 0
            _tell("set", names=sorted(set(names)))

    def failed(self, error: BaseException, place: Dict[str, object]) -> None:
        if self.after is not None and not self.done:
            self.done = True
            _tell("error", text=f"{type(error).__name__}: {error}", **place)


def _relation(pairs: List[Tuple[int, Optional[int]]]) -> Optional[Callable[[int], Optional[int]]]:
    """Return the function that gives a slot's number for a published value, or None.

    pairs: (published value, number in the slot) of some messages
    """
    (v0, n0), (v1, n1) = pairs[:2]
    if n0 is None or n1 is None or v0 == v1 or n0 == n1:
        return None
    slope = fractions.Fraction(n1 - n0, v1 - v0)
    if any(n0 + slope * (v - v0) != n for v, n in pairs):
        return None

    def number_for(value: int) -> Optional[int]:
        number = n0 + slope * (value - v0)
        return int(number) if number.denominator == 1 else None

    return number_for


class _Slot(NamedTuple):
    """Something that holds a whole number: key is the same at each message, put() sets it."""

    key: Key
    name: str
    value: int
    put: Callable[[int], object]


def _slots(frames: List[types.FrameType]) -> Iterator[_Slot]:
    for depth, frame in enumerate(frames):
        if frame.f_locals is not frame.f_globals:
            for name, held in list(frame.f_locals.items()):
                put = functools.partial(_put_local, frame, name)
                yield from _slots_of(held, (depth, frame.f_code.co_name, name), name, put)
    for variables in {id(frame.f_globals): frame.f_globals for frame in frames}.values():
        for name, held in list(variables.items()):
            put = functools.partial(variables.__setitem__, name)
            yield from _slots_of(held, ("global", name), name, put)


def _slots_of(
    held: Any, key: Key, name: str, put: Callable[[int], object], depth: int = 0
) -> Iterator[_Slot]:
    if type(held) is int:
        yield _Slot(key, name, held, put)
    elif depth < _DEEPEST and (_is_of_package(held) or hasattr(held, "_md5sum")):
        slots = getattr(type(held), "__slots__", ())
        for attribute in [*getattr(held, "__dict__", ()), *slots]:
            setter = functools.partial(setattr, held, attribute)
            value = getattr(held, attribute, None)
            yield from _slots_of(value, (*key, attribute), attribute, setter, depth + 1)


def _is_of_package(held: object) -> bool:
    """Return whether something is an object of a class of the package's own code."""
    module = sys.modules.get(type(held).__module__)
    path = os.path.realpath(getattr(module, "__file__", None) or "")
    # What catkin's relay runs calls itself __main__, but lies elsewhere.
    return path.startswith(_SOURCES) or type(held).__module__ in ("__main__", "builtins.__main__")


def _put_local(frame: types.FrameType, name: str, value: int) -> None:
    frame.f_locals[name] = value
    if sys.version_info < (3, 13):
        to_fast = ctypes.pythonapi.PyFrame_LocalsToFast
        to_fast.argtypes = [ctypes.py_object, ctypes.c_int]
        to_fast(frame, 0)


if _HOOK:
    faulthandler.register(signal.SIGUSR1, all_threads=False)
    faulthandler.register(signal.SIGUSR2, all_threads=True)
    sys.meta_path.insert(0, _AfterRospy())
    _tell_exits()
