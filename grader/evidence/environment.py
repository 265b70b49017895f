"""Evidence about a Gymnasium environment of a student's: what it returned, beside what was true in the world.

The environment lives in a process of its own as a guest of the world, which is ours: it drives the robot and reads its
sensors as any node does. The grader asks for ``reset`` and ``step`` over a topic, and notes what really happened.
"""

from __future__ import annotations

import json
import math
import random
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from grader.assignment import Assignment
from grader.evidence.episodes import MOST_PRINTED, STEP, JudgedRunner, noisy
from kit.geometry import Pose
from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.node_process import Guest
from kit.host.sandbox.confinement import Level
from kit.host.wire import Json, ProtocolError, decode, printable
from kit.msg.message import Message
from kit.msg.std_msgs import String
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node
from kit.run.scenario import Place
from kit.sim.simulation import Simulation

EXAMINER: Final = Path(__file__).with_name("environment_examiner.py")
ASK: Final = "/examination/ask"
ANSWER: Final = "/examination/answer"
PATIENCE_S: Final = 5.0
"""Simulated: how long one call may take. A step takes a tenth of a second."""
CHECKER_S: Final = 60.0
"""Simulated: how long Gymnasium's checker may take, which makes many steps."""
LATE: Final = 6
"""Steps for which an episode is still driven after it should have ended."""


@dataclass(frozen=True, slots=True)
class Wish:
    """The kind's task: which environment is to be written, and where it lives."""

    cls: str
    place: Place
    moves: tuple[tuple[float, float], ...]
    """What each action does: m/s, rad/s."""
    step_s: float
    max_steps: int
    way: tuple[tuple[float, float], ...]
    """Points by which the target is reached."""
    scan: str
    """The topic of the robot's laser."""
    clip: float
    """m: ranges are given up to here."""
    seed: int
    secret_seed: int | None


@dataclass(frozen=True, slots=True)
class Moment:
    """One step: what was returned, and what was true."""

    action: int
    returned: Mapping[str, Json]
    inside: bool
    """Whether the observation lies in the space of observations."""
    before: Pose
    after: Pose
    touched: bool
    """Whether the robot touched something during the step."""
    target_m: float
    """From the hull to the target's middle, after it."""
    ranges: tuple[float, ...]
    """The newest scan."""

    def part(self, place: int) -> Mapping[str, Json]:
        """One of the values returned; empty if there is none."""
        parts = self.returned.get("parts", [])
        return parts[place] if len(parts) > place else {}

    def says(self, place: int) -> bool:
        """Whether it returned True there."""
        return self.part(place).get("value") is True

    @property
    def is_over(self) -> bool:
        return self.says(2) or self.says(3)


@dataclass(slots=True)
class Episode:
    """From a reset on."""

    name: str
    returned: Mapping[str, Json]
    inside: bool
    pose: Pose
    ranges: tuple[float, ...]
    moments: list[Moment] = field(default_factory=list)


@dataclass(slots=True)
class Visit:
    """Everything that was seen."""

    wish: Wish
    about: Mapping[str, Json] = field(default_factory=dict)
    """Of the environment: its spaces, and whether it is one."""
    episodes: dict[str, Episode] = field(default_factory=dict)
    checker: str = ""
    """What Gymnasium's own checker complains of."""
    steps: int = 0
    printed: tuple[str, ...] = ()

    @property
    def moments(self) -> list[Moment]:
        return [moment for episode in self.episodes.values() for moment in episode.moments]


class FreeRunner(JudgedRunner):
    """A world whose robot may be put anywhere: an environment begins its episodes as it likes."""

    def _is_allowed(self, service: str, arguments: tuple[Any, ...]) -> bool:
        return service in self._services


