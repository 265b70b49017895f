"""One place, one robot, one controller: what a face shows and what ``kit run`` runs.

A session builds the runner, keeps score of the drive, and changes controllers while it runs. It belongs to
whoever ticks the runner: a face posts its wishes to the world's thread.
"""

from __future__ import annotations

import json
import re
from collections import deque
from types import TracebackType
from typing import Final, Self

from kit.controllers import ControllerFile
from kit.controllers.keystrokes import KeystrokePublisher
from kit.host.failure import Failure
from kit.host.limits import DESK, Limits
from kit.msg.geometry_msgs import Twist
from kit.places import Place
from kit.recording import Playback, Recording
from kit.ros.graph import Graph
from kit.ros.log import LoggingSeverity, LogRecord
from kit.runner import Runner
from kit.seat import Seat
from kit.sim.simulation import Simulation
from kit.trip import Trip

KEPT_MESSAGES: Final = 200
LOG_LINE: Final = re.compile(r"\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[[\d.]+\] \[([^]]*)\]: (.*)")


class Session:
    """Everything of one drive. Close it when done, or use it as a context manager.

    ``watched``: somebody looks, so lasers look too, whether a node listens or not. ``graph``: one that others
    are in already; without it the session makes its own.
    """

    def __init__(
        self,
        place: Place,
        *,
        seed: int = 0,
        step_size: float = 0.01,
        limits: Limits = DESK,
        watched: bool = False,
        graph: Graph | None = None,
    ) -> None:
        self.place = place
        self.messages: deque[LogRecord] = deque(maxlen=KEPT_MESSAGES)
        self.graph = Graph() if graph is None else graph
        self.graph.log.sink = self.messages.append
        simulation = Simulation(
            place.world, seed=seed, step_size=step_size, wanted=None if watched else self._has_listener
        )
        self.runner = Runner(simulation, self.graph)
        self.trip = Trip(place.robot, place.case)
        self.runner.observers.append(self.trip)
        self.keys = KeystrokePublisher(self.graph)
        self.seat = Seat(
            self.runner,
            self._arguments(),
            seed=seed,
            limits=limits,
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
        playback = Playback(recording, runner.simulation.accept, runner.tell, on_end=runner.pause)
        runner.guests.append(playback)
        runner.observers.append(playback)

    def wait_until_driven(self) -> None:
        """Waits until the controller drives, or has failed to."""
        self.seat.wait()

    def look_around(self) -> None:
        """To be called a few times a second: new versions of the controller, ones that are ready, ones that failed."""
        self.seat.look()
        self.keys.look_around()

    def stop_robot(self) -> None:
        """Takes the last command off the robot: nobody drives it who would."""
        robot = next((model for model in self.place.world.models if model.name == self.place.robot), None)
        if robot is None:
            return
        others = [other.topic("") for other in self.place.world.models if other.namespace != robot.namespace]
        for end in self.runner.simulation.endpoints:
            if end.direction == "subscribe" and end.type is Twist and end.topic.startswith(robot.topic("")):
                if not robot.namespace and end.topic.startswith(tuple(others)):
                    continue
                self.runner.accept(end.topic, Twist())

    def _print(self, line: str) -> None:
        self.note(line, self.controller.name if self.controller else "")

    def note(self, line: str, program: str) -> None:
        """A line that a program printed, as one of the session's messages."""
        found = LOG_LINE.fullmatch(line)
        severity, name, text = found.groups() if found else ("INFO", program, line)
        self.messages.append(
            LogRecord(self.runner.simulation.time_ns, LoggingSeverity[severity], name, text, "", "", 0)
        )

    def reset(self, seed: int | None = None) -> None:
        """The world back to its start; the controller starts anew too."""
        self.runner.tell("reset", seed)
        self.seat.restart()

    def close(self) -> None:
        self.seat.close()

    def _has_listener(self, topic: str) -> bool:
        return self.graph.subscription_count(topic) > 0

    def _arguments(self) -> list[str]:
        """What every controller is told of the place: its robot's name and where home is; which world it is in,
        who drives there, and where to."""
        place, start = self.place, self.place.start
        if start is None or place.robot is None:
            return []
        told = {
            "home": f"[{start.x!r}, {start.y!r}, {start.theta!r}]",
            "model": place.robot,
            "models": json.dumps(place.partners),
            "world": json.dumps(str(place.world.file.absolute())),
        }
        if place.case is not None:
            x, y = place.case.target
            told |= {"target": f"[{x!r}, {y!r}]", "target_radius": repr(float(place.case.target_radius))}
        return ["--ros-args", *(word for name, value in told.items() for word in ("-p", f"{name}:={value}"))]
