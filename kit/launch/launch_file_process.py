"""A launch file in its process: asked what to do, told what has happened."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from kit.host import failure_messages
from kit.host.output import Printed
from kit.host.package_program import Installed
from kit.host.process import Child
from kit.host.protocol import Ended, Frame, Reply
from kit.host.sandbox.limits import DESK, MIB
from kit.host.wire import Json, ProtocolError
from kit.launch.program_lookup import DESK_BOUNDS, Bounds
from kit.launch.requests import Argument, Request, parse_request
from kit.ros.packages import SEARCH_VARIABLE

LIMITS: Final = replace(DESK, reply_s=10.0, frame=16 * MIB)


def declared_arguments(
    file: Path, folder: Path, search: Sequence[Path], bounds: Bounds = DESK_BOUNDS
) -> list[Argument]:
    """The arguments that a launch file declares, without carrying it out. Raises GuestError."""
    with _child(file, folder, search, {}, bounds, only_arguments=True) as child:
        requests = _requests(child, child.started())
    return [request for request in requests if isinstance(request, Argument)]


class LaunchFile:
    """One run of a launch file. Starts at once; ``begin`` waits. Whatever goes wrong is raised as GuestError."""

    def __init__(
        self,
        file: Path,
        folder: Path,
        search: Sequence[Path],
        arguments: Mapping[str, str],
        bounds: Bounds = DESK_BOUNDS,
    ) -> None:
        self._child = _child(file, folder, search, arguments, bounds, only_arguments=False)
        self.wake_ns: int | None = None
        """When it wants to go on by itself, in the launch's time."""

    def begin(self) -> list[Request]:
        """What it wants at once."""
        return self._take(self._child.started())

    def go_on(self, now_ns: int, happened: list[Json]) -> list[Request]:
        """What it wants now that this has happened, at this time of the launch."""
        return self._take(self._child.ask("tick", now_ns, happened))

    def take_output(self) -> Printed:
        """What the launch file itself has printed."""
        return self._child.take_output()

    def close(self) -> None:
        self._child.close()

    def _take(self, frame: Frame | None) -> list[Request]:
        requests = _requests(self._child, frame)
        self.wake_ns = frame.wake_ns if isinstance(frame, Reply) else None
        return requests


def _child(
    file: Path,
    folder: Path,
    search: Sequence[Path],
    arguments: Mapping[str, str],
    bounds: Bounds,
    *,
    only_arguments: bool,
) -> Child:
    # Whoever bounds a launch does not let it see the environment, nor be where the user is.
    is_desk = bounds.file_limits is None
    environment = dict(os.environ) if is_desk else {}
    installed = Installed(
        folder,
        Path.cwd() if is_desk else folder,
        {**environment, SEARCH_VARIABLE: os.pathsep.join(map(str, search))},
    )
    start = {"seed": 0, "arguments": dict(arguments), "only_arguments": only_arguments}
    return Child(
        "launch", file, start, limits=bounds.file_limits or LIMITS, level=bounds.level, installed=installed
    )


def _requests(child: Child, frame: Frame | None) -> list[Request]:
    try:
        if not isinstance(frame, (Reply, Ended)):
            raise ProtocolError("another kind of answer")
        return [parse_request(event) for event in frame.events]
    except (ProtocolError, TypeError) as problem:  # TypeError: too many or too few parts
        raise child.condemn(failure_messages.nonsense(str(problem))) from None
