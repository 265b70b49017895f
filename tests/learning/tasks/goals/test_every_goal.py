"""The contract of goals, for every goal that there is: read, counted, told, raced or refused, by one file each."""

from __future__ import annotations

import ast
import json
from dataclasses import fields, replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

import kit
from kit.document.layout import lines_of
from kit.learning.authoring.new_task import new_task_file
from kit.learning.authoring.task_check import check_task
from kit.learning.authoring.task_text import build_case_scene, key_tables, task_blocks
from kit.learning.environment.batch import BatchEnv
from kit.learning.policies.node_goals.goal_count import GoalStep
from kit.learning.policies.policy_node import node_count, node_refusals
from kit.learning.tasks.goals.goal import KNOWN_IN_RACE, CaseTargets
from kit.learning.tasks.goals.registry import goal_kinds
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_reader import ReadTask, read_task
from kit.learning.tasks.transition import EpisodeState, Transition
from kit.school.game.objective import Objective
from kit.school.game.task_levels import task_level
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError

KINDS = goal_kinds()
WORLDS, STEPS = 6, 60
TARGETS = {
    CaseTargets.NONE: "",
    CaseTargets.PLACE: ", target: [2.4, 2.0]",
    CaseTargets.ROUTE: ", targets: [[1.4, 2.0], [2.0, 2.0]]",
    CaseTargets.LEADER: ", target_model: slow_cart",
}
PLACES = {
    1: ("crossing", "[0.6, 2.0, 0]"),
    2: ("pair_straight", "[0.475, 0.5, 1.5708], other_starts: [[0.875, 0.5, 1.5708]]"),
}
"""A map for so many robots, and where they start."""
TASK = """\
maps: [{map}]
cases: [{{name: road, start: {start}{targets}}}]
actions: {{twists: {{forward: [0.4, 0], left: [0, 1.2], right: [0, -1.2]}}, one_number: false}}
observation: {{sectors: 13, achieved: true}}
reward: {{terms: {{achieving: 1.0, reached: 1.0}}}}
goal: {goal}
start: {{noise: 0.05, max_rotation: 0.3}}
target: {{radius: 0.15}}
step: {{limit: 120}}
"""
every_goal = pytest.mark.parametrize("kind", KINDS)


def read_goal_task(kind: str, folder: Path, settings: str = "") -> ReadTask:
    """A task with that goal, on a road with carts."""
    file = folder / f"{kind}.yaml"
    goal = f"{{kind: {kind}{settings}}}"
    targets = TARGETS[KINDS[kind].case_targets] + (
        ", target_heading: 0" if "heading_tolerance" in settings else ""
    )
    place, start = PLACES[KINDS[kind].least_robots]
    file.write_text(TASK.format(map=place, start=start, targets=targets, goal=goal))
    return read_task(file)


def drive(task: LearningTask, n: int, first: int = 0) -> list[Transition]:
    """Steps of worlds by chance, mostly forward; each world has actions of its own."""
    batch = BatchEnv(task, n, seed=3, first=first)
    batch.reset()
    numbers = (STEPS, task.robots) if task.robots > 1 else STEPS
    actions = [np.random.default_rng(first + i).choice(3, numbers, p=[0.8, 0.1, 0.1]) for i in range(n)]
    return [batch.step(each).transition for each in np.stack(actions, axis=1)]


def test_every_module_of_the_folder_is_a_goal_or_the_contract() -> None:
    folder = Path(kit.__file__).parent / "learning" / "tasks" / "goals"
    assert set(KINDS) == {file.stem for file in folder.glob("*.py")} - {"__init__", "goal", "registry"}
    assert all(KINDS[kind].__module__.endswith(f".{kind}") for kind in KINDS)


@every_goal
def test_a_file_gives_its_settings_and_nothing_else(kind: str, tmp_path: Path) -> None:
    usual = read_goal_task(kind, tmp_path).task.goal
    assert usual == KINDS[kind]()
    for field in fields(usual):  # type: ignore[arg-type]  # a dataclass, by contract
        value = getattr(usual, field.name)
        other = {str: "left", int: 2, float: 0.5, type(None): 0.5}[type(value)]
        found = read_goal_task(kind, tmp_path, f", {field.name}: {other}").task.goal
        assert getattr(found, field.name) == other
    if KINDS[kind].least_robots > 1:
        file = tmp_path / f"{kind}.yaml"
        file.write_text(
            TASK.format(map="crossing", start="[0.6, 2.0, 0]", targets="", goal=f"{{kind: {kind}}}")
        )
        with pytest.raises(WorldError, match="needs 2 robots"):
            read_task(file)
    with pytest.raises(WorldError, match="no_such_setting"):
        read_goal_task(kind, tmp_path, ", no_such_setting: 1")


@every_goal
def test_it_is_checked_drawn_and_told(kind: str, tmp_path: Path) -> None:
    read = read_goal_task(kind, tmp_path)
    check_task(read)
    task, goal = read.task, read.task.goal
    (card, case), *_ = task.map_cases()
    drawn = build_case_scene(task, card, case)
    assert bool(drawn.targets) == goal.has_standing_targets
    assert goal.description in " ".join(" ".join(lines_of(task_blocks(task))).split())
    keys = "\n".join(lines_of(key_tables()))
    assert kind in keys
    assert all(name.split()[0] in keys for name in goal.usual_settings().split(", ") if name)
    assert kind in new_task_file("mine", "crossing", tmp_path).read_text()


