"""A session: one scenario, its runner, its metrics and the controller that drives, as the screens and ``kit run`` use it.

It belongs to the thread that ticks the runner; a face posts jobs to the world's thread.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable
from datetime import datetime
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Final, Protocol, Self

from kit.controllers import ControllerFile, kit_controllers
from kit.host.failure import Failure
from kit.host.program_terminal import ProgramStreams
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.msg.geometry_msgs import Twist
from kit.render.scene import PenStroke, SceneBody
from kit.ros.graph.graph import Graph
from kit.ros.log import LoggingSeverity, LogRecord
from kit.run.connection_watch import ConnectionWatch
from kit.run.controller_switcher import ControllerSwitcher
from kit.run.episode import controller_arguments
from kit.run.keystrokes import KeystrokePublisher
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Playback, Recording
from kit.run.runner import Runner
from kit.run.scenario import Scenario
from kit.sim.simulation import Simulation

if TYPE_CHECKING:
    from kit.run.view import View

STANDS_STILL_M: Final = 0.01
"""A robot that has driven less than this stands still [m]."""


@cache
def _files_of_kit() -> frozenset[Path]:
    return frozenset(each.file for each in kit_controllers())


MAX_MESSAGES: Final = 200
LOG_LINE: Final = re.compile(
    r"\[(?P<severity>DEBUG|INFO|WARN|ERROR|FATAL)\] \[(?P<s>\d+)\.(?P<ns>\d{9})\] \[(?P<name>[^]]*)\]: (?P<text>.*)"
)


class SceneAddition(Protocol):
    """Something that is drawn with a world and is not part of it."""

    @property
    def bodies(self) -> tuple[SceneBody, ...]: ...

    @property
    def strokes(self) -> tuple[PenStroke, ...]: ...


class Session:
    """Runs one scenario with exchangeable controllers. Close it when done, or use it as a context manager.

    ``level``: how far controllers are confined. ``always_scan``: the robot's lasers are computed even when no node
    subscribes to them. ``on_message``: called with each log message as it comes. ``graph``: one that other nodes are in
    already; by default the session makes its own. ``offered_truths`` and ``is_hidden``: as ``Runner`` takes them. ``streams``: what a
    controller reads that is run by hand.
    """

    def __init__(
        self,
        scenario: Scenario,
        *,
        seed: int = 0,
        step_size: float = 0.01,
        limits: Limits = INTERACTIVE_LIMITS,
        level: Level = INTERACTIVE_LEVEL,
        always_scan: bool = False,
        on_message: Callable[[LogRecord], object] = lambda record: None,
        graph: Graph | None = None,
        offered_truths: frozenset[str] | None = None,
        streams: ProgramStreams | None = None,
        is_hidden: bool = False,
    ) -> None:
        self.scenario = scenario
        self._on_message = on_message
        self.messages: deque[LogRecord] = deque(maxlen=MAX_MESSAGES)
        self.graph = Graph() if graph is None else graph
        self.graph.log.sink = self._log
        self._scanned_topics: frozenset[str] = frozenset()
        simulation = Simulation(
            scenario.world, seed=seed, step_size=step_size, has_subscribers=self._has_subscribers
        )
        if always_scan:
            ends = (end for name in scenario.partners for end in simulation.model_endpoints(name))
            self._scanned_topics = frozenset(end.topic for end in ends)
        self.runner = Runner(simulation, self.graph, offered_truths=offered_truths, is_hidden=is_hidden)
        self.additions: list[SceneAddition] = []
        """What the view draws beside the world."""
        self.shown: Callable[[View], View] = lambda view: view
        """What is shown of a view: a game has targets of its own. Called in the thread that ticks."""
        self.metrics = MetricsRecorder.for_scenario(scenario)
        self.runner.observers.append(self.metrics)
        self._watch: ConnectionWatch | None = None
        self.keys = KeystrokePublisher(self.graph, is_hidden=is_hidden)
        self._switcher = ControllerSwitcher(
            self.runner,
            controller_arguments(scenario),
            seed=seed,
            limits=limits,
            level=level,
            on_stop=self.stop_robot,
            on_reload=self._log_reload,
            on_print=self._print,
            streams=streams,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def controller(self) -> ControllerFile | None:
        """The controller that drives, or is about to."""
        return self._switcher.controller

    @property
    def failure(self) -> Failure | None:
        """Why the controller does not run, or why its newest version was not taken; None while all is well."""
        return self._switcher.failure

    def drive_with(self, controller: ControllerFile | None) -> None:
        """Starts a controller, which replaces the present one once it has started well. None: nobody drives."""
        self._switcher.load(controller)

    def watch_connections(self, way_out: str = "") -> ConnectionWatch:
        """Warns from now on of what the controller's nodes connect to that has no other end, and ask for that is too much, and where
        it sends no speed: ``way_out`` says how to change that here.

        The kit's own controllers need not hear all that they can: of one of them that is told while the robot stands still.
        """
        watch = ConnectionWatch(
            self.graph,
            self._watched_nodes,
            self._warn,
            commanders=lambda: self._switcher.node_names,
            commands=self._expected_commands,
            way_out=way_out,
        )
        self.runner.observers.append(watch)
        self._watch = watch
        return watch

    def play_back(self, recording: Recording) -> None:
        """Replays a recording's inputs; pauses at its end."""
        runner = self.runner
        playback = Playback(recording, runner.simulation.accept, runner.call_service, on_end=runner.pause)
        runner.participants.append(playback)
        runner.observers.append(playback)

    def wait_until_driven(self) -> None:
        """Waits until the controller drives, or has failed to."""
        self._switcher.wait()

    def poll(self) -> None:
        """Follows the controller: new versions, ones that have started, ones that failed. Call it a few times a second."""
        self._switcher.poll()
        self.keys.resend_held_keys()

    def read_output(self) -> None:
        """Turns what the controller has printed since the last time into messages."""
        self._switcher.read_output()

    def stop_robot(self) -> None:
        """Commands zero speed to all robots that drive in this scenario."""
        for topic in dict.fromkeys(
            topic for name in self.scenario.partners for topic in self.command_topics(name)
        ):
            self.runner.accept(topic, Twist())

    def command_topics(self, model: str) -> tuple[str, ...]:
        """Topics on which a model's devices subscribe to Twists."""
        return self.runner.simulation.command_topics(model)

    def _watched_nodes(self) -> frozenset[str]:
        drives = self.metrics.metrics.distance_m >= STANDS_STILL_M
        if drives and self.controller is not None and self.controller.file in _files_of_kit():
            return frozenset()
        return self._switcher.node_names

    def _expected_commands(self) -> tuple[str, ...]:
        """Topics on which the user's own controller is to send speeds; none where it is one of the kit's."""
        if self.controller is None or self.controller.file in _files_of_kit():
            return ()
        return tuple(topic for name in self.scenario.partners for topic in self.command_topics(name))

    def _warn(self, text: str) -> None:
        self._log(LogRecord(self.graph.now_ns, LoggingSeverity.WARN, "kit", text, "", "", 0))

    def _print(self, line: str) -> None:
        self.log_line(line, self.controller.name if self.controller else "")

    def log_line(self, line: str, program: str) -> None:
        """Adds a line that a program printed to the messages; log lines keep their severity, name and time."""
        now, severity, name, text = self.runner.simulation.time_ns, LoggingSeverity.INFO, program, line
        if found := LOG_LINE.fullmatch(line):
            severity, name, text = LoggingSeverity[found["severity"]], found["name"], found["text"]
            now = min(now, int(found["s"] + found["ns"]))  # it was printed before it is read
        self._log(LogRecord(now, severity, name, text, "", "", 0))

    def _log_reload(self, file: Path) -> None:
        if self._watch is not None:
            self._watch.begin_again()
        text = f"reloaded {file.name} {datetime.now():%H:%M:%S}"
        self._log(LogRecord(self.graph.now_ns, LoggingSeverity.INFO, "kit", text, "", "", 0))

    def _log(self, record: LogRecord) -> None:
        self.messages.append(record)
        self._on_message(record)

    def reset(self, seed: int | None = None) -> None:
        """Puts the world back to its start and restarts the controller."""
        self.runner.call_service("reset", seed)
        self._switcher.restart()

    def interrupt(self) -> None:
        """Lets the controller do what it does at Ctrl-C. Only ``disconnect`` and ``close`` may follow."""
        self._switcher.interrupt()

    def disconnect(self) -> None:
        """Ends a tick that waits for the controller, from any thread. Only ``close`` may follow."""
        self._switcher.disconnect()

    def close(self) -> None:
        self._switcher.close()

    def _has_subscribers(self, topic: str) -> bool:
        return topic in self._scanned_topics or self.graph.has_subscriptions(topic)
