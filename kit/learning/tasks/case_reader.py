"""Reads the cases of a task file: where episodes start and end."""

from __future__ import annotations

import math
from dataclasses import dataclass

from kit.geometry import Pose
from kit.learning.tasks.goals.goal import Goal
from kit.learning.tasks.task_case import EpisodePlaces, TaskCase
from kit.plain_text import counted, quoted, suggestion
from kit.world.catalogue import MapCard
from kit.world.yaml_section import Section

START_KEYS = ("start", "starts", "start_area", "start_anywhere")
TARGET_KEYS = ("target", "targets", "target_area", "target_anywhere", "target_model")
MAX_PLACES = 1000


@dataclass(frozen=True, slots=True, eq=False)
class PlacedCase:
    """A case, and the section of the file that it was read from."""

    map_number: int
    case: TaskCase
    section: Section

    def error(self, message: str, keys: tuple[str, ...]) -> None:
        """Notes a problem at the first of these keys that the file has, or at the case."""
        key = next((key for key in keys if self.section.has(key)), None)
        self.section.error(message, key)


class CaseReader:
    """Reads the ``cases`` of a task on these maps for this many robots."""

    def __init__(self, cards: tuple[MapCard, ...], robots: int, goal: Goal) -> None:
        self._cards = cards
        self._robots = robots
        self._goal = goal

    def read(self, section: Section) -> tuple[PlacedCase, ...]:
        """The file's own cases; none where it leaves them to the maps."""
        if not section.has("cases"):
            if self._cards and not self._cards[0].cases:
                section.error('a task with its own world needs "cases": where episodes start and end')
            return ()
        found, names = [], set()
        for number, inner in enumerate(section.sections("cases", at_least=1)):
            case = self._read_case(inner, number)
            if case.case.name in names:
                inner.error(f"a case named {quoted(case.case.name)} already exists", "name")
            names.add(case.case.name)
            found.append(case)
        return tuple(found)

    def _read_case(self, section: Section, number: int) -> PlacedCase:
        case = TaskCase(
            name=section.name("name", f"case_{number + 1}"),
            starts=self._read_starts(section),
            targets=self._read_targets(section),
            start_shift=section.point("start_shift", (0.0, 0.0)),
            target_shift=section.point("target_shift", (0.0, 0.0)),
            is_heading_random=section.flag("any_heading", False),
            group=section.text("group", ""),
        )
        map_number = self._map_number(section)
        section.finish()
        return PlacedCase(map_number, case, section)

    def _map_number(self, section: Section) -> int:
        names = [card.name for card in self._cards]
        if not section.has("map"):
            if len(names) > 1:
                section.error(f'give its map: "map": {", ".join(names)}')
            return 0
        name = section.name("map")
        if name not in names:
            section.error(f"the task has no map {quoted(name)}: {suggestion(name, names)}", "map")
            return 0
        return names.index(name)

    def _read_starts(self, section: Section) -> tuple[EpisodePlaces, ...]:
        key = _only_key(section, START_KEYS)
        headings = _read_headings(section)
        if key == "start_area":
            area = _read_area(section, key)
            return (EpisodePlaces(area=area, headings=headings),) * self._robots
        if key == "start_anywhere":
            section.flag(key)
            return (EpisodePlaces(headings=headings),) * self._robots
        if key == "starts":
            first = section.poses(key, at_least=1, at_most=MAX_PLACES)
        else:
            first = (section.pose("start"),)
        return (EpisodePlaces(first), *self._other_starts(section, len(first)))

    def _other_starts(self, section: Section, count: int) -> tuple[EpisodePlaces, ...]:
        """The starts of the other robots: a pose for each of them, beside each start of the first one."""
        others = self._robots - 1
        if not others:
            if section.has("other_starts"):
                section.poses("other_starts", at_most=MAX_PLACES)
                section.error(
                    'one robot drives: without "robots" that name more, there are no other starts',
                    "other_starts",
                )
            return ()
        if not section.has("other_starts"):
            section.error(
                f'with {self._robots} robots it needs "other_starts": for each start, {counted(others, "pose")} of the other '
                f"{'robot' if others == 1 else 'robots'}"
            )
            return (EpisodePlaces((Pose(),) * count),) * others
        poses = section.poses("other_starts", at_least=others * count, at_most=others * count)
        poses = poses if len(poses) == others * count else (Pose(),) * (others * count)
        return tuple(EpisodePlaces(poses[robot::others]) for robot in range(others))

    def _read_targets(self, section: Section) -> EpisodePlaces:
        goal = self._goal
        key = _only_key(section, TARGET_KEYS, needed=goal.needs_target)
        if goal.needs_leader and key not in ("target_model", None):
            section.error(f'the goal {goal.kind} needs a "target_model": a model that moves', key)
        if goal.is_route and key not in ("targets", "target", None):
            section.error(f'the goal {goal.kind} needs "targets": a list of points', key)
        if key == "target_model":
            return EpisodePlaces(model=section.name(key))
        if key == "target_area":
            return EpisodePlaces(area=_read_area(section, key))
        if key == "target_anywhere":
            section.flag(key)
            return EpisodePlaces()
        if key == "targets":
            points = section.points(key, at_least=1, at_most=MAX_PLACES)
            return EpisodePlaces(tuple(Pose(x, y) for x, y in points) or (Pose(),))
        if key is None:
            return EpisodePlaces((Pose(),))
        x, y = section.point("target")
        return EpisodePlaces((Pose(x, y, self._target_heading(section)),))

    def _target_heading(self, section: Section) -> float:
        if self._goal.heading_tolerance is not None:
            return section.number("target_heading")
        if section.has("target_heading"):
            section.error('a heading at the target needs a goal with "heading_tolerance"', "target_heading")
        return 0.0


def _only_key(section: Section, keys: tuple[str, ...], *, needed: bool = True) -> str | None:
    """The one of these keys that the section has; the first of them, which will be missed, where it has none but needs one."""
    present = [key for key in keys if section.has(key)]
    for key in present[1:]:
        section.error(f"give {quoted(present[0])} or {quoted(key)}, not both", key)
    if not present:
        return keys[0] if needed else None
    return present[0]


def _read_area(section: Section, key: str) -> tuple[float, float, float, float]:
    x1, y1, x2, y2 = section.numbers(key, length=4)
    if section.has(key) and (x1 == x2 or y1 == y2):
        section.error(f"{quoted(key)} must be [x1, y1, x2, y2]: two opposite corners of a rectangle", key)
    return min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2)


def _read_headings(section: Section) -> tuple[float, float]:
    low, high = section.point("start_headings", (-math.pi, math.pi))
    if low > high:
        section.error('"start_headings" must be [least, greatest] in radians', "start_headings")
    return low, high
