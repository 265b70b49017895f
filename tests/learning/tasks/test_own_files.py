"""A user's own task and reward files are found, and nothing else is taken for one."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.learning.authoring.new_task import new_task_file
from kit.learning.authoring.own_rewards import own_reward_files
from kit.learning.tasks.catalogue import find_task, find_task_file, tasks_folder
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.own_files import own_task_files, workspace_task_file
from kit.world.catalogue import maps_folder


def test_every_task_of_the_kit_would_be_found_and_no_file_of_a_map() -> None:
    assert set(own_task_files([tasks_folder()])) == set(tasks_folder().glob("*.yaml"))
    assert own_task_files([maps_folder()]) == ()


def test_own_tasks_are_found_where_kit_task_new_writes_them(tmp_path: Path) -> None:
    first = new_task_file("mine", "turn", tmp_path)
    (tmp_path / "runs" / "old").mkdir(parents=True)
    (tmp_path / "runs" / "old" / "task.yaml").write_text(first.read_text())
    (tmp_path / "broken.yaml").write_bytes(b"\xff\xfe")
    assert own_task_files([tmp_path, tmp_path]) == (first,)


def test_only_files_with_a_reward_that_can_be_called_are_offered(tmp_path: Path) -> None:
    (tmp_path / "good.py").write_text("def reward(reached):\n    return 1.0 * reached\n")
    (tmp_path / "bad.py").write_text("def reward(no_such_thing):\n    return 0.0\n")
    (tmp_path / "none.py").write_text("def other():\n    pass\n")
    assert own_reward_files([tmp_path]) == (tmp_path / "good.py",)


def test_a_task_of_the_workspace_is_found_by_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path / "nowhere"))
    assert workspace_task_file("mine") is None
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path))
    file = new_task_file("mine", "turn", tmp_path)
    assert workspace_task_file("mine") == find_task_file("mine") == file
    assert find_task("mine").name == "mine"
    with pytest.raises(UnknownTask):
        find_task_file("yours")
