"""Drives to race against: the reference's, each driver's best, classmates', and splits between two drives."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.run.recording import Recording, RecordingError, load_recording, save_recording
from kit.run.scenario import Scenario
from kit.school.game import leaderboard
from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_recording
from kit.workspace import Workspace

FOLDER: Final = "levels"
UNFINISHED: Final = "unfinished.npz"
REFERENCE: Final = "reference"
MAX_CLASSMATES: Final = 3
"""Ghosts of classmates on a level."""


@dataclass(frozen=True, slots=True, eq=False)
class Ghost:
    """The poses of a former drive at every tick."""

    name: str
    """The driver: ``keys``, ``controller``, ``agent``, ``reference``, or a classmate's name."""
    seconds: float
    tracks: tuple[FloatArray, ...]
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


def save_ghost(
    workspace: Workspace,
    level: GameLevel,
    driver: DriverKind,
    recordings: Sequence[Recording],
    counts: int = 0,
) -> Path:
    """Saves the best drive of a driver, and beside it a program's drives from the other starts. ``counts``: the number of
    the one that counts. Returns its file. Raises OSError."""
    file = ghost_file(workspace, level, driver)
    file.parent.mkdir(parents=True, exist_ok=True)
    for stale in other_start_files(workspace, level, driver):
        stale.unlink(missing_ok=True)
    for number, recording in enumerate(recordings):
        name = file if number == counts else file.with_suffix(f".{recording.seed}.npz")
        save_recording(recording, name)
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


def load_reference_ghost(
    level: GameLevel, on_progress: Callable[[float], None] | None = None
) -> Ghost | None:
    """The ghost of the level's reference drive; None for a level without one. ``on_progress``: as of
    ``reference_recording``."""
    recording = reference_recording(level, on_progress)
    return None if recording is None else _ghost_of(REFERENCE, recording, level.find_scenario())


def classmate_ghosts(level: GameLevel) -> tuple[Ghost, ...]:
    """The fastest drives of others who have joined the leaderboard with a drive of this level, fastest first."""
    entries = leaderboard.read_entries(leaderboard.leaderboard_folder(), [level])
    others = [each for each in entries if not each.is_mine][:MAX_CLASSMATES]
    return tuple(Ghost(each.name, each.seconds, each.tracks, each.step_size) for each in others)


def level_ghosts(
    workspace: Workspace | None, level: GameLevel, on_progress: Callable[[float], None] | None = None
) -> tuple[Ghost, ...]:
    """All ghosts of a level: one's own best drives (none without a workspace), the reference, and classmates.
    Drives the reference if nobody has yet; ``on_progress``: as of ``reference_recording``."""
    reference = load_reference_ghost(level, on_progress)
    own = () if workspace is None else load_ghosts(workspace, level)
    return (*own, *([] if reference is None else [reference]), *classmate_ghosts(level))


def ghost_file(workspace: Workspace, level: GameLevel, driver: DriverKind) -> Path:
    """The file of a driver's best drive."""
    return ghosts_folder(workspace) / f"{level.id}.{driver.value}.npz"


def unfinished_file(workspace: Workspace) -> Path:
    """The file of the last drive by hand that the end of the kit, such as a dropped link, has cut short. It is deleted when
    that drive goes on."""
    return ghosts_folder(workspace) / UNFINISHED


def load_unfinished(workspace: Workspace) -> Recording | None:
    """The drive that was cut short; None if there is none, or it cannot be read. ``level`` of it says where."""
    try:
        return load_recording(unfinished_file(workspace))
    except (RecordingError, OSError):
        return None


def best_recordings(workspace: Workspace, level: GameLevel, driver: DriverKind) -> list[Recording]:
    """The recordings of a driver's best drive, of a program those from all its starts; none where one cannot be read."""
    files = [ghost_file(workspace, level, driver), *other_start_files(workspace, level, driver)]
    try:
        return [load_recording(file) for file in files]
    except (RecordingError, OSError):
        return []


def other_start_files(workspace: Workspace, level: GameLevel, driver: DriverKind) -> list[Path]:
    """The files of a program's drives from the starts whose drive does not count, in no order."""
    return list(ghosts_folder(workspace).glob(f"{level.id}.{driver.value}.*.npz"))


def _ghost_of(name: str, recording: Recording, scenario: Scenario) -> Ghost:
    tracks = tuple(recording.track(partner) for partner in scenario.partners)
    return Ghost(name, recording.ticks * recording.step_size, tracks, recording.step_size)


