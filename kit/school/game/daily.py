"""The daily challenge: the date chooses a level and a twist, the same for everybody, and a streak counts the days."""

from __future__ import annotations

import datetime
import random
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from kit.learning.tasks.goals import PatrolGoal
from kit.school.game.levels import GameLevel, UnknownLevel, all_levels, find_level
from kit.school.game.player_progress import drive_from_event
from kit.school.progress import EventKind, ProgressEvent

PREFIX: Final = "daily-"
_ID: Final = re.compile(rf"{PREFIX}(\d{{4}}-\d{{2}}-\d{{2}})")


def today() -> datetime.date:
    """The date where the player is."""
    return datetime.datetime.now().astimezone().date()


def daily_level(day: datetime.date) -> GameLevel:
    """The level of a day: one of the levels with a single robot, on every second day in fog. It is always open."""
    chance = random.Random(day.toordinal())
    levels = [each for each in all_levels() if each.world != "pair" and not isinstance(each.goal, PatrolGoal)]
    level = chance.choice(levels)
    fog = level.conditions.fog or chance.random() < 0.5
    title = f"{day.isoformat()}: {level.title}{' in fog' if fog else ''}"
    return replace(
        level,
        id=f"{PREFIX}{day.isoformat()}",
        title=title,
        opened_by=(),
        opened_by_lesson="",
        reference=level.reference_id,
        conditions=replace(level.conditions, fog=fog),
    )


def find_playable_level(name: str) -> GameLevel:
    """Finds a level as ``find_level`` does, or a daily one by its id, such as ``daily-2026-09-01``. Raises UnknownLevel."""
    found = _ID.fullmatch(name)
    if found is None:
        return find_level(name)
    try:
        return daily_level(datetime.date.fromisoformat(found[1]))
    except ValueError:
        raise UnknownLevel(f"There is no such day: {found[1]}.") from None


def streak(events: Sequence[ProgressEvent], today: datetime.date) -> int:
    """For how many days in a row, up to today or yesterday, the daily challenge was finished on its day."""
    days = set()
    for event in events:
        found = _ID.fullmatch(event.subject) if event.kind is EventKind.FINISH else None
        drive = drive_from_event(event) if found is not None else None
        if found is None or drive is None or not drive.finish.reached or drive.is_shipped:
            continue
        day = event.time.astimezone().date()
        if day.isoformat() == found[1]:
            days.add(day)
    last = today if today in days else today - datetime.timedelta(days=1)
    count = 0
    while last - datetime.timedelta(days=count) in days:
        count += 1
    return count
