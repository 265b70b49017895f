"""``kit task``, as a user types it."""

from __future__ import annotations

import re
import shutil
import zipfile
from pathlib import Path

import pytest

from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.layers.case_sources import open_task
from kit.learning.policies.policy_file import load_policy
from kit.learning.tasks.catalogue import find_task, task_names
from kit.learning.tasks.reward_terms import TERMS
from kit.learning.tasks.transition import TRANSITION_FIELDS
from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.new_map import write_map
from kit.run.scenario import case_names
from kit.school.game.daily import find_playable_level
from kit.workspace import open_workspace
from kit.world.catalogue import maps_folder
from tests.cases import every_case
from tests.cli.verbs import kit


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def own_map() -> Path:
    """A map in the workspace, drawn as text: a straight hall."""
    folder = open_workspace().worlds / "corridor"
    write_map(folder, read_drawing("########\n#S    T#\n########"), title="Corridor", source="drawn")
    return folder


@pytest.mark.sampled(3)
@pytest.mark.parametrize("source", ["turn", "wheelchairs", "maze"])
def test_a_new_task_is_sound(source: str) -> None:
    kit("task", "new", "mine", "--from", source)
    assert ": valid" in kit("task", "check", "mine").output
    assert find_task("mine").name == "mine"
    assert "already exists" in kit("task", "new", "mine", code=2).output


def test_a_new_task_on_a_map_of_ones_own_by_its_name(own_map: Path) -> None:
    told = kit("task", "new", "reach", "--from", own_map.name).output
    assert "kit train reach`" in told
    assert find_task("reach").name == "reach"
    assert ": valid" in kit("task", "check", own_map / "reach.yaml").output
    assert "rom" in kit("task", "new", "reach", "--from", "rom", code=2).output


def test_layers_find_a_map_of_ones_own_by_its_name(own_map: Path) -> None:
    assert open_task(own_map.name).case == open_task(str(own_map)).case


@pytest.mark.long
def test_fields_are_tested_on_a_map_of_ones_own_by_its_name(own_map: Path) -> None:
    tested = kit("fields", "test", own_map.name, "--runs", 1)
    assert tested.output.splitlines()[1].split()[0] in case_names(own_map.name)
    assert case_names(own_map.name) == case_names(str(own_map))


def test_no_two_tasks_have_the_same_summary() -> None:
    summaries = [find_task(name).summary for name in task_names()]
    assert len(set(summaries)) == len(summaries)


@pytest.mark.long
def test_a_new_task_beside_a_world(tmp_path: Path) -> None:
    shutil.copytree(maps_folder() / "simple", tmp_path / "room", symlinks=False)
    shutil.copytree(maps_folder() / "robots", tmp_path / "room" / "robots")
    world = tmp_path / "room" / "world.yaml"
    world.write_text(world.read_text().replace("../robots", "robots"))
    kit("task", "new", "reach", "--from", "room")
    output = kit("task", "show", "room/reach.yaml").output
    assert "S" in output
    assert "per step" in output


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


def test_keys_names_all_that_a_task_file_and_a_reward_may_say() -> None:
    told = kit("task", "keys").output
    assert {
        each
        for each in ("summary", "maps", "cases", "goal", *TERMS, *TRANSITION_FIELDS)
        if f"\n  {each} " not in told
    } == set()
    assert not [line for line in told.splitlines() if re.fullmatch(r"  \w+", line)], (
        "a name that nothing explains"
    )


def test_tasks_of_ones_own_are_listed(own_map: Path) -> None:
    kit("task", "new", "reach", "--from", own_map.name)
    assert re.search(rf"^ *reach +{str(own_map)[:20]}", kit("task", "list").output, re.MULTILINE)


def test_all_tasks_are_listed() -> None:
    output = kit("task", "list").output
    assert all(name in output for name in task_names())


