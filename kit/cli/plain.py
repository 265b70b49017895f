"""The kit line by line: for screen readers, pipes, and terminals without a full screen."""

from __future__ import annotations

import math
import shlex
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import click

from kit.cli.waiting import Intake, Lines
from kit.controllers import ControllerFile, find_controller, kit_controllers, user_controllers
from kit.inspection.server import InspectionServer, open_inspection_server
from kit.msg.geometry_msgs import Twist, Vector3
from kit.render.world_text import describe_scene, scene_rows
from kit.ros.log import LogRecord
from kit.run.episode import EndCondition, EndReason, run_until
from kit.run.pacing import MAXIMUM, REAL_TIME, Schedule
from kit.run.recording import Recorder, save_recording
from kit.run.scenario import Scenario, find_scenario
from kit.run.session import Session
from kit.run.view import ViewBuilder, format_clock, format_log
from kit.world.catalogue import all_maps
from kit.world.problems import WorldError

LONGEST: Final = 3600.0
"""Seconds that one line may run."""

OUTPUT_INTERVAL: Final = 10
"""Ticks after which the controller's output is read."""

WIDTH, HEIGHT = 78, 20


class Mistake(Exception):
    """A line that cannot be done; the message says why."""


class Verb(NamedTuple):
    words: str
    text: str
    do: Callable[[Plain, Sequence[str]], None]


class Plain:
    """One session driven by lines of text. Time stands still between lines."""

    def __init__(
        self,
        scenario: Scenario,
        controller: ControllerFile,
        *,
        seed: int,
        folder: Path,
        root: Path | None = None,
        socket_dir: Path | None = None,
        record: Path | None = None,
        intake: Intake | None = None,
        says_where: bool = True,
    ) -> None:
        """``root``: the folder that the world files named later may read; by default each its own. ``socket_dir``: where
        other terminals find the world. ``record``: where the drive is kept at the end. ``intake``: of who read lines
        before, and reads on afterwards. ``says_where``: whether to say where the drive is kept."""
        self._seed = seed
        self._folder = folder
        self._root = root
        self._socket_dir = socket_dir
        self._inspection_server: InspectionServer | None = None
        self._record = record
        self._says_where = says_where
        self._controller = controller
        self.lines = Lines(self.attend, intake)
        self._session = self._open(scenario)
        self.is_over = False

    def attend(self) -> None:
        """Answers who has come to look in, while time stands still."""
        self._session.runner.exchange_until_idle()

    def run(self, seconds: float, factor: float = MAXIMUM) -> None:
        """Lets the world run, and says what was said and where that led. ``factor``: simulated seconds per second."""
        session = self._session
        if not 0 < seconds <= LONGEST:
            raise Mistake(f"say how many seconds, above 0 and at most {LONGEST:g}")
        if session.controller is not None and _modified(self._controller.file) not in (None, self._saved):
            self._seat(session)
        failure = session.failure
        run_until(
            session.runner,
            limit_s=seconds,
            ends=(EndCondition(EndReason.FAILED, lambda: session.failure is not failure),),
            schedule=Schedule(session.runner.step_size, factor=factor),
            before_tick=lambda number: session.read_output() if number % OUTPUT_INTERVAL == 0 else None,
        )
        session.poll()
        if session.failure is not failure:
            click.echo(f"the controller stopped: {session.failure}")
        self.look()

    def drive(self, forward: float, turn: float, seconds: float) -> None:
        session = self._session
        topics = session.command_topics(session.scenario.robot or "")
        if not topics:
            raise Mistake("nothing here can be driven")
        session.drive_with(None)
        command = Twist(linear=Vector3(x=forward), angular=Vector3(z=turn))
        for topic in topics:
            session.runner.accept(topic, command)
        try:
            self.run(seconds)
        finally:
            session.stop_robot()

    def look(self) -> None:
        view = ViewBuilder(self._session).build()
        score = view.metrics
        click.echo(f"at {format_clock(view.time_s)}: {describe_scene(view.scene)}")
        for side, distance in view.nearest:
            click.echo(f"  {side}: {'nothing in range' if distance is None else f'{distance:.2f} m'}")
        done = "" if score.reached_s is None else f"; target reached after {score.reached_s:.1f} s"
        click.echo(f"  way {score.distance_m:.1f} m, bumps {score.bumps}{done}")

    def picture(self) -> None:
        click.echo("\n".join(scene_rows(ViewBuilder(self._session).build().scene, WIDTH, HEIGHT)))

    def use(self, name: str) -> None:
        self._controller = find_controller(name, self._folder)
        self._seat(self._session)

    def open(self, name: str, case: str | None) -> None:
        scenario = find_scenario(name, case, self._root)
        self._leave()
        self._session = self._open(scenario)
        self.look()

    def reset(self) -> None:
        self._session.reset()
        _wait(self._session)
        self.look()

    def controllers(self) -> None:
        for each in (*user_controllers(self._folder), *kit_controllers()):
            click.echo(f"{each.name}: {each.title}")

    def close(self) -> None:
        """Ends the session, and keeps the drive if that was asked for. Raises OSError where it cannot be kept."""
        self.lines.close()
        self._leave()
        if self._record is not None and self._recorder is not None:
            save_recording(self._recorder.recording(), self._record)
            if self._says_where:
                click.echo(f"The drive is kept in {self._record}.")

    def _open(self, scenario: Scenario) -> Session:
        session = Session(scenario, seed=self._seed, always_scan=True, on_message=_say)
        if self._socket_dir is not None:
            self._inspection_server = open_inspection_server(
                session.graph, self._socket_dir, scenario.name, self.lines.wake
            )
            if self._inspection_server is not None:
                session.runner.participants.append(self._inspection_server)
        self._recorder: Recorder | None = None
        if self._record is not None:
            case = scenario.case.name if scenario.case else None
            self._recorder = Recorder(scenario.name, case, session.runner.simulation)
            session.runner.observers.append(self._recorder)
        self._seat(session)
        return session

    def _leave(self) -> None:
        if self._inspection_server is not None:
            self._inspection_server.close()
            self._inspection_server = None
        self._session.close()

    def _seat(self, session: Session) -> None:
        """Has the controller drive, as its file is now. If that fails, who drove before goes on."""
        self._saved = _modified(self._controller.file)
        session.drive_with(self._controller)
        _wait(session)


