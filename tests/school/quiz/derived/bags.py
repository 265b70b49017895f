"""What recordings of speeds bring back, and what topics carry, found out in small worlds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from click.testing import CliRunner

from kit.cli import main
from kit.controllers import find_controller
from kit.geometry import Pose
from kit.msg.geometry_msgs import Twist
from kit.ros.bags import Bag, read_bag
from kit.ros.node.node import create_graph_node
from kit.ros.serialization import serialize_message
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.quiz.items import QuizItem
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from tests.school.quiz.derived.finding import Derivation, Finding
from tests.sim.workshop import Workshop


@cache
def bag_of(place: str, steps: int, seed: int) -> Bag:
    """The summary of the bag that ``kit run`` writes of a drive."""
    with TemporaryDirectory() as name:
        folder = Path(name) / "bag"
        options = ["--steps", str(steps), "--seed", str(seed), "--bag", str(folder)]
        result = CliRunner().invoke(main, ["run", place, *options])
        assert result.exit_code == 0, result.output
        return read_bag(folder)


def count_on(bag: Bag, topic: str) -> int:
    return next(each.count for each in bag.topics if each.name == topic)


def way_of_played_speeds(folder: Path, speed: float, seconds: float, rate: float) -> float:
    """How far a robot gets [m] if a speed and, so many recorded seconds later, a stop are played at a rate."""
    simulation = Simulation(Workshop(folder).serp())
    for metres_per_second, until_s in ((speed, seconds / rate), (0.0, 1.0)):
        command = Twist()
        command.linear.x = metres_per_second
        simulation.accept("/cmd_vel", command)
        simulation.step(round(until_s * 100))
    return math.dist(simulation.pose("serp")[:2], (0.0, 0.0))


def recorded_speeds(seconds: float) -> list[tuple[int, Twist]]:
    """What ``avoid`` tells the robot of the simple room, with the ticks."""
    commands: list[tuple[int, Twist]] = []
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        create_graph_node(session.graph, "recorder").create_subscription(
            Twist, "/cmd_vel", lambda command: commands.append((session.runner.simulation.tick, command)), 10
        )
        session.drive_with(find_controller("avoid"))
        session.wait_until_driven()
        for _ in range(round(seconds * 100)):
            session.runner.tick()
        assert session.metrics.metrics.bumps == 0
    return commands


def played_from(commands: Sequence[tuple[int, Twist]], shift: float) -> tuple[list[Pose], bool]:
    """The poses of a robot that starts so far to its left [m] and is told the same, and whether it touched."""
    simulation = Simulation(scenario_on_map(find_map("simple")).world, seed=1)
    robot = scenario_on_map(find_map("simple")).robot
    assert robot is not None
    start = simulation.pose(robot)
    simulation.move_model(robot, Pose(*start.transform_point(0.0, shift), start.theta))
    poses, touched, waiting = [], False, list(commands)
    while waiting:
        while waiting and waiting[0][0] <= simulation.tick:
            simulation.accept("/cmd_vel", waiting.pop(0)[1])
        simulation.step()
        poses.append(simulation.pose(robot))
        touched |= simulation.is_touching(robot)
    return poses, touched


def played_again(item: QuizItem, folder: Path) -> Finding:
    """From elsewhere the way begins in the same direction, and nobody turns away from the wall."""
    commands = recorded_speeds(20.0)
    (_, touched), (_, elsewhere) = played_from(commands, 0.0), played_from(commands, 1.0)
    assert not touched
    return Finding(
        "blind" if elsewhere else "careful",
        {
            "It keeps clear of all walls, as before": "careful",
            "It goes to the old start before it drives": "returns",
            "It does as it was told, walls or no walls": "blind",
        },
    )


def half_the_rate(item: QuizItem, folder: Path) -> Finding:
    ways = {"2 m": 2.0, "4 m": 4.0, "1 m": 1.0}
    found = way_of_played_speeds(folder, 0.5, 4.0, 0.5)
    return Finding(min(ways, key=lambda text: abs(ways[text] - found)), {text: text for text in ways})


def heavier_topic(item: QuizItem, folder: Path) -> Finding:
    """By one message of each; both come equally often."""
    messages = {}
    simulation = Simulation(Workshop(folder).serp([(2, -1, 2, 1)]))
    for each in simulation.step(100):
        messages[each.topic] = each.message
    scan, odom = (
        next(
            size
            for topic, size in ((t, len(serialize_message(m))) for t, m in messages.items())
            if word in topic
        )
        for word in ("laser", "odom")
    )
    return Finding(
        "odom" if odom > scan else "scan",
        {
            "/static_laser, since a scan has 91 ranges": "scan",
            "/odom, since its numbers take more bytes": "odom",
            "Both the same, since both come as often": "same",
        },
    )


def silent_topic(item: QuizItem, folder: Path) -> Finding:
    """/teleopkeys exists in a drive that no key has touched."""
    found = {each.name: each.count for each in bag_of("simple", 100, 1).topics}.get("/teleopkeys", "missing")
    return Finding(
        found,
        {
            "That it is there, and nothing was said": 0,
            "That the bag is damaged in that place": "damaged",
            "That the recorder began too late for it": "missing",
        },
    )


def nobody_publishes(item: QuizItem, folder: Path) -> Finding:
    """What reaches a subscription that comes after a message: what ``echo`` is."""
    from tests.school.quiz.derived.service_quality import heard_by_latecomer

    heard = heard_by_latecomer(10, 10, [1.0], [2.0])
    return Finding(
        heard,
        {
            "All that was published since the start": (1.0, 2.0),
            "What is published from now on": (2.0,),
            "The last message, again and again": (1.0, 1.0),
        },
    )


BAGS: dict[str, Derivation] = {
    "played-again": played_again,
    "half-the-rate": half_the_rate,
    "heavier-topic": heavier_topic,
    "silent-topic": silent_topic,
    "nobody-publishes": nobody_publishes,
}
