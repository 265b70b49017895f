"""How the lessons on ROS 2's tools and on systems are found out again: the companion of ``derivations.py``."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Mapping
from itertools import pairwise, product
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from grader.kinds.function.kind import cases_of, load_reference
from kit.controllers import find_controller
from kit.fields.adjacency import (
    MAX_RANGE_DIFFERENCE,
    MAX_SIDE_RANGE,
    AdjacencyThresholds,
    is_adjacent_by_poses,
    is_adjacent_by_rays,
)
from kit.msg.action_msgs import GoalStatus
from kit.msg.geometry_msgs import Twist
from kit.msg.sensor_msgs import LaserScan
from kit.msg.turtlesim import RotateAbsolute
from kit.ros.action.client import ActionClient
from kit.ros.action.server import ActionServer, ServerGoalHandle
from kit.ros.execution.context import context_of
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.node.qos import (
    DurabilityPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.lessons.records import LessonStep
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from tests.school.lessons.derivations import Claim, shell
from tests.school.quiz.derived.bags import (
    bag_of,
    count_on,
    played_from,
    recorded_speeds,
    way_of_played_speeds,
)
from tests.school.quiz.derived.localisation import localised, reference
from tests.school.quiz.derived.service_quality import KEPT, LOSSY, heard_by_latecomer
from tests.school.quiz.derived.wheelchairs import rays_between_walls, wheelchair_reference
from tests.sim.workshop import Workshop

# Lesson 0: what this is about


def random_walk_rate(words: str, step: LessonStep, folder: Path) -> str:
    """Counts the commands of two simulated seconds."""
    commands: list[Twist] = []
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        create_graph_node(session.graph, "counter").create_subscription(
            Twist, "/cmd_vel", commands.append, 10
        )
        session.drive_with(find_controller("random_walk"))
        session.wait_until_driven()
        commands.clear()
        for _ in range(200):
            session.runner.tick()
    return {20: "ten times a second"}[len(commands)]


# Quality of service


def usual_profile(words: str, step: LessonStep, folder: Path) -> str:
    return f"{QoSProfile(depth=10).reliability.name} is the usual setting"


def sensor_and_default(words: str, step: LessonStep, folder: Path) -> str:
    """What the first step's driver hears of five messages."""
    heard = heard_by_latecomer(LOSSY, 10, [], [1.0] * 5)
    return {0: "Nothing, not even one message."}[len(heard)]


def reliability_table(words: str, step: LessonStep, folder: Path) -> str:
    rows = []
    for offered in (ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE):
        rows.append(offered.name)
        for asked in (ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE):
            profiles = [QoSProfile(depth=10, reliability=each) for each in (offered, asked)]
            rows.append("fits" if heard_by_latecomer(*profiles, [], [1.0]) else "does not fit")
    return " ".join(rows)


def _more(*settings: tuple[str, QoSProfile]) -> str:
    """The one of two settings that may be offered to the other, and not asked of it."""
    (a, first), (b, second) = settings
    passes = (
        bool(heard_by_latecomer(first, second, [], [1.0])),
        bool(heard_by_latecomer(second, first, [], [1.0])),
    )
    return {(True, False): f"{a} is more than {b}", (False, True): f"{b} is more than {a}"}[passes]


def reliability_order(words: str, step: LessonStep, folder: Path) -> str:
    return _more(("RELIABLE", QoSProfile(depth=10)), ("BEST_EFFORT", LOSSY))


def durability_order(words: str, step: LessonStep, folder: Path) -> str:
    return _more(("TRANSIENT_LOCAL", KEPT), ("VOLATILE", QoSProfile(depth=10)))


def depths_free(words: str, step: LessonStep, folder: Path) -> str:
    assert all(heard_by_latecomer(*depths, [], [1.0]) for depths in ((1, 100), (100, 1)))
    return "The depths are not compared"


