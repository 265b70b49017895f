"""Records a finished drive: always an event in the journal, and the recording where it is the driver's best.

The card of a drive: its path in dots, its time and its medal, as text to share.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from kit.render.encode import BrailleEncoder
from kit.render.scene import Disc, Scene, SceneMark, ScenePath
from kit.render.world_text import scene_rows
from kit.run.animation import AnimationSettings, export_recording
from kit.run.recording import Recording, RecordingError
from kit.school.game import leaderboard
from kit.school.game.challenges import all_challenges
from kit.school.game.daily import DAILY_PREFIX, daily_level, has_run, streak, today
from kit.school.game.ghosts import best_recordings, save_ghost
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.medal import Medal, medal_of
from kit.school.game.player_progress import (
    BY_HAND,
    DriverFacts,
    ExtraRule,
    belt_of,
    completed_lessons,
    is_best_drive,
    kept_rules,
    level_progress,
    open_level_after,
)
from kit.school.game.race import DriverKind, RaceFinish, middle_drive, run_again
from kit.school.game.references import reference_seconds
from kit.school.game.replayed_goal import show_goal
from kit.school.game.shared_answers import publish_answers
from kit.school.game.shared_drives import digest_of
from kit.school.game.starts import film_scenario
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import Workspace, write_atomically


@dataclass(frozen=True, slots=True)
class DriveRecord:
    """The result of recording one drive, or a program's drives from all starts."""

    counts: int
    """The number of the drive that counts: a program's middle one."""
    medal: Medal
    """Medal of that drive."""
    rules: tuple[ExtraRule, ...]
    """Extra rules that this drive kept."""
    new_rules: tuple[ExtraRule, ...]
    """Those that no drive before had kept."""
    is_shipped: bool
    """Whether one of the kit's own controllers drove, which earns nothing."""
    is_practice: bool
    """Whether a run of this day's level came before: only the first one counts."""
    is_best: bool
    replaces: bool
    """Whether it takes the place of a better one which this version of the kit drives differently, so that no board shows it."""
    previous_best: float | None
    """The driver's shortest time before [s]."""
    previous_medal: Medal
    unlocked: tuple[GameLevel, ...]
    """Other levels that this drive has opened."""
    following: GameLevel | None
    """The next level that is open; None after the last one, and after a day's."""
    belt: str
    """The belt of the level's world that this drive has earned; empty where it was earned before."""
    streak: int
    """For how many days in a row the daily challenge has been finished; 0 for another level."""
    recording: Path | None
    """The saved recording, where the drive is the driver's best; else None."""


def begin_run(journal: ProgressJournal, level: GameLevel) -> bool:
    """Records that a level of a day is driven from now on, so that a run which is left counts as well. Returns whether it is
    practice, as after the first run of the day. Raises ProgressError."""
    if not level.id.startswith(DAILY_PREFIX):
        return False
    is_practice = has_run(journal.events(subject=level.id), level)
    if not is_practice:
        journal.add(EventKind.START, level.id)
    return is_practice


def record_drive(
    journal: ProgressJournal,
    workspace: Workspace,
    level: GameLevel,
    driver: DriverKind,
    drives: Sequence[tuple[RaceFinish, Recording]],
    facts: DriverFacts = BY_HAND,
    *,
    is_practice: bool = False,
) -> DriveRecord:
    """Records a drive. Medals and stars count even where the recording cannot be written. Raises ProgressError.

    ``drives``: one by hand; of a program or an agent those from all starts, of which the middle one counts. ``is_practice``: as
    ``begin_run`` has said of it.
    """
    counts = middle_drive([finish for finish, _ in drives])
    finish = drives[counts][0]
    levels, events = all_levels(), journal.events()
    lessons = completed_lessons(levels, events)
    before = level_progress(levels, events, lessons)
    (of_level,) = level_progress([level], events)
    counts_as_own = not facts.is_shipped and not is_practice
    is_best = counts_as_own and is_best_drive(of_level, driver, finish)
    replaces = (
        counts_as_own
        and finish.reached
        and not is_best
        and not _drives_again(best_recordings(workspace, level, driver), level)
    )
    recording_file = None
    if is_best or replaces:
        try:
            recording_file = save_ghost(
                workspace, level, driver, [recording for _, recording in drives], counts
            )
        except OSError:
            recording_file = None
    earns = level.has_medals and not facts.is_shipped and not is_practice
    medal = medal_of(finish, reference_seconds(level), driver) if earns else Medal.NONE
    rules = kept_rules(level, finish, facts) if earns else ()
    content = {
        **finish.as_event(driver, None if recording_file is None else recording_file.name),
        "medal": medal.value,
        "rules": [rule.value for rule in rules],
        "shipped": facts.is_shipped,
    }
    if not is_practice:
        journal.add(EventKind.FINISH, level.id, content)
    events = journal.events(EventKind.FINISH)
    after = level_progress(levels, events, lessons)
    belt_before, belt = (
        belt_of([each.best_medal for each in progress if each.level.world == level.world])
        for progress in (before, after)
    )
    if is_best or replaces:
        _update_leaderboard(journal, workspace, level, driver)
    return DriveRecord(
        counts,
        medal,
        rules,
        tuple(rule for rule in rules if rule not in of_level.rules),
        facts.is_shipped,
        is_practice,
        is_best,
        replaces,
        of_level.best_times.get(driver),
        of_level.medals.get(driver, Medal.NONE),
        tuple(
            now.level
            for now, then in zip(after, before, strict=True)
            if now.is_open and not then.is_open and now.level != level
        ),
        open_level_after(after, level),
        "" if belt == belt_before else belt,
        streak(events, today()) if level.id.startswith(DAILY_PREFIX) else 0,
        recording_file,
    )


