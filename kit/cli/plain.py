"""Runs a session line by line, reading lines and wake-ups from other threads: for screen readers, pipes and plain terminals."""

from __future__ import annotations

import math
import shlex
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import click

from kit.cli.input_lines import InputBuffer, InputLines
from kit.cli.maps import maps_table
from kit.controllers import ControllerFile, find_controller, kit_controllers, user_controllers
from kit.document.blocks import labelled_table
from kit.document.layout import lines_of
from kit.inspection.server import InspectionServer, open_inspection_server
from kit.interruption import uninterrupted
from kit.msg.geometry_msgs import Twist, Vector3
from kit.plain_text import format_clock
from kit.render.world_text import describe_scene, scene_rows
from kit.ros.log import LogRecord
from kit.run.episode import EndCondition, EndReason, run_until
from kit.run.lockstep import Observer
from kit.run.pacing import MAXIMUM, REAL_TIME, Schedule
from kit.run.recording import Recorder
from kit.run.recording_file import RecordingFile
from kit.run.scenario import Scenario, find_scenario
from kit.run.session import Session
from kit.run.view import ViewBuilder, format_log
from kit.world.catalogue import all_maps
from kit.world.problems import WorldError


class CommandError(Exception):
    """A line that cannot be executed; the message says why."""


MAX_RUN_S: Final = 3600.0
"""Seconds that one line may run."""

OUTPUT_INTERVAL: Final = 10
"""Ticks after which the controller's output is read."""

WIDTH, HEIGHT = 78, 20


class LineVerb(NamedTuple):
    usage: str
    summary: str
    execute: Callable[[PlainSession, Sequence[str]], None]


class PlainSession:
    """A session that lines of text control; time stands still between lines."""

    def __init__(
        self,
        scenario: Scenario,
        controller: ControllerFile,
        *,
        seed: int,
        folder: Path,
        root: Path | None = None,
        socket_dir: Path | None = None,
        record: RecordingFile | None = None,
        input_buffer: InputBuffer | None = None,
        prints_file: bool = True,
        observer: Observer | None = None,
        report: Callable[[], str] = lambda: "",
    ) -> None:
        """``root``: the folder that world files named later may read; by default each its own. ``socket_dir``: where other
        terminals find the world. ``record``: the file that the drive is saved in at the end. ``input_buffer``: that of a
        reader that read lines before and reads on afterwards. ``prints_file``: whether to print the name of ``record``.
        ``observer``: of the first world. ``report``: one more line of the state; empty for none."""
        self._seed = seed
        self._folder = folder
        self._root = root
        self._socket_dir = socket_dir
        self._inspection_server: InspectionServer | None = None
        self._record = record
        self._prints_file = prints_file
        self._controller = controller
        self.lines = InputLines(self.answer_clients, input_buffer)
        self._report = report
        self._session = self._open(scenario)
        if observer is not None:
            self._session.runner.observers.append(observer)
        self.is_over = False

    def answer_clients(self) -> None:
        """Answers other terminals while time stands still."""
        self._session.runner.exchange_until_idle()

    def run(self, seconds: float, factor: float = MAXIMUM) -> None:
        """Runs the world for ``seconds``, printing log lines and the final state. ``factor``: simulated seconds per second."""
        session = self._session
        if not 0 < seconds <= MAX_RUN_S:
            raise CommandError(f"give a number of seconds above 0 and at most {MAX_RUN_S:g}")
        if session.controller is not None and _modification_time(self._controller.file) not in (
            None,
            self._loaded_version,
        ):
            self._load_controller(session)
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
        self.print_state()

    def drive(self, forward: float, turn: float, seconds: float) -> None:
        """Drives the robot by hand for ``seconds``: ``forward`` [m/s], ``turn`` [rad/s]."""
        session = self._session
        topics = session.command_topics(session.scenario.robot or "")
        if not topics:
            raise CommandError("this world has nothing to drive")
        session.drive_with(None)
        command = Twist(linear=Vector3(x=forward), angular=Vector3(z=turn))
        for topic in topics:
            session.runner.accept(topic, command)
        try:
            self.run(seconds)
        finally:
            session.stop_robot()

    def print_state(self) -> None:
        """Prints the time, the scene in words, the distances around the robot and the metrics."""
        view = ViewBuilder(self._session).build()
        score = view.metrics
        click.echo(f"at {format_clock(view.time_s)}: {describe_scene(view.scene)}")
        for side, distance in view.nearest:
            click.echo(f"  {side}: {'nothing in range' if distance is None else f'{distance:.2f} m'}")
        done = "" if score.reached_s is None else f"; target reached after {score.reached_s:.1f} s"
        click.echo(f"  distance {score.distance_m:.1f} m, bumps {score.bumps}{done}")
        if report := self._report():
            click.echo(f"  {report}")

    def print_picture(self) -> None:
        """Prints the world in characters."""
        click.echo("\n".join(scene_rows(ViewBuilder(self._session).build().scene, WIDTH, HEIGHT)))

    def use(self, name: str) -> None:
        """Loads another controller by name or file."""
        self._controller = find_controller(name, self._folder)
        self._load_controller(self._session)

    def open(self, name: str, case: str | None) -> None:
        """Opens another map or world file in place of this one."""
        scenario = find_scenario(name, case, self._root)
        self._close_world()
        self._session = self._open(scenario)
        self.print_state()

    def reset(self) -> None:
        """Puts the world back to its start."""
        self._session.reset()
        _wait_until_driven(self._session)
        self.print_state()

    def print_controllers(self) -> None:
        """Prints the names and titles of all controllers."""
        for each in (*user_controllers(self._folder), *kit_controllers()):
            click.echo(f"{each.name}: {each.title}")

    def close(self) -> None:
        """Ends the session, and saves the drive if that was asked for. Raises OSError where it cannot be saved."""
        with uninterrupted():
            self.lines.close()
            self._close_world()
            if self._record is not None and self._recorder is not None:
                self._record.complete(self._recorder.recording())
                if self._prints_file:
                    click.echo(f"Drive saved to {self._record.file}. {self._record.remark}".rstrip())

    def _open(self, scenario: Scenario) -> Session:
        session = Session(scenario, seed=self._seed, always_scan=True, on_message=_print_log)
        if self._socket_dir is not None:
            self._inspection_server = open_inspection_server(
                session.graph, self._socket_dir, scenario.name, self.lines.wake
            )
            if self._inspection_server is not None:
                session.runner.participants.append(self._inspection_server)
        self._recorder: Recorder | None = None
        if self._record is not None:
            self._recorder = Recorder.for_scenario(scenario, session.runner.simulation, self._record)
            session.runner.observers.append(self._recorder)
        self._load_controller(session)
        return session

    def _close_world(self) -> None:
        if self._inspection_server is not None:
            self._inspection_server.close()
            self._inspection_server = None
        self._session.close()

    def _load_controller(self, session: Session) -> None:
        """Loads the controller as its file is now. If that fails, the one before goes on."""
        self._loaded_version = _modification_time(self._controller.file)
        session.drive_with(self._controller)
        _wait_until_driven(session)