def kept_but_not_asked(words: str, step: LessonStep, folder: Path) -> str:
    assert heard_by_latecomer(KEPT, 10, [0.4], []) == ()
    assert heard_by_latecomer(KEPT, 10, [0.4], [0.3]) == (0.3,)
    return words


def heard_as_the_graph(words: str, step: LessonStep, folder: Path) -> str:
    """The exercise's reference says of each of its cases what the kit does."""
    assert step.exercise is not None
    module = load_reference(step.exercise.folder / "reference.py")
    for case in cases_of(module, "heard", 1):
        offered, asked = (_profile(case[side]) for side in ("offered", "asked"))
        before, after = [0.0] * case["before"], [0.0] * case["after"]
        assert module.heard(**case) == len(heard_by_latecomer(offered, asked, before, after)), case
    return words


def _profile(settings: Mapping[str, Any]) -> QoSProfile:
    return QoSProfile(
        depth=settings["depth"],
        reliability=ReliabilityPolicy[settings["reliability"]],
        durability=DurabilityPolicy[settings["durability"]],
    )


def sensor_profile(words: str, step: LessonStep, folder: Path) -> str:
    profile = qos_profile_sensor_data
    return f"{profile.reliability.name} with a depth of {profile.depth}"


# Actions


def action_parts(words: str, step: LessonStep, folder: Path) -> str:
    """What an action server adds to a graph."""
    graph = Graph(log_sink=[].append)
    node = create_graph_node(graph, "server")
    before = len(graph.directory.services), {each.topic_name for each in node.publishers}
    ActionServer(node, RotateAbsolute, "turn_to", lambda handle: RotateAbsolute.Result())
    numbers = {2: "two", 3: "three"}
    services = numbers[len(graph.directory.services) - before[0]]
    topics = numbers[len({each.topic_name for each in node.publishers} - before[1])]
    return f"an action is {services} services and {topics} topics"


def rotate_fields(words: str, step: LessonStep, folder: Path) -> str:
    shown = shell("ros", "interface", "show", "turtlesim/action/RotateAbsolute")
    named = {"theta": "a heading", "delta": "how far it turned", "remaining": "how far it still is"}
    goal, result, feedback = (named[name] for name in re.findall(r"^float32 (\w+)", shown, re.M))
    return f"The goal is {goal}, the result {result}, the feedback {feedback}"


def aborted_result(words: str, step: LessonStep, folder: Path) -> str:
    graph = Graph(log_sink=[].append)

    def give_up(handle: ServerGoalHandle) -> Any:
        handle.abort()
        return RotateAbsolute.Result(delta=0.5)

    ActionServer(create_graph_node(graph, "server"), RotateAbsolute, "turn_to", give_up)
    client = ActionClient(create_graph_node(graph, "client"), RotateAbsolute, "turn_to")
    sent = client.send_goal_async(RotateAbsolute.Goal(theta=1.0))
    graph.run_due()
    result = sent.result().get_result_async()  # type: ignore[union-attr]  # accepted by now
    graph.run_due()
    assert (result.result().status, result.result().result.delta) == (GoalStatus.STATUS_ABORTED, 0.5)
    return words


def single_thread_starves(words: str, step: LessonStep, folder: Path) -> str:
    """A callback that takes a while, and what a timer beside it does meanwhile in a plain spin."""
    graph = Graph(None, log_sink=[].append)
    node, calls = create_graph_node(graph, "server"), []
    node.create_timer(0.001, lambda: calls.append("other"))

    def take_long() -> None:
        calls.append("begin")
        time.sleep(0.05)
        calls.append("end")

    node.create_timer(0.001, take_long)
    executor = SingleThreadedExecutor(context=context_of(graph))
    executor.add_node(node)
    while "end" not in calls:
        executor.spin_once(timeout_sec=1)
    assert calls[calls.index("begin") + 1] == "end"
    return words


# The command line and bags


