"""Ghosts: the best drives of a level so far, kept as recordings, and the reference's."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from kit.run.recording import Recording, RecordingError, load, save
from kit.school.game.levels import Level
from kit.school.game.race import Driver, reference
from kit.workspace import Workspace

FOLDER: Final = "levels"
REFERENCE: Final = "reference"


@dataclass(frozen=True, slots=True, eq=False)
class Ghost:
    """Where somebody was, at every tick of a former drive."""

    name: str
    """Whose: ``keys``, ``controller``, ``agent`` or ``reference``."""
    seconds: float
    tracks: tuple[NDArray[np.float64], ...]
    """For each who drove, (ticks, 3) ``x y theta`` [m, m, rad]."""
    step: float
    """s"""

    def poses(self, time_s: float) -> list[tuple[float, float, float]]:
        """Where they were then; at the end they stay."""
        tick = max(0, round(time_s / self.step))
        return [tuple(track[min(tick, len(track) - 1)].tolist()) for track in self.tracks if len(track)]


def folder(workspace: Workspace) -> Path:
    """Where the drives of levels are kept."""
    return workspace.recordings / FOLDER


def keep(workspace: Workspace, level: Level, name: str, recording: Recording) -> Path:
    """Keeps a drive as the best of its driver. Raises OSError."""
    file = _file(workspace, level, name)
    file.parent.mkdir(parents=True, exist_ok=True)
    save(recording, file)
    return file


def ghost(workspace: Workspace, level: Level, name: str) -> Ghost | None:
    """The best drive so far of one driver; None if there is none, or it cannot be read, or is of another map."""
    try:
        recording = load(_file(workspace, level, name))
    except (RecordingError, OSError):
        return None
    place = level.find()
    if (recording.place, recording.case) != (place.name, level.case):
        return None
    tracks = tuple(recording.track(partner) for partner in place.partners)
    return Ghost(name, recording.ticks * recording.step_size, tracks, recording.step_size)


def reference_ghost(workspace: Workspace, level: Level) -> Ghost | None:
    """The reference's drive; driven when first asked for, which takes a few seconds, and kept."""
    name = f"{REFERENCE}-{_version()}"
    found = ghost(workspace, level, name)
    if found is None:
        finish, recording = reference(level)
        if not finish.reached:
            return None
        with suppress(OSError):
            keep(workspace, level, name, recording)
        tracks = tuple(recording.track(partner) for partner in level.find().partners)
        found = Ghost(REFERENCE, recording.ticks * recording.step_size, tracks, recording.step_size)
    return Ghost(REFERENCE, found.seconds, found.tracks, found.step)


def ghosts(workspace: Workspace, level: Level) -> tuple[Ghost, ...]:
    """Everybody's that is kept, the quickest first; without the reference."""
    found = [ghost(workspace, level, driver.value) for driver in Driver]
    return tuple(sorted((each for each in found if each is not None), key=lambda each: each.seconds))


def _file(workspace: Workspace, level: Level, name: str) -> Path:
    return folder(workspace) / f"{level.id}.{name}.npz"


def _version() -> str:
    try:
        return version("robot-learning-kit")
    except PackageNotFoundError:
        return "0"
