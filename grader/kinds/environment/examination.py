"""Collects evidence about a student's Gymnasium environment: what it returned, and what was true in the world.

The environment runs in a process of its own, whose node takes part in the grader's world: it drives the robot and reads
its sensors as any node does. The grader requests ``reset`` and ``step`` over a topic, and records what really happened.
The process only makes calls and sends what they return, as data. Spaces, steps, seeds and Gymnasium's checker are the
grader's business, and how long a step took is read from the world's clock.
"""

from __future__ import annotations

import json
import math
import random
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from grader.assignment import Assignment
from grader.driving.episodes import STEP, with_laser_settings
from grader.driving.restricted_runner import RestrictedRunner
from grader.driving.traffic import MAX_PRINTED_LINES
from grader.evidence.submission_clock import SubmissionClock
from kit.geometry import Pose, wrap_angle
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.private_folder import private_folder
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import Json, ProtocolError, decode, printable
from kit.msg.message import Message
from kit.msg.std_msgs import String
from kit.ros.graph.directory import NodeLike
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.run.episode import controller_arguments, run_until, when, when_failed
from kit.run.metrics import MetricsRecorder
from kit.run.scenario import Scenario
from kit.sim.simulation import Simulation

EXAMINER_FILE: Final = Path(__file__).with_name("environment_examiner.py")
REQUEST_TOPIC: Final = "/examination/ask"
ANSWER_TOPIC: Final = "/examination/answer"
CALL_TIMEOUT_S: Final = 5.0
"""Simulated seconds that one call may take; a step takes a tenth of a second."""
MIN_STEP_S: Final = STEP
"""Simulated seconds that the shortest step takes."""
OVERDUE_STEPS: Final = 6
"""Steps for which an episode goes on after it should have ended."""


@dataclass(frozen=True, slots=True)
class EnvironmentTask:
    """The environment that is to be written, and its scenario."""

    class_name: str
    scenario: Scenario
    moves: tuple[tuple[float, float], ...]
    """The velocities of each action: m/s, rad/s."""
    step_s: float
    max_steps: int
    waypoints: tuple[tuple[float, float], ...]
    """Waypoints of a drive to the target."""
    scan: str
    """The topic of the robot's laser."""
    clip: float
    """m: ranges in observations are clipped to this."""
    seed: int
    secret_seed: int | None

    def has_lasted(self, durations: Sequence[float]) -> bool:
        """True if steps with these durations [s] have waited for the world.

        One of them may be short: a collision is reported at once.
        """
        return not durations or sum(durations) >= max((len(durations) - 1) * self.step_s / 2, MIN_STEP_S)


@dataclass(frozen=True, slots=True)
class StepRecord:
    """One step: what the environment returned, and what was true in the world."""

    action: int
    returned: Mapping[str, Json]
    is_in_space: bool
    """Whether the observation lies in the observation space."""
    pose_before: Pose
    pose_after: Pose
    collided: bool
    """Whether the robot touched something during the step."""
    target_distance: float
    """From the hull to the target's centre after the step [m]."""
    ranges: tuple[float, ...]
    """The newest scan."""
    duration_s: float
    """Simulated seconds that passed in the world during the step."""

    def part(self, index: int) -> Mapping[str, Json]:
        """Returns one of the returned values; empty if there is none."""
        parts = self.returned.get("parts", [])
        return parts[index] if len(parts) > index else {}

    def is_true(self, index: int) -> bool:
        """True if the value at this index is True."""
        return self.part(index).get("value") is True

    @property
    def is_over(self) -> bool:
        return self.is_true(2) or self.is_true(3)


@dataclass(slots=True)
class EnvironmentEpisode:
    """One episode: the reset and the steps after it."""

    name: str
    returned: Mapping[str, Json]
    is_in_space: bool
    pose: Pose
    ranges: tuple[float, ...]
    step_records: list[StepRecord] = field(default_factory=list)


