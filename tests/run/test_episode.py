"""The episode: the same arguments, metrics and end at the student's own run, in a race and in a grade; one loop."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import pytest

import kit
from grader.assignment import Assignment, Shift, Trial
from grader.driving.episodes import run_episode
from grader.evidence.contract import EpisodeSpec
from grader.kinds.environment.examination import EnvironmentTask, examine_environment
from grader.kinds.world.facts import WorldRunSpec
from grader.kinds.world.world_run import run_world
from grader.task_files import task_scenario
from kit.controllers import ControllerFile, find_controller
from kit.geometry import Pose
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.goals.patrol import PatrolGoal
from kit.ros.execution.arguments import parse_ros_arguments
from kit.run.episode import (
    EndCondition,
    EndReason,
    controller_arguments,
    run_until,
    when,
    when_failed,
    when_reached,
)
from kit.run.headless import run_headless
from kit.run.metrics import DriveMetrics, MetricsRecorder
from kit.run.scenario import Scenario, find_scenario, scenario_in_file
from kit.run.session import Session
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.objective import Objective
from kit.school.game.race import race_controller
from tests.cases import every_case
from tests.kit_content import kit_maps

ROOT = Path(__file__).parent.parent.parent
CASES = [(card.name, case.name) for card in kit_maps() for case in card.cases]

DRIVER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        models = self.declare_parameter("models", [""]).value
        partners = ["cmd_vel"] if len(models) == 1 else [f"/{name}/cmd_vel" for name in models]
        self.wheels = [self.create_publisher(Twist, topic, 10) for topic in partners]
        self.create_timer(0.05, self.drive)

    def drive(self):
        command = Twist()
        command.linear.x = 0.5
        for wheels in self.wheels:
            wheels.publish(command)
"""


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The arguments of every program that is started; none of them really starts."""
    seen: list[list[str]] = []

    def refuse(self: NodeProcess, graph: object, file: Path, *, args: list[str], **_: object) -> None:
        seen.append([str(word) for word in args])
        raise StudentCodeError(Failure(FailureKind.EXIT, "only the arguments are wanted here"))

    monkeypatch.setattr(NodeProcess, "__init__", refuse)
    return seen


def level_on(map_name: str, case: str, seconds: float = 6.0) -> GameLevel:
    return GameLevel("test", "Test", map_name, case, "", (), 0, time_limit=seconds)


def trial_on(map_name: str, case: str | None, seconds: float) -> Trial:
    return trial_of(find_scenario(map_name, case), seconds)


def trial_of(scenario: Scenario, seconds: float) -> Trial:
    return Trial(
        "test",
        scenario,
        seconds,
        (1,),
        (),
        Shift(),
        None,
        True,
        frozenset({"move_model"}),
    )


@dataclass(frozen=True)
class OnlyLimits:
    """The part of an assignment that an environment's evidence needs."""

    limits: Limits = INTERACTIVE_LIMITS


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("map_name", "case"), CASES)
def test_a_controller_gets_the_same_arguments_everywhere(
    map_name: str, case: str, given: list[list[str]], tmp_path: Path
) -> None:
    check_faces(find_scenario(map_name, case), level_on(map_name, case), given, tmp_path)


@pytest.mark.parametrize("rounds", [1, 2])
def test_a_controller_gets_all_targets_everywhere(
    rounds: int, given: list[list[str]], tmp_path: Path
) -> None:
    way = ((2.0, -1.6), (-1.9, 1.6), (0.8, 1.0))
    level = replace(level_on("house", "house_study"), goal=PatrolGoal(rounds), targets=way)
    scenario = level.find_scenario()
    values = values_of(check_faces(scenario, level, given, tmp_path))
    assert values["target"] == list(way[0])
    assert values["targets"] == [each for point in way * rounds for each in point]
    headless = ControllerFile("driver", tmp_path / "driver.py", "")
    run_headless(scenario, headless, steps=1)
    assert given[-1] == controller_arguments(scenario)


def test_a_way_of_one_target_is_no_new_parameter() -> None:
    level = replace(level_on("house", "house_study"), goal=PatrolGoal(1), targets=((2.0, -1.6),))
    assert "targets" not in values_of(controller_arguments(level.find_scenario()))


def test_patrols_of_the_game_and_of_tasks_say_where_they_go() -> None:
    ways = 0
    for level in all_levels():
        scenario = level.find_scenario()
        values = values_of(controller_arguments(scenario))
        if level.goal.is_route:
            discs = Objective(replace(level, any_order=True), scenario, 0.01).discs
            assert values["targets"] == [each for disc in discs for each in (disc.x, disc.y)], level.id
            ways += 1
        else:
            assert "targets" not in values, level.id
    assert ways > 10
    task = find_task("night-watch")
    (_, case), *_ = task.map_cases()
    corners = [each for pose in case.targets.poses for each in (pose.x, pose.y)]
    assert values_of(controller_arguments(task_scenario(task)))["targets"] == corners
    assert "targets" not in values_of(controller_arguments(task_scenario(find_task("hallway"))))


