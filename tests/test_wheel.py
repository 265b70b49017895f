"""What is installed from a wheel, outside the checkout, finds its maps and lessons and runs."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy
import pytest

from kit.school.lessons.checking import exercise_folder
from kit.school.lessons.reading import find_lesson, lesson_names
from kit.workspace import open_workspace

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_wheel(tmp_path_factory.mktemp("wheel"))


def build_wheel(folder: Path) -> Path:
    """Builds a wheel of this checkout in a folder, and returns its file."""
    subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--wheel-dir", folder, ROOT],
        check=True,
        capture_output=True,
    )
    return next(folder.glob("*.whl"))


@pytest.mark.long
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
    assert {"kit/py.typed", "grader/py.typed"} <= set(names)  # so that type checkers read the annotations


@pytest.mark.long
def test_a_wheel_that_a_workflow_builds_names_its_repository(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GITHUB_SERVER_URL", "https://example.org")
    monkeypatch.setenv("GITHUB_REPOSITORY", "somebody/kit")
    archive = zipfile.ZipFile(build_wheel(tmp_path))
    (metadata,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
    assert "Project-URL: Source, https://example.org/somebody/kit\n" in archive.read(metadata).decode()


@pytest.mark.long
def test_the_wheel_registers_its_environments_as_a_gymnasium_plugin(wheel: Path) -> None:
    archive = zipfile.ZipFile(wheel)
    (entry_points,) = (name for name in archive.namelist() if name.endswith(".dist-info/entry_points.txt"))
    text = archive.read(entry_points).decode()
    assert "[gymnasium.envs]\n__root__ = kit.environment_ids:register" in text


@pytest.mark.long
def test_the_installed_kit_runs_a_shipped_map(wheel: Path, tmp_path: Path) -> None:
    """The dependencies come from this environment; the kit itself only from the wheel."""
    python, site = install_wheel(wheel, tmp_path / "venv")
    environment = _environment(tmp_path)
    where = subprocess.run(
        [python, "-c", "import kit; print(kit.__file__)"],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    assert Path(where.stdout.strip()).is_relative_to(site)
    program = "import kit, gymnasium; print(gymnasium.make('RobotKit/Turn-v0').unwrapped)"
    made = subprocess.run(
        [python, "-c", program], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert "TurnEnv" in made.stdout
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
    assert listed.count("\n") > len(lesson_names())
    lesson = find_lesson("2")
    exercise = lesson.exercises[0]
    file = exercise_folder(open_workspace(tmp_path / "workspace"), lesson, exercise) / exercise.file
    number = next(step.number for step in lesson.steps if step.exercise is exercise)
    walked = subprocess.run(
        [python, "-m", "kit", "lesson", "2", "--plain"],
        input=f"l {number}\nc\nq\n",
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert walked.returncode == 0, walked.stderr
    assert file.is_file()
    assert " points, checked in " in walked.stdout
    assert "stars" in _said(python, tmp_path, environment, "game", "--plain")


BY_NAME = """
import json
from importlib.util import find_spec
import click, kit
from grader.__main__ import main as grader
from grader.kinds.contract import find_kind, kind_names
from kit.cli import main

def verbs(group, path):
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        yield f"{path} {name}"
        if isinstance(command, click.Group):
            yield from verbs(command, f"{path} {name}")

print(json.dumps({
    "verbs": [*verbs(main, "kit"), *verbs(grader, "grader")],
    "kinds": [find_kind(name).__class__.__name__ + " " + name for name in kind_names()],
    "public names": [getattr(kit, name).__name__ for name in kit.__all__],
    "processes": [find_spec(f"grader.kinds.{name}.child").name for name in ("task", "world")],
}))
"""


@pytest.mark.long
def test_what_is_imported_by_its_name_is_in_the_wheel(wheel: Path, tmp_path: Path) -> None:
    """No import statement names verbs, kinds, public names and the grader's own processes: a move loses them in silence."""
    python, _ = install_wheel(wheel, tmp_path / "venv")
    found = [
        json.loads(
            subprocess.run(
                [each, "-c", BY_NAME], cwd=folder, env=_environment(tmp_path), capture_output=True, check=True
            ).stdout
        )
        for each, folder in ((python, tmp_path), (sys.executable, ROOT))
    ]
    assert found[0] == found[1]
    assert all(found[0].values())


