"""Checks of drives ask for a behaviour: what happens once, or all at once, is none."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from grader.check import NoParams
from grader.driving.checks import interfaces, speeds, walls, ways
from grader.driving.checks.interfaces import AnswerParams
from grader.driving.checks.ways import CircleParams
from grader.driving.drive_record import NO_COMMAND, GradedDrive, TopicTraffic
from grader.driving.following import FlagByRangeParams, SpeedByFlagParams, SpeedByRangeParams
from grader.driving.message_rate import MessageRate
from grader.driving.service_calls import NO_SERVICE
from grader.grading import GradingOptions, grade
from grader.kinds.environment.examination import FreePlacementRunner
from grader.reading import read_assignment
from grader.submission import Submission
from kit.arrays import FloatArray
from kit.host.sandbox.sandbox_config import Level
from kit.ros.graph.connections import NodeConnections
from kit.ros.graph.graph import Graph
from kit.run.scenario import find_scenario
from kit.sim.simulation import Simulation, SimulationError
from tests.cases import every_case
from tests.grader.conftest import QUICK, write_assignment
from tests.grader.further_attacks import ROBOT, ROBOT_WITH_LASER, ROOM, SQUARE

SECONDS = 20


def rate_of(per_second: dict[int, int], rate: float) -> float:
    return MessageRate(per_second, rate, SECONDS).error


@every_case(
    "rate, per_second, is_steady",
    [
        (10, dict.fromkeys(range(SECONDS), 10), True),
        (10, dict.fromkeys(range(1, SECONDS), 10), True),
        (10, {0: 10 * SECONDS}, False),
        (10, {0: 100, 19: 100}, False),
        (10, dict.fromkeys(range(0, SECONDS, 2), 20), False),
        (10, dict.fromkeys(range(SECONDS), 5), False),
        (10, {}, False),
        (1, dict.fromkeys(range(SECONDS), 1), True),
        (1, {0: SECONDS}, False),
        (0.5, dict.fromkeys(range(0, SECONDS, 2), 1), True),
        (0.5, {0: 10}, False),
    ],
)
def test_a_rate_is_kept_all_the_time(rate: float, per_second: dict[int, int], is_steady: bool) -> None:
    assert (rate_of(per_second, rate) <= 0.1) == is_steady


def graded(folder: Path, checks: str, source: str) -> dict[str, float]:
    sheet = QUICK.partition("checks:")[0] + f"checks: [{checks}]\n"
    assignment = read_assignment(write_assignment(folder, sheet))
    work = Submission("ada", "controller.py", {"controller.py": source.encode()})
    result = grade(assignment, work, GradingOptions(Level.LIMITED))
    return {test.id: test.points for test in result.tests}


NODE = """
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.drive = self.create_publisher(Twist, "TOPIC", 10)
        self.create_timer(PERIOD, self.once)
        self.is_first = True

    def once(self):
        for _ in range(COUNT):
            if self.is_first or not ALL_AT_ONCE:
                self.drive.publish(Twist())
                self.get_logger().info("alive")
        self.is_first = False

