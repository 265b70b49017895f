"""Task files: what they say, and every mistake in them with its place."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from kit.learning.authoring.task_check import check_task
from kit.learning.environment.batch import BatchEnv
from kit.learning.policies.policy_node import leader_frame
from kit.learning.tasks.actions import MAX_SPEED, MAX_TURN_RATE, ContinuousActions
from kit.learning.tasks.case_reader import MAX_PLACES
from kit.learning.tasks.catalogue import (
    all_tasks,
    dissertation_tasks,
    find_task,
    first_tasks,
    task_names,
    tasks_folder,
)
from kit.learning.tasks.goals.cover import CoverGoal
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.task_reader import MAX_ACTIONS, MAX_FRAMES, read_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.world.problems import WorldError
from tests.cases import every_case

WHOLE = """\
summary: Sweep the room
maps: [maze, house]
cases:
  - {name: one, map: maze, start: [0, 0, -1.57], target: [6.94, -3.79], group: mine}
  - {name: two, map: house, start_area: [-0.3, -0.3, 0.3, 0.3], start_headings: [0, 1], target_anywhere: true}
actions: {linear: [-0.1, 0.4], angular: [-1.5, 1.5]}
observation: {rays: [45, 0], sectors: 7, speeds: true, own_pose: true, last_action: true, frames: 3, achieved: true}
reward:
  terms: {progress: 1, collided: {weight: -2, at_end: false}}
  scale: 0.5
goal: {kind: cover, share: 0.5}
endings: {collision: continues, goal: truncated, time: terminated}
step: {time: 0.1, collision_checks: 3, limit: 77}
start: {noise: 0.01}
disturbances: {lidar_noise: [0, 0.02], latency: 0.1}
success: 0.8
preset: turn
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "mine.yaml"
    file.write_text(text)
    return file


def test_every_key_is_read(tmp_path: Path) -> None:
    task = read_task(written(tmp_path, WHOLE)).task
    assert (task.name, task.maps, task.robots, task.preset) == ("mine", ("maze", "house"), 1, "turn")
    assert task.actions == ContinuousActions((-0.1, 0.4), (-1.5, 1.5))
    seen = task.observation
    assert (seen.sector_count, seen.frame_size, seen.size) == (7, 2 + 7 + 2 + 2 + 4 + 1, 54)
    assert [part.name for part in seen.parts] == ["speeds", "last_action", "own_pose", "achieved"]
    assert [(weight.term, weight.value, weight.at_end) for weight in task.reward.weights] == [
        ("progress", 1.0, True),
        ("collided", -2.0, False),
    ]
    assert (task.reward.scale, task.goal) == (0.5, CoverGoal(0.5))
    assert (task.collision_ending, task.goal_ending, task.timeout_terminal) == (
        "continues",
        "truncated",
        True,
    )
    assert (task.step_time, task.collision_checks, task.max_steps) == (0.1, 3, 77)
    assert (task.disturbances.lidar_noise, task.disturbances.latency.high) == ((0.0, 0.02), 0.1)
    (_, one), (card, two) = task.map_cases()
    assert (one.start, one.target, one.group) == ((0, 0, -1.57), (6.94, -3.79), "mine")
    assert (card.name, two.starts[0].area, two.starts[0].headings) == (
        "house",
        (-0.3, -0.3, 0.3, 0.3),
        (0, 1),
    )
    assert two.targets.is_area
    assert [case.name for _, case in task.on("mine").map_cases()] == ["one"]