def played_elsewhere(words: str, step: LessonStep, folder: Path) -> str:
    """The same speeds from two places: the same curve until one of the two touches a wall."""
    commands = recorded_speeds(20.0)
    (here, touched), (there, touches) = played_from(commands, 0.0), played_from(commands, 1.0)
    assert (touched, touches) == (False, True)
    ways = [[math.dist(a[:2], b[:2]) for a, b in pairwise(poses[:200])] for poses in (here, there)]
    assert np.allclose(*ways, atol=1e-3)
    return words


def steps_of_the_run(words: str, step: LessonStep, folder: Path) -> str:
    seconds = bag_of("simple", 1000, 1).duration_ns / 1e9
    return f"The robot drove for { {10: 'ten'}[round(seconds)] } seconds"


def laser_rate_of_the_bag(words: str, step: LessonStep, folder: Path) -> str:
    bag = bag_of("simple", 1000, 1)
    rate = count_on(bag, "/static_laser") / round(bag.duration_ns / 1e9)
    return f"The laser published { {10: 'ten times'}[round(rate)] } a second"


def scans_of_the_bag(words: str, step: LessonStep, folder: Path) -> str:
    return f"the { {100: 'hundred'}[count_on(bag_of('simple', 1000, 1), '/static_laser')] } scans"


def played_at_once(words: str, step: LessonStep, folder: Path) -> str:
    return f"0.4 m/s for ten seconds: {way_of_played_speeds(folder, 0.4, 10.0, 1.0):.0f} m"


def played_at_twice(words: str, step: LessonStep, folder: Path) -> str:
    way = way_of_played_speeds(folder, 0.4, 10.0, 2.0)
    return f"About {way:.0f} m, since it goes as fast as before for half the time."


# Where am I?


def corridor_twice(words: str, step: LessonStep, folder: Path) -> str:
    """Scans at many poses of a corridor, compared with the one at the robot's: two poses see the same."""

    def scan(x: float, y: float, theta: float) -> np.ndarray[Any, Any]:
        changes = {"lidar": {"noise_std_dev": 0, "range": 20}}
        simulation = Simulation(Workshop(folder).serp(walls, pose=(x, y, theta), **changes))
        found = [each.message for each in simulation.step(100) if isinstance(each.message, LaserScan)]
        return np.nan_to_num(np.array(found[-1].ranges), nan=99.0)

    ends = ((0, 0, 8, 0), (0, 2, 8, 2), (0, 0, 0, 2), (8, 0, 8, 2))
    walls = [list(each) for each in ends]
    here = scan(2.0, 1.2, 0.3)
    others = [(6.0, 0.8, 0.3 + math.pi), (6.0, 0.8, 0.3), (2.5, 1.2, 0.3), (2.0, 0.8, 0.3), (4.0, 1.0, 0.3)]
    same = [pose for pose in others if np.allclose(scan(*pose), here, atol=0.01)]
    return {1: "No. Two poses fit, one for each way round."}[len(same)]


def log_odds(words: str, step: LessonStep, folder: Path) -> str:
    return f"A half is {math.log(0.5 / (1 - 0.5)):g}"


def two_hits(words: str, step: LessonStep, folder: Path) -> str:
    module, grid = reference("grid"), [[0.0]]
    for _ in range(2):
        grid = module.updated(grid, [], [0, 0])
    return f"After two hits that is {module.probability(grid[0][0]):.2f}"


def particles_find_it(words: str, step: LessonStep, folder: Path) -> str:
    _, off = localised(18)
    assert off <= 0.2
    return words


def equal_weights(words: str, step: LessonStep, folder: Path) -> str:
    """With the starter's functions the particles stay as spread as they were."""
    spread, _ = localised(18, solved=False)
    assert spread > 2.0
    return words


def sure_and_wrong(words: str, step: LessonStep, folder: Path) -> str:
    spread, off = localised(2, 400, 0.3)
    assert off > 1.0
    return f"spread over {spread:.1f} m" if "spread" in words else "Here more than a metre away"