def visit(wish: Wish, assignment: Assignment, file: Path, level: Level, seed: int) -> Visit:
    """Lives through some episodes with the environment. Raises GuestError where the student's code fails."""
    with tempfile.TemporaryDirectory(prefix="examination-") as folder:
        Path(folder).chmod(0o755)
        shutil.copyfile(EXAMINER, Path(folder, EXAMINER.name))
        shutil.copyfile(file, Path(folder, file.name))
        graph = Graph(log_sink=lambda record: None)
        simulation = Simulation(noisy(wish.place.world, 0.0), seed=1, step_size=STEP)
        runner = FreeRunner(simulation, graph, frozenset({"move_model"}))
        arguments = [file.stem, wish.cls, *_parameters(wish.place)]
        # It listens before there is anything to hear.
        examination = _Examination(runner, wish, seed)
        guest = Guest.start(
            graph, Path(folder, EXAMINER.name), args=arguments, limits=assignment.limits, level=level
        )
        with guest:
            runner.participants.append(guest)
            examination.hold(guest)
            lines = guest.take_output().lines
    examination.seen.printed = tuple(printable(line.text) for line in lines)[:MOST_PRINTED]
    return examination.seen


def _parameters(place: Place) -> list[str]:
    """What every program is told of the place."""
    home = place.start or Pose()
    return [
        "--ros-args",
        "-p",
        f"home:=[{home.x!r}, {home.y!r}, {home.theta!r}]",
        "-p",
        f"model:={place.robot}",
    ]


