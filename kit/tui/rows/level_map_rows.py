"""Worlds of levels as maps in characters: where each level stands and what opens what."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Final

from kit.document.rows import Row
from kit.school.game.medal import Medal
from kit.school.game.player_progress import LevelProgress
from kit.tui.rows.medal_signs import MEDAL_SIGNS

GAP: Final = 4
"""Columns between two pictures, for the lines."""
MOST_COLUMNS, LEAST_COLUMNS = 24, 12
MOST_ROWS, LEAST_ROWS = 8, 3
"""Most and fewest rows of a picture; where there are fewer, titles stand alone."""
RIGHT, LEFT, UP, DOWN = 1, 2, 4, 8
"""Directions in which a line leaves a character."""


@dataclass(frozen=True, slots=True)
class LevelPlace:
    """Where a level stands on the map, in characters from the map's left upper corner."""

    level: str
    x: int
    y: int
    """Row of its title; the picture is below."""
    columns: int
    rows: int
    """Rows of the picture; 0 for a title alone."""


def map_places(standings: Sequence[LevelProgress], width: int, height: int) -> tuple[LevelPlace, ...]:
    """Places the levels of a world: each to the right of all that open it, with a picture where there is room, else its title
    alone. Empty where there is no room for titles."""
    depths: dict[str, int] = {}
    for each in standings:  # a level comes after those that open it
        before = [depths[name] for name in each.level.opened_by if name in depths]
        depths[each.level.id] = max(before, default=-1) + 1
    count = max(depths.values(), default=0) + 1
    by_depth = [[name for name, depth in depths.items() if depth == number] for number in range(count)]
    most = max((len(names) for names in by_depth), default=1)
    columns = min(MOST_COLUMNS, (width - 1 - GAP * (count - 1)) // count)
    rows = min(MOST_ROWS, (height + 1) // most - 2)
    rows = rows if rows >= LEAST_ROWS else 0
    pitch = rows + 2 if rows or 2 * most - 1 <= height else 1
    if columns < LEAST_COLUMNS or most * pitch > height + 1 or most > height:
        return ()
    places = []
    for depth, names in enumerate(by_depth):
        top = (most - len(names)) * pitch // 2
        places += [
            LevelPlace(name, 1 + depth * (columns + GAP), top + number * pitch, columns, rows)
            for number, name in enumerate(names)
        ]
    return tuple(places)


def level_at(places: Sequence[LevelPlace], x: int, y: int) -> str | None:
    """The level whose title or picture is at this character of the map.

    >>> level_at([LevelPlace("maze", 1, 0, 12, 3)], 12, 3), level_at([LevelPlace("maze", 1, 0, 12, 3)], 13, 3)
    ('maze', None)
    """
    for place in places:
        if 0 <= x - place.x < place.columns and 0 <= y - place.y <= place.rows:
            return place.level
    return None


def map_rows(
    standings: Sequence[LevelProgress],
    places: Sequence[LevelPlace],
    pictures: Mapping[str, Sequence[str]],
    chosen: str,
) -> list[Row]:
    """The map as rows of text. ``pictures``: the rows of each level's picture; one that is missing stays blank."""
    if not places:
        return []
    width = max(place.x + place.columns for place in places) + 1
    height = max(place.y + place.rows for place in places) + 1
    signs = [[(" ", "") for _ in range(width)] for _ in range(height)]
    by_level = {place.level: place for place in places}
    for y, line in enumerate(_connection_lines(standings, by_level, width, height)):
        for x, sign in enumerate(line):
            signs[y][x] = sign, "dim"
    for each in standings:
        place = by_level[each.level.id]
        medal = MEDAL_SIGNS[each.best_medal] if each.best_medal else " "
        title = f"{medal} {each.level.title}" if each.is_open else f"({each.level.title})"
        style = "key" if each.level.id == chosen else "" if each.is_open else "dim"
        _write_signs(
            signs,
            place.x,
            place.y,
            title[: place.columns + 1].ljust(place.columns),  # its bracket may stand in the gap
            style,
        )
        style = "warn" if each.best_medal >= Medal.GOLD else "" if each.is_open else "dim"
        for number, text in enumerate(pictures.get(each.level.id, ())[: place.rows]):
            _write_signs(
                signs, place.x, place.y + 1 + number, text[: place.columns].ljust(place.columns), style
            )
    return [
        tuple(("".join(sign for sign, _ in run), style) for style, run in groupby(line, lambda each: each[1]))
        for line in signs
    ]


def _write_signs(signs: list[list[tuple[str, str]]], x: int, y: int, text: str, style: str) -> None:
    for number, sign in enumerate(text):
        signs[y][x + number] = sign, style


def _connection_lines(
    standings: Sequence[LevelProgress], places: Mapping[str, LevelPlace], width: int, height: int
) -> list[str]:
    """The lines from each level to those in the next column that it opens, ending in an arrow."""
    ways = [[0] * width for _ in range(height)]
    arrows = set()
    for each in standings:
        end = places[each.level.id]
        for name in each.level.opened_by:
            begin = places.get(name)
            if begin is None or begin.x + begin.columns + GAP != end.x:
                continue
            x, middle = begin.x + begin.columns, begin.x + begin.columns + GAP // 2
            first, last = (place.y + (place.rows + 1) // 2 for place in (begin, end))
            _trace_line(ways, [(x, first), (middle, first), (middle, last), (end.x - 1, last)])
            arrows.add((end.x - 1, last))
    return [
        "".join("▶" if (x, y) in arrows else _SIGNS[way] for x, way in enumerate(line))
        for y, line in enumerate(ways)
    ]


def _trace_line(ways: list[list[int]], corners: Sequence[tuple[int, int]]) -> None:
    """Leaves in each character on the way the directions in which the line goes on."""
    for (x, y), (end_x, end_y) in pairwise(corners):
        while (x, y) != (end_x, end_y):
            step_x, step_y = (end_x > x) - (end_x < x), (end_y > y) - (end_y < y)
            there, back = (RIGHT, LEFT) if step_x else (DOWN, UP) if step_y > 0 else (UP, DOWN)
            ways[y][x] |= there
            x, y = x + step_x, y + step_y
            ways[y][x] |= back


_SIGNS: Final = {
    0: " ", RIGHT: "─", LEFT: "─", RIGHT | LEFT: "─", UP: "│", DOWN: "│", UP | DOWN: "│",
    RIGHT | DOWN: "┌", LEFT | DOWN: "┐", RIGHT | UP: "└", LEFT | UP: "┘",
    RIGHT | LEFT | DOWN: "┬", RIGHT | LEFT | UP: "┴", RIGHT | UP | DOWN: "├", LEFT | UP | DOWN: "┤",
    RIGHT | LEFT | UP | DOWN: "┼",
}  # fmt: skip
"""The character for the directions in which lines leave it."""