def _drives_again(recordings: Sequence[Recording], level: GameLevel) -> bool:
    """Whether the drive that counts, the first of these, is the same one when it is run again; False where there is none."""
    try:
        again = [run_again(level, each)[1] for each in recordings[:1]]
    except (RecordingError, ValueError):
        return False
    return bool(again) and digest_of(again[0]) == digest_of(recordings[0])


def join_leaderboard(journal: ProgressJournal, workspace: Workspace, name: str) -> None:
    """Puts the player's name, best drives and answers of puzzles on the leaderboard. Raises LeaderboardError and ProgressError."""
    drives = {
        (level.id, driver): recordings
        for level in (*all_levels(), daily_level(today()))
        for driver in DriverKind
        if (recordings := best_recordings(workspace, level, driver))
    }
    folder = leaderboard.leaderboard_folder()
    leaderboard.publish_drives(folder, name, drives)
    publish_answers(folder, workspace, all_challenges())


def _update_leaderboard(
    journal: ProgressJournal, workspace: Workspace, level: GameLevel, driver: DriverKind
) -> None:
    """Puts the player's best drive on the leaderboard, if the player has joined it."""
    folder = leaderboard.leaderboard_folder()
    recordings = best_recordings(workspace, level, driver)
    if not recordings or not leaderboard.has_joined(folder):
        return
    name = leaderboard.own_name(folder) or journal.student_name or "somebody"
    with suppress(leaderboard.LeaderboardError):  # the drive counts without it
        leaderboard.publish_drives(folder, name, {(level.id, driver): recordings})


COLUMNS, ROWS = 48, 14


def card_rows(
    level: GameLevel, driver: DriverKind, finish: RaceFinish, medal: Medal, recording: Recording
) -> list[str]:
    """The rows of the card, at most ``COLUMNS`` wide."""
    scenario = level.find_scenario()
    case = scenario.case
    tracks = [recording.track(name)[::5, :2] for name in scenario.partners]
    scene = Scene(
        walls=scenario.world.wall_segments,
        paths=tuple(ScenePath(track) for track in tracks if len(track) > 1),
        targets=() if case is None else (Disc(*case.target, case.target_radius),),
        marks=tuple(SceneMark(start.x, start.y, "S") for start in scenario.starts[:1]),
    )
    head = f"{level.title}  {finish.seconds:.2f} s"
    if level.has_medals:
        head += f"  {medal.title}"
    return [
        head,
        f"robot learning kit, {driver.phrase}",
        *scene_rows(scene, COLUMNS, ROWS, BrailleEncoder()),
    ]


def save_film(card: Path, level: GameLevel, recording: Recording) -> Path:
    """Writes a drive as a moving picture beside its card. Raises OSError and ExportError."""
    file = card.with_suffix(".gif")
    settings = AnimationSettings(speed=2.0)
    scenario = film_scenario(level, recording.seed)
    export_recording(recording, scenario, file, settings, title=level.title, prepare=show_goal)
    return file


def save_card(workspace: Workspace, level: GameLevel, driver: DriverKind, rows: list[str]) -> Path:
    """Writes a card as a text file into the workspace. Raises OSError."""
    folder = workspace.folder / "cards"
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{level.id}.{driver.value}.txt"
    write_atomically(file, ("\n".join(rows) + "\n").encode())
    return file
