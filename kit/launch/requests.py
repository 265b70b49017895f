"""Parses and checks the requests of a launch file's process, and the world that ``flatland_server``'s parameters ask for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, Literal, cast

from kit.host.protocol import GraphEvent
from kit.host.wire import MAX_NAME, MAX_TEXT, Json, ProtocolError, integer, items, text
from kit.launch.processes import ProcessStartError
from kit.plain_text import nearest_name
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.execution.arguments import parse_ros_arguments

Severity = Literal["DEBUG", "INFO", "WARN", "ERROR", "FATAL"]


@dataclass(frozen=True, slots=True)
class LogRequest:
    """Log a line."""

    severity: Severity
    text: str


@dataclass(frozen=True, slots=True)
class OutputRequest:
    """Send an event for every line that a process prints."""


@dataclass(frozen=True, slots=True)
class StartRequest:
    """Start a process."""

    number: int
    title: str
    package: str | None
    executable: str | None
    """The program of the package; None: ``command`` is the whole command."""
    command: tuple[str, ...]
    """The command line; for a package's program its arguments only."""
    shell: bool
    environment: Mapping[str, str]
    cwd: Path | None
    where: str
    """``FILE:LINE: `` of the launch file, as the beginning of a message; may be empty."""
    is_component: bool = False
    """Whether ``executable`` names a composable node of the package instead of a program."""

    @property
    def name(self) -> str:
        """The name of the process in the output, such as ``random_walk-2``."""
        return f"{self.title}-{self.number}"


@dataclass(frozen=True, slots=True)
class EndRequest:
    """End a process."""

    number: int


@dataclass(frozen=True, slots=True)
class TransitionRequest:
    """Request a transition of a lifecycle node, as soon as it is there."""

    node: str
    """Its full name."""
    transition: int
    """Number of the transition in lifecycle_msgs/msg/Transition."""


@dataclass(frozen=True, slots=True)
class WatchRequest:
    """Send an event for every transition of a lifecycle node."""

    node: str
    """Its full name."""


@dataclass(frozen=True, slots=True)
class TimerRequest:
    """Expect that a timer starts something."""

    due_ns: int
    """When it is due [ns of the launch's time]."""


@dataclass(frozen=True, slots=True)
class ShutdownRequest:
    """End the launch."""

    reason: str


@dataclass(frozen=True, slots=True)
class DeclaredArgument:
    """An argument that the launch file declares."""

    name: str
    default: str | None
    description: str
    choices: tuple[str, ...] | None


Request = (
    LogRequest
    | OutputRequest
    | StartRequest
    | EndRequest
    | TransitionRequest
    | WatchRequest
    | TimerRequest
    | ShutdownRequest
    | DeclaredArgument
)


def parse_request(event: GraphEvent) -> Request:
    """Checks and converts a request. Raises ProtocolError."""
    if event.name not in _PARSERS:
        raise ProtocolError(f"no such request: {event.name}")
    return _PARSERS[event.name](*items(event.fields))


def _parse_log_request(severity: Json, line: Json) -> LogRequest:
    if severity not in ("DEBUG", "INFO", "WARN", "ERROR", "FATAL"):
        raise ProtocolError("no severity of a log")
    return LogRequest(cast(Severity, severity), text(line))


def _parse_start_request(number: Json, specification: Json) -> StartRequest:
    if type(specification) is not dict:
        raise ProtocolError("no specification of a process")
    is_component = specification.get("kind") == "component"
    is_node = is_component or specification.get("kind") == "node"
    file, line = specification.get("file"), specification.get("line")
    where = "" if file is None or line is None else f"{text(file)}:{integer(line)}: "
    environment = specification.get("environment")
    if type(environment) is not dict:
        raise ProtocolError("no environment of a process")
    cwd = specification.get("cwd")
    return StartRequest(
        integer(number),
        text(specification.get("title"), MAX_NAME),
        _optional_text(specification.get("package")) if is_node else None,
        text(specification.get("executable")) if is_node else None,
        _texts(specification.get("arguments" if is_node else "command")),
        specification.get("shell") is True,
        {_any_text(key): _any_text(value) for key, value in environment.items()},
        None if cwd is None else Path(text(cwd)),
        where,
        is_component,
    )