@every_goal
def test_it_is_counted_in_one_world_as_among_many(kind: str, tmp_path: Path) -> None:
    task = read_goal_task(kind, tmp_path).task
    many = drive(task, WORLDS)
    for world in range(WORLDS):
        for step, alone in zip(many, drive(task, 1, first=world), strict=True):
            assert np.array_equal(step.achieved[world], alone.achieved[0])
            assert np.array_equal(step.previous_achieved[world], alone.previous_achieved[0])


@every_goal
def test_its_count_grows_and_is_reached_when_full(kind: str, tmp_path: Path) -> None:
    task = read_goal_task(kind, tmp_path).task
    for step in drive(task, WORLDS):
        if task.goal.case_targets is not CaseTargets.PLACE:  # robots may leave a target
            assert (step.achieved >= step.previous_achieved).all()
        assert np.array_equal(step.reached, (step.achieved >= 1.0) & ~step.collided)
        assert (step.previous_achieved[step.step > 1] < 1.0).all()
        progress = [task.goal.progress(float(count), 4.0) for count in step.after.count]
        assert all(isinstance(each, str) for each in progress)


@every_goal
def test_a_race_counts_it_without_what_a_race_does_not_know(kind: str, tmp_path: Path) -> None:
    read = read_goal_task(kind, tmp_path)
    level = task_level(tmp_path / f"{kind}.yaml")
    scenario = level.find_scenario()
    objective = Objective(level, scenario, 0.01)
    simulation = Simulation(scenario.world, seed=1)
    for _ in range(20):
        simulation.step()
        objective.on_step(simulation)
    assert "nan" not in objective.progress
    # the count of the batch engine, of the same states in which all is known
    cases = BatchEnv(read.task, 1, seed=0)._case_arrays.goal_cases
    count = read.task.goal.make_count(cases, 1, read.task.step_time)
    (step,) = drive(replace(read.task, random_phase=False), 1)[:1]
    count.begin(np.zeros(1, dtype=np.int64), step.case, step.previous_pose)
    other = read.task.goal.make_count(cases, 1, read.task.step_time)
    other.begin(np.zeros(1, dtype=np.int64), step.case, step.previous_pose)
    reads_lidar = read.task.goal.reads_lidar
    unknown = replace(
        step, before=unsensed(step.before, reads_lidar), after=unsensed(step.after, reads_lidar)
    )
    assert np.array_equal(count.count(step), other.count(unknown))


def unsensed(state: object, reads_lidar: bool) -> EpisodeState:
    """The state as far as a race knows it, which reads lidars only where the goal does."""
    whole = EpisodeState.of(state)  # type: ignore[arg-type]
    known = KNOWN_IN_RACE | ({"ranges"} if reads_lidar else set())
    unknown = {each.name for each in fields(EpisodeState)} - known
    return replace(whole, **{name: np.full(getattr(whole, name).shape, np.nan) for name in unknown})


@every_goal
def test_a_node_counts_it_as_training_does_or_is_refused(kind: str, tmp_path: Path) -> None:
    read = read_goal_task(kind, tmp_path)
    goal, cases = read.task.goal, BatchEnv(read.task, 1, seed=0)._case_arrays.goal_cases
    program = files("kit.learning.policies.node_goals").joinpath(f"{kind}.py")
    if not program.is_file():
        assert any(f"goal {kind}" in each for each in node_refusals(read.task))
        return
    assert node_refusals(read.task) == ()
    facts = {**goal.node_facts(cases[0]), "step_time": read.task.step_time}
    count = type(node_count(read.task))(json.loads(json.dumps(facts)))
    assert count.is_observation_delayed == goal.is_observation_delayed
    steps = drive(read.task, 1)
    told = count.begin(steps[0].previous_pose[0])
    assert told == steps[0].before.count[0]
    for step in steps:
        told = count.count(
            told,
            GoalStep(
                step.pose[0],
                step.previous_pose[0],
                bool(step.in_target.all()),
                step.target[0],
                np.stack([step.beside_left[0], step.beside_right[0]], axis=1),
            ),
        )
        if step.collided[0] or step.ended[0]:
            break
        assert told == pytest.approx(step.after.count[0])
        assert told / count.needed == pytest.approx(step.achieved[0])


def test_nobody_else_tells_goals_apart() -> None:
    """Neither by ``isinstance`` nor by ``match`` nor by the name of a kind."""
    root = Path(kit.__file__).parents[1]
    classes = {goal.__name__ for goal in KINDS.values()}
    found = []
    for file in (*root.glob("kit/**/*.py"), *root.glob("grader/**/*.py")):
        text = file.read_text(encoding="utf-8")
        if file.parent.name == "goals" or not ("goal" in text and ("Goal" in text or ".kind" in text)):
            continue
        for node in ast.walk(ast.parse(text)):
            asked: list[ast.AST] = []
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == "isinstance"
            ):
                asked = [node.args[1]]
            elif isinstance(node, ast.MatchClass):
                asked = [node.cls]
            elif isinstance(node, ast.Compare) and ast.unparse(node.left).endswith("goal.kind"):
                found.append(f"{file}:{node.lineno}")
            names = {each.id for part in asked for each in ast.walk(part) if isinstance(each, ast.Name)}
            if names & classes:
                found.append(f"{file}:{node.lineno}")  # type: ignore[attr-defined]  # a call or a pattern has a place
    assert not found