@dataclass(slots=True)
class EnvironmentRecord:
    """Everything that was recorded about an environment."""

    task: EnvironmentTask
    description: Mapping[str, Json] = field(default_factory=dict)
    """The environment's spaces, and whether it is a gymnasium.Env."""
    changed_spaces: dict[str, str] = field(default_factory=dict)
    """What was called when a space was another one than at first, by the space's name."""
    episodes: dict[str, EnvironmentEpisode] = field(default_factory=dict)
    checker_complaint: str = ""
    """The first complaint of Gymnasium's own checker; empty if there is none."""
    checker_step_durations: list[float] = field(default_factory=list)
    """Simulated seconds that passed during each step that Gymnasium's checker made."""
    steps: int = 0
    printed: tuple[str, ...] = ()

    @property
    def step_records(self) -> list[StepRecord]:
        return [step for episode in self.episodes.values() for step in episode.step_records]


class FreePlacementRunner(RestrictedRunner):
    """A runner whose robot may be moved anywhere while an episode begins: an environment begins its episodes where it likes. In a
    step it is driven, and not moved."""

    is_in_step = False
    """Whether the environment is making a step."""

    def _is_allowed(self, service: str, arguments: tuple[Any, ...]) -> bool:
        return service in self._services and not self.is_in_step


def examine_environment(
    task: EnvironmentTask,
    assignment: Assignment,
    file: Path,
    level: Level,
    seed: int,
    clock: SubmissionClock | None = None,
) -> EnvironmentRecord:
    """Runs some episodes of the environment. Raises StudentCodeError where the student's code fails."""
    with private_folder() as outer_folder:
        folder = outer_folder / "examination"
        # What lies beside the environment comes along, but for a file that would take the examiner's place.
        shutil.copytree(
            file.parent,
            folder,
            ignore=shutil.ignore_patterns(EXAMINER_FILE.name),
            copy_function=shutil.copyfile,
        )
        folder.chmod(0o755)  # for a program that runs as another user
        shutil.copyfile(EXAMINER_FILE, Path(folder, EXAMINER_FILE.name))
        graph = Graph(log_sink=lambda record: None)
        simulation = Simulation(with_laser_settings(task.scenario.world, noise=0.0), seed=1, step_size=STEP)
        runner = FreePlacementRunner(simulation, graph, frozenset({"move_model"}))
        arguments = [file.stem, task.class_name, *controller_arguments(task.scenario)]
        # Subscribe before the program can publish.
        clock = clock or SubmissionClock()
        clock.show_progress("starting the program")
        examination = _EnvironmentExaminer(runner, task, seed, clock)
        node_process = NodeProcess.start(
            graph,
            Path(folder, EXAMINER_FILE.name),
            args=arguments,
            limits=clock.shorten(assignment.limits),
            level=level,
        )
        with node_process:
            runner.participants.append(node_process)
            examination.run_all(node_process)
            lines = node_process.take_output().lines
    examination.record.printed = tuple(printable(line.text) for line in lines)[:MAX_PRINTED_LINES]
    return examination.record


