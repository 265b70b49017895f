"""Runs a launch file in a process of its own: sends it events, receives its requests."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from kit.host.failure import protocol_violation
from kit.host.output import ProgramOutput
from kit.host.process import PackageProgram, StudentProcess
from kit.host.protocol import Ended, Frame, Reply
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, MIB
from kit.host.wire import Json, ProtocolError
from kit.launch.program_lookup import INTERACTIVE_BOUNDS, LaunchBounds
from kit.launch.requests import DeclaredArgument, Request, parse_request
from kit.ros.packages import SEARCH_VARIABLE

LIMITS: Final = replace(INTERACTIVE_LIMITS, reply_s=10.0, frame=16 * MIB)


def declared_arguments(
    file: Path, folder: Path, search: Sequence[Path], bounds: LaunchBounds = INTERACTIVE_BOUNDS
) -> list[DeclaredArgument]:
    """The arguments that a launch file declares, without carrying it out. Raises StudentCodeError."""
    with _start_child(file, folder, search, {}, bounds, only_arguments=True) as child:
        requests = _parse_requests(child, child.wait_started(), Ended)
    return [request for request in requests if isinstance(request, DeclaredArgument)]


class LaunchFileProcess:
    """One run of a launch file; the process starts with the constructor. All failures are raised as StudentCodeError."""

    def __init__(
        self,
        file: Path,
        folder: Path,
        search: Sequence[Path],
        arguments: Mapping[str, str],
        bounds: LaunchBounds = INTERACTIVE_BOUNDS,
    ) -> None:
        self._process = _start_child(file, folder, search, arguments, bounds, only_arguments=False)
        self.wake_ns: int | None = None
        """When its next timer is due [ns of the launch's time]; None without timers."""

    def start(self) -> list[Request]:
        """Waits until the file is loaded; returns its first requests."""
        return self._read_requests(self._process.wait_started())

    def advance(self, now_ns: int, events: list[Json]) -> list[Request]:
        """Sends events at a time of the launch; returns the requests that follow."""
        return self._read_requests(self._process.request("tick", now_ns, events))

    def take_output(self) -> ProgramOutput:
        """Removes and returns what the launch file itself has printed."""
        return self._process.take_output()

    def close(self) -> None:
        self._process.close()

    def _read_requests(self, frame: Frame | None) -> list[Request]:
        requests = _parse_requests(self._process, frame, Reply)
        self.wake_ns = frame.wake_ns if isinstance(frame, Reply) else None
        return requests


def _start_child(
    file: Path,
    folder: Path,
    search: Sequence[Path],
    arguments: Mapping[str, str],
    bounds: LaunchBounds,
    *,
    only_arguments: bool,
) -> StudentProcess:
    # A bounded launch file sees neither the environment nor the user's working directory.
    environment = dict(os.environ) if bounds.is_interactive else {}
    package_program = PackageProgram(
        folder,
        Path.cwd() if bounds.is_interactive else folder,
        {**environment, SEARCH_VARIABLE: os.pathsep.join(map(str, search))},
    )
    start = {"seed": 0, "arguments": dict(arguments), "only_arguments": only_arguments}
    return StudentProcess(
        "launch",
        file,
        start,
        limits=bounds.file_limits or LIMITS,
        level=bounds.level,
        package=package_program,
    )


def _parse_requests(
    child: StudentProcess, frame: Frame | None, expected: type[Reply] | type[Ended]
) -> list[Request]:
    """Returns the requests of an answer: a launch file that runs replies, one that is only described has ended."""
    try:
        if not isinstance(frame, expected):
            raise ProtocolError("another kind of answer")
        return [parse_request(event) for event in frame.events]
    except (ProtocolError, TypeError) as problem:  # TypeError: too many or too few parts
        raise child.fail(protocol_violation(str(problem))) from None
