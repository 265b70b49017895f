"""What a student's process may say to us, and the one place that checks it.

A frame's content is an array that starts with the name of its kind. Nothing in it names code or is turned into
any. The parent asks, the child answers, each answer carrying the number of what it answers; a child that says
anything else is ended.

    parent -> child                              child -> parent
    setup  (how to lock itself in)               confined level, or refused reason
    start  0 ...                                 reply 0 ..., or functions 0 ...
    tick   n, time, events                       reply n, wake time, events
    call   n, function, count, columns           values n, numbers
    tell   n, function, record                   told n, what it returned
                                                 ended n, events        the program is over, as it wished
                                                 failed n, what, where  the program is over, by its own fault

Which frame may come when is ``ALLOWED``: by what the parent waits for. Nothing that the student's code can write
has a meaning before ``confined`` (it is not there yet), and nothing that only the code above it may say has one
afterwards.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType
from typing import Final, TypeAlias

from kit.host.failure import REPORTABLE, Failure
from kit.host.wire import MAX_NAME, Json, ProtocolError, integer, items, number, shown, text, text_to_numbers


@dataclass(frozen=True, slots=True)
class Confined:
    """The child is locked in, to this level of the ladder, and has run nothing of the student's yet."""

    level: int


@dataclass(frozen=True, slots=True)
class Refused:
    """The child cannot be locked in as asked, and has ended."""

    reason: str


@dataclass(frozen=True, slots=True)
class GraphEvent:
    """Something a student's node did: declared an endpoint, published, asked, answered, logged.

    ``fields`` are raw; ``kit.host.declarations`` and ``codec`` check them against the types concerned.
    """

    name: str
    fields: list[Json]


@dataclass(frozen=True, slots=True)
class Reply:
    """All nodes wait. ``wake_ns``: when the earliest wants to go on by itself; None: never."""

    seq: int
    wake_ns: int | None
    events: tuple[GraphEvent, ...]


@dataclass(frozen=True, slots=True)
class Functions:
    """The functions a student's file defines."""

    seq: int
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Values:
    """What a function returned for each record of a batch: finite numbers."""

    seq: int
    values: array[float]


@dataclass(frozen=True, slots=True)
class Told:
    """What a function returned for one record: a number, a truth value, a text, or lists of these."""

    seq: int
    value: Json


@dataclass(frozen=True, slots=True)
class Ended:
    """The program has come to its end."""

    seq: int
    events: tuple[GraphEvent, ...]


@dataclass(frozen=True, slots=True)
class Failed:
    """The program has failed, as the child tells it."""

    seq: int
    failure: Failure


Frame: TypeAlias = Confined | Refused | Reply | Functions | Values | Told | Ended | Failed


class State(Enum):
    """What the parent waits for. The student's code is sent, and so can write, from ``STARTING`` states on."""

    CONFINING = "confining"
    """That the child is locked in. Only the kit's own code runs in it so far."""
    STARTING_NODE = "starting node"
    STARTING_FUNCTIONS = "starting functions"
    STARTING_LAUNCH = "starting launch"
    TICKING = "ticking"
    CALLING = "calling"
    TELLING = "telling"
    IDLE = "idle"
    """For nothing: nothing has been asked."""


ALLOWED: Final[Mapping[State, tuple[type[Frame], ...]]] = MappingProxyType(
    {
        State.CONFINING: (Confined, Refused),
        State.STARTING_NODE: (Reply, Ended, Failed),
        State.STARTING_FUNCTIONS: (Functions, Failed),
        State.STARTING_LAUNCH: (Reply, Ended, Failed),
        State.TICKING: (Reply, Ended, Failed),
        State.CALLING: (Values, Failed),
        State.TELLING: (Told, Failed),
        State.IDLE: (),
    }
)
"""The kinds of frame a child may send in each state. Any other ends it, by its own fault."""

ASKING: Final[Mapping[str, State]] = MappingProxyType(
    {"tick": State.TICKING, "call": State.CALLING, "tell": State.TELLING}
)
"""The state that follows a question."""


def check_allowed(frame: Frame, state: State) -> None:
    """ProtocolError if a child may not send this kind of frame in this state."""
    if not isinstance(frame, ALLOWED[state]):
        raise ProtocolError(f"a frame {type(frame).__name__.lower()!r} at the wrong time ({state.value})")


DEEPEST: Final = 3
"""Lists in lists that a function may return."""


def _confined(level: Json) -> Confined:
    return Confined(integer(level, 0, 3))


def _refused(reason: Json) -> Refused:
    return Refused(text(reason))


def _reply(seq: Json, wake_ns: Json, events: Json) -> Reply:
    return Reply(integer(seq), None if wake_ns is None else integer(wake_ns, 0, 2**63 - 1), _events(events))


def _functions(seq: Json, names: Json) -> Functions:
    return Functions(integer(seq), tuple(text(name, MAX_NAME) for name in items(names)))


def _values(seq: Json, values: Json) -> Values:
    return Values(integer(seq), text_to_numbers(values, "d", finite=True))


def _told(seq: Json, value: Json) -> Told:
    return Told(integer(seq), _plain(value, DEEPEST))


def _plain(value: Json, deep: int) -> Json:
    if type(value) is list:
        if deep == 0:
            raise ProtocolError("lists in too many lists")
        return [_plain(each, deep - 1) for each in value]
    if value is None or type(value) is bool:
        return value
    return text(value) if type(value) is str else number(value)


def _ended(seq: Json, events: Json) -> Ended:
    return Ended(integer(seq), _events(events))


def _failed(seq: Json, kind: Json, message: Json, file: Json, line: Json) -> Failed:
    name = text(kind, MAX_NAME)
    known = {kind.value: kind for kind in REPORTABLE}
    if name not in known:
        raise ProtocolError(f"no such kind of failure: {name}")
    where = None if file is None else text(file, MAX_NAME)
    at = None if line is None or where is None else integer(line, 1)
    return Failed(integer(seq), Failure(known[name], text(message), where, at))


def _events(events: Json) -> tuple[GraphEvent, ...]:
    found = []
    for event in items(events):
        name, *fields = items(event) or [None]
        found.append(GraphEvent(text(name, MAX_NAME), fields))
    return tuple(found)


_FRAMES: Final[Mapping[str, tuple[int, Callable[..., Frame]]]] = MappingProxyType(
    {
        "confined": (1, _confined),
        "refused": (1, _refused),
        "reply": (3, _reply),
        "functions": (2, _functions),
        "values": (2, _values),
        "told": (2, _told),
        "ended": (2, _ended),
        "failed": (5, _failed),
    }
)


def parse(content: Json) -> Frame:
    """The frame a child sent, every value checked. ProtocolError if there is anything wrong with it."""
    name, *fields = items(content) or [None]
    if type(name) is not str or name not in _FRAMES:
        raise ProtocolError(f"no such kind of frame: {shown(name)}")
    count, read = _FRAMES[name]
    if len(fields) != count:
        raise ProtocolError(f"{name} with {len(fields)} fields instead of {count}")
    return read(*fields)