SECTORS: Final = 3
"""A drive is divided into this many parts of equal length."""
NEAR: Final = 0.8
"""A place counts as passed within this distance of it [m]."""
LEEWAY: Final = 0.1
"""A passage may be so much farther away than a later one [m]."""
GAIN_TICKS: Final = 25
"""Of one part of a drive that is coloured by what it gained."""
PUT_BACK, PUT_BACK_SPEED = 0.1, 1.0
"""A robot that has moved farther than this [m] and faster [m/s] was put back."""


@dataclass(frozen=True, slots=True)
class Split:
    """One sector of a drive."""

    time: float
    """When its end was passed [s]."""
    sector: float
    """Time from the end of the sector before [s]."""
    difference: float
    """How much longer the sector took than it took the other drive [s]; negative: shorter."""


class GhostComparison:
    """Compares a drive, pose by pose, with a ghost: where the ghost was when it stood at the same place."""

    def __init__(self, ghost: Ghost) -> None:
        track = ghost.tracks[0][:, :2] if ghost.tracks else np.zeros((0, 2))
        self._ghost = ghost
        self._track: FloatArray = track[np.isfinite(track).all(axis=1)]
        self._window = max(1, round(1.5 / ghost.step_size))
        along = (
            np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self._track, axis=0).T))])
            if len(track)
            else track
        )
        ends = [along[-1] * number / SECTORS for number in range(1, SECTORS)] if len(track) else []
        self._ends = [int(np.searchsorted(along, end)) for end in ends]
        self._last: tuple[float, float, float] | None = None
        self._begin()

    def _begin(self) -> None:
        self._at = 0
        self._passed: list[tuple[float, float]] = []

    def update(self, time_s: float, x: float, y: float) -> float | None:
        """The time [s] by which the drive is behind the ghost at this place, negative if ahead; None away from its way.

        A robot that was put back to its start after a bump begins the ghost's way once more.
        """
        if self._last is not None:
            before, *place = self._last
            if math.dist(place, (x, y)) > PUT_BACK + PUT_BACK_SPEED * (time_s - before):
                self._begin()
        self._last = time_s, x, y
        window = self._track[self._at : self._at + self._window]
        if not len(window):
            return None
        distances = np.hypot(window[:, 0] - x, window[:, 1] - y)
        least = float(distances.min())
        if least > NEAR:
            return None
        # Where the ghost comes by again, on its way back, its first passage counts.
        leaves = np.append(np.diff(distances) > 0.0, True)
        self._at += int((leaves & (distances <= least + LEEWAY)).argmax())
        while len(self._passed) < len(self._ends) and self._at >= self._ends[len(self._passed)]:
            self._passed.append((time_s, self._ends[len(self._passed)] * self._ghost.step_size))
        return time_s - self._at * self._ghost.step_size

    def splits(self, finish_s: float) -> tuple[Split, ...]:
        """All sectors of a drive that has ended; none where its way was another."""
        if len(self._passed) < len(self._ends) or not self._ends:
            return ()
        times = [*self._passed, (finish_s, self._ghost.seconds)]
        before = (0.0, 0.0)
        found = []
        for mine, theirs in times:
            sector = mine - before[0]
            found.append(Split(mine, sector, sector - (theirs - before[1])))
            before = mine, theirs
        return tuple(found)


def gains_along(track: FloatArray, step_size: float, ghost: Ghost) -> FloatArray:
    """How much each part of a recorded drive gained on a ghost: (k, 5) ``x y x y`` of a part's ends [m], and the seconds that
    it gained; nan away from the ghost's way."""
    comparison = GhostComparison(ghost)
    rows = []
    before: tuple[float, float, float | None] | None = None
    for tick in range(0, len(track), GAIN_TICKS):
        x, y = float(track[tick, 0]), float(track[tick, 1])
        behind = comparison.update(tick * step_size, x, y)
        if before is not None:
            gain = math.nan if behind is None or before[2] is None else before[2] - behind
            rows.append((before[0], before[1], x, y, gain))
        before = x, y, behind
    return np.array(rows, dtype=np.float64).reshape(-1, 5)


def compare_tracks(track: FloatArray, step_size: float, ghost: Ghost, finish_s: float) -> tuple[Split, ...]:
    """The splits of a whole recorded drive, ``track`` (ticks, 3), against a ghost."""
    comparison = GhostComparison(ghost)
    for tick in range(0, len(track), 5):
        comparison.update(tick * step_size, float(track[tick, 0]), float(track[tick, 1]))
    return comparison.splits(finish_s)
