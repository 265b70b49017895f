"""Ghosts to race against: the best recorded drive of each driver on a level, and the reference driver's."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from kit.run.recording import Recording, RecordingError, load_recording, save_recording
from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind, drive_reference
from kit.workspace import Workspace

FOLDER: Final = "levels"
REFERENCE: Final = "reference"


@dataclass(frozen=True, slots=True, eq=False)
class Ghost:
    """The poses of a former drive at every tick."""

    name: str
    """The driver: ``keys``, ``controller``, ``agent`` or ``reference``."""
    seconds: float
    tracks: tuple[NDArray[np.float64], ...]
    """One array per robot, (ticks, 3) ``x y theta`` [m, m, rad]."""
    step_size: float
    """s"""

    def poses_at(self, time_s: float) -> list[tuple[float, float, float]]:
        """The poses at a time [s], one per robot; after the end of the drive the last ones."""
        tick = max(0, round(time_s / self.step_size))
        return [tuple(track[min(tick, len(track) - 1)].tolist()) for track in self.tracks if len(track)]


def ghosts_folder(workspace: Workspace) -> Path:
    """The folder of the recorded drives of levels."""
    return workspace.recordings / FOLDER


def save_ghost(workspace: Workspace, level: GameLevel, name: str, recording: Recording) -> Path:
    """Saves a drive as the best one of its driver. Raises OSError."""
    file = _ghost_file(workspace, level, name)
    file.parent.mkdir(parents=True, exist_ok=True)
    save_recording(recording, file)
    return file


def load_ghost(workspace: Workspace, level: GameLevel, name: str) -> Ghost | None:
    """Reads the best drive of one driver; None if there is none, it cannot be read, or it is of another map."""
    try:
        recording = load_recording(_ghost_file(workspace, level, name))
    except (RecordingError, OSError):
        return None
    scenario = level.find_scenario()
    if (recording.place, recording.case) != (scenario.name, level.case):
        return None
    tracks = tuple(recording.track(partner) for partner in scenario.partners)
    return Ghost(name, recording.ticks * recording.step_size, tracks, recording.step_size)


def load_reference_ghost(workspace: Workspace, level: GameLevel) -> Ghost | None:
    """Reads the reference driver's drive. The first call drives it, which takes a few seconds, and saves it."""
    name = f"{REFERENCE}-{_kit_version()}"
    ghost = load_ghost(workspace, level, name)
    if ghost is None:
        finish, recording = drive_reference(level)
        if not finish.reached:
            return None
        with suppress(OSError):
            save_ghost(workspace, level, name, recording)
        tracks = tuple(recording.track(partner) for partner in level.find_scenario().partners)
        ghost = Ghost(REFERENCE, recording.ticks * recording.step_size, tracks, recording.step_size)
    return Ghost(REFERENCE, ghost.seconds, ghost.tracks, ghost.step_size)


def load_ghosts(workspace: Workspace, level: GameLevel) -> tuple[Ghost, ...]:
    """Reads the ghosts of all drivers except the reference, fastest first."""
    ghosts = [load_ghost(workspace, level, driver.value) for driver in DriverKind]
    return tuple(sorted((each for each in ghosts if each is not None), key=lambda each: each.seconds))


def _ghost_file(workspace: Workspace, level: GameLevel, name: str) -> Path:
    return ghosts_folder(workspace) / f"{level.id}.{name}.npz"


def _kit_version() -> str:
    try:
        return version("robot-learning-kit")
    except PackageNotFoundError:
        return "0"