THIEF = """
import os, sys

def _read(path):
    with open(path, "rb") as opened: return len(opened.read())

def stolen():
    count = 0
    for path in {secrets!r}:
        try: count += _read(path)
        except OSError: pass
    for name in ("grader", "kit.sim", "kit.school"):
        try: count += __import__(name).__file__ is not None  # None: a folder in which nothing is to be seen
        except (ImportError, OSError): pass
    return count

def beside():
    import beside, numpy
    assert numpy.__file__.startswith({site!r})
    return float(numpy.arange(4).sum())
"""

NODE = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_srvs.srv import Empty

rclpy.init()
node = Node("heard")
node.create_publisher(Twist, "cmd_vel", 1)
node.create_client(Empty, "reset")
rclpy.spin(node)
"""

TRIAL = """
import sys
from pathlib import Path
from kit.host.node_process import NodeProcess
from kit.host.student_functions import StudentFunctions
from kit.ros.graph.graph import Graph
from kit.host.sandbox.sandbox_config import Level
from kit.host.sandbox.probe import is_level_available
for level in Level:
    if is_level_available(level):
        with StudentFunctions(Path(sys.argv[1]), level=level) as functions:
            print(int(level), functions.call_batch("stolen", [{}])[0] > 0, functions.call_batch("beside", [{}])[0])
        with NodeProcess.start(Graph(log_sink=print), Path(sys.argv[2]), level=level) as node:
            assert node.failure is None, node.failure
"""


@pytest.mark.long
def test_a_program_reads_no_solution_from_an_installed_wheel(wheel: Path, tmp_path: Path) -> None:
    """What is installed beside the kit can be imported, and a node runs, at every level that this machine has."""
    python, site = install_wheel(wheel, tmp_path / "venv")
    (site / "beside").mkdir()
    (site / "beside" / "__init__.py").touch()
    installed = Path(numpy.__file__).parent
    for folder in (installed, installed.with_name("numpy.libs")):
        if folder.is_dir():
            shutil.copytree(folder, site / folder.name, ignore=shutil.ignore_patterns("tests"))
    data = site / "kit" / "data"
    secrets = [
        *(path for path in (data / "solutions").rglob("*") if path.is_file()),
        *(path for name in ("secret.yaml", "reference.py") for path in data.rglob(name)),
        *site.glob("robot_learning_kit-*/*"),
        site / "grader" / "grading.py",
    ]
    assert len(secrets) > 50
    file = tmp_path / "student" / "controller.py"
    file.parent.mkdir()
    file.write_text(THIEF.format(secrets=list(map(str, secrets)), site=str(site)))
    program = file.with_name("node.py")
    program.write_text(NODE)
    said = subprocess.run(
        [python, "-c", TRIAL, str(file), str(program)],
        cwd=tmp_path,
        env=_environment(tmp_path),
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert said.returncode == 0, said.stderr
    levels = said.stdout.splitlines()
    assert levels == ["0 True 6.0", *(f"{level} False 6.0" for level in range(1, len(levels)))]


def install_wheel(wheel: Path, place: Path, python: str = sys.executable) -> tuple[Path, Path]:
    """Makes an environment of this Python with the wheel in it; returns its Python and its folder of packages.

    What the kit needs is seen where that Python has it."""
    made = [python, "-m", "venv", "--without-pip", "--symlinks", str(place)]
    subprocess.run(made, check=True, capture_output=True)
    site = next((place / "lib").glob("python*/site-packages"))
    zipfile.ZipFile(wheel).extractall(site)
    asked = [python, "-P", "-c", "import json, sys; print(json.dumps(sys.path))"]
    paths = json.loads(subprocess.run(asked, check=True, capture_output=True, text=True).stdout)
    needed = [path for path in paths if Path(path).name in ("site-packages", "dist-packages")]
    (site / "dependencies.pth").write_text("\n".join(needed) + "\n")
    return place / "bin" / "python", site


def _environment(folder: Path) -> dict[str, str]:
    """Without what would put a checkout before the wheel."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return {**kept, "KIT_WORKSPACE": str(folder / "workspace")}


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
