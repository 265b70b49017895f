"""One game of tag by two programs in one world, without a screen; and the same game run again from its recording.

Each program drives one robot in a namespace of its own and can use no name outside of it: neither the other's topics nor the
services of the world. Beside its robot's topics it is told ``is_catcher`` (std_msgs/Bool) and ``goal_pose``
(geometry_msgs/PoseStamped: where the other robot is, in the world's frame), ten times a second.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import Final

from kit.controllers import ControllerFile
from kit.host.failure import StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.proxy_nodes import NameScope
from kit.host.sandbox.limits import Limits
from kit.host.sandbox.sandbox_config import Level as Confinement
from kit.msg.geometry_msgs import PoseStamped, Twist
from kit.msg.std_msgs import Bool
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.episode import controller_arguments, run_until, when
from kit.run.lockstep import Observer
from kit.run.recording import Playback, Recorder, Recording
from kit.run.runner import Runner
from kit.run.scenario import Scenario
from kit.school.game.levels import GameLevel
from kit.school.game.starts import OWN_SEED
from kit.school.game.two_players import (
    GUEST,
    TAG_SECONDS,
    SharedGameState,
    SharedMode,
    SharedReferee,
    shared_scenario,
)
from kit.sim.simulation import STEP_SIZE_S, Simulation

NAMESPACES: Final = ("first", "second")
TOLD_TICKS: Final = 10
"""Between two messages to the programs."""
MAX_TICKS: Final = math.ceil(TAG_SECONDS / STEP_SIZE_S) + 1


@dataclass(frozen=True, slots=True, eq=False)
class TagGame:
    """A game that has been played."""

    state: SharedGameState
    """At its end; the first robot began as the catcher."""
    recording: Recording
    failures: tuple[str, str]
    """Why each program has stopped before the end; empty if it has not."""


def tag_scenario(level: GameLevel) -> Scenario:
    """A level's scenario with two robots, each in a namespace of its own. Raises as ``shared_scenario``."""
    scenario = shared_scenario(level)
    spaces = dict(zip((scenario.robot, GUEST), NAMESPACES, strict=True))
    models = tuple(
        replace(model, namespace=spaces.get(model.name, model.namespace)) for model in scenario.world.models
    )
    return replace(scenario, world=replace(scenario.world, models=models))


def play_tag(
    level: GameLevel, programs: Sequence[ControllerFile], confinement: Confinement, limits: Limits
) -> TagGame:
    """Lets two programs play a whole game. One that fails stands still from then on. Raises as ``shared_scenario``."""
    scenario = tag_scenario(level)
    graph = Graph(log_sink=lambda record: None)
    simulation = Simulation(scenario.world, seed=OWN_SEED, has_subscribers=graph.has_subscriptions)
    runner = Runner(simulation, graph, offered_truths=frozenset())
    referee = SharedReferee(scenario, SharedMode.TAG, simulation)
    recorder = Recorder.for_scenario(scenario, simulation)
    runner.observers += [referee, recorder, TagAnnouncer(graph, referee, dict(enumerate(NAMESPACES)))]
    referee.begin()
    players: list[NodeProcess | None] = []
    failures = ["", ""]
    with ExitStack() as stack:
        for number, program in enumerate(programs):
            try:
                player = NodeProcess.start(
                    graph,
                    program.file,
                    args=program_arguments(scenario, number),
                    seed=OWN_SEED,
                    limits=limits,
                    level=confinement,
                    scope=NameScope(f"/{NAMESPACES[number]}"),
                )
            except StudentCodeError as error:
                failures[number] = str(error.failure)
                players.append(None)
                continue
            stack.callback(player.close)
            players.append(player)
        runner.participants += [player for player in players if player is not None]
        stopped: set[int] = set()

        def stop_failed(tick: int) -> None:
            """Whose program has failed, stands: its last command would drive its robot on."""
            for number, player in enumerate(players):
                if player is not None and player.failure is not None and number not in stopped:
                    stopped.add(number)
                    failures[number] = str(player.failure)
                    for topic in simulation.command_topics(referee.robots[number]):
                        runner.accept(topic, Twist())

        run_until(runner, ticks=MAX_TICKS, ends=[when(lambda: referee.is_over)], before_tick=stop_failed)
    return TagGame(referee.state, recorder.recording(), (failures[0], failures[1]))


def tag_again(
    level: GameLevel, recording: Recording, on_state: Callable[[SharedGameState], object] | None = None
) -> tuple[SharedGameState, Recording]:
    """Runs a recorded game again, bit for bit, and judges it. ``on_state``: gets how it stands, every ``TOLD_TICKS`` ticks from
    the first on. Raises as ``shared_scenario``, ValueError if it is of another level, and RecordingError where an input is not
    possible in its world."""
    scenario = tag_scenario(level)
    if (recording.place, recording.case, recording.seed) != (scenario.name, level.case, OWN_SEED):
        raise ValueError(f"this is a game on {recording.place} {recording.case or ''}, not on {level.title}")
    simulation = Simulation(scenario.world, seed=OWN_SEED, has_subscribers=lambda topic: False)
    runner = Runner(simulation, Graph(log_sink=lambda record: None))
    playback = Playback(recording, runner.accept, runner.call_service)
    referee = SharedReferee(scenario, SharedMode.TAG, simulation)
    recorder = Recorder.for_scenario(scenario, simulation)
    runner.participants.append(playback)
    runner.observers += [playback, referee, recorder]
    referee.begin()

    def tell(tick: int) -> None:
        if on_state is not None and simulation.tick % TOLD_TICKS == 0:
            on_state(referee.state)

    run_until(runner, ticks=recording.ticks, before_tick=tell)
    return referee.state, recorder.recording()


class TagAnnouncer(Observer):
    """Tells programs who catches and where the other robot is."""

    def __init__(self, graph: Graph, referee: SharedReferee, spaces: Mapping[int, str]) -> None:
        """``spaces``: the namespace of each player that a program plays, by the player's number."""
        self._referee = referee
        node = create_graph_node(graph, "tag")
        graph.reserved_names.add(node.handle.full_name)
        self._told = [
            (
                number,
                node.create_publisher(Bool, f"/{space}/is_catcher", 10),
                node.create_publisher(PoseStamped, f"/{space}/goal_pose", 10),
            )
            for number, space in spaces.items()
        ]

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick % TOLD_TICKS != 1:
            return
        state = self._referee.state
        for number, catches, places in self._told:
            catches.publish(Bool(data=state.catcher == number))
            other = state.poses[1 - number]
            message = PoseStamped()
            message.header.frame_id = "map"
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(simulation.time_ns, 10**9)
            message.pose.position.x, message.pose.position.y = other.x, other.y
            message.pose.orientation.z = math.sin(0.5 * other.theta)
            message.pose.orientation.w = math.cos(0.5 * other.theta)
            places.publish(message)


def program_arguments(scenario: Scenario, number: int) -> list[str]:
    """What a program is told at its start: as in every race, and its target is where the other robot starts."""
    robots = (scenario.robot or "", GUEST)
    poses = {model.name: model.pose for model in scenario.world.models}
    other = poses[robots[1 - number]]
    assert scenario.case is not None
    case = replace(scenario.case, target=(other.x, other.y))
    return controller_arguments(replace(scenario, robot=robots[number], case=case, targets=()))
