"""The reference drives that ship with the kit: their commands, their times, and the drives themselves, driven again."""

from __future__ import annotations

import json
import math
from collections import OrderedDict
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Final

from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.recording import Recording
from kit.run.session import Session
from kit.school.game.drive_commands import DriveCommand, ReferenceDrive
from kit.school.game.levels import GameLevel
from kit.school.game.race import RaceFinish, run_race
from kit.school.lessons.reading import lessons_folder

DRIVES_FILE: Final = "reference_drives.json"


def drives_file() -> Path:
    """The file of all reference drives. Raises FileNotFoundError where the lessons are missing."""
    return lessons_folder() / DRIVES_FILE


@cache
def load_drives() -> dict[str, ReferenceDrive]:
    """The reference drive of each level that has one, by the level's id; none where there is no such file."""
    try:
        content = json.loads(drives_file().read_text())
    except FileNotFoundError:
        return {}
    return {
        level: ReferenceDrive(
            tuple(DriveCommand(int(ticks), speed, turn) for ticks, speed, turn in drive["commands"]),
            drive["seconds"],
        )
        for level, drive in content.items()
    }


def reference_seconds(level: GameLevel) -> float | None:
    """The time of a level's reference drive [s]; None for a level without one."""
    drive = find_drive(level)
    return None if drive is None else drive.seconds


def find_drive(level: GameLevel) -> ReferenceDrive | None:
    """The reference drive of a level; None for a level without one."""
    return level.drive or load_drives().get(level.reference_id)


def drive_reference(
    level: GameLevel,
    drive: ReferenceDrive | None = None,
    on_second: Callable[[float], None] | None = None,
) -> tuple[RaceFinish, Recording]:
    """Drives a level's reference drive, or another one; calls ``on_second`` with the race's time [s] now and then.
    Raises LookupError for a level that has none."""
    if drive is None:
        drive = find_drive(level)
        if drive is None:
            raise LookupError(f"There is no reference drive of {level.title}.")
    chosen = drive
    return run_race(
        level,
        level.find_scenario(),
        lambda session: session.runner.participants.append(CommandPlayer(session, chosen)),
        on_second,
    )


class CommandPlayer:
    """Gives the robots of a session the commands of a drive; the last one is held."""

    def __init__(self, session: Session, drive: ReferenceDrive) -> None:
        self._session = session
        self._scenario = session.scenario
        starts = self._scenario.starts
        self._half_gap = 0.5 * math.dist(starts[0][:2], starts[1][:2]) if len(starts) > 1 else 0.0
        self._due: dict[int, DriveCommand] = {}
        tick = 0
        for command in drive.commands:
            self._due[tick] = command
            tick += command.ticks

    def exchange(self) -> bool:
        """Publishes the command that begins at this tick, if one does."""
        command = self._due.pop(self._session.runner.simulation.tick, None)
        if command is None:
            return False
        for name, offset in zip(self._scenario.partners, (-self._half_gap, self._half_gap), strict=False):
            twist = Twist(
                linear=Vector3(x=command.speed + command.turn * offset), angular=Vector3(z=command.turn)
            )
            for topic in self._session.command_topics(name):
                self._session.runner.accept(topic, twist)
        return False


_RECORDINGS: OrderedDict[GameLevel, Recording] = OrderedDict()
MAX_RECORDINGS: Final = 8
"""Reference drives that are kept in memory."""


def reference_recording(
    level: GameLevel, on_progress: Callable[[float], None] | None = None
) -> Recording | None:
    """The reference drive of a level, driven again; None for a level without one. Calls ``on_progress`` with the share,
    0 to 1, that has been driven."""
    seconds = reference_seconds(level)
    if seconds is None:
        return None
    recording = _RECORDINGS.get(level)
    if recording is None:

        def share(driven: float) -> None:
            if on_progress is not None:
                on_progress(min(1.0, driven / max(seconds, 1e-9)))

        recording = _RECORDINGS[level] = drive_reference(level, on_second=share)[1]
        if len(_RECORDINGS) > MAX_RECORDINGS:
            _RECORDINGS.popitem(last=False)
    return recording
