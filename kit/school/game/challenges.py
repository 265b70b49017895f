"""The challenges of ``lessons/challenges.yaml``: read, found, prepared, and the medals that they have earned."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path
from typing import Final

from kit.plain_text import unknown_name
from kit.school.game.challenge import Challenge
from kit.school.game.challenge_kinds import challenge_kinds
from kit.school.game.judgement import Judgement
from kit.school.game.levels import all_levels
from kit.school.game.medal import Medal
from kit.school.game.player_progress import GameSummary, level_progress
from kit.school.lessons.reading import lessons_folder
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.workspace import Workspace
from kit.world.documents import open_document
from kit.world.yaml_section import Section

CHALLENGES_FILE: Final = "challenges.yaml"
BEGUN: Final = "begun"
"""The text of the event with which a clock begins, which is no check."""
PREFIX: Final = "challenge-"
"""Prefix of a challenge's subject in the journal."""


@cache
def all_challenges() -> tuple[Challenge, ...]:
    """Reads all challenges. Raises WorldError with all mistakes of the file."""
    file = lessons_folder() / CHALLENGES_FILE
    with open_document(file) as section:
        return tuple(_read_challenges(section, file.parent))


def _read_challenges(section: Section, folder: Path) -> Iterator[Challenge]:
    for each in section.sections("challenges", at_least=1):
        kind = challenge_kinds[each.text("kind", choices=tuple(challenge_kinds))]
        yield Challenge(
            each.name("id"),
            each.name("title"),
            each.text("story"),
            each.text("task"),
            each.text("form", ""),
            each.name("lesson"),
            kind.read(each, folder),
        )
        each.finish()


def find_challenge(name: str) -> Challenge:
    """Finds a challenge by its id or its title. Raises LookupError that offers the nearest one."""
    challenges = all_challenges()
    for each in challenges:
        if name.casefold() in (each.id, each.title.casefold()):
            return each
    raise LookupError(unknown_name("puzzle", name, [each.id for each in challenges], "kit game puzzle"))


def answers_folder(workspace: Workspace) -> Path:
    """The folder of the answers' files."""
    return workspace.folder / "puzzles"


def starts_clock(journal: ProgressJournal, challenge: Challenge) -> bool:
    """Whether a clock begins with the next look at a challenge. Raises ProgressError."""
    return challenge.task.clock is not None and not _looks(journal, challenge)


def challenge_events(journal: ProgressJournal, challenge: Challenge) -> list[ProgressEvent]:
    """What is recorded of a challenge, the oldest first: where a clock runs its first look, and each check. Raises ProgressError."""
    return journal.events(EventKind.FINISH, f"{PREFIX}{challenge.id}")


def _looks(journal: ProgressJournal, challenge: Challenge) -> list[float]:
    """When a challenge with a clock was looked at, or its answer judged [s since the epoch]."""
    return [event.time.timestamp() for event in challenge_events(journal, challenge)]


def prepare_answer(
    journal: ProgressJournal, challenge: Challenge, folder: Path, now_s: float | None = None
) -> tuple[Path | None, float]:
    """Makes the file of an answer in ``folder`` unless it is there; where a clock runs, it begins with the first look.

    Returns the file, None where the answer is none, and the seconds since the first look, infinite where no clock runs.
    Raises ProgressError and OSError.
    """
    file = challenge.task.prepare(folder / challenge.id, (challenge.written_task,))
    if challenge.task.clock is None:
        return file, math.inf
    now = time.time() if now_s is None else now_s
    begun = _looks(journal, challenge)
    if not begun:
        journal.add(EventKind.FINISH, f"{PREFIX}{challenge.id}", {"medal": 0, "text": BEGUN})
    return file, max(0.0, now - begun[0]) if begun else 0.0


def record_judgement(journal: ProgressJournal, challenge: Challenge, judgement: Judgement) -> None:
    """Records a medal. Raises ProgressError."""
    journal.add(
        EventKind.FINISH,
        f"{PREFIX}{challenge.id}",
        {"medal": judgement.medal.value, "text": judgement.text},
    )


def challenge_medals(events: list[ProgressEvent]) -> dict[str, Medal]:
    """The best medal of each challenge that has one, by its id."""
    best: dict[str, Medal] = {}
    for event in events:
        medal = int(event.number("medal") or 0)
        if event.kind is EventKind.FINISH and event.subject.startswith(PREFIX) and medal in tuple(Medal):
            name = event.subject.removeprefix(PREFIX)
            best[name] = max(best.get(name, Medal.NONE), Medal(medal))
    return best


def game_summary(events: list[ProgressEvent], lessons: Collection[str] = ()) -> GameSummary:
    """All that was won. ``lessons``: as of ``level_progress``. Raises WorldError and FileNotFoundError."""
    medals = challenge_medals(events)
    best = tuple(medals.get(each.id, Medal.NONE) for each in all_challenges())
    return GameSummary(level_progress(all_levels(), events, lessons), best)
