"""One place, one robot, one controller: what a face shows and what ``kit run`` runs.

A session builds the runner, keeps score of the drive, and changes controllers while it runs. It belongs to
whoever ticks the runner: a face posts its wishes to the world's thread.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable
from types import TracebackType
from typing import Final, Self

from kit.controllers import ControllerFile
from kit.controllers.keystrokes import KeystrokePublisher
from kit.host.failure import Failure
from kit.host.sandbox.confinement import DESK_LEVEL, Level
from kit.host.sandbox.limits import DESK, Limits
from kit.msg.geometry_msgs import Twist
from kit.ros.graph.graph import Graph
from kit.ros.log import LoggingSeverity, LogRecord
from kit.run.controller_switcher import Seat
from kit.run.episode import controller_arguments
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Playback, Recording
from kit.run.runner import Runner
from kit.run.scenario import Place
from kit.sim.simulation import Simulation

KEPT_MESSAGES: Final = 200
LOG_LINE: Final = re.compile(
    r"\[(?P<severity>DEBUG|INFO|WARN|ERROR|FATAL)\] \[(?P<s>\d+)\.(?P<ns>\d{9})\] \[(?P<name>[^]]*)\]: (?P<text>.*)"
)


class Session:
    """Everything of one drive. Close it when done, or use it as a context manager.

    ``level``: how far controllers are locked in. ``watched``: somebody looks, so the robot's lasers look too, whether a node listens or not. ``on_message`` is
    told each message as it comes. ``graph``: one that others are in already; without it the session makes its own.
    """

    def __init__(
        self,
        place: Place,
        *,
        seed: int = 0,
        step_size: float = 0.01,
        limits: Limits = DESK,
        level: Level = DESK_LEVEL,
        watched: bool = False,
        on_message: Callable[[LogRecord], object] = lambda record: None,
        graph: Graph | None = None,
    ) -> None:
        self.place = place
        self._on_message = on_message
        self.messages: deque[LogRecord] = deque(maxlen=KEPT_MESSAGES)
        self.graph = Graph() if graph is None else graph
        self.graph.log.sink = self._said
        self._looked_at: frozenset[str] = frozenset()
        simulation = Simulation(place.world, seed=seed, step_size=step_size, has_subscribers=self._is_wanted)
        if watched:
            ends = (end for name in place.partners for end in simulation.model_endpoints(name))
            self._looked_at = frozenset(end.topic for end in ends)
        self.runner = Runner(simulation, self.graph)
        self.metrics = MetricsRecorder.for_scenario(place)
        self.runner.observers.append(self.metrics)
        self.keys = KeystrokePublisher(self.graph)
        self.seat = Seat(
            self.runner,
            controller_arguments(place),
            seed=seed,
            limits=limits,
            level=level,
            on_empty=self.stop_robot,
            on_print=self._print,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def controller(self) -> ControllerFile | None:
        """Who drives, or is about to."""
        return self.seat.controller

    @property
    def failure(self) -> Failure | None:
        """Why the controller does not run, or why its newest version was not taken; None while all is well."""
        return self.seat.failure

    def drive_with(self, controller: ControllerFile | None) -> None:
        """Starts a controller and, as soon as it has started well, lets it take over. None: nobody drives."""
        self.seat.seat(controller)

    def play_back(self, recording: Recording) -> None:
        """Has the world told again what it was told then; at the recording's end it stands still."""
        runner = self.runner
        playback = Playback(recording, runner.simulation.accept, runner.call_service, on_end=runner.pause)
        runner.participants.append(playback)
        runner.observers.append(playback)

    def wait_until_driven(self) -> None:
        """Waits until the controller drives, or has failed to."""
        self.seat.wait()

    def look_around(self) -> None:
        """To be called a few times a second: new versions of the controller, ones that are ready, ones that failed."""
        self.seat.look()
        self.keys.look_around()

    def listen(self) -> None:
        """Takes in what the controller has printed since the last time."""
        self.seat.listen()

    def stop_robot(self) -> None:
        """Takes the last command off the robot, and off its partner: nobody drives them who would."""
        for topic in dict.fromkeys(
            topic for name in self.place.partners for topic in self.command_topics(name)
        ):
            self.runner.accept(topic, Twist())

    def command_topics(self, model: str) -> tuple[str, ...]:
        """Where a model's devices take commands, as Twists."""
        ends = self.runner.simulation.model_endpoints(model)
        return tuple(end.topic for end in ends if end.direction == "subscribe" and end.type is Twist)

    def _print(self, line: str) -> None:
        self.note(line, self.controller.name if self.controller else "")

    def note(self, line: str, program: str) -> None:
        """A line that a program printed, as one of the session's messages."""
        now, severity, name, text = self.runner.simulation.time_ns, LoggingSeverity.INFO, program, line
        if found := LOG_LINE.fullmatch(line):
            severity, name, text = LoggingSeverity[found["severity"]], found["name"], found["text"]
            now = min(now, int(found["s"] + found["ns"]))  # heard later than said
        self._said(LogRecord(now, severity, name, text, "", "", 0))

    def _said(self, record: LogRecord) -> None:
        self.messages.append(record)
        self._on_message(record)

    def reset(self, seed: int | None = None) -> None:
        """The world back to its start; the controller starts anew too."""
        self.runner.call_service("reset", seed)
        self.seat.restart()

    def hang_up(self) -> None:
        """From any thread: a tick that waits for the controller waits no longer. Only ``close`` may follow."""
        self.seat.hang_up()

    def close(self) -> None:
        self.seat.close()

    def _is_wanted(self, topic: str) -> bool:
        return topic in self._looked_at or self.graph.subscription_count(topic) > 0
