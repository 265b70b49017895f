"""Ghosts to race against: the best recorded drive of each driver on a level, and the reference driver's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from kit.run.recording import Recording, RecordingError, load_recording, save_recording
from kit.school.game import leaderboard
from kit.school.game.levels import GameLevel
from kit.school.game.race import EDITION, DriverKind
from kit.school.game.reference_drives import drive_reference
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.run.scenario import Scenario

FOLDER: Final = "levels"
REFERENCE: Final = "reference"
MAX_CLASSMATES: Final = 3
"""Ghosts of classmates on a level."""


@dataclass(frozen=True, slots=True, eq=False)
class Ghost:
    """The poses of a former drive at every tick."""

    name: str
    """The driver: ``keys``, ``controller``, ``agent``, ``reference``, or a classmate's name."""
    seconds: float
    tracks: tuple[NDArray[np.float64], ...]
    """One array per robot, (ticks, 3) ``x y theta`` [m, m, rad]."""
    step_size: float
    """s"""

    def poses_at(self, time_s: float) -> list[tuple[float, float, float]]:
        """The poses at a time [s], one per robot; after the end of the drive the last ones."""
        tick = max(0, round(time_s / self.step_size))
        return [tuple(track[min(tick, len(track) - 1)].tolist()) for track in self.tracks if len(track)]

    def sampled_track(self) -> list[list[float]]:
        """The first robot's poses in steps of ``leaderboard.TRACK_STEP``, rounded: what classmates may see."""
        if not self.tracks:
            return []
        stride = max(1, round(leaderboard.TRACK_STEP / self.step_size))
        sampled: list[list[float]] = np.round(self.tracks[0][::stride], 3).tolist()
        return sampled


def ghosts_folder(workspace: Workspace) -> Path:
    """The folder of the recorded drives of levels."""
    return workspace.recordings / FOLDER


def save_ghost(workspace: Workspace, level: GameLevel, driver: DriverKind, recording: Recording) -> Path:
    """Saves a drive as the best one of its driver. Raises OSError."""
    file = ghost_file(workspace, level, driver)
    file.parent.mkdir(parents=True, exist_ok=True)
    save_recording(recording, file)
    return file


def load_ghost(workspace: Workspace, level: GameLevel, driver: DriverKind) -> Ghost | None:
    """Reads the best drive of one driver; None if there is none, it cannot be read, or it is of another map."""
    try:
        recording = load_recording(ghost_file(workspace, level, driver))
    except (RecordingError, OSError):
        return None
    scenario = level.find_scenario()
    if (recording.place, recording.case) != (scenario.name, level.case):
        return None
    return _ghost_of(driver.value, recording, scenario)


def load_ghosts(workspace: Workspace, level: GameLevel) -> tuple[Ghost, ...]:
    """Reads the ghosts of all drivers except the reference, fastest first."""
    ghosts = [load_ghost(workspace, level, driver) for driver in DriverKind]
    return tuple(sorted((each for each in ghosts if each is not None), key=lambda each: each.seconds))


@lru_cache(maxsize=8)
def reference_recording(level: GameLevel) -> Recording | None:
    """The reference drive of a level, driven again; None for a level without one."""
    try:
        return drive_reference(level)[1]
    except LookupError:
        return None


def load_reference_ghost(level: GameLevel) -> Ghost | None:
    """The ghost of the level's reference drive; None for a level without one."""
    recording = reference_recording(level)
    return None if recording is None else _ghost_of(REFERENCE, recording, level.find_scenario())


def classmate_ghosts(level: GameLevel) -> tuple[Ghost, ...]:
    """The fastest drives of others who have joined the leaderboard with a drive of this level, fastest first."""
    ghosts = []
    for entry in leaderboard.read_entries(leaderboard.leaderboard_folder()):
        if entry.level == level.id and not entry.is_mine and entry.track:
            track = np.array(entry.track, dtype=np.float64)
            ghosts.append(Ghost(entry.name, entry.seconds, (track,), leaderboard.TRACK_STEP))
    return tuple(ghosts[:MAX_CLASSMATES])


def ghost_file(workspace: Workspace, level: GameLevel, driver: DriverKind) -> Path:
    """The file of a driver's best drive; drives of the game's first edition have other names."""
    return ghosts_folder(workspace) / f"{level.id}.{driver.value}-{EDITION}.npz"


def _ghost_of(name: str, recording: Recording, scenario: Scenario) -> Ghost:
    tracks = tuple(recording.track(partner) for partner in scenario.partners)
    return Ghost(name, recording.ticks * recording.step_size, tracks, recording.step_size)