MISTAKES = {
    "no such source": (("task", "new", "mine", "--from", "tern"), "is not one of the kit's tasks or maps"),
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


QUICK = ("--algo", "q-learning", "--steps", "4000", "--keep-training", "--name", "mine")


@pytest.mark.parametrize("source", ["turn", "night-watch", "wheelchairs"])
def test_how_an_agent_is_raced_is_told_and_is_right(source: str) -> None:
    for verb in (("new", "mine", "--from", source), ("check", "mine")):
        told = re.search(r"`kit game race (\S+) --agent RUN`", kit("task", *verb).output)
        assert told is not None
        level = find_playable_level(told[1])
        assert level.goal == find_task("mine").goal
        level.find_scenario()


@pytest.mark.long
def test_a_task_of_ones_own_from_file_to_table(tmp_path: Path) -> None:
    kit("task", "new", "mine")
    task = Path("mine/task.yaml")
    text = task.read_text()
    kit("train", "mine", *QUICK)
    assert "`kit game race mine/task.yaml --agent mine`" in kit("watch", "mine").output
    run = tmp_path / "workspace" / "runs" / "mine"
    assert (run / "task.yaml").read_text() == text
    assert load_policy(run / "best.npz").trained_on.name == "mine"
    task.write_text(text.replace("scale: 0.5", "scale: 6"))
    output = kit("evaluate", "mine", "--episodes", 5).output
    assert "has changed since" in output
    assert "scale was 0.5 and is 6.0" in kit("evaluate", "mine", "--task", "mine", code=2).output
    task.unlink()
    for verb in (("evaluate", "mine", "--episodes", 5), ("compare", "mine", "mine", "--episodes", 5)):
        assert "turn_a_to_b" in kit(*verb).output
    assert "mine" in kit("runs").output
    task.write_text(text)
    folder = ("sweep", "mine", "--crosstable", "--algos", "sarsa", "--steps", 4000, "--episodes", 5)
    for _ in range(2):  # the second time it only reads
        assert "turn_b_to_a" in kit(*folder).output


WRONG_REWARDS = {
    "at every step": "def reward(reached, distance):\n    return 2.0 * reached - distanze\n",
    "in a metric": "def metric_near(distance):\n    return 0.5 * distanze\n\ndef reward(step):\n    return step\n",
    "on collision": "def reward(collided):\n    return -distanze if collided else 0\n",
    "on arrival": "def reward(reached):\n    return distanze if reached else 0\n",
    "at the last step": "def reward(timed_out):\n    return distanze if timed_out else 0\n",
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("source", WRONG_REWARDS.values(), ids=WRONG_REWARDS)
def test_a_fault_in_the_body_of_a_reward_is_told_before_training(tmp_path: Path, source: str) -> None:
    kit("task", "new", "mine")
    task = Path("mine/task.yaml")
    task.write_text(task.read_text().replace("name: algorithm-3\n  scale: 0.01", "file: own.py"))
    Path("mine/own.py").write_text(source)
    for verb in (("task", "check", "mine"), ("train", "mine", *QUICK)):
        output = kit(*verb, code=2).output
        assert "mine/own.py:2" in output
        assert "distanze" in output
    assert not list((tmp_path / "workspace").glob("runs/*"))
    Path("mine/own.py").write_text(source.replace("distanze", "1.0"))
    assert ": valid" in kit("task", "check", "mine").output


@pytest.mark.long
def test_a_reward_beside_a_task_is_used_and_kept(tmp_path: Path) -> None:
    kit("task", "new", "mine")
    task = Path("mine/task.yaml")
    text = task.read_text().replace("name: algorithm-3\n  scale: 0.01", "file: reward.py")
    task.write_text(text)
    assert "there is no file" in kit("task", "check", "mine", code=2).output
    Path("mine/reward.py").write_text("def reward(speed):\n    return speed\n")
    assert "reward.py:1" in kit("train", "mine", *QUICK, code=2).output
    Path("mine/reward.py").write_text("def reward(reached, collided):\n    return 2.0 * reached - collided\n")
    kit("train", "mine", *QUICK)
    kept = tmp_path / "workspace" / "runs" / "mine" / "reward.py"
    assert kept.read_text() == Path("mine/reward.py").read_text()


def test_a_start_in_a_wall_is_told_before_anything_is_written(tmp_path: Path) -> None:
    kit("task", "new", "mine")
    task = Path("mine/task.yaml")
    task.write_text(task.read_text() + "cases:\n  - {start: [0.5, 0, 0], target: [1.6, 1.6]}\n")
    line = len(task.read_text().splitlines())
    for verb in (("task", "check", "mine"), ("train", "mine", *QUICK)):
        output = kit(*verb, code=2).output
        assert f"mine/task.yaml:{line}:" in output
        assert "inside a wall" in output
    assert not list((tmp_path / "workspace").glob("runs/*"))


def test_continuous_actions_take_an_algorithm_that_learns_them() -> None:
    assert "ppo" in kit("train", "smooth-turn", "--algo", "dqn", code=2).output


@pytest.mark.skipif(highest_level_up_to(max(Level)) is Level.LIMITED, reason="nothing is confined here")
def test_the_reward_of_a_packed_task_is_run_without_ones_rights(tmp_path: Path) -> None:
    kit("task", "new", "mine")
    task = Path("mine/task.yaml")
    task.write_text(task.read_text().replace("name: algorithm-3\n  scale: 0.01", "file: own.py"))
    written = tmp_path / "written"
    Path("mine/own.py").write_text(
        f"try:\n    open({str(written)!r}, 'w')\nexcept OSError:\n    pass\ndef reward(reached):\n    return 1.0 * reached\n"
    )
    kit("task", "pack", "mine", "--output", "sent.zip")
    assert ": valid" in kit("task", "check", "sent.zip").output
    assert not written.exists()


def test_a_packed_task_is_checked_and_unpacked() -> None:
    kit("task", "new", "mine")
    assert "task.yaml" in kit("task", "pack", "mine", "--output", "sent.zip").output
    assert "sent.zip: valid" in kit("task", "check", "sent.zip").output
    assert "kit train there/mine" in kit("task", "unpack", "sent.zip", "--dest", "there").output
    assert "already exists" in kit("task", "unpack", "sent.zip", "--dest", "there", code=2).output
    with zipfile.ZipFile("wrong.zip", "w") as archive:
        archive.writestr("wrong/task.yaml", "maps: [maze]")
    assert "wrong/task.yaml:1:1" in kit("task", "unpack", "wrong.zip", code=2).output
    assert not Path("wrong").exists()
    Path("no.zip").write_text("no archive")
    assert "not a zip file" in kit("task", "check", "no.zip", code=2).output


def test_a_new_task_of_a_level_says_the_way_to_its_race() -> None:
    told = kit("task", "new", "mine", "--level", "wheels-that-lie").output
    assert "kit train mine --algo recurrent-ppo" in told
    assert "kit game race wheels-that-lie --agent mine" in told
    assert ": valid" in kit("task", "check", "mine").output
    assert "already exists" in kit("task", "new", "mine", "--level", "depot", code=2).output
    assert (
        "--steps 1500000 --seed 1 --name night"
        in kit("task", "new", "night", "--level", "the-long-night").output
    )
    kit("task", "new", "three", "--level", "depot")
    assert "rad/s" not in kit("task", "show", "three").output
    assert "left-turn" in kit("task", "new", "other", "--level", "left-turm", code=2).output
    assert not Path("other").exists()
