"""A session: one scenario, its runner, its metrics and the controller that drives, as the screens and ``kit run`` use it.

It belongs to the thread that ticks the runner; a face posts jobs to the world's thread.

Switches controllers while a world runs: the next one starts beside the active one and replaces it once it has started well.
"""

from __future__ import annotations

import os
import re
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Final, Protocol, Self

from kit.controllers import ControllerFile, kit_controllers
from kit.host.failure import Failure, StudentCodeError
from kit.host.file_watcher import FileWatcher
from kit.host.node_process import NodeProcess
from kit.host.process import PackageProgram
from kit.host.program_terminal import ProgramStreams
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.msg.geometry_msgs import Twist
from kit.msg.interfaces import register_packages
from kit.msg.std_msgs import Float32, String
from kit.render.scene import PenStroke, SceneBody
from kit.ros.graph.graph import Graph
from kit.ros.log import LoggingSeverity, LogRecord
from kit.ros.node.node import create_graph_node
from kit.ros.packages import (
    SEARCH_VARIABLE,
    find_packages,
    import_folders,
    interface_packages,
    workspace_folders,
)
from kit.run.connection_watch import ConnectionWatch
from kit.run.episode import controller_arguments
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Playback, Recording
from kit.run.runner import Runner
from kit.run.scenario import Scenario
from kit.sim.simulation import Simulation

KEYS_TOPIC: Final = "/teleopkeys"
STRENGTH_TOPIC: Final = f"{KEYS_TOPIC}/strength"
STANDS_STILL_M: Final = 0.01
"""A robot that has driven less than this stands still [m]."""


class KeystrokePublisher:
    """Publishes ``p_up``, ``r_up`` and so on (pressed, released) on ``/teleopkeys``.

    A terminal that reports no key release leaves open for a while whether a key is still down; how strongly
    the keys push meanwhile, 0 to 1, goes to ``/teleopkeys/strength``.
    """

    def __init__(self, graph: Graph, *, is_hidden: bool = False) -> None:
        """``is_hidden``: its names are hidden ones, for a world in which no program expects keys."""
        self._graph = graph
        mark = "_" if is_hidden else ""
        node = create_graph_node(graph, f"{mark}TeleOpKeys")
        self._topic = KEYS_TOPIC.replace("/", f"/{mark}", 1)
        self._keys = node.create_publisher(String, self._topic, 10)
        self._strengths = node.create_publisher(Float32, STRENGTH_TOPIC.replace("/", f"/{mark}", 1), 10)
        self._strength = 1.0
        self._held: list[str] = []
        self._listeners = 0

    @property
    def has_listener(self) -> bool:
        """Whether a node listens to the keys."""
        return self._graph.subscription_count(self._topic) > 0

    def publish(self, messages: Iterable[str], strength: float = 1.0) -> None:
        if strength != self._strength:
            self._strength = strength
            self._strengths.publish(Float32(data=float(strength)))
        for message in messages:
            self._keys.publish(String(data=message))
            event, _, key = message.partition("_")
            self._held = [held for held in self._held if held != key]
            if event == "p":
                self._held.append(key)

    def resend_held_keys(self) -> None:
        """Publishes the keys that are down to a listener that has just started: it missed when they went down."""
        listeners = self._graph.subscription_count(self._topic)
        if listeners > self._listeners:
            self.publish([f"p_{key}" for key in self._held], self._strength)
        self._listeners = listeners


