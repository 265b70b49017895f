"""No seed puts a robot into a wall or behind one: a right program would lose points by it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from grader.__main__ import main
from grader.driving.starts import blocked_seeds, start_problems
from grader.new_assignment import TEMPLATES
from grader.reading import read_assignment
from kit.school.lessons.reading import lessons_folder

SHIFTED = [
    file.parent
    for root in (lessons_folder(), TEMPLATES)
    for file in sorted(root.rglob("assignment.yaml"))
    if "shift:" in file.read_text("utf-8")
]


@pytest.mark.parametrize("folder", SHIFTED, ids=lambda folder: f"{folder.parent.name}/{folder.name}")
def test_every_start_of_the_kits_assignments_is_free(folder: Path) -> None:
    assert list(start_problems(read_assignment(folder))) == []


@pytest.mark.parametrize(
    ("shift", "is_free"),
    [("[0, 0, 3]", True), ("[0.6, 0, 0]", False), ("[3, 0, 0]", False), ("[0, 0.2, 0]", True)],
)
def test_a_start_in_a_wall_or_behind_one_is_found(shift: str, is_free: bool, tmp_path: Path) -> None:
    folder = tmp_path / "hall"
    folder.mkdir()
    (folder / "assignment.yaml").write_text(
        f"{{title: Hall, submit: a.py, trials: [{{name: hall, place: hall_straight, time: 1, seeds: [1], shift: {shift}}}], "
        "checks: [{check: runs, title: Runs, points: 1}]}\n"
    )
    assignment = read_assignment(folder)
    assert (blocked_seeds(assignment.trials[0]) == ()) is is_free


def test_the_self_test_tells_of_it(tmp_path: Path) -> None:
    folder = tmp_path / "corner"
    shutil.copytree(TEMPLATES / "controller", folder)
    sheet = folder / "assignment.yaml"
    sheet.write_text(
        sheet.read_text("utf-8").replace("shift: [0.08, 0.08, 0.5]", "shift: [1, 0, 0]"), "utf-8"
    )
    for each in ("starter.py", "solution.py", "wrong"):
        path = folder / each
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    done = CliRunner().invoke(main, ["self-test", str(folder)])
    assert done.exit_code == 1
    assert "shift" in done.output
    assert "there" in done.output