rclpy.init()
rclpy.spin(Talker())
"""


def talker(topic: str, *, all_at_once: bool, count: int = 1) -> str:
    words = {"TOPIC": topic, "PERIOD": "0.1", "COUNT": str(count), "ALL_AT_ONCE": str(all_at_once)}
    source = NODE
    for word, value in words.items():
        source = source.replace(word, value)
    return source


@pytest.mark.long
@pytest.mark.parametrize(("all_at_once", "count", "points"), [(False, 1, 2.0), (True, 40, 0.0)])
def test_all_messages_and_lines_in_the_first_tick_are_no_rate(
    all_at_once: bool, count: int, points: float, tmp_path: Path
) -> None:
    checks = (
        "{check: rate, points: 1, with: {topic: /cmd_vel, rate: 10}}, "
        "{check: says, points: 1, with: {text: alive, seconds: 0.1}}"
    )
    source = talker("cmd_vel", all_at_once=all_at_once, count=count)
    sheet_time = QUICK.count("time:")
    assert sheet_time == 1
    assert sum(graded(tmp_path / "r", checks, source).values()) == pytest.approx(points)


def drive_by_range(distances: list[float], driven: list[float]) -> float:
    """What ``speed_by_range`` measures where a scan comes ten times a second, and a command right after it."""
    return speeds.speed_by_range.measure(range_drive(distances, driven), SpeedByRangeParams())


def range_drive(distances: list[float], driven: list[float]) -> GradedDrive:
    times = np.arange(len(distances)) / 10
    return drive_of(
        ahead={"/static_laser": np.column_stack([times, distances, distances])},
        commands=np.column_stack([times + 0.01, driven, 0 * times]),
    )


def drive_of(**fields: Any) -> GradedDrive:
    """A drive of which only these fields are known."""
    drive = object.__new__(GradedDrive)
    nothing = {"ahead": {}, "flags": {}, "commands": np.empty((0, 3)), "answers": {}, "refused": ()}
    known = {"secret": False, "printed": (), "connections": NodeConnections(), **nothing, **fields}
    for name, value in known.items():
        object.__setattr__(drive, name, value)
    return drive


def test_the_speed_must_follow_what_the_laser_measures() -> None:
    distances = [*np.linspace(2.0, 0.4, 60).tolist(), *[0.4] * 20, *[float("nan")] * 5]
    right = [0.0 if each < 0.5 else 0.3 if each < 1.2 else 0.6 for each in distances]
    assert drive_by_range(distances, right) == 1.0
    assert drive_by_range(distances, [right[0], *right[:-1]]) == 1.0, (
        "it may answer the scan before the newest"
    )
    assert drive_by_range(distances, [0.6] * len(right)) == 0.0
    late = [*[0.6] * 12, *right[:-12]]
    assert drive_by_range(distances, late) < 0.9, "the same speeds in the same order, by the clock"
    assert drive_by_range([2.0] * 50, [0.6] * 50) == 0.0, "who never comes near shows nothing"
    assert drive_by_range([], []) == 0.0


def test_the_first_speed_that_does_not_follow_is_told_with_what_was_ahead() -> None:
    distances = [*np.linspace(2.0, 0.4, 60).tolist(), *[0.4] * 20]

    def told(driven: list[float]) -> str:
        return range_drive(distances, driven).explain("speed_by_range", SpeedByRangeParams())

    never_stops = told([0.3 if each < 1.2 else 0.6 for each in distances])
    assert "0.3 m/s; 0 m/s is asked for" in never_stops
    shown = float(never_stops.partition("with ")[2].partition(" m")[0])
    assert 0.4 <= shown < 0.5, "the case that is wrong, though the others come before it"
    assert not told([0.0 if each < 0.5 else 0.3 if each < 1.2 else 0.6 for each in distances])
    far = range_drive([2.0] * 50, [0.6] * 50).explain("speed_by_range", SpeedByRangeParams())
    assert "less than 0.5 m" in far, "a case that never came is named"
    open_ground = range_drive([float("nan")] * 50, [0.0] * 50).explain("speed_by_range", SpeedByRangeParams())
    assert "nan" in open_ground
    assert "0.6 m/s is asked for" in open_ground


def flags_by_range(near: list[float], wide: list[float], said: list[bool]) -> float:
    return speeds.flag_by_range.measure(flag_drive(near, wide, said), FlagByRangeParams())


def flag_drive(near: list[float], wide: list[float], said: list[bool]) -> GradedDrive:
    times = np.arange(len(near)) / 10
    return drive_of(
        ahead={"/static_laser": np.column_stack([times, near, wide])},
        flags={"/wall_ahead": np.column_stack([times, said])},
    )


def test_the_first_wrong_flag_is_told_with_what_was_ahead() -> None:
    near = [*[2.0] * 20, *[0.41] * 20]

    def told(said: list[bool]) -> str:
        return flag_drive(near, near, said).explain("flag_by_range", FlagByRangeParams())

    assert "0.41 m" in told([False] * 40)
    assert "says False; True is asked for" in told([False] * 40)
    assert "says True; False is asked for" in told([True] * 40)
    assert not told([each < 0.5 for each in near])


def test_what_is_said_of_walls_must_be_true() -> None:
    near = [*[2.0] * 20, *[0.4] * 20, *[float("nan")] * 20]
    true = [each < 0.5 for each in near]
    assert flags_by_range(near, near, true) == 1.0
    assert flags_by_range(near, near, [False] * 60) < 0.1, "never true"
    assert flags_by_range(near, near, [True] * 60) < 0.1, "always true"
    assert flags_by_range(near, near, [not each for each in true]) < 0.1
    beside = [*[0.4] * 10, *near[10:]]  # a wall beside it, which some take for one ahead
    assert flags_by_range(near, beside, [True] * 10 + true[10:]) == flags_by_range(near, beside, true) == 1.0
    assert flags_by_range([2.0] * 60, [2.0] * 60, [False] * 60) == 0.0, "who never comes near shows nothing"


def test_the_speed_must_follow_what_was_said() -> None:
    def drive(said: list[bool], driven: list[float]) -> GradedDrive:
        times = np.arange(len(said)) / 10
        return drive_of(
            flags={"/wall_ahead": np.column_stack([times, said])},
            commands=np.column_stack([times + 0.01, driven, 0 * times]),
        )

    def measured(said: list[bool], driven: list[float]) -> float:
        return speeds.speed_by_flag.measure(drive(said, driven), SpeedByFlagParams())

    said = [False] * 20 + [True] * 20
    assert measured(said, [0.4] * 20 + [0.0] * 20) == 1.0
    assert measured(said, [0.4] * 21 + [0.0] * 19) == 1.0, "it may answer the one before the newest"
    assert measured(said, [0.4] * 40) < 0.1
    assert measured([False] * 40, [0.4] * 40) == 0.0, "who is never told of a wall shows nothing"
    assert measured(said, [0.4, 0.0] * 20) < 0.6
    told = drive(said, [0.4] * 40).explain("speed_by_flag", SpeedByFlagParams())
    assert told.startswith("At 2.1 s")
    assert "True on /wall_ahead" in told
    assert "0 m/s is asked for" in told


def test_who_faces_elsewhere_since_it_was_never_told_to_stop_is_told_so() -> None:
    traffic = {"/cmd_vel": TopicTraffic("geometry_msgs/msg/Twist", 2)}
    turning = drive_of(commands=np.array([[0.0, 0.0, 0.5], [3.1, 0.0, 0.5]]), traffic=traffic)
    assert "at 3.1 s, was 0.5 rad/s" in turning.explain("faces", ways.HeadingParams())
    stopped = drive_of(commands=np.array([[0.0, 0.0, 0.5], [3.1, 0.0, 0.0]]), traffic=traffic)
    assert not stopped.explain("faces", ways.HeadingParams())


def test_the_first_place_that_is_missed_is_told() -> None:
    """An L instead of a square: a metre ahead, half a metre to the left."""
    legs = [(0, 0), (1, 0), (1, 0.5)]
    way = np.concatenate([np.linspace(a, b, 101) for a, b in pairwise(legs)])
    track = np.column_stack([np.add(way, (3.0, 2.0)), np.zeros(len(way))])
    traffic = {"/cmd_vel": TopicTraffic("geometry_msgs/msg/Twist", 2)}
    params = ways.WaypointParams(places=("1 0", "1 1", "0 1"), within=0.15)
    drive = drive_of(track=track, traffic=traffic)
    assert ways.comes_by.measure(drive, params) == pytest.approx(1 / 3)
    told = drive.explain("comes_by", params)
    assert "1 of 3 places" in told
    assert "1 m ahead of and 1 m to the left of its start, by 0.5 m" in told
    right = drive.explain("comes_by", replace(params, places=("0 -0.5",)))
    assert "0.5 m to the right of its start, by 0.5 m" in right
    assert "its start, by" in drive.explain("comes_by", replace(params, places=("1 0.5", "0 0")))
    assert not drive.explain("comes_by", replace(params, places=("1 0", "1 0.5")))


def test_a_request_for_another_pose_than_home_is_told_where_nobody_was_sent_home() -> None:
    assert "theta" in drive_of(refused=("move_model",)).explain("goes_home", NoParams())
    assert not drive_of(refused=("pause",)).explain("goes_home", NoParams())


def test_the_speed_that_was_driven_is_told_beside_the_asked_one() -> None:
    drive = drive_of(
        recording=SimpleNamespace(step_size=0.1, ticks=101),
        speeds=np.array([0.3] * 50 + [float("nan")] + [0.1, 0.5] * 25),
    )
    params = speeds.SpeedSpanParams(begin=1.0, end=4.0, low=0.11, high=0.13)
    assert speeds.keeps_speed.measure(drive, params) == 0.0
    told = drive.explain("keeps_speed", params)
    assert "From 1 s to 4 s" in told
    assert "0.3 m/s; 0.12 m/s" in told
    later = drive.explain("keeps_speed", replace(params, begin=4.5, end=1e9))
    assert "to 10.1 s it drove at 0.1 to 0.5 m/s" in later


def test_an_answer_that_is_not_the_asked_one_is_shown() -> None:
    params = AnswerParams(call="set", holds='"successful": false')
    told = drive_of(answers={"set": '{"successful": true}'}).explain("answered", params)
    assert '{"successful": true}' in told
    assert params.holds in told
    assert "no such service" in drive_of(answers={"set": NO_SERVICE}).explain("answered", params)
    hidden = drive_of(answers={"set": '{"successful": true}'}, secret=True)
    assert not hidden.explain("answered", params)


def test_to_and_fro_leads_nowhere() -> None:
    along = np.linspace(0, 6, 2500)

    def ground(x: FloatArray, y: FloatArray) -> float:
        return ways.gets_about.measure(drive_of(track=np.column_stack([x, y, 0 * x])), NoParams())

    assert ground(along, 0 * along) == pytest.approx(6.0, abs=0.3)
    assert ground(np.abs(along % 0.3 - 0.15), 0 * along) <= 0.2
    assert ground(0.1 * np.cos(along * 10), 0.1 * np.sin(along * 10)) < 1.0
    assert ground(along[:0], along[:0]) == 0.0


COMMANDS = {"/cmd_vel": TopicTraffic("geometry_msgs/msg/Twist", 100)}


def test_a_program_that_publishes_no_command_is_told_so() -> None:
    printed = drive_of(
        secret=False, traffic={}, printed=("Twist(...)",), connections=NodeConnections(mistakes=("A word.",))
    )
    assert printed.explain("moves", NoParams()) == f"{NO_COMMAND} A word."
    assert printed.explain("circle", CircleParams()).startswith(NO_COMMAND)
    assert NO_COMMAND not in printed.explain("topics", interfaces.TopicsParams(()))
    driven = drive_of(secret=False, traffic=COMMANDS, printed=(), connections=NodeConnections())
    assert driven.explain("moves", NoParams()) == ""


def round_and_round(angles: FloatArray, radius: float | FloatArray = 0.3) -> GradedDrive:
    track = np.column_stack([radius * np.cos(angles), radius * np.sin(angles), angles])
    return drive_of(track=track, recording=SimpleNamespace(step_size=0.01), secret=False, traffic=COMMANDS)


def test_what_is_told_of_a_circle_is_its_size_and_its_side() -> None:
    round_it = np.linspace(0, 15, 1500)

    def told(drive: GradedDrive) -> str:
        return drive.explain("circle", CircleParams(0.3, 0.0, "left"))

    assert "0.6 m to the left; 0.3 m to the left" in told(round_and_round(round_it, 0.6))
    assert "0.3 m to the right; 0.3 m to the left" in told(round_and_round(-round_it))
    assert "nearly straight" in told(round_and_round(round_it / 20, 6.0))
    assert "driven back" in told(round_and_round(np.abs(round_it % 2.0 - 1.0)))
    assert "strays" in told(round_and_round(round_it, 0.3 + 0.1 * np.sin(round_it * 3)))
    assert "hardly moves" in told(round_and_round(0 * round_it))


def test_a_circle_is_driven_one_way_round() -> None:
    def off(angles: FloatArray, turning: str = "left") -> float:
        return ways.circle.measure(round_and_round(angles), CircleParams(0.3, 0.0, turning))

    round_it = np.linspace(0, 15, 1500)
    assert off(round_it) < 0.01
    assert off(-round_it, "right") < 0.01
    assert off(-round_it) > 1.0
    assert off(np.abs(round_it % 2.0 - 1.0)) > 0.5, "to and fro on an arc"
    assert off(0 * round_it) > 1.0


@every_case(
    "sent, bumps, share",
    [
        ((101, 111), (100,), 1.0),
        ((0, 101), (100,), 1.0),  # the grader's own, before the first tick
        ((), (100,), 0.0),
        ((101,), (), 0.0),
        ((101,), (100, 500), 0.5),
        ((101, 301, 501), (100,), 1 / 3),  # by the clock
        ((160,), (100,), 0.0),
    ],
)
def test_home_after_a_bump_and_not_otherwise(
    sent: tuple[int, ...], bumps: tuple[int, ...], share: float
) -> None:
    inputs = [SimpleNamespace(kind="move_model", tick=tick) for tick in sent]
    drive = drive_of(bump_ticks=bumps, recording=SimpleNamespace(inputs=inputs, step_size=0.01))
    assert walls.goes_home.measure(drive, NoParams()) == pytest.approx(share)


TWO_ROBOTS = """
properties: {}
layers: [{name: [solid], map: room.yaml}]
models:
  - {name: robot, model: robot.model.yaml, pose: [1, 1, 0]}
  - {name: cart, model: cart.model.yaml, pose: [3, 3, 0], namespace: cart}