MISTAKES = {
    "reward: {terms: {progres: 1}}": (1, 'did you mean "progress"', "There are: collided"),
    "reward: {terms: {progress: {weight: 1, speed: 2}}}": (1, "unknown key"),
    "reward: {name: algorithm-9}": (1, "algorithm-3"),
    "reward: {file: gone.py}": (1, "there is no file"),
    "reward: {file: ../../secret.py}": (1, "outside the folder"),
    "actions: {twists: {go: [9, 0], turn: [0, 1]}}": (1, "m/s, rad/s"),
    "actions: {twists: {go: [0.3, 0]}}": (1, "2 to 64"),
    "actions: {linear: [0.4, 0.1], angular: [-1, 1]}": (1, "least, greatest"),
    "observation: {}": (1, "needs observations"),
    "observation: {sectors: [10, 10]}": (1, "20 rays"),
    "observation: {sectors: 3, side_rays: true}": (1, "two robots"),
    "observation: {sectors: 3, targets: true}": (1, 'did you mean "target"'),
    "goal: {kind: clean}": (1, '"cover"'),
    "goal: {kind: follow}": (1, "target_model"),
    "goal: {kind: cover, share: 2}": (1, "at most 1"),
    "endings: {time: stops}": (1, "terminated"),
    "disturbances: {lidar_nose: 1}": (1, "lidar_noise"),
    "maps: [maize]": (1, "maze"),
    "world: gone.yaml": (1, "there is no file"),
    "cases: [{start: [0, 0, 0], starts: [[0, 0, 0]], target: [1, 1]}]": (1, "not both"),
    "cases: [{start: [0, 0, 0]}]": (1, '"target" is missing'),
    "robots: [a, b, c, d, e]": (1, "at most 4"),
    "gaol: {}": (1, 'did you mean "goal"'),
}
SOUND = {
    "maps": "maps: [maze]",
    "actions": "actions: {twists: {go: [0.3, 0], turn: [0, 1]}}",
    "observation": "observation: {sectors: 3}",
    "reward": "reward: {terms: {reached: 1}}",
    "cases": "cases: [{start: [0, 0, -1.57], target: [6.94, -3.79]}]",
}


@every_case("line", MISTAKES)
def test_a_mistake_has_its_place(line: str, tmp_path: Path) -> None:
    key = line.partition(":")[0]
    others = [text for name, text in SOUND.items() if name != key and (key, name) != ("world", "maps")]
    with pytest.raises(WorldError) as caught:
        read_task(written(tmp_path, "\n".join([line, *others])))
    row, *messages = MISTAKES[line]
    found = [problem for problem in caught.value.problems if messages[0] in problem.message]
    assert found, str(caught.value)
    assert key in ("goal", "robots") or found[0].location.line == row
    assert all(message in found[0].message for message in messages)


def twists(count: int) -> str:
    return f"actions: {{twists: {{{', '.join(f'a{number}: [0.1, 0]' for number in range(count))}}}}}"


def starts(count: int) -> str:
    return f"cases: [{{starts: {[[0, 0, 0]] * count}, target: [6.94, -3.79]}}]"


def targets(count: int) -> str:
    return f"cases: [{{start: [0, 0, 0], targets: {[[6.94, -3.79]] * count}}}]"


LIMITS = [
    (
        f"actions: {{twists: {{go: [{MAX_SPEED}, 0], turn: [0, -{MAX_TURN_RATE}]}}}}",
        f"actions: {{twists: {{go: [{MAX_SPEED}, 0], turn: [0, -{MAX_TURN_RATE + 0.01}]}}}}",
        "at most 2 and 6.3",
    ),
    (
        f"actions: {{linear: [-{MAX_SPEED}, {MAX_SPEED}], angular: [-{MAX_TURN_RATE}, {MAX_TURN_RATE}]}}",
        f"actions: {{linear: [-{MAX_SPEED}, {MAX_SPEED + 0.01}], angular: [0, 1]}}",
        "between -2 and 2",
    ),
    (twists(MAX_ACTIONS), twists(MAX_ACTIONS + 1), f"2 to {MAX_ACTIONS} actions"),
    (
        f"observation: {{sectors: 3, frames: {MAX_FRAMES}}}",
        f"observation: {{sectors: 3, frames: {MAX_FRAMES + 1}}}",
        f"at most {MAX_FRAMES}",
    ),
    (starts(MAX_PLACES), starts(MAX_PLACES + 1), f"at most {MAX_PLACES}"),
    (targets(MAX_PLACES), targets(MAX_PLACES + 1), f"at most {MAX_PLACES}"),
]


@every_case("most, beyond, message", LIMITS)
def test_numbers_go_up_to_their_limits(most: str, beyond: str, message: str, tmp_path: Path) -> None:
    others = [text for name, text in SOUND.items() if name != most.partition(":")[0]]
    read_task(written(tmp_path, "\n".join([most, *others])))
    with pytest.raises(WorldError, match=message):
        read_task(written(tmp_path, "\n".join([beyond, *others])))


def test_all_mistakes_come_at_once(tmp_path: Path) -> None:
    lines = [
        "reward: {terms: {progres: 1}}",
        "observation: {sectors: 0}",
        "maps: [maize]",
        "actions: {}",
        "x: 1",
    ]
    with pytest.raises(WorldError) as caught:
        read_task(written(tmp_path, "\n".join(lines)))
    assert {problem.location.line for problem in caught.value.problems} == {1, 2, 3, 4, 5}