def _wait_until_driven(session: Session) -> None:
    """Waits until the controller drives or has failed, and prints which."""
    session.wait_until_driven()
    if session.failure is not None:
        click.echo(f"the controller failed to start: {session.failure}")
    elif session.controller is not None:
        click.echo(f"{session.controller.name} drives in {session.scenario.title}")


def _modification_time(file: Path) -> int | None:
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return None


def _print_log(record: LogRecord) -> None:
    click.echo(format_log(record))


def _print_help(plain: PlainSession, words: Sequence[str]) -> None:
    rows = [(verb.usage, verb.summary) for verb in VERBS.values()]
    click.echo("\n".join(lines_of([labelled_table(rows)])))


def _print_maps(plain: PlainSession, words: Sequence[str]) -> None:
    click.echo("\n".join(lines_of([maps_table(all_maps())])))


def _quit(plain: PlainSession, words: Sequence[str]) -> None:
    plain.is_over = True


VERBS: Final = {
    "run": LineVerb(
        "run SECONDS", "run the world", lambda plain, words: plain.run(*_parse_numbers(words, 1))
    ),
    "live": LineVerb(
        "live SECONDS",
        "run it in real time, to inspect it with kit ros",
        lambda plain, words: plain.run(_parse_numbers(words, 1)[0], REAL_TIME),
    ),
    "drive": LineVerb(
        "drive SPEED TURN SECONDS",
        "drive by hand: m/s, rad/s to the left",
        lambda plain, words: plain.drive(*_parse_numbers(words, 3)),
    ),
    "look": LineVerb("look", "print where things are", lambda plain, words: plain.print_state()),
    "picture": LineVerb(
        "picture", "draw the world in characters", lambda plain, words: plain.print_picture()
    ),
    "controller": LineVerb(
        "controller NAME",
        "use another controller, by name or file",
        lambda plain, words: plain.use(_parse_name(words)),
    ),
    "controllers": LineVerb(
        "controllers", "list the controllers", lambda plain, words: plain.print_controllers()
    ),
    "map": LineVerb(
        "map NAME [CASE]",
        "open another map or world file",
        lambda plain, words: plain.open(_parse_name(words), words[1] if words[1:] else None),
    ),
    "maps": LineVerb("maps", "list the maps", _print_maps),
    "restart": LineVerb("restart", "start again from the beginning", lambda plain, words: plain.reset()),
    "help": LineVerb("help", "list these commands", _print_help),
    "quit": LineVerb("quit", "leave", _quit),
}


def _parse_name(words: Sequence[str]) -> str:
    if not words:
        raise CommandError("give a name")
    return words[0]


def _parse_numbers(words: Sequence[str], count: int) -> list[float]:
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = [math.nan]
    if not all(map(math.isfinite, numbers)):
        raise CommandError("give numbers, such as 0.5")
    if len(numbers) != count:
        wanted = "one number" if count == 1 else f"{count} numbers"
        raise CommandError(f"give {wanted}, not {len(numbers)}")
    return numbers


def execute_line(plain: PlainSession, line: str) -> None:
    """Executes one line. Errors are printed, and change nothing."""
    try:
        words = shlex.split(line, comments=True)
        if not words:
            return
        verb = VERBS.get(words[0].lower())
        if verb is None:
            raise CommandError(f"there is no command {words[0]!r}; type help for a list")
        verb.execute(plain, words[1:])
    except (CommandError, LookupError, WorldError, ValueError) as error:
        click.echo(str(error))


def run_plain_session(plain: PlainSession) -> None:
    """Reads lines from standard input until ``quit`` or its end."""
    try:
        plain.print_state()
        click.echo("Type help for a list of commands, quit to leave.")
        while not plain.is_over:
            if sys.stdin is not None and sys.stdin.isatty():
                click.echo("> ", nl=False)
            line = plain.lines.read_line()
            if line is None:
                break
            execute_line(plain, line)
    except KeyboardInterrupt:
        click.echo()
    finally:
        plain.close()
