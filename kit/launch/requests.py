"""What a launch file's process asks for, checked: the other half of ``kit.ros.launch.service``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final, Literal, cast

from kit.host.protocol import Event
from kit.host.wire import MAX_NAME, MAX_TEXT, Json, ProtocolError, integer, items, text

Severity = Literal["DEBUG", "INFO", "WARN", "ERROR", "FATAL"]


@dataclass(frozen=True, slots=True)
class Say:
    """A line of the launch's own log."""

    severity: Severity
    text: str


@dataclass(frozen=True, slots=True)
class Listen:
    """The launch file wants to know what processes print."""


@dataclass(frozen=True, slots=True)
class Start:
    """A process to be started."""

    number: int
    title: str
    package: str | None
    executable: str | None
    """Of the package; None: ``command`` says it all."""
    command: tuple[str, ...]
    """For a node only the arguments."""
    shell: bool
    environment: Mapping[str, str]
    cwd: Path | None
    where: str
    """File and line in the launch file, to begin a message with; may be empty."""

    @property
    def name(self) -> str:
        """What its lines begin with: ``random_walk-2``."""
        return f"{self.title}-{self.number}"


@dataclass(frozen=True, slots=True)
class End:
    """A process to be ended."""

    number: int


@dataclass(frozen=True, slots=True)
class EndAll:
    """The launch is to be ended."""

    reason: str


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument that the launch file declares."""

    name: str
    default: str | None
    description: str
    choices: tuple[str, ...] | None


Request = Say | Listen | Start | End | EndAll | Argument


def parse_request(event: Event) -> Request:
    """Raises ProtocolError if there is anything wrong with it."""
    if event.name not in _KINDS:
        raise ProtocolError(f"no such request: {event.name}")
    return _KINDS[event.name](*items(event.fields))


def _say(severity: Json, line: Json) -> Say:
    if severity not in ("DEBUG", "INFO", "WARN", "ERROR", "FATAL"):
        raise ProtocolError("no severity of a log")
    return Say(cast(Severity, severity), text(line))


def _start(number: Json, specification: Json) -> Start:
    if type(specification) is not dict:
        raise ProtocolError("no specification of a process")
    is_node = specification.get("kind") == "node"
    file, line = specification.get("file"), specification.get("line")
    where = "" if file is None or line is None else f"{text(file)}:{integer(line)}: "
    environment = specification.get("environment")
    if type(environment) is not dict:
        raise ProtocolError("no environment of a process")
    cwd = specification.get("cwd")
    return Start(
        integer(number),
        text(specification.get("title"), MAX_NAME),
        _maybe(specification.get("package")) if is_node else None,
        text(specification.get("executable")) if is_node else None,
        _texts(specification.get("arguments" if is_node else "command")),
        specification.get("shell") is True,
        {_any_text(key): _any_text(value) for key, value in environment.items()},
        None if cwd is None else Path(text(cwd)),
        where,
    )


def _argument(name: Json, default: Json, description: Json, choices: Json) -> Argument:
    return Argument(
        text(name, MAX_NAME), _maybe(default), text(description), None if choices is None else _texts(choices)
    )


def _maybe(value: Json) -> str | None:
    return None if value is None else text(value)


def _texts(values: Json) -> tuple[str, ...]:
    return tuple(_any_text(value) for value in items(values))


def _any_text(value: Json) -> str:
    """Not shown to anybody: line breaks are allowed."""
    if type(value) is not str or len(value) > 32 * MAX_TEXT or "\0" in value:
        raise ProtocolError("no text")
    return value


_KINDS: Final[Mapping[str, Callable[..., Request]]] = MappingProxyType(
    {
        "log": _say,
        "listen": Listen,
        "process": _start,
        "end": lambda number: End(integer(number)),
        "shutdown": lambda reason: EndAll(text(reason)),
        "argument": _argument,
    }
)