class ControllerSwitcher:
    """Owns the process of the controller that takes part in the runner's ticks. Belongs to the thread that ticks."""

    def __init__(
        self,
        runner: Runner,
        arguments: Sequence[str],
        *,
        seed: int,
        limits: Limits,
        level: Level = INTERACTIVE_LEVEL,
        on_stop: Callable[[], object] = lambda: None,
        on_reload: Callable[[Path], object] = lambda file: None,
        on_print: Callable[[str], object] = lambda line: None,
        streams: ProgramStreams | None = None,
    ) -> None:
        """``on_stop``: called when a controller has stopped driving; ``on_reload``: when a new version of its file drives; ``on_print``: with each line it prints.

        ``streams``: what a controller reads that is run by hand.
        """
        self._streams = streams
        self._runner = runner
        self._on_stop = on_stop
        self._on_reload = on_reload
        self._is_reload = False
        self._on_print = on_print
        self._arguments: Final = tuple(arguments)
        self._seed = seed
        self._limits = limits
        self._level = level
        self._active: NodeProcess | None = None
        self._pending: NodeProcess | None = None
        self._failure: Failure | None = None
        self._file: FileWatcher | None = None
        self.controller: ControllerFile | None = None
        """The one that drives or is about to."""

    @property
    def failure(self) -> Failure | None:
        """Why the active controller has stopped, or why its newest version was not taken."""
        if self._failure is None and self._active is not None:
            return self._active.failure
        return self._failure

    @property
    def node_names(self) -> frozenset[str]:
        """The full names of the active controller's nodes."""
        return frozenset() if self._active is None else self._active.node_names

    def load(self, controller: ControllerFile | None) -> None:
        """Starts a controller without waiting for it; None only stops the active one."""
        self._cancel_pending()
        self._failure = None
        self.controller = controller
        if controller is None:
            self._unload()
            return
        self._file = FileWatcher(controller.file)
        self._start(controller)

    def restart(self) -> None:
        """Stops the active controller at once and starts the same one from its beginning."""
        self._unload()
        self.load(self.controller)

    def wait(self) -> None:
        """Waits until the pending controller drives or has failed."""
        if self._pending is not None:
            self._finish_start(self._pending.wait_until_started)

    def poll(self) -> None:
        """Activates a pending controller that has started, and starts a new version of a file that was saved."""
        pending = self._pending
        self.read_output()
        if self._active is not None and self._active.failure is not None and self._failure is None:
            self._failure = self._active.failure
            self._on_stop()
        if pending is not None:
            self._finish_start(pending.is_started)
        elif self.controller is not None and self._file is not None and self._file.has_changed():
            self._failure = None
            self._start(self.controller)
            self._is_reload = True

    def disconnect(self) -> None:
        """Stops waiting for the active and the pending controller; may be called in any thread."""
        for process in filter(None, (self._active, self._pending)):
            process.disconnect()

    def read_output(self) -> None:
        """Passes on what the active controller has printed since the last time."""
        if self._active is not None:
            self._pass_on_output(self._active)

    def close(self) -> None:
        """Ends both processes."""
        self._cancel_pending()
        self._unload()

    def _start(self, controller: ControllerFile) -> None:
        self._is_reload = False
        try:
            self._pending = NodeProcess(
                self._runner.graph,
                controller.file,
                args=self._arguments,
                seed=self._seed,
                limits=self._limits,
                level=self._level,
                package=_controller_package(controller.file) if self._level is INTERACTIVE_LEVEL else None,
                streams=self._streams,
                replaces=self._active,
            )
        except StudentCodeError as error:
            self._failure = error.failure

    def _finish_start(self, is_started: Callable[[], bool | None]) -> None:
        """Activates the pending controller unless ``is_started`` returns False; discards it if that raises."""
        pending = self._pending
        assert pending is not None
        try:
            if is_started() is False:
                return
        except StudentCodeError as error:
            self._failure = error.failure
            self._pass_on_output(pending)
            self._cancel_pending()
            return
        self._pending = self._failure = None
        self._unload()
        pending.join()
        self._active = pending
        self._runner.participants.append(pending)
        if self._is_reload and self.controller is not None:
            self._on_reload(self.controller.file)

    def _cancel_pending(self) -> None:
        if self._pending is not None:
            self._pending.close()
            self._pending = None

    def _unload(self) -> None:
        if self._active is not None:
            self._pass_on_output(self._active)
            self._runner.participants.remove(self._active)
            self._active.close()
            self._active = None
            self._on_stop()

    def _pass_on_output(self, process: NodeProcess) -> None:
        printed = process.take_output()
        for line in printed.lines:
            self._on_print(line.text)
        if printed.omission:
            self._on_print(printed.omission)


@cache
def _files_of_kit() -> frozenset[Path]:
    return frozenset(each.file for each in kit_controllers())


def _controller_package(file: Path) -> PackageProgram | None:
    """What a controller's file sees of the ROS 2 workspace in which it lies; None if it lies in none."""
    search = workspace_folders(file.absolute())
    if not search:
        return None
    packages = find_packages(search)
    interfaces = interface_packages(packages)
    register_packages({name: str(folder) for name, folder in interfaces.items()})
    environment = {SEARCH_VARIABLE: os.pathsep.join(map(str, search))}
    return PackageProgram(
        file.absolute().parent,
        None,
        environment,
        imports=import_folders(packages.values()),
        interfaces=interfaces,
        is_controller=True,
    )


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
        self.metrics = MetricsRecorder.for_scenario(scenario)
        self.runner.observers.append(self.metrics)
        self.keys = KeystrokePublisher(self.graph, is_hidden=is_hidden)
        self.switcher = ControllerSwitcher(
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
        return self.switcher.controller

    @property
    def failure(self) -> Failure | None:
        """Why the controller does not run, or why its newest version was not taken; None while all is well."""
        return self.switcher.failure

    def drive_with(self, controller: ControllerFile | None) -> None:
        """Starts a controller, which replaces the present one once it has started well. None: nobody drives."""
        self.switcher.load(controller)

    def watch_connections(self) -> ConnectionWatch:
        """Warns from now on of what the controller's nodes connect to that has no other end, and ask for that is too much.

        The kit's own controllers need not hear all that they can: of one of them that is told while the robot stands still.
        """
        watch = ConnectionWatch(
            self.graph, self._watched_nodes, self._warn, commanders=lambda: self.switcher.node_names
        )
        self.runner.observers.append(watch)
        return watch

    def play_back(self, recording: Recording) -> None:
        """Replays a recording's inputs; pauses at its end."""
        runner = self.runner
        playback = Playback(recording, runner.simulation.accept, runner.call_service, on_end=runner.pause)
        runner.participants.append(playback)
        runner.observers.append(playback)

    def wait_until_driven(self) -> None:
        """Waits until the controller drives, or has failed to."""
        self.switcher.wait()

    def poll(self) -> None:
        """Follows the controller: new versions, ones that have started, ones that failed. Call it a few times a second."""
        self.switcher.poll()
        self.keys.resend_held_keys()

    def read_output(self) -> None:
        """Turns what the controller has printed since the last time into messages."""
        self.switcher.read_output()

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
        return self.switcher.node_names

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
        text = f"reloaded {file.name} {datetime.now():%H:%M:%S}"
        self._log(LogRecord(self.graph.now_ns, LoggingSeverity.INFO, "kit", text, "", "", 0))

    def _log(self, record: LogRecord) -> None:
        self.messages.append(record)
        self._on_message(record)

    def reset(self, seed: int | None = None) -> None:
        """Puts the world back to its start and restarts the controller."""
        self.runner.call_service("reset", seed)
        self.switcher.restart()

    def disconnect(self) -> None:
        """Ends a tick that waits for the controller, from any thread. Only ``close`` may follow."""
        self.switcher.disconnect()

    def close(self) -> None:
        self.switcher.close()

    def _has_subscribers(self, topic: str) -> bool:
        return topic in self._scanned_topics or self.graph.has_subscriptions(topic)