def _parse_argument(name: Json, default: Json, description: Json, choices: Json) -> DeclaredArgument:
    return DeclaredArgument(
        text(name, MAX_NAME),
        _optional_text(default),
        text(description),
        None if choices is None else _texts(choices),
    )


def _optional_text(value: Json) -> str | None:
    return None if value is None else text(value)


def _texts(values: Json) -> tuple[str, ...]:
    return tuple(_any_text(value) for value in items(values))


def _any_text(value: Json) -> str:
    """A text that is not displayed, so that line breaks are allowed."""
    if type(value) is not str or len(value) > 32 * MAX_TEXT or "\0" in value:
        raise ProtocolError("no text")
    return value


_PARSERS: Final[Mapping[str, Callable[..., Request]]] = MappingProxyType(
    {
        "log": _parse_log_request,
        "listen": OutputRequest,
        "process": _parse_start_request,
        "watch": lambda node: WatchRequest(text(node, MAX_NAME)),
        "transition": lambda node, number: TransitionRequest(text(node, MAX_NAME), integer(number)),
        "timer": lambda due_ns: TimerRequest(integer(due_ns, 0, 2**63 - 1)),
        "end": lambda number: EndRequest(integer(number)),
        "shutdown": lambda reason: ShutdownRequest(text(reason)),
        "argument": _parse_argument,
    }
)


NODE_NAME: Final = "flatland_server"

PARAMETERS: Final = frozenset(
    {
        "world_path",
        "update_rate",
        "step_size",
        "show_viz",
        "viz_pub_rate",
        "use_sim_time",
        "use_rviz",
        "simplify_map",
    }
)
"""The parameters of flatland_server; those of visualization and of the clock have no effect here."""


@dataclass(frozen=True, slots=True)
class WorldRequest:
    """The parameters of ``flatland_server``, with its own defaults."""

    path: Path
    update_rate: float = 200.0
    """Ticks a second of wall clock [Hz]."""
    step_size: float = 0.005
    """Simulated time of a tick [s]."""
    show_viz: bool = False
    where: str = ""
    """File and line of the launch file, for messages."""
    is_hidden: bool = False
    """Whether the world's own node and services have hidden names: it only shows what another node does."""

    @property
    def factor(self) -> float:
        """Simulated seconds per second of wall clock."""
        return self.update_rate * self.step_size


def parse_world_request(request: StartRequest) -> WorldRequest:
    """Parses the arguments of the request. Raises ProcessStartError."""
    try:
        given = parse_ros_arguments(request.command).parameters_of(NODE_NAME, "/")
    except InvalidRosArguments as problem:
        raise ProcessStartError(f"{request.where}flatland_server: {problem}") from None
    values = {name: parameter.value for name, parameter in given.items()}
    for name in sorted(values.keys() - PARAMETERS):
        near = nearest_name(name, PARAMETERS)
        hint = f"; did you mean '{near}'?" if near else ""
        raise ProcessStartError(f"{request.where}flatland_server has no parameter '{name}'{hint}")
    if "world_path" not in values:
        raise ProcessStartError(
            f"{request.where}flatland_server: the parameter 'world_path' is missing: "
            "parameters=[{'world_path': 'FILE.yaml'}]"
        )
    default = WorldRequest(Path())
    return WorldRequest(
        (request.cwd or Path.cwd()) / str(values["world_path"]),
        _positive_number(request, values, "update_rate", default.update_rate),
        _positive_number(request, values, "step_size", default.step_size),
        _boolean(request, values, "show_viz", default.show_viz),
        request.where,
    )


def _positive_number(request: StartRequest, values: dict[str, Any], name: str, default: float) -> float:
    value = values.get(name, default)
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if isinstance(value, bool) or not (math.isfinite(number) and number > 0):
        raise ProcessStartError(
            f"{request.where}flatland_server: '{name}' must be a number above 0, not {value!r}"
        )
    return number


def _boolean(request: StartRequest, values: dict[str, Any], name: str, default: bool) -> bool:
    value = values.get(name, default)
    if not isinstance(value, bool):
        raise ProcessStartError(
            f"{request.where}flatland_server: '{name}' must be true or false, not {value!r}"
        )
    return value