def check_faces(scenario: Scenario, level: GameLevel, given: list[list[str]], tmp_path: Path) -> list[str]:
    """Starts a program in every face, and checks that each gives it the same; returns what it is given."""
    file = tmp_path / "driver.py"
    file.write_text(DRIVER)
    with Session(scenario) as session:
        session.drive_with(find_controller(str(file)))
    race_controller(level, find_controller("random_walk"))
    run_episode(
        EpisodeSpec(trial_of(scenario, 1.0), 1, "", False),
        file,
        limits=INTERACTIVE_LIMITS,
        level=INTERACTIVE_LEVEL,
    )
    task = EnvironmentTask("Env", scenario, ((0.1, 0.0),), 0.1, 10, (), "/scan", 1.0, 1, None)
    with pytest.raises(StudentCodeError):
        examine_environment(task, cast("Assignment", OnlyLimits()), file, INTERACTIVE_LEVEL, 1)
    own, raced, graded, environment = given
    assert own == raced == graded
    assert environment == [file.stem, "Env", *own]
    assert own == controller_arguments(scenario)
    return own


def values_of(words: list[str]) -> dict[str, object]:
    """The parameters among a program's arguments, by name."""
    parsed = parse_ros_arguments(words)
    return {each.name: each.value for given in parsed.parameters for each in given.parameters}


@pytest.mark.sampled(5)
@pytest.mark.parametrize(("map_name", "case"), CASES)
def test_a_graded_world_tells_its_driver_the_same(
    map_name: str, case: str, given: list[list[str]], tmp_path: Path
) -> None:
    scenario = find_scenario(map_name, case)
    assert scenario.case is not None
    alone = replace(scenario, case=replace(scenario.case, partner_start=None))
    target, radius = scenario.case.target, scenario.case.target_radius
    run_world(scenario.world, WorldRunSpec("", 1, 1.0, str(tmp_path / "x.py"), "", target, radius, True))
    assert given == [controller_arguments(alone)]


@every_case(("map_name", "case"), CASES)
def test_the_arguments_say_what_the_scenario_is(map_name: str, case: str) -> None:
    scenario = find_scenario(map_name, case)
    assert scenario.case is not None
    assert scenario.driven is not None
    parsed = parse_ros_arguments(controller_arguments(scenario))
    assert values_of(controller_arguments(scenario)) == {
        "home": list(scenario.case.start),
        "model": scenario.robot,
        "models": list(scenario.partners),
        "world": str(scenario.world.file.absolute()),
        "target": list(scenario.case.target),
        "target_radius": scenario.case.target_radius,
    }
    namespaces = [each.replacement for each in parsed.remappings]
    assert namespaces == ([f"/{scenario.driven.namespace}"] if scenario.driven.namespace else [])


@dataclass(frozen=True)
class Outcome:
    """What came of one episode."""

    metrics: DriveMetrics
    end: EndReason


def own_run(map_name: str, case: str | None, controller: ControllerFile, seconds: float) -> Outcome:
    with Session(find_scenario(map_name, case), seed=1) as session:
        session.drive_with(controller)
        session.wait_until_driven()
        ends = (when_failed(session), when_reached(session.metrics))
        end = run_until(session.runner, limit_s=seconds, ends=ends)
        return Outcome(session.metrics.metrics, end)


@pytest.mark.long
@pytest.mark.parametrize(
    ("map_name", "seconds", "end"),
    [
        ("hall_straight", 8.0, EndReason.REACHED),
        ("simple", 3.0, EndReason.LIMIT),
        ("turn", 6.0, EndReason.LIMIT),  # into a wall
        ("pair_straight", 12.0, EndReason.REACHED),
    ],
)
def test_the_same_metrics_and_end_everywhere(
    map_name: str, seconds: float, end: EndReason, tmp_path: Path
) -> None:
    file = tmp_path / "driver.py"
    file.write_text(DRIVER)
    own = own_run(map_name, None, find_controller(str(file)), seconds)
    assert own.end is end

    trial = trial_on(map_name, None, seconds)
    graded = run_episode(
        EpisodeSpec(trial, 1, "", False), file, limits=INTERACTIVE_LIMITS, level=INTERACTIVE_LEVEL
    )
    assert graded.score == own.metrics
    assert len(graded.bump_ticks) == own.metrics.bumps
    assert graded.failure is None

    case = trial.scenario.case
    assert case is not None
    finish, recording = race_controller(level_on(map_name, case.name, seconds), find_controller(str(file)))
    assert finish.failure is None
    assert finish.reached == (end is EndReason.REACHED)
    assert finish.seconds == own.metrics.time_s
    assert recording.ticks == graded.recording.ticks
    if len(trial.scenario.partners) == 1:
        assert finish.collisions == own.metrics.bumps


