"""What the last lesson says is found out again: by making its map, and by the marks of its exercise."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from click.testing import CliRunner

from grader.assignment import Criterion
from grader.reading import read_assignment
from kit.cli import main
from kit.school.lessons.reading import lessons_folder, solutions_folder
from kit.school.lessons.records import LessonStep
from kit.sim.simulation import load_world


def make_map(drawing: str, folder: Path, *options: str) -> str:
    """What ``kit maps new`` says of a drawing; empty if it made the map."""
    (folder / "course.txt").write_text(drawing)
    words = ["maps", "new", "course", "--from", str(folder / "course.txt"), *options]
    done = CliRunner().invoke(main, [*words, "--workspace", str(folder / "workspace")])
    is_made = (folder / "workspace" / "worlds" / "course" / "world.yaml").is_file()
    assert is_made == (done.exit_code == 0)
    return "" if is_made else done.output


def race_criterion(name: str) -> Criterion:
    """A criterion of the last exercise."""
    (found,) = (
        each
        for each in read_assignment(lessons_folder() / "41-capstone" / "race").criteria
        if each.id == name
    )
    return found


def blocked_map(words: str, step: LessonStep, folder: Path) -> str:
    assert "There is no path" in make_map(step.picture, folder)
    return "At the first, when the map is made."


def character_width(words: str, step: LessonStep, folder: Path) -> str:
    """By the size that a drawing's map has."""
    drawing = (solutions_folder() / "41-capstone" / "draft" / "solution" / "course.txt").read_text()
    assert not make_map(drawing, folder)
    made = load_world(folder / "workspace" / "worlds" / "course" / "world.yaml").layers[0].walls
    assert made is not None
    # The outermost characters are wall, whose inner edge is what counts.
    inner = float(np.ptp(made.segments[:, ::2]))
    columns = len(drawing.splitlines()[0])
    return (
        f"a character is {min((0.25, 0.5, 1.0), key=lambda each: abs((columns - 2) * each - inner)):g} m wide"
    )


def capstone_marks(words: str, step: LessonStep, folder: Path) -> str:
    full = {name: race_criterion(name).anchors.full for name in ("map", "test", "race")}
    texts = (
        f"a way leads to T, {full['map']:g} m or more",
        f"it surely arrives in {100 * full['test']:g} %",
        f"at most {full['race']:g} times the shortest time",
    )
    return next((each for each in texts if each[:4] == words[:4]), texts[0])


CAPSTONE_DERIVATIONS: Final = (blocked_map, character_width, capstone_marks)
