"""Reads the game's levels: map and case, par time, and the levels that open each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.plain_text import quoted, suggestion
from kit.run.scenario import Scenario, find_scenario
from kit.school.lessons.reading import lessons_folder
from kit.world.documents import WorldDocuments
from kit.world.files import AllowedRoot
from kit.world.problems import ProblemCollector, WorldError
from kit.world.records import SourceLocation as At
from kit.world.yaml_section import Section

LEVELS_FILE: Final = "levels.yaml"


class UnknownLevel(LookupError):
    """No level has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class GameLevel:
    """One level."""

    id: str
    title: str
    map_name: str
    """Name of a map of the kit."""
    case: str
    par: float
    """Time to beat [s]."""
    hint: str
    opened_by: tuple[str, ...]
    """Ids of levels; finishing any of them opens this one. Empty: it is open from the start."""
    row: int
    """Row on the map of levels: the smallest number of levels before it."""
    opened_by_lesson: str = ""
    """Name of the lesson that opens it too, ``01-drive``; may be empty."""

    @property
    def opened_text(self) -> str:
        """What the end of the lesson that opens it says of it."""
        return f"It opens the level {self.title} of the game. To drive it: kit game play {self.id}"

    def find_scenario(self) -> Scenario:
        """Loads the scenario that is driven. Raises LookupError and WorldError."""
        return find_scenario(self.map_name, self.case, None)


def all_levels(folder: Path | None = None) -> tuple[GameLevel, ...]:
    """Reads all levels in order. Raises WorldError with all mistakes of the file."""
    file = (lessons_folder() if folder is None else folder) / LEVELS_FILE
    problems = ProblemCollector()
    section = WorldDocuments(AllowedRoot.of_folder(file.parent), {}, problems).section(file, At(file))
    problems.raise_if_any()
    assert section is not None  # None is noted as a problem
    levels = tuple(_read_levels(section))
    section.finish()
    problems.raise_if_any()
    return levels


def levels_of_lesson(name: str, levels: tuple[GameLevel, ...] | None = None) -> tuple[GameLevel, ...]:
    """The levels that a lesson opens. ``name``: of the lesson, ``01-drive``."""
    return tuple(
        each for each in (all_levels() if levels is None else levels) if each.opened_by_lesson == name
    )


def find_level(name: str, levels: tuple[GameLevel, ...] | None = None) -> GameLevel:
    """Finds a level by its id or its number, counted from 1. Raises UnknownLevel."""
    levels = all_levels() if levels is None else levels
    for number, level in enumerate(levels, 1):
        if name in (level.id, str(number)):
            return level
    ids = [level.id for level in levels]
    raise UnknownLevel(f"There is no level {quoted(name)}: {suggestion(name, ids)}. `kit game` lists them.")


def _read_levels(section: Section) -> Iterator[GameLevel]:
    rows: dict[str, int] = {}
    for each in section.sections("levels", at_least=1):
        identity = each.name("id")
        after = each.texts("after", ())
        for before in after:
            if before not in rows:
                each.error(
                    f"no level {quoted(before)} stands before this one: {suggestion(before, tuple(rows))}",
                    "after",
                )
        row = 1 + max((rows.get(before, 0) for before in after), default=-1)
        if identity in rows:
            each.error(f"a level {quoted(identity)} exists already", "id")
        rows[identity] = row
        level = GameLevel(
            id=identity,
            title=each.name("title"),
            map_name=each.name("place"),
            case=each.name("case"),
            par=each.number("par", above=0, maximum=3600),
            hint=each.text("hint"),
            opened_by=after,
            row=row,
            opened_by_lesson=each.name("lesson") if each.has("lesson") else "",
        )
        each.finish()
        try:
            level.find_scenario()
        except (LookupError, WorldError) as error:
            each.error(str(error), "place")
            continue
        yield level
