"""``kit task``, as a user types it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.learning.environment.tasks import find_task, task_names
from kit.world.catalogue import maps_folder
from tests.cases import every_case


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def kit(*arguments: object, code: int = 0) -> Result:
    result = CliRunner().invoke(main, [str(each) for each in arguments], env={"COLUMNS": "80", "LINES": "24"})
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.output
    return result


@pytest.mark.sampled(3)
@pytest.mark.parametrize("source", ["turn", "wheelchairs", "maze"])
def test_a_new_task_is_sound(source: str) -> None:
    kit("task", "new", "mine", "--from", source)
    assert "sound" in kit("task", "check", "mine").output
    assert find_task("mine").name == "mine"
    assert "exists already" in kit("task", "new", "mine", code=2).output


@pytest.mark.long
def test_a_new_task_beside_a_world(tmp_path: Path) -> None:
    shutil.copytree(maps_folder() / "simple", tmp_path / "room", symlinks=False)
    shutil.copytree(maps_folder() / "robots", tmp_path / "room" / "robots")
    world = tmp_path / "room" / "world.yaml"
    world.write_text(world.read_text().replace("../robots", "robots"))
    kit("task", "new", "reach", "--from", "room")
    output = kit("task", "show", "room/reach.yaml").output
    assert "S" in output
    assert "together" in output


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["turn", "wheelchairs"])
def test_a_task_is_shown(name: str) -> None:
    output = kit("task", "show", name, "--glyphs", "ascii").output
    task = find_task(name)
    for word in (
        task.summary,
        *(case.name for _, case in task.map_cases()),
        "sees",
        "earns",
        task.goal.description,
    ):
        assert word in output


def test_all_tasks_are_listed() -> None:
    output = kit("task", "list").output
    assert all(name in output for name in task_names())


MISTAKES = {
    "no such source": (("task", "new", "mine", "--from", "tern"), "neither a task nor a map"),
    "bad name": (("task", "new", "a/b"), "letters"),
    "no such task": (("task", "check", "tern"), "turn"),
    "no such file": (("task", "show", "mine/task.yaml"), "no file"),
    "no such case": (("task", "show", "turn", "--on", "stairs"), "stairs"),
}


@every_case(("arguments", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_ends_with_a_clear_line(arguments: tuple[str, ...], message: str) -> None:
    assert message in kit(*arguments, code=2).output


def test_the_errors_of_a_file_come_with_their_places() -> None:
    kit("task", "new", "mine")
    file = Path("mine/task.yaml")
    text = file.read_text()
    file.write_text(text.replace("clip: 2", "clop: 2").replace("algorithm-3", "algorithm-33"))
    lines = [
        number for number, line in enumerate(text.splitlines(), 1) if "clip" in line or "algorithm" in line
    ]
    for verb in (("task", "check"), ("train",), ("evaluate", "--task")):
        output = kit(*verb, "mine", code=2).output
        if verb[0] != "evaluate":  # without a policy that comes first
            assert all(f"mine/task.yaml:{line}:" in output for line in lines)
            assert "2 problems" in output
