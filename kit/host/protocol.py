"""Checks every frame that a student's process sends: the only place where one is read.

A frame's content is an array that starts with the name of its kind. Nothing in it names code or is turned into
any. The parent sends a command, the child one answer with the number of the command; a child that sends anything
else is ended.

    parent -> child                              child -> parent
    setup  (how to lock itself in)               confined level, or refused reason
    start  0 ...                                 reply 0 ..., or functions 0 ...
    tick   n, time, events                       reply n, wake time, events
    call   n, function, count, columns           values n, numbers
    tell   n, function, record                   told n, what it returned
                                                 ended n, events                 the program is over, as it wished
                                                 failed n, what, where, status   the program is over, by its own fault

``ALLOWED_FRAMES`` says which frame may come when: by what the parent waits for. Nothing that the student's code can
write has a meaning before ``confined`` (it is not there yet), and nothing that only the kit's code may write has one
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
from kit.host.wire import (
    MAX_NAME,
    MAX_RESULT_DEPTH,
    Json,
    ProtocolError,
    describe_value,
    integer,
    items,
    number,
    text,
    text_to_numbers,
)


@dataclass(frozen=True, slots=True)
class Confined:
    """The child is confined at this level, and has run nothing of the student's yet."""

    level: int


@dataclass(frozen=True, slots=True)
class ConfinementRefused:
    """The child cannot be confined as requested, and has ended."""

    reason: str


@dataclass(frozen=True, slots=True)
class GraphEvent:
    """Something a student's node did: created an endpoint, published, sent a request or a response.

    ``fields`` are raw; ``proxy_nodes`` and ``codec`` check them against the types concerned.
    """

    name: str
    fields: list[Json]


HOLD_NS: Final = -1
"""In place of a time to run again: at once, and simulated time is to stand still until the answer. Only another terminal
asks for that."""


@dataclass(frozen=True, slots=True)
class Reply:
    """All nodes wait. ``wake_ns``: when the first of them must run again [ns], or HOLD_NS; None: not before an event."""

    seq: int
    wake_ns: int | None
    events: tuple[GraphEvent, ...]


@dataclass(frozen=True, slots=True)
class FunctionNames:
    """The functions a student's file defines."""

    seq: int
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class BatchResult:
    """The results of a function, one finite number for each record of a batch."""

    seq: int
    values: array[float]


@dataclass(frozen=True, slots=True)
class JsonResult:
    """The result of a function for one record: None, a number, a truth value, a text, or lists of these."""

    seq: int
    value: Json


@dataclass(frozen=True, slots=True)
class Ended:
    """The program has come to its end."""

    seq: int
    events: tuple[GraphEvent, ...]


@dataclass(frozen=True, slots=True)
class Failed:
    """The program has failed, as reported by the child."""

    seq: int
    failure: Failure


Frame: TypeAlias = (
    Confined | ConfinementRefused | Reply | FunctionNames | BatchResult | JsonResult | Ended | Failed
)


class ProcessState(Enum):
    """What the parent waits for. The student's code is there, and so can write, from the ``STARTING`` states on."""

    CONFINING = "confining"
    """For the child to be confined. Only the kit's own code runs in it so far."""
    STARTING_NODE = "starting node"
    STARTING_FUNCTIONS = "starting functions"
    STARTING_LAUNCH = "starting launch"
    TICKING = "ticking"
    CALLING_BATCH = "calling"
    CALLING_JSON = "calling for plain data"
    IDLE = "idle"
    """For nothing: no command is open."""


ALLOWED_FRAMES: Final[Mapping[ProcessState, tuple[type[Frame], ...]]] = MappingProxyType(
    {
        ProcessState.CONFINING: (Confined, ConfinementRefused),
        ProcessState.STARTING_NODE: (Reply, Ended, Failed),
        ProcessState.STARTING_FUNCTIONS: (FunctionNames, Failed),
        ProcessState.STARTING_LAUNCH: (Reply, Ended, Failed),
        ProcessState.TICKING: (Reply, Ended, Failed),
        ProcessState.CALLING_BATCH: (BatchResult, Failed),
        ProcessState.CALLING_JSON: (JsonResult, Failed),
        ProcessState.IDLE: (),
    }
)
"""The kinds of frame that a child may send in each state. It is ended for any other."""

STATE_AFTER_COMMAND: Final[Mapping[str, ProcessState]] = MappingProxyType(
    {"tick": ProcessState.TICKING, "call": ProcessState.CALLING_BATCH, "tell": ProcessState.CALLING_JSON}
)
"""The state that follows a command."""


def check_allowed(frame: Frame, state: ProcessState) -> None:
    """Raises ProtocolError if a child may not send this kind of frame in this state."""
    if not isinstance(frame, ALLOWED_FRAMES[state]):
        raise ProtocolError(f"a frame {_NAMES[type(frame)]!r} at the wrong time ({state.value})")


def _confined(level: Json) -> Confined:
    return Confined(integer(level, 0, 3))


def _refused(reason: Json) -> ConfinementRefused:
    return ConfinementRefused(text(reason))


def _reply(seq: Json, wake_ns: Json, events: Json) -> Reply:
    return Reply(integer(seq), None if wake_ns is None else integer(wake_ns, 0, 2**63 - 1), _events(events))


def _hold_reply(seq: Json, events: Json) -> Reply:
    return Reply(integer(seq), HOLD_NS, _events(events))


def _function_names(seq: Json, names: Json) -> FunctionNames:
    return FunctionNames(integer(seq), tuple(text(name, MAX_NAME) for name in items(names)))


def _batch_result(seq: Json, values: Json) -> BatchResult:
    return BatchResult(integer(seq), text_to_numbers(values, "d", finite=True))


def _json_result(seq: Json, value: Json) -> JsonResult:
    return JsonResult(integer(seq), _plain(value, MAX_RESULT_DEPTH))


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


def _failed(seq: Json, kind: Json, message: Json, file: Json, line: Json, status: Json) -> Failed:
    name = text(kind, MAX_NAME)
    known = {kind.value: kind for kind in REPORTABLE}
    if name not in known:
        raise ProtocolError(f"no such kind of failure: {name}")
    where = None if file is None else text(file, MAX_NAME)
    at = None if line is None or where is None else integer(line, 1)
    return Failed(integer(seq), Failure(known[name], text(message), where, at, integer(status, 0, 255)))


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
        "held": (2, _hold_reply),
        "functions": (2, _function_names),
        "values": (2, _batch_result),
        "told": (2, _json_result),
        "ended": (2, _ended),
        "failed": (6, _failed),
    }
)


_NAMES: Final[Mapping[type[Frame], str]] = MappingProxyType(
    {
        Confined: "confined",
        ConfinementRefused: "refused",
        Reply: "reply",
        FunctionNames: "functions",
        BatchResult: "values",
        JsonResult: "told",
        Ended: "ended",
        Failed: "failed",
    }
)


def parse(content: Json) -> Frame:
    """Returns the frame that a child sent, with every value checked. Raises ProtocolError."""
    name, *fields = items(content) or [None]
    if type(name) is not str or name not in _FRAMES:
        raise ProtocolError(f"no such kind of frame: {describe_value(name)}")
    count, read = _FRAMES[name]
    if len(fields) != count:
        raise ProtocolError(f"{name} with {len(fields)} fields instead of {count}")
    return read(*fields)
