"""Pictures of levels and lessons: small ones as text, the scene beside a list, the ways and letters of ghosts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from typing import Final

import numpy as np

from kit.document.rows import Row, row, side_by_side
from kit.render.encode import ASCII_GLYPHS, ENCODERS, UNICODE_GLYPHS
from kit.render.floor_plan import floor_plan
from kit.render.roles import Role
from kit.render.scene import Disc, Scene, SceneMark, ScenePath
from kit.render.world_text import scene_rows
from kit.run.scenario import Scenario, find_scenario
from kit.run.session import Session
from kit.run.view import ViewBuilder
from kit.school.game.ghosts import REFERENCE, Ghost
from kit.school.game.levels import GameLevel
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_seconds
from kit.school.lessons.reading import exercise_scene
from kit.school.lessons.records import Lesson
from kit.tui.rows.level_card_rows import Company, Rival, best_splits, level_card

ROOM_FOR_THREE: Final = 100
"""Columns from which on three pictures stand beside each other."""
PICTURE_GAP: Final = 4
TARGET_SIGNS: Final = {False: UNICODE_GLYPHS.target, True: ASCII_GLYPHS.target}
"""A target on a small picture, without and with ASCII alone."""
WAY: Final = 0.15
"""m between two points of a ghost's way, as it is drawn."""
GHOST_LOOKS: Final = {
    REFERENCE: ("P", Role.GHOST_REFERENCE),
    DriverKind.HAND.value: ("K", Role.GHOST_KEYS),
    DriverKind.PROGRAM.value: ("C", Role.GHOST_PROGRAM),
    DriverKind.AGENT.value: ("A", Role.GHOST_AGENT),
}
"""The letter and the role of each ghost: the reference sets the pace, R is a record; a classmate has the first letter of the
name."""


def ghost_look(ghost: Ghost) -> tuple[str, Role]:
    """The letter that stands where a ghost is, and the role that it and its way are drawn as."""
    return GHOST_LOOKS.get(ghost.name, (ghost.name[:1].lower(), Role.GHOST_OTHER))


def ghost_driver(ghost: Ghost) -> str:
    """Who drove a ghost's drive, in words that go with its letter."""
    own = {driver.value: f"your best {driver.phrase}" for driver in DriverKind}
    return {REFERENCE: "the reference", **own}.get(ghost.name, ghost.name)


def company_of(ghosts: Sequence[Ghost]) -> Company:
    """What these add to a level's card: each with the letter on the map, and the best of one's own by sectors."""
    rivals = (Rival(ghost_look(each)[0], ghost_driver(each), each.seconds) for each in ghosts)
    return Company(tuple(rivals), best_splits(ghosts))


def ghost_marks(ghosts: Sequence[Ghost], time_s: float) -> tuple[SceneMark, ...]:
    """The letters of ghosts, each where it was at this time of its drive [s]."""
    return tuple(
        SceneMark(x, y, *ghost_look(ghost)) for ghost in ghosts for x, y, _ in ghost.poses_at(time_s)
    )


def picture_of(level: GameLevel, columns: int, rows: int, glyphs: str) -> list[str]:
    """A small picture: walls, targets and the start."""
    scenario = level.find_scenario()
    places = level.targets or (() if scenario.case is None else (scenario.case.target,))
    start, is_ascii = scenario.starts[0], glyphs == "ascii"
    signs = dict.fromkeys(places, TARGET_SIGNS[is_ascii]) | {(start.x, start.y): "S"}
    return floor_plan(
        scenario.world.wall_segments, (start.x, start.y), signs, columns, rows, ascii_only=is_ascii
    )


def picture_rows(picture: Sequence[str]) -> list[Row]:
    """A small picture with its walls dim, its targets and its start in the styles that both have elsewhere."""
    styles = dict.fromkeys(TARGET_SIGNS.values(), "good") | {"S": "bold"}
    return [
        row(*(("".join(run), style) for style, run in groupby(line, lambda sign: styles.get(sign, "dim"))))
        for line in picture
    ]


def level_beside(level: GameLevel, driver: DriverKind, columns: int, rows: int, glyphs: str) -> list[Row]:
    """What a level is about, beside a program for it: its map, and its card below that."""
    picture = picture_rows(picture_of(level, columns, rows // 2, glyphs))
    room = rows - len(picture) - 1
    card = level_card(level, driver, reference_seconds(level), (), columns, room, Company())
    return [*picture, row(), *(each for part in card.values() for each in part)]


def task_picture(task: str, columns: int, rows: int, glyphs: str) -> list[Row]:
    """The map of a learning task with its starts and targets. Takes a moment: the learning side is imported."""
    from kit.learning.authoring.task_text import build_case_scene
    from kit.learning.tasks.catalogue import find_task

    found = find_task(task)
    card, case = found.map_cases()[0]
    drawn = scene_rows(build_case_scene(found, card, case), columns, rows, ENCODERS[glyphs](False))
    return [row(line) for line in drawn]


def pictures_of(levels: Sequence[GameLevel], width: int, height: int, glyphs: str) -> list[Row]:
    """Small pictures of levels below their titles and the reference drives' times, up to two or three beside each other."""
    across = min(len(levels), 3 if width >= ROOM_FOR_THREE else 2)
    columns, rows = width // across, height // math.ceil(len(levels) / across)
    made: list[Row] = []
    for start in range(0, len(levels), across):
        line: list[Row] = [row()] * rows
        for place, level in enumerate(levels[start : start + across]):
            picture = picture_of(level, columns - PICTURE_GAP, rows - 2, glyphs)
            seconds = reference_seconds(level)
            told = "" if seconds is None else f"  reference {seconds:.2f} s"
            told = told if len(level.title) + len(told) <= columns - PICTURE_GAP else ""
            shown = [row((level.title, "title"), (told, "dim")), *picture_rows(picture)]
            line = side_by_side(line, shown, place * columns) if place else shown
        made += [*line, row()]
    return made


def first_scene(scenario: Scenario) -> Scene:
    """A scenario before anybody drives."""
    with Session(scenario) as session:
        return ViewBuilder(session).build().scene


def scene_of_lesson(lesson: Lesson) -> Scene | None:
    """The world of the lesson's first step that shows one, else of the first exercise that is checked in one; None where none is.
    Raises WorldError and the like."""
    exercises = (step.exercise for step in lesson.steps if step.exercise is not None)
    scenes = (*(step.scene for step in lesson.steps), *map(exercise_scene, exercises))
    first = next((each for each in scenes if each is not None), None)
    return None if first is None else first_scene(find_scenario(first.map_name, first.case))


def scene_of(level: GameLevel) -> Scene:
    """The level before anybody drives, with all its targets."""
    scenario = level.find_scenario()
    scene = first_scene(scenario)
    if scenario.case is not None and level.targets:
        radius = scenario.case.target_radius
        scene = replace(scene, targets=tuple(Disc(x, y, radius) for x, y in level.targets))
    return scene


def ghost_paths(ghost: Ghost) -> list[ScenePath]:
    """The ways of a ghost's robots, thinned out."""
    made = []
    for track in ghost.tracks:
        points = track[:, :2]
        if len(points) < 2:
            continue
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        steps = np.arange(0.0, float(along[-1]) + WAY, WAY)
        at = np.searchsorted(along, steps).clip(0, len(points) - 1)
        if math.isfinite(float(along[-1])):
            made.append(ScenePath(points[np.unique(at)], role=ghost_look(ghost)[1]))
    return made