def _wait(session: Session) -> None:
    """Until the controller drives, or has failed to; says which."""
    session.wait_until_driven()
    if session.failure is not None:
        click.echo(f"the controller does not run: {session.failure}")
    elif session.controller is not None:
        click.echo(f"{session.controller.name} drives in {session.scenario.title}")


def _modified(file: Path) -> int | None:
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return None


def _say(record: LogRecord) -> None:
    click.echo(format_log(record))


def _help(plain: Plain, words: Sequence[str]) -> None:
    for verb in VERBS.values():
        click.echo(f"{verb.words:<28} {verb.text}")


def _maps(plain: Plain, words: Sequence[str]) -> None:
    for card in all_maps():
        click.echo(f"{card.name}: {card.summary}")


def _quit(plain: Plain, words: Sequence[str]) -> None:
    plain.is_over = True


VERBS: Final = {
    "run": Verb("run SECONDS", "let the world run", lambda plain, words: plain.run(*_numbers(words, 1))),
    "live": Verb(
        "live SECONDS",
        "the same in real time: for who looks in with kit ros",
        lambda plain, words: plain.run(_numbers(words, 1)[0], REAL_TIME),
    ),
    "drive": Verb(
        "drive SPEED TURN SECONDS",
        "drive yourself: m/s, rad/s to the left",
        lambda plain, words: plain.drive(*_numbers(words, 3)),
    ),
    "look": Verb("look", "where things are", lambda plain, words: plain.look()),
    "picture": Verb("picture", "the world in characters", lambda plain, words: plain.picture()),
    "controller": Verb(
        "controller NAME", "another controller, or a file", lambda plain, words: plain.use(_word(words))
    ),
    "controllers": Verb("controllers", "which there are", lambda plain, words: plain.controllers()),
    "map": Verb(
        "map NAME [CASE]",
        "another map or world file",
        lambda plain, words: plain.open(_word(words), words[1] if words[1:] else None),
    ),
    "maps": Verb("maps", "which there are", _maps),
    "reset": Verb("reset", "back to the start", lambda plain, words: plain.reset()),
    "help": Verb("help", "these lines", _help),
    "quit": Verb("quit", "leave", _quit),
}


def _word(words: Sequence[str]) -> str:
    if not words:
        raise Mistake("a name is missing")
    return words[0]


def _numbers(words: Sequence[str], count: int) -> list[float]:
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = [math.nan]
    if not all(map(math.isfinite, numbers)):
        raise Mistake("numbers are wanted there, such as 0.5")
    if len(numbers) != count:
        wanted = "one number is" if count == 1 else f"{count} numbers are"
        raise Mistake(f"{wanted} wanted there, not {len(numbers)}")
    return numbers


def obey(plain: Plain, line: str) -> None:
    """Does what one line says. Mistakes are told, and change nothing."""
    try:
        words = shlex.split(line, comments=True)
        if not words:
            return
        verb = VERBS.get(words[0].lower())
        if verb is None:
            raise Mistake(f"there is no {words[0]!r} here; help lists what there is")
        verb.do(plain, words[1:])
    except (Mistake, LookupError, WorldError, ValueError) as mistake:
        click.echo(str(mistake))


def play_plainly(plain: Plain) -> None:
    """Reads lines from standard input until ``quit`` or its end."""
    try:
        plain.look()
        click.echo("Type help for what you can say, quit to leave.")
        while not plain.is_over:
            if sys.stdin is not None and sys.stdin.isatty():
                click.echo("> ", nl=False)
            line = plain.lines.next()
            if line is None:
                break
            obey(plain, line)
    except KeyboardInterrupt:
        click.echo()
    finally:
        plain.close()