# Two wheelchairs


def rays_and_walls(words: str, step: LessonStep, folder: Path) -> str:
    assert rays_between_walls(0.3) == (True, False)
    assert is_adjacent_by_poses([0.0, 0.4, 0.0], [0.0, 0.0, 0.0])
    return words


def ray_limits(words: str, step: LessonStep, folder: Path) -> str:
    texts = (f"all four are at most {MAX_SIDE_RANGE} m long", f"differ by at most {MAX_RANGE_DIFFERENCE} m")
    return next(each for each in texts if each.split()[0] == words.split()[0])


def pose_limits(words: str, step: LessonStep, folder: Path) -> str:
    """The limits, and that the exercise's reference says of its cases what the kit does."""
    module = wheelchair_reference("beside")
    for case in cases_of(module, "by_poses", 1):
        assert module.by_poses(**case) == bool(is_adjacent_by_poses(case["left"], case["right"])), case
    for case in cases_of(module, "by_rays", 1):
        assert module.by_rays(**case) == bool(is_adjacent_by_rays(case["left"], case["right"])), case
    limits = AdjacencyThresholds()
    return next(
        each
        for each in (f"nearer than {limits.distance} m", f"off by {limits.angle} rad")
        if each.split()[0] == words.split()[0]
    )


def wrapped_degrees(words: str, step: LessonStep, folder: Path) -> str:
    apart = abs(math.degrees(math.remainder(math.radians(179) - math.radians(-179), math.tau)))
    return f"179 and -179 degrees are {apart:.0f} degrees apart"


def values_above_the_limit(words: str, step: LessonStep, folder: Path) -> str:
    from kit.learning.training.presets import SEED_DQN

    limit = SEED_DQN.settings.value_limit  # type: ignore[union-attr]  # a deep Q-network's
    if words.startswith("pass"):
        return f"pass {limit:g}"
    if words.startswith("Its"):
        return f"Its library had the limit of {limit:g}"
    return f"The library took all values above {limit:g} for equal"


def pairs_of_actions(words: str, step: LessonStep, folder: Path) -> str:
    def count(actions: int, robots: int) -> int:
        return len(list(product(range(actions), repeat=robots)))

    with_three = f"with three robots of 7 it would be {count(7, 3)}"
    texts = (
        f"{count(7, 2)}, one for each pair of actions.",
        f"These are 7 x 7. With 4 actions each it would be {count(4, 2)}, and {with_three}.",
        f"With 4 actions each, {count(4, 2)} pairs",
        f"the largest of {count(7, 2)} guesses",
        f"{count(7, 2)} actions",
    )
    return next((each for each in texts if each == words), texts[0])


SYSTEM_DERIVATIONS: Final[Mapping[str, Claim]] = MappingProxyType(
    {
        claim.__name__.replace("_", "-"): claim
        for claim in (
            random_walk_rate,
            usual_profile,
            sensor_and_default,
            reliability_table,
            reliability_order,
            durability_order,
            depths_free,
            kept_but_not_asked,
            heard_as_the_graph,
            sensor_profile,
            action_parts,
            rotate_fields,
            aborted_result,
            single_thread_starves,
            played_elsewhere,
            steps_of_the_run,
            laser_rate_of_the_bag,
            scans_of_the_bag,
            played_at_once,
            played_at_twice,
            corridor_twice,
            log_odds,
            two_hits,
            particles_find_it,
            equal_weights,
            sure_and_wrong,
            rays_and_walls,
            ray_limits,
            pose_limits,
            wrapped_degrees,
            values_above_the_limit,
            pairs_of_actions,
        )
    }
)
"""By the name that a claim's ``derived`` gives."""
SYSTEM_DEAR: Final = frozenset(
    {
        "particles-find-it",
        "equal-weights",
        "sure-and-wrong",
        "played-elsewhere",
    }
)
"""Those that take more than a second: they run with the long tests."""