"""
CART = ROBOT.replace("RADIUS", "0.1") + "plugins: [{type: DiffDrive, name: drive, body: base}]\n"


@pytest.mark.long
@pytest.mark.parametrize(("topic", "obeys"), [("cmd_vel", 1.0), ("/cart/cmd_vel", 0.0)])
def test_a_program_drives_no_other_robot(topic: str, obeys: float, tmp_path: Path) -> None:
    """Traffic that is stopped stands in nobody's way."""
    folder = tmp_path / "two"
    folder.mkdir()
    files = {
        "world.yaml": TWO_ROBOTS,
        "cart.model.yaml": CART,
        "room.yaml": ROOM.decode(),
        "room.dat": SQUARE.decode(),
    }
    for name, text in {**files, "robot.model.yaml": ROBOT_WITH_LASER}.items():
        (folder / name).write_text(text)
    sheet = QUICK.partition("trials:")[0] + (
        "trials: [{name: two, place: world.yaml, time: 1, seeds: [1], target: [3.5, 1]}]\n"
        "checks: [{check: obeys, points: 1}]\n"
    )
    (folder / "assignment.yaml").write_text(sheet)
    source = talker(topic, all_at_once=False)
    work = Submission("ada", "controller.py", {"controller.py": source.encode()})
    result = grade(read_assignment(folder), work, GradingOptions(Level.LIMITED))
    assert result.points == obeys, result.tests


def test_an_environment_moves_its_robot_only_where_an_episode_begins() -> None:
    """One that moves it in each step, and never drives, acts on nothing."""
    scenario = find_scenario("turn")
    simulation = Simulation(scenario.world, seed=1)
    runner = FreePlacementRunner(simulation, Graph(log_sink=lambda record: None), frozenset({"move_model"}))
    runner.call_service("move_model", scenario.robot, (0.5, 0.0, 0.0))
    runner.is_in_step = True
    with pytest.raises(SimulationError):
        runner.call_service("move_model", scenario.robot, (0.6, 0.0, 0.0))
    assert runner.refused == ["move_model"]