def test_arrival_is_at_most_the_radius() -> None:
    scenario = find_scenario("simple")
    assert scenario.case is not None
    assert scenario.robot is not None
    with Session(scenario) as session:
        simulation = session.runner.simulation
        exact = simulation.hull_distance(scenario.robot, scenario.case.target)
        assert scenario.driven is not None
        inside = MetricsRecorder([scenario.driven], scenario.case.target, exact)
        outside = MetricsRecorder([scenario.driven], scenario.case.target, exact - 1e-9)
        session.runner.observers += [inside, outside]
        session.runner.tick()
        assert simulation.hull_distance(scenario.robot, scenario.case.target) == exact
        assert inside.all_reached_s == pytest.approx(0.01)
        assert outside.all_reached_s is None


def test_both_of_a_pair_must_arrive() -> None:
    scenario = find_scenario("pair_straight")
    assert scenario.case is not None
    left, right = scenario.partners
    with Session(scenario) as session:
        x, y = scenario.case.target
        session.runner.call_service("move_model", left, (x, y, 0.0))
        session.runner.tick()
        assert session.metrics.metrics_of(left).reached_s is not None
        assert session.metrics.metrics_of(right).reached_s is None
        assert session.metrics.all_reached_s is None


class Counting:
    """Something to tick."""

    step_size = 0.1

    def __init__(self) -> None:
        self.count = 0

    def tick(self) -> None:
        self.count += 1


def test_a_limit_is_so_many_seconds_or_ticks() -> None:
    run = Counting()
    assert run_until(run, limit_s=1.0) is EndReason.LIMIT
    assert run.count == 10
    assert run_until(run, ticks=3) is EndReason.LIMIT
    assert run.count == 13
    for ticks in (0, -1):
        assert run_until(run, ticks=ticks) is EndReason.LIMIT
        assert run.count == 13


def test_a_time_that_is_none_is_refused() -> None:
    for seconds in (-1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="seconds"):
            kit.run_episode("maze", "forward", seconds=seconds)


def test_the_first_end_that_is_met_counts() -> None:
    run = Counting()
    failed = EndCondition(EndReason.FAILED, lambda: run.count >= 4)
    numbers: list[int] = []
    end = run_until(run, limit_s=1.0, ends=(when(lambda: run.count >= 5), failed), before_tick=numbers.append)
    assert end is EndReason.FAILED
    assert numbers == [0, 1, 2, 3]
    assert run_until(run, limit_s=1.0, ends=(failed,)) is EndReason.FAILED
    assert run.count == 4  # it was over before it began


def test_an_end_that_is_met_by_the_last_tick_counts() -> None:
    run = Counting()
    assert run_until(run, ticks=5, ends=(when(lambda: run.count == 5),)) is EndReason.STOPPED


def test_a_world_without_a_robot_has_no_arguments(tmp_path: Path) -> None:
    (tmp_path / "world.yaml").write_text("properties: {}\nlayers: []\nmodels: []\n")
    assert controller_arguments(scenario_in_file(tmp_path / "world.yaml")) == []


def test_home_may_be_elsewhere() -> None:
    words = controller_arguments(find_scenario("simple"), Pose(0.5, -0.25, 1.0))
    assert "home:=[0.5, -0.25, 1.0]" in words


LOOPS = {
    "kit/run/episode.py",  # the loop
    "kit/run/runner.py",  # what one turn of it is
    "kit/run/world_thread.py",  # a face's thread: between any two ticks it may be paused, stepped or given a job
}


def ticking_loops(source: Path) -> Iterator[int]:
    """Lines of loops that tick a run or step a simulation by themselves."""
    for loop in ast.walk(ast.parse(source.read_text())):
        if not isinstance(loop, ast.For | ast.While):
            continue
        for call in ast.walk(loop):
            if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute)):
                continue
            owner = ast.unparse(call.func.value)
            if (call.func.attr == "tick" and "parser" not in owner) or (
                call.func.attr in ("step", "advance") and "simulation" in owner
            ):
                yield call.lineno


def test_nobody_else_has_a_loop_of_ticks() -> None:
    sources = [*(ROOT / "kit").rglob("*.py"), *(ROOT / "grader").rglob("*.py")]
    found = {
        f"{name}:{line}"
        for source in sources
        if (name := source.relative_to(ROOT).as_posix()) not in LOOPS and not name.startswith("kit/sim/")
        for line in ticking_loops(source)
    }
    assert found == set()
