"""What is installed from a wheel, outside the checkout, finds its maps and lessons and runs."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from kit.school.lessons.exercise_files import exercise_folder
from kit.school.lessons.reading import find_lesson, lesson_names
from kit.workspace import open_workspace

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--wheel-dir", folder, ROOT],
        check=True,
        capture_output=True,
    )
    return next(folder.glob("*.whl"))


def test_the_wheel_carries_the_data_and_no_tests(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    shipped = {path.name for path in (ROOT / "maps").iterdir() if path.is_dir()}
    assert {
        name.split("/")[3] for name in names if name.count("/") > 3 and name.startswith("kit/data/maps/")
    } >= shipped
    for folder, data in (("lessons", "lessons"), ("tests/solutions", "solutions")):
        here = {
            f"kit/data/{data}/{file.relative_to(ROOT / folder).as_posix()}"
            for file in (ROOT / folder).rglob("*")
            if file.is_file() and "__pycache__" not in file.parts
        }
        assert here <= set(names), sorted(here - set(names))
    assert not [name for name in names if name.startswith(("tests/", "maps/", "lessons/"))]


def test_the_installed_kit_runs_a_shipped_map(wheel: Path, tmp_path: Path) -> None:
    """The dependencies come from this environment; the kit itself only from the wheel."""
    place = tmp_path / "venv"
    venv.create(place, symlinks=True)
    python = place / "bin" / "python"
    site = next((place / "lib").glob("python*/site-packages"))
    zipfile.ZipFile(wheel).extractall(site)
    ours = [path for path in map(Path, sys.path) if path.name == "site-packages"]
    (site / "dependencies.pth").write_text("\n".join(str(path) for path in ours) + "\n")
    environment = {**os.environ, "KIT_WORKSPACE": str(tmp_path / "workspace")}
    where = subprocess.run(
        [python, "-c", "import kit; print(kit.__file__)"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert Path(where.stdout.strip()).is_relative_to(site)
    run = subprocess.run(
        [python, "-m", "kit", "run", "maze", "--controller", "random_walk", "--steps", "300"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert run.returncode == 0, run.stderr
    assert "300" in run.stdout
    listed = _said(python, tmp_path, environment, "lesson")
    assert all(name.partition("-")[0] in listed for name in lesson_names())
    lesson = find_lesson("2")
    exercise = lesson.exercises[0]
    file = exercise_folder(open_workspace(tmp_path / "workspace"), lesson, exercise) / exercise.file
    number = next(step.number for step in lesson.steps if step.exercise is exercise)
    walked = subprocess.run(
        [python, "-m", "kit", "lesson", "2", "--plain"],
        input=f"g {number}\nr\nq\n",
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert walked.returncode == 0, walked.stderr
    assert file.is_file()
    assert " points, in " in walked.stdout
    assert "stars" in _said(python, tmp_path, environment, "game", "--plain")


def _said(python: Path, folder: Path, environment: dict[str, str], *arguments: str) -> str:
    return subprocess.run(
        [python, "-m", "kit", *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    ).stdout
