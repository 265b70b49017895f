"""What maps of maybes and particles do, found out with the lesson's own functions."""

from __future__ import annotations

import math
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

from click.testing import CliRunner

from kit.cli import main
from kit.school.lessons.reading import lessons_folder, solutions_folder
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding

LESSON = "40-where-am-i"


reference = partial(lesson_reference, LESSON)


@cache
def localised(
    seconds: int, particles: int = 1000, spread: float = 2.0, *, solved: bool = True
) -> tuple[float, float]:
    """How far the particles are spread and how far their middle is off [m], with the reference solution."""
    exercise = lessons_folder() / LESSON / "particles" / "starter.py"
    file = solutions_folder() / LESSON / "particles" / "solution.py" if solved else exercise
    source = file.read_text().replace("PARTICLES = 1000", f"PARTICLES = {particles}")
    with TemporaryDirectory() as name:
        controller = Path(name) / "localiser.py"
        controller.write_text(source.replace("SPREAD = 2.0", f"SPREAD = {spread}"))
        arguments = ["simple", "--controller", str(controller), "--steps", str(seconds * 100 + 10)]
        told = CliRunner().invoke(main, ["run", *arguments])
    assert told.exit_code == 0, told.output
    line = [each for each in told.output.splitlines() if "localiser:" in each][-1]
    words = line.replace(";", "").split()
    return float(words[words.index("over") + 1]), float(words[words.index("is") + 1])


def behind_the_hit(item: QuizItem, folder: Path) -> Finding:
    (new,) = reference("grid").updated([[0.0] * 5], [[0, 0], [0, 1]], [0, 2])
    return Finding(
        new[3:],
        {
            "That they are occupied too": [0.9, 0.9],
            "Nothing at all": [0.0, 0.0],
            "That they are free": [-0.4, -0.4],
        },
    )


def one_wrong_ray(item: QuizItem, folder: Path) -> Finding:
    grid = [[0.0]]
    for free, hit in (([[0, 0]], None),) * 3 + (([], [0, 0]),):
        grid = reference("grid").updated(grid, free, hit)
    return Finding(
        math.copysign(1.0, grid[0][0]) if grid[0][0] else 0.0,
        {
            "That it is free rather than occupied": -1.0,
            "That it is occupied, as the last ray said": 1.0,
            "Nothing, as before the first ray": 0.0,
        },
    )


def why_a_limit(item: QuizItem, folder: Path) -> Finding:
    grid, rays = [[0.0]], 0
    for _ in range(10_000):
        grid = reference("grid").updated(grid, [], [0, 0])
    while grid[0][0] > 1e-9:
        grid, rays = reference("grid").updated(grid, [[0, 0]], None), rays + 1
    return Finding(rays, {"After ten": 10, "After one": 1, "After ten thousand": 10_000})


def nan_in_a_product(item: QuizItem, folder: Path) -> Finding:
    products = [
        math.prod(math.exp(-((there - here) ** 2)) for here in (1.0, math.nan)) for there in (1.0, 2.0)
    ]
    weights = [each / sum(products) for each in products]
    return Finding(
        "nan" if all(map(math.isnan, weights)) else "number",
        {
            "It becomes 0, and the particle dies out": "zero",
            "It stays what it is without that ray": "number",
            "It becomes nan, and so do all the others": "nan",
        },
    )


def copies_of_one(item: QuizItem, folder: Path) -> Finding:
    """A narrow filter agrees, and is wrong; so agreement says nothing of the robot."""
    spread, off = localised(2, 400, 0.3)
    return Finding(
        "copies" if spread <= 0.1 and off > 0.5 else "there",
        {
            "That the robot is there, within centimetres": "there",
            "That they are copies of a few that fitted best": "copies",
            "That the laser measured without an error": "laser",
        },
    )


def heavy_particle(item: QuizItem, folder: Path) -> Finding:
    counts = {
        reference("particles").resample([0.0, 0.5, 0.25, 0.25], first).count(1) for first in (0.01, 0.1, 0.24)
    }
    (count,) = counts
    return Finding(count, {"Once": 1, "Four times": 4, "Twice": 2})


LOCALISATION: dict[str, Derivation] = {
    "behind-the-hit": behind_the_hit,
    "one-wrong-ray": one_wrong_ray,
    "why-a-limit": why_a_limit,
    "nan-in-a-product": nan_in_a_product,
    "copies-of-one": copies_of_one,
    "heavy-particle": heavy_particle,
}