OUT_OF_PLACE = {
    "start: [0.45, 0, 0], target: [1.6, 1.6]": "is inside a wall",
    "start: [0, 0, 0], target: [-3, 0]": "cannot be reached",
    "start: [0, 0, 0], target: [1.6, 0.3]": "cannot be reached",
    "start: [0, 0, 0], targets: [[1.6, 1.6], [1.6, 0.3]]": "(1.6, 0.3) cannot be reached",
    "start: [0, 0, 0], target_area: [1, 0, 1.5, 0.5]": "nothing in it can be reached",
    "start_area: [1, 0, 1.5, 0.5], target: [0, 0]": "no path",
    "start: [0, 0, 0], target: [0.1, 0.1]": "starts in the target",
    "start: [0, 0, 0], target: [1.6, 1.6], other_starts: [[0, 0, 0]]": "no other starts",
}


@every_case("case", OUT_OF_PLACE)
def test_a_start_in_a_wall_and_a_target_out_of_reach(case: str, tmp_path: Path) -> None:
    text = "\n".join([SOUND["actions"], SOUND["observation"], SOUND["reward"], "maps: [turn]", "cases:"])
    file = written(tmp_path, f"{text}\n  - {{{case}}}\n")
    with pytest.raises(WorldError) as caught:
        check_task(read_task(file))
    (problem,) = caught.value.problems
    assert OUT_OF_PLACE[case] in problem.message
    assert (problem.location.file.name, problem.location.line) == ("mine.yaml", 6)


MISSING = {
    "robots: [surp]": 'did you mean "serp"',
    "goal: {kind: avoid}": "needs models that move",
    "goal: {kind: follow}": 'nothing that moves on turn is named "serp"',
}


@every_case("line", MISSING)
def test_what_the_world_lacks_is_said_where_the_task_asks_for_it(line: str, tmp_path: Path) -> None:
    target = "target_model: serp" if "follow" in line else "target: [1.6, 1.6]"
    sound = [SOUND["actions"], SOUND["observation"], SOUND["reward"], "maps: [turn]"]
    text = "\n".join([*sound, line, f"cases: [{{start: [0, 0, 0], {target}}}]"])
    with pytest.raises(WorldError) as caught:
        check_task(read_task(written(tmp_path, text)))
    (problem,) = caught.value.problems
    assert MISSING[line] in problem.message
    assert (problem.location.file.name, problem.location.line) == ("mine.yaml", 6 if "follow" in line else 5)


LONG = {
    "goal: {kind: target}": "target: [1.6, 1.6]",
    "goal: {kind: patrol, rounds: 9}": "targets: [[1.6, 1.6], [0, 0.5]]",
    "goal: {kind: wall, length: 60}": "",
}


@every_case("goal", LONG)
def test_a_goal_that_takes_longer_than_an_episode_is_told(goal: str, tmp_path: Path) -> None:
    case = ", ".join(["start: [0, 0, 0]", *filter(None, [LONG[goal]])])
    rest = [
        *(SOUND[key] for key in ("actions", "observation", "reward")),
        "maps: [turn]",
        f"cases: [{{{case}}}]",
    ]
    check_task(read_task(written(tmp_path, "\n".join(["step: {limit: 9000}", goal, *rest]))))
    with pytest.raises(WorldError, match=r"an episode is over after 0\.8 s") as caught:
        check_task(read_task(written(tmp_path, "\n".join(["step: {limit: 4}", goal, *rest]))))
    (problem,) = caught.value.problems
    assert problem.location.line == 1


def test_starts_of_other_robots_are_asked_for(tmp_path: Path) -> None:
    lines = ["robots: [serp, other]", *SOUND.values()]
    with pytest.raises(WorldError, match=r'with 2 robots it needs "other_starts": for each start, 1 pose'):
        read_task(written(tmp_path, "\n".join(lines)))


@pytest.mark.sampled(5)
@pytest.mark.parametrize("task", all_tasks(), ids=lambda task: task.name)
def test_the_kits_own_tasks_are_sound_files(task: LearningTask) -> None:
    assert task.file == tasks_folder() / f"{task.name}.yaml"
    check_task(read_task(task.file))
    assert task.summary
    assert {task.name for task in all_tasks()} == set(task_names())


