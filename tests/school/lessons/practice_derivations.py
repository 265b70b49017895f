"""How the lessons on workspaces, on photographs and on real robots are found out again: beside ``derivations.py``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import chdir
from functools import cache
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Final

from click.testing import CliRunner

from kit.cli import main
from kit.launch.package_creation import create_package
from kit.mapmaking.route import ROBOT_RADIUS
from kit.school.lessons.records import LessonStep
from tests.school.lessons.derivations import Claim
from tests.school.quiz.derived.photographs import LESSON as PHOTO_LESSON
from tests.school.quiz.derived.photographs import photo_reference
from tests.school.quiz.derived.robots import drift_sweep, training_line
from tests.school.quiz.derived.workspaces import order_reference, run_setup

# A real workspace


def built_copy(words: str, step: LessonStep, folder: Path) -> str:
    """Builds a package, changes its program, and reads the speed in the copy."""
    package = create_package("my_robot", folder / "src")
    program = package / "my_robot" / "driver.py"
    program.write_text("SPEED = 0.2\n")
    run_setup(package, "build_py", "--build-lib", str(folder / "install"))
    program.write_text("SPEED = 0.4\n")
    _, _, speed = (folder / "install" / "my_robot" / "driver.py").read_text().partition(" = ")
    return f"{float(speed):g}, since the copy was made before."


def order_of_a_build(words: str, step: LessonStep, folder: Path) -> str:
    """Of the packages in the picture."""
    needs = {}
    for line in step.picture.splitlines():
        name, _, others = line.partition("needs")
        needs[name.strip()] = [each.strip() for each in others.split(",")]
    return ", ".join(order_reference().build_order(needs))


# From a photograph to a map


@cache
def told_of_the_photo(*options: str) -> str:
    """What ``kit maps from-photo`` says of the lesson's photograph; also where it makes no map."""
    photo = PHOTO_LESSON / "sheet" / "starter" / "plan.jpg"
    with (
        TemporaryDirectory() as folder,
        chdir(folder),
    ):  # the picture that a refusal writes lies in the working folder
        result = CliRunner().invoke(
            main, ["maps", "from-photo", str(photo), "plan", "--workspace", folder, *options]
        )
        assert result.exit_code in (0, 2), result.output
        return result.output


def _passage(told: str) -> float:
    found = re.search(r"narrowest passage, (\d+\.\d+) m\s+wide", told)
    assert found is not None, told
    return float(found[1])


def photo_passage(words: str, step: LessonStep, folder: Path) -> str:
    width = _passage(told_of_the_photo("--width", "5"))
    return f"If it is 5 m wide, the way from start to target is {width:.2f} m wide at its narrowest place."


def needed_width(words: str, step: LessonStep, folder: Path) -> str:
    return f"The robot needs {2 * ROBOT_RADIUS:.2f} m"


def told_at_width(width: float) -> str:
    """With start and target at the same places of the drawing as at 5 m, which the kit says."""
    places = r"plan: from \((\S+), (\S+), .* of \((\S+), (\S+)\)"
    found = re.search(places, told_of_the_photo("--width", "5"))
    assert found is not None
    x, y, to_x, to_y = (float(each) * width / 5 for each in found.groups())
    return told_of_the_photo("--width", f"{width:g}", "--start", f"{x},{y}", "--target", f"{to_x},{to_y}")


def photo_at_a_third(words: str, step: LessonStep, folder: Path) -> str:
    assert "There is no path" in told_at_width(1.6)
    return "No world. It says that the robot does not get through."


def closed_room(words: str, step: LessonStep, folder: Path) -> str:
    """Gives the kit the drawing of the picture, and the same with a door."""
    told = []
    for name, drawing in (
        ("closed", step.picture),
        ("open", step.picture.replace("#    #    #", "#         #")),
    ):
        (folder / f"{name}.txt").write_text(drawing)
        words_given = ["maps", "new", name, "--from", str(folder / f"{name}.txt"), "--workspace", str(folder)]
        told.append(CliRunner().invoke(main, words_given))
    assert told[1].exit_code == 0, told[1].output
    assert told[0].exit_code == 2
    assert "There is no path" in told[0].output
    return "It makes no world, and says that there is no path."


def cells_of_a_size(words: str, step: LessonStep, folder: Path) -> str:
    """A robot fits if all cells that it covers are floor: counts those that keep it away when they are walls."""
    fits, middle = photo_reference("ways").fits, [5, 5]
    counts = []
    for size in (0, 1):
        count = 0
        for row, column in product(range(11), repeat=2):
            grid = ["." * 11 for _ in range(11)]
            grid[row] = "." * column + "#" + "." * (10 - column)
            count += not fits(grid, middle, size)
        counts.append(count)
    return f"{counts[0]} cell for size 0, {counts[1]} cells for size 1"


# From simulation to a robot


def steps_of_both_trainings(words: str, step: LessonStep, folder: Path) -> str:
    (count,) = {re.findall(r"--steps (\d+)", training_line(name))[0] for name in ("careful", "shaken")}
    return f"for {int(count):,} steps"


def drift_of_careful(words: str, step: LessonStep, folder: Path) -> str:
    shares = drift_sweep("careful")
    if words.startswith("It arrives"):
        return f"It arrives in {shares[0.0]} of its tests"
    if words.startswith("first agent"):
        return f"first agent {shares[-1.0]} {shares[0.0]} {shares[1.0]}"
    return shares[1.0]


def drift_of_shaken(words: str, step: LessonStep, folder: Path) -> str:
    shares = drift_sweep("shaken")
    return f"It arrives in {shares[0.0]} at 0, and in {shares[-1.0]} and {shares[1.0]} beside it."


def shaken_against_careful(words: str, step: LessonStep, folder: Path) -> str:
    careful, shaken = drift_sweep("careful"), drift_sweep("shaken")
    assert float(shaken[0.0]) < float(careful[0.0])
    assert all(float(shaken[each]) > float(careful[each]) for each in (-1.0, 1.0))
    return "Worse at 0, and better at -1 and at 1."


PRACTICE_DERIVATIONS: Final[Mapping[str, Claim]] = MappingProxyType(
    {
        claim.__name__.replace("_", "-"): claim
        for claim in (
            built_copy,
            order_of_a_build,
            photo_passage,
            needed_width,
            photo_at_a_third,
            closed_room,
            cells_of_a_size,
            steps_of_both_trainings,
            drift_of_careful,
            drift_of_shaken,
            shaken_against_careful,
        )
    }
)
"""By the name that a claim's ``derived`` gives."""
PRACTICE_DEAR: Final = frozenset(
    each.__name__.replace("_", "-")
    for each in (
        built_copy, photo_passage, photo_at_a_third,
        drift_of_careful, drift_of_shaken, shaken_against_careful,
    )
)  # fmt: skip
"""Those that take more than a second: they run with the long tests."""
