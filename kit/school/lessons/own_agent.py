"""A film of the student's own agent: their lines learn the floor of a lesson, then a robot drives as they have learned."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from kit.host.failure import StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.learning.grid.grid_world import FLOOR, START, TARGET, WALL, GridCell, GridWorld
from kit.run.episode import run_until, when
from kit.school.lessons.own_learners import OwnLinesError, StudentLines, make_own_learner
from kit.school.lessons.records import LearningScene

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario

CELL_M: Final = 0.8
"""Side of a cell of the floor that the robot drives on [m]."""
FLOOR_FOLDER: Final = "floor"
"""Beside the student's file: the floor as a map."""
FILM_FILE: Final = "film.npz"
"""Beside the student's file: the robot's drive."""
LIMIT_S: Final = 180.0
"""Longest drive [s]."""
MAP_SIGNS: Final = {WALL: "#", START: "S", TARGET: "T"}


class OwnAgentError(Exception):
    """The drive cannot be recorded; the message says why."""


@dataclass(frozen=True, slots=True)
class OwnAgentFilm:
    """What the student's lines learned, and the drive that came of it."""

    scene: LearningScene
    """It learns again before one's eyes, by the answers that the lines gave."""
    recording: Recording
    place: Scenario
    file: Path
    """Where the drive is kept."""
    moves: int
    """Moves of the way that it drives."""
    is_solved: bool
    """Whether that way leads to the target."""
    seconds: float
    """How long it drives [s]."""


def make_film(
    scene: LearningScene, files: list[Path], level: Level, show_progress: Callable[[str], None]
) -> OwnAgentFilm:
    """Lets the lines in the student's files learn, then the robot drive. ``level``: their confinement. Takes some seconds, and
    says at each tenth how far it is. Raises OwnAgentError."""
    try:
        with StudentLines(files, level) as lines:
            learner = make_own_learner(scene.world, scene.learners[0], lines)
            tenth = 0
            while learner.updates < scene.updates:
                learner.step()
                if (reached := 10 * learner.updates // scene.updates) > tenth:
                    tenth = reached
                    show_progress(
                        f"Your lines learn the floor: {learner.updates:,} of {scene.updates:,} updates."
                    )
            kept = lines.kept_lines()
    except StudentCodeError as error:
        raise OwnAgentError(f"Your lines stopped: {error.failure}") from None
    except OwnLinesError as error:
        raise OwnAgentError(str(error)) from None
    path = learner.greedy_path()
    folder = files[0].parent
    recording, place = _drive(scene.world, path, folder)
    seconds = recording.ticks * recording.step_size
    return OwnAgentFilm(
        replace(scene, lines=kept),
        recording,
        place,
        folder / FILM_FILE,
        len(path) - 1,
        learner.is_solved,
        seconds,
    )


def _drive(world: GridWorld, path: tuple[GridCell, ...], folder: Path) -> tuple[Recording, Scenario]:
    """A robot drives along the cells of a path, in a world that is the floor. Raises OwnAgentError."""
    from kit.run.place_driver import WayDriver
    from kit.run.recording import Recorder, save_recording
    from kit.run.scenario import find_scenario
    from kit.run.session import Session

    try:
        place = find_scenario(str(_floor_map(world, folder)))
        points = [_middle_of(cell, world) for cell in path]
        with Session(place, seed=0, always_scan=True) as session:
            driver = WayDriver(session, points)
            recorder = Recorder.for_scenario(place, session.runner.simulation)
            session.runner.observers += [recorder, driver]
            run_until(session.runner, limit_s=LIMIT_S, ends=(when(lambda: driver.is_done),))
            recording = recorder.recording()
        save_recording(recording, folder / FILM_FILE)
    except (OSError, ValueError) as error:
        raise OwnAgentError(f"The robot could not drive: {error}") from None
    return recording, place


def _floor_map(world: GridWorld, folder: Path) -> Path:
    """Writes the floor as a map, once; returns its folder. Raises OSError and ValueError."""
    from kit.mapmaking.map_drawing import read_drawing
    from kit.mapmaking.new_map import write_map

    made = folder / FLOOR_FOLDER
    shutil.rmtree(made, ignore_errors=True)
    rim = "#" * (world.shape[1] + 2)
    rows = ["".join(MAP_SIGNS.get(sign, FLOOR) for sign in row) for row in world.rows]
    drawing = "\n".join([rim, *(f"#{row}#" for row in rows), rim])
    write_map(made, read_drawing(drawing, cell=CELL_M), title="Your agent's floor", source="a lesson's floor")
    return made


def _middle_of(cell: GridCell, world: GridWorld) -> tuple[float, float]:
    """Where a cell's middle is in the map [m, m], whose walls are a cell thick."""
    return (cell.column + 1.5) * CELL_M, (world.shape[0] - cell.row + 0.5) * CELL_M


def describe_film(film: OwnAgentFilm) -> str:
    """Says in one sentence what came of it."""
    if not film.moves:
        return f"{film.scene.titles[0]} has learned no move that leads away from S, so its robot stays there."
    end = "to G" if film.is_solved else "and does not get to G yet"
    return f"{film.scene.titles[0]}: {film.moves} moves {end}, driven in {film.seconds:.1f} s."
