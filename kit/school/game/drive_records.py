"""Records a finished drive: always an event in the journal, and the recording where it is the driver's best."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from kit.run.recording import Recording
from kit.school.game import leaderboard
from kit.school.game.ghosts import save_ghost
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.player_progress import is_best_drive, level_progress
from kit.school.game.race import DriverKind, RaceFinish
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace


@dataclass(frozen=True, slots=True)
class DriveRecord:
    """The result of recording one drive."""

    stars: tuple[bool, bool, bool]
    """Stars of this drive: finished, safe, under par."""
    is_best: bool
    recording: Path | None
    """The saved recording, where the drive is the driver's best; else None."""


def record_drive(
    journal: ProgressJournal,
    workspace: Workspace,
    level: GameLevel,
    driver: DriverKind,
    finish: RaceFinish,
    recording: Recording,
) -> DriveRecord:
    """Records a drive. The stars count even where the recording cannot be written. Raises ProgressError."""
    (before,) = level_progress([level], journal.events(EventKind.FINISH))
    is_best = is_best_drive(before, driver, finish)
    recording_file = None
    if is_best:
        try:
            recording_file = save_ghost(workspace, level, driver.value, recording)
        except OSError:
            recording_file = None
    journal.add(
        EventKind.FINISH,
        level.id,
        finish.as_event(driver, None if recording_file is None else recording_file.name),
    )
    _update_leaderboard(journal)
    return DriveRecord(finish.earned_stars(level.par), is_best, recording_file)


def _update_leaderboard(journal: ProgressJournal) -> None:
    """Updates the player's entry on the leaderboard, if the player has joined it."""
    folder = leaderboard.leaderboard_folder()
    if not leaderboard.has_joined(folder):
        return
    mine = next((each.name for each in leaderboard.read_entries(folder) if each.is_mine), "")
    name = mine or journal.student_name or "somebody"
    try:
        leaderboard.publish_entry(
            folder, name, level_progress(all_levels(), journal.events(EventKind.FINISH))
        )
    except leaderboard.LeaderboardError:
        return  # the drive counts without it
