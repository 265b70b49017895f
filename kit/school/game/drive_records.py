"""What is kept of a drive: an event always, and the recording where it is the driver's best."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from kit.run.recording import Recording
from kit.school.game import leaderboard
from kit.school.game.ghosts import keep
from kit.school.game.levels import Level, all_levels
from kit.school.game.player_progress import improves, standings
from kit.school.game.race import Driver, Finish
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace


@dataclass(frozen=True, slots=True)
class Noted:
    """What a drive earned."""

    stars: tuple[bool, bool, bool]
    """Of this drive: finished, safe, under par."""
    is_best: bool
    kept: Path | None
    """The recording, where it was kept as the driver's best."""


def note(
    journal: ProgressJournal,
    workspace: Workspace,
    level: Level,
    driver: Driver,
    finish: Finish,
    recording: Recording,
) -> Noted:
    """Notes a drive. A recording that cannot be written costs the ghost, not the stars. Raises ProgressError."""
    (before,) = standings([level], journal.events(EventKind.FINISH))
    is_best = improves(before, driver, finish)
    kept = None
    if is_best:
        try:
            kept = keep(workspace, level, driver.value, recording)
        except OSError:
            kept = None
    journal.add(EventKind.FINISH, level.id, finish.as_event(driver, None if kept is None else kept.name))
    _tell_the_hall(journal)
    return Noted(finish.stars(level.par), is_best, kept)


def _tell_the_hall(journal: ProgressJournal) -> None:
    """Brings the entry in the hall of fame up to date, where the player is in it."""
    folder = leaderboard.hall()
    if not leaderboard.has_joined(folder):
        return
    mine = next((each.name for each in leaderboard.entries(folder) if each.is_mine), "")
    name = mine or journal.student_name or "somebody"
    try:
        leaderboard.publish(folder, name, standings(all_levels(), journal.events(EventKind.FINISH)))
    except leaderboard.FameError:
        return  # the drive counts without it