class _EnvironmentExaminer:
    """Requests calls of the environment, and records what happens."""

    def __init__(
        self, runner: FreePlacementRunner, task: EnvironmentTask, seed: int, clock: SubmissionClock
    ) -> None:
        self._runner = runner
        self._clock = clock
        self._node_process: NodeProcess | None = None
        self._task = task
        self._seed = seed
        self.record = EnvironmentRecord(task)
        assert task.scenario.robot is not None  # checked when the assignment was read
        self._robot = task.scenario.robot
        self._answers: list[str] = []
        self._question_number = 0
        self._call_s = 0.0
        self._spaces: dict[str, Json] = {}
        self._observation_space: Any = None
        self._ranges: tuple[float, ...] = ()
        self._metrics = MetricsRecorder.for_scenario(task.scenario)
        runner.observers.append(self._metrics)
        node = create_graph_node(runner.graph, "grader")
        runner.graph.reserved_names.add(node.handle.full_name)
        self._request_publisher = node.create_publisher(String, REQUEST_TOPIC, 10)
        node.create_subscription(String, ANSWER_TOPIC, self._on_answer, 10)
        runner.graph.add_message_listener(self._on_message)

    def run_all(self, node_process: NodeProcess) -> None:
        """Runs all episodes and Gymnasium's checker, in order."""
        self._node_process = node_process
        description = self._await_answer(CALL_TIMEOUT_S, "the file's beginning")
        self.record.description = description
        if "missing" in description or not description.get("is_env"):
            return
        from grader.kinds.environment.described_values import clean_space, rebuild_space

        self._spaces = {name: description.get(name) for name in ("action_space", "observation_space")}
        self._observation_space = rebuild_space(self._spaces["observation_space"])
        self.record.description = {name: clean_space(each) for name, each in self._spaces.items()} | {
            "is_env": True
        }
        turning = next((k for k, (speed, turn) in enumerate(self._task.moves) if not speed and turn > 0), 0)
        ahead = next((k for k, (speed, turn) in enumerate(self._task.moves) if speed and not turn), 0)
        self._run_episode("turning on the spot", 0, lambda _: turning, self._task.max_steps)
        self._run_episode("into the wall", 1, lambda _: ahead, self._task.max_steps)
        self._run_episode("to the target", 2, self._make_pilot(), self._task.max_steps)
        rng = random.Random(f"moves {self._seed}")
        moves = [rng.randrange(len(self._task.moves)) for _ in range(15)]
        for name, seed in (("one seed", 3), ("the same seed again", 3), ("another seed", 4)):
            self._run_episode(name, seed, lambda done: moves[done], len(moves))
        self._clock.show_progress("Gymnasium's own checker")
        self.record.checker_complaint = self._run_checker()

    def _run_episode(self, name: str, seed: int, choose: Callable[[int], int], steps: int) -> None:
        """Runs an episode to its end, and a few steps on if it does not end where it should."""
        self._clock.show_progress(f"episode “{name}”")
        number = self._seed + seed
        answer = self._call({"call": "reset", "keywords": {"seed": number}}, f"reset(seed={number})")
        returned = answer["returned"]
        episode = EnvironmentEpisode(name, returned, self._is_in_space(returned), self._pose(), self._ranges)
        self.record.episodes[name] = episode
        overdue = 0
        while overdue < OVERDUE_STEPS and len(episode.step_records) < steps + OVERDUE_STEPS:
            done = len(episode.step_records)
            if name not in TERMINATING_EPISODES and done >= steps:
                return
            step = self._make_step(choose(done))
            episode.step_records.append(step)
            if step.is_over:
                return
            is_due = step.collided or step.target_distance < 0.1 or done + 1 > steps
            overdue += is_due or overdue > 0

    def _make_step(self, action: int) -> StepRecord:
        before, contact_steps = self._pose(), self._metrics.contact_steps(self._robot)
        answer = self._call({"call": "step", "action": action}, f"step({action})")
        self.record.steps += 1
        case = self._task.scenario.case
        assert case is not None  # checked when the assignment was read
        distance = self._runner.simulation.hull_distance(self._robot, case.target)
        returned = answer["returned"]
        touched = self._metrics.contact_steps(self._robot) > contact_steps
        return StepRecord(
            action,
            returned,
            self._is_in_space(returned),
            before,
            self._pose(),
            touched,
            distance,
            self._ranges,
            self._call_s,
        )

    def _is_in_space(self, returned: Mapping[str, Json]) -> bool:
        """True if the observation, the first of the returned values, lies in the observation space."""
        from grader.kinds.environment.described_values import is_in_space, rebuild_value

        value = rebuild_value(returned)
        return is_in_space(self._observation_space, value[0] if isinstance(value, tuple) and value else value)

    def _make_pilot(self) -> Callable[[int], int]:
        """Returns a function that chooses actions along the waypoints: turn towards the next one, then drive."""
        waypoints = list(self._task.waypoints)

        def choose(done: int) -> int:
            pose = self._pose()
            while (
                len(waypoints) > 1 and math.hypot(waypoints[0][0] - pose.x, waypoints[0][1] - pose.y) < 0.15
            ):
                waypoints.pop(0)
            heading = math.atan2(waypoints[0][1] - pose.y, waypoints[0][0] - pose.x)
            off = wrap_angle(heading - pose.theta)
            return max(
                range(len(self._task.moves)),
                key=lambda k: self._task.moves[k][0] if abs(off) < 0.12 else off * self._task.moves[k][1],
            )

        return choose

    def _run_checker(self) -> str:
        """Runs Gymnasium's checker on an environment that forwards its calls; returns the first complaint."""
        from grader.kinds.environment.gymnasium_checker import first_checker_complaint

        def forward_call(question: dict[str, Json]) -> Mapping[str, Any]:
            answer = self._call(question, "Gymnasium's checker")
            if question["call"] == "step" and "raised" not in answer:
                self.record.checker_step_durations.append(self._call_s)
            return answer

        return first_checker_complaint(forward_call, self._spaces)

    def _call(self, question: dict[str, Json], what: str) -> Mapping[str, Any]:
        from grader.kinds.environment.described_values import check_description

        self._question_number += 1
        text = json.dumps({**question, "number": self._question_number})
        self._request_publisher.publish(String(data=text))
        began_ns = self._runner.graph.now_ns
        self._runner.is_in_step = question["call"] == "step"
        answer = self._await_answer(CALL_TIMEOUT_S, what)
        self._call_s = (self._runner.graph.now_ns - began_ns) / 1e9
        if self._call_s == 0:  # calls that wait for nothing must not all come at one moment
            self._runner.tick()
        changed = answer.get("changed", [])
        for name in self._spaces:
            if isinstance(changed, list) and name in changed:
                self.record.changed_spaces.setdefault(name, what)
        try:
            if not (question.get("checking") and isinstance(answer.get("raised"), str)):
                check_description(answer.get("returned"))
        except ProtocolError as error:
            raise StudentCodeError(
                Failure(FailureKind.PROTOCOL, f"the answer is not plain data: {error}")
            ) from None
        return answer

    def _await_answer(self, timeout_s: float, what: str) -> Mapping[str, Json]:
        """Ticks until the answer comes. Raises StudentCodeError if it does not come in time, or the program fails."""
        node_process = self._node_process
        assert node_process is not None  # ``run_all`` has set it
        run_until(
            self._runner,
            limit_s=timeout_s,
            ends=(
                self._clock.end_condition,
                when_failed(node_process),
                when(lambda: node_process.has_ended),
                when(self._has_answer),
            ),
        )
        self._clock.check()
        if node_process.failure is not None:
            raise StudentCodeError(node_process.failure)
        if node_process.has_ended:
            raise StudentCodeError(Failure(FailureKind.EXIT, f"the program ended during {what}."))
        if self._answers:
            return self._decode_answer(self._answers.pop())
        message = f"{what} did not come back within {timeout_s:g} simulated seconds. Does it wait for a message that never comes?"
        raise StudentCodeError(Failure(FailureKind.TIMEOUT, message))

    def _has_answer(self) -> bool:
        self._runner.exchange_until_idle()
        return bool(self._answers)

    def _decode_answer(self, text: str) -> Mapping[str, Any]:
        try:
            answer = decode(text.encode("ascii", "replace"))
        except ProtocolError as error:
            raise StudentCodeError(
                Failure(FailureKind.PROTOCOL, f"the answer is not plain data: {error}")
            ) from None
        if not isinstance(answer, dict):
            raise StudentCodeError(Failure(FailureKind.PROTOCOL, "the answer is not plain data"))
        if self._answers or answer.get("number") != self._question_number:
            message = "an answer came to a question that the grader has not asked"
            raise StudentCodeError(Failure(FailureKind.PROTOCOL, message))
        return answer

    def _on_answer(self, message: String) -> None:
        self._answers.append(message.data)

    def _on_message(self, _: int, node: NodeLike, topic: str, message: Message) -> None:
        if topic == self._task.scan and node is self._runner.node:
            self._ranges = tuple(getattr(message, "ranges", ()))

    def _pose(self) -> Pose:
        return self._runner.simulation.pose(self._robot)


TERMINATING_EPISODES: Final = ("turning on the spot", "into the wall", "to the target")
"""Names of the episodes that run until they end."""


def sector_minima(ranges: Sequence[float], count: int, clip: float) -> list[float]:
    """Returns the nearest range in each of ``count`` sectors of a scan, at most ``clip``; left-over rays belong to the last."""
    nearest, size = [clip] * count, max(1, len(ranges) // count)
    for k, each in enumerate(ranges):
        if not math.isnan(each):
            index = min(k // size, count - 1)
            nearest[index] = min(nearest[index], each)
    return nearest