def test_a_task_is_found_by_file_and_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "sweep").mkdir()
    (tmp_path / "sweep" / "task.yaml").write_text(WHOLE)
    monkeypatch.chdir(tmp_path)
    for name in ("sweep", "sweep/task.yaml", str(tmp_path / "sweep")):
        assert find_task(name).name == "sweep"
    for name in ("swep", "sweep/tusk.yaml"):
        with pytest.raises(UnknownTask):
            find_task(name)


def test_a_choice_keeps_the_text_of_its_file(tmp_path: Path) -> None:
    file = written(tmp_path, WHOLE)
    choice = TaskSpec(str(file), ("one",)).frozen()
    again = TaskSpec.from_dict(choice.as_dict())
    assert again == choice
    assert (again.name, again.title, again.has_changed) == ("mine", "mine on one", False)
    file.write_text(WHOLE.replace("limit: 77", "limit: 78"))
    assert (again.resolve().max_steps, again.has_changed) == (77, True)
    file.unlink()
    assert again.resolve().max_steps == 77
    assert TaskSpec("turn").frozen() == TaskSpec("turn")


OWN_WORLD = """
summary: In a world of its own
world: WORLD
cases: [{start: [0.5, 0.5, 0], target: [0.8, 0.5]}]
actions: {twists: {forward: [0.3, 0], left: [0, 1]}}
observation: {sectors: 1}
reward: {terms: {progress: 1.0}}
"""


def test_a_text_from_elsewhere_names_no_file_of_this_machine(tmp_path: Path) -> None:
    """A policy brings the text of its task, and the path of a file: the world is read only where that file names it too."""
    secret, file = tmp_path / "secret.yaml", tmp_path / "task.yaml"
    secret.write_text("hunter2: [40302]\n")
    text = OWN_WORLD.replace("WORLD", "secret.yaml")
    for present in (None, "nothing: of it\n", "[", OWN_WORLD.replace("WORLD", "other.yaml")):
        if present is not None:
            file.write_text(present)
        with pytest.raises(WorldError) as caught:
            TaskSpec(str(file), text=text).resolve()
        assert "its world is not here" in str(caught.value)
        assert "hunter2" not in str(caught.value)
    file.write_text(text)
    assert TaskSpec(str(file), text=text).resolve().maps == ()  # its own author's: it is read later


def test_whether_a_file_has_changed_is_not_looked_for_in_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    text = (tasks_folder() / "turn.yaml").read_text()
    for place in (tmp_path / "pipe", Path("/dev/zero"), tmp_path / "none"):
        assert not TaskSpec(str(place), text=text).has_changed
    (tmp_path / "mine.yaml").write_text("summary: another\n")
    assert TaskSpec(str(tmp_path / "mine.yaml"), text=text).has_changed


def test_the_worlds_file_of_a_map_lies_in_its_folder(tmp_path: Path) -> None:
    file = tmp_path / "task.yaml"
    for name in ("../../pyproject.toml", "/etc/passwd", "x" * 300):
        file.write_text(f"{(tasks_folder() / 'turn.yaml').read_text()}\nworld_file: {name}\n")
        with pytest.raises(WorldError, match=r"outside|no file"):
            read_task(file)


def test_a_task_adds_carts_to_its_map(tmp_path: Path) -> None:
    carts = "carts: [{name: lorry, start: [0.9, 2.0, 0], delta: [4.0, 0], duration: 6}]\n"
    text = (tasks_folder() / "behind-the-cart.yaml").read_text()
    file = tmp_path / "task.yaml"
    file.write_text(carts + text.replace("slow_cart", "lorry"))
    read = read_task(file)
    check_task(read)
    assert BatchEnv(read.task, 1).obstacle_poses(0).shape == (4, 3)
    assert leader_frame(read.task)
    file.write_text(carts.replace("duration: 6", "duration: 0") + text)
    with pytest.raises(WorldError, match=r"task.yaml:1:.*duration"):
        read_task(file)


def test_a_newcomer_meets_the_dissertations_variants_apart() -> None:
    assert {each.name for each in first_tasks()} >= {"turn", "hallway", "wheelchairs"}
    assert not {each.name for each in first_tasks()} & {each.name for each in dissertation_tasks()}
    assert all("-seed" in each.name for each in dissertation_tasks())
    assert not any("-seed" in each.name for each in first_tasks())