class _Examination:
    """Asks, and notes what happened."""

    def __init__(self, runner: FreeRunner, wish: Wish, seed: int) -> None:
        self._runner = runner
        self._guest: Guest | None = None
        self._wish = wish
        self._seed = seed
        self.seen = Visit(wish)
        assert wish.place.robot is not None  # the sheet's reader sees to it
        self._robot = wish.place.robot
        self._heard: list[str] = []
        self._ranges: tuple[float, ...] = ()
        self._touched = False
        node = runner.graph.create_node("grader")
        self._ask = node.create_publisher(String, ASK, 10)
        node.create_subscription(String, ANSWER, self._heard_answer, 10)
        runner.graph.add_message_listener(self._overhear)

    def hold(self, guest: Guest) -> None:
        """Everything that is tried, in order."""
        self._guest = guest
        self.seen.about = self._answer(PATIENCE_S, "the file's beginning")
        if "missing" in self.seen.about or not self.seen.about.get("is_env"):
            return
        turning = next((k for k, (speed, turn) in enumerate(self._wish.moves) if not speed and turn > 0), 0)
        ahead = next((k for k, (speed, turn) in enumerate(self._wish.moves) if speed and not turn), 0)
        self._episode("turning on the spot", 0, lambda _: turning, self._wish.max_steps)
        self._episode("into the wall", 1, lambda _: ahead, self._wish.max_steps)
        self._episode("to the target", 2, self._pilot(), self._wish.max_steps)
        chance = random.Random(f"moves {self._seed}")
        moves = [chance.randrange(len(self._wish.moves)) for _ in range(15)]
        for name, seed in (("one seed", 3), ("the same seed again", 3), ("another seed", 4)):
            self._episode(name, seed, lambda done: moves[done], len(moves))
        self.seen.checker = self._checked()

    def _episode(self, name: str, seed: int, choose: Callable[[int], int], steps: int) -> None:
        """Drives until it is over, and a little on if it does not end where it should."""
        answer = self._call(f"reset(seed={self._seed + seed})", call="reset", seed=self._seed + seed)
        episode = Episode(
            name, answer.get("returned", {}), answer.get("inside") is True, self._pose(), self._ranges
        )
        self.seen.episodes[name] = episode
        overdue = 0
        while overdue < LATE and len(episode.moments) < steps + LATE:
            done = len(episode.moments)
            if name not in ENDING and done >= steps:
                return
            moment = self._step(choose(done))
            episode.moments.append(moment)
            if moment.is_over:
                return
            is_due = moment.touched or moment.target_m < 0.1 or done + 1 > steps
            overdue += is_due or overdue > 0

    def _step(self, action: int) -> Moment:
        before, self._touched = self._pose(), False
        answer = self._call(f"step({action})", call="step", action=action)
        self.seen.steps += 1
        case = self._wish.place.case
        assert case is not None  # the sheet's reader sees to it
        away = self._runner.simulation.hull_distance(self._robot, case.target)
        returned, inside = answer.get("returned", {}), answer.get("inside") is True
        return Moment(action, returned, inside, before, self._pose(), self._touched, away, self._ranges)

    def _pilot(self) -> Callable[[int], int]:
        """Chooses moves along the way: turn towards the next point, then go."""
        way = list(self._wish.way)

        def choose(done: int) -> int:
            pose = self._pose()
            while len(way) > 1 and math.hypot(way[0][0] - pose.x, way[0][1] - pose.y) < 0.15:
                way.pop(0)
            off = math.atan2(way[0][1] - pose.y, way[0][0] - pose.x) - pose.theta
            off = (off + math.pi) % (2 * math.pi) - math.pi
            return max(
                range(len(self._wish.moves)),
                key=lambda k: self._wish.moves[k][0] if abs(off) < 0.12 else off * self._wish.moves[k][1],
            )

        return choose

    def _checked(self) -> str:
        answer = self._call("Gymnasium's checker", CHECKER_S, call="checker")
        complaints = [str(answer.get("says", "")), *map(str, answer.get("warns", []))]
        return printable(next((each for each in complaints if each), ""))[:500]

    def _call(self, what: str, patience_s: float = PATIENCE_S, **question: Json) -> Mapping[str, Json]:
        self._ask.publish(String(data=json.dumps(question)))
        return self._answer(patience_s, what)

    def _answer(self, patience_s: float, what: str) -> Mapping[str, Json]:
        """Ticks until the answer comes."""
        for _ in range(round(patience_s / STEP)):
            self._runner.exchange_until_idle()
            if self._heard:
                return self._read(self._heard.pop())
            self._runner.tick()
            self._touched = self._touched or self._runner.simulation.touches(self._robot)
            if self._guest is not None and self._guest.failure is not None:
                raise GuestError(self._guest.failure)
            if self._guest is not None and self._guest.has_ended:
                raise GuestError(Failure(FailureKind.EXIT, f"the program ended during {what}."))
        message = f"{what} did not come back within {patience_s:g} simulated seconds. Does it wait for a message that nobody sends?"
        raise GuestError(Failure(FailureKind.TIMEOUT, message))

    def _read(self, text: str) -> Mapping[str, Json]:
        try:
            answer = decode(text.encode("ascii", "replace"))
        except ProtocolError as error:
            raise GuestError(Failure(FailureKind.PROTOCOL, f"the answer is no data: {error}")) from None
        if not isinstance(answer, dict) or not _is_plain(answer.get("returned", {})):
            raise GuestError(Failure(FailureKind.PROTOCOL, "the answer is no data"))
        return answer

    def _heard_answer(self, message: String) -> None:
        self._heard.append(message.data)

    def _overhear(self, _: int, node: Node, topic: str, message: Message) -> None:
        if topic == self._wish.scan and node.handle.full_name == "/flatland_server":
            self._ranges = tuple(getattr(message, "ranges", ()))

    def _pose(self) -> Pose:
        return self._runner.simulation.pose(self._robot)


ENDING: Final = ("turning on the spot", "into the wall", "to the target")
"""Episodes that are driven until they end."""


def _is_plain(told: Json) -> bool:
    """Whether a told value has the shape that ``grader.evidence.environment_examiner`` gives it."""
    if not isinstance(told, dict):
        return False
    parts = told.get("parts", [])
    return isinstance(parts, list) and all(map(_is_plain, parts))


def sectors(ranges: Sequence[float], count: int, clip: float) -> list[float]:
    """The nearest range of each of ``count`` parts of a scan, at most ``clip``; what is left over is in the last part."""
    nearest, size = [clip] * count, max(1, len(ranges) // count)
    for k, each in enumerate(ranges):
        if not math.isnan(each):
            place = min(k // size, count - 1)
            nearest[place] = min(nearest[place], each)
    return nearest
