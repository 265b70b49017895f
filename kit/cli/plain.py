"""The kit line by line: for screen readers, pipes, and terminals without a full screen."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import click

from kit.cli import options
from kit.controllers import find, in_folder, shipped
from kit.msg.geometry_msgs import Twist, Vector3
from kit.picture.text import plain_rows, report
from kit.places import find_place
from kit.session import Session
from kit.showing import Showing, clock
from kit.world.catalogue import all_maps
from kit.world.problems import WorldError

LONGEST: Final = 3600.0
"""Seconds that one line may run."""

WIDTH, HEIGHT = 78, 20


class Mistake(Exception):
    """A line that cannot be done; the message says why."""


class Verb(NamedTuple):
    words: str
    text: str
    do: Callable[[Plain, Sequence[str]], None]


class Plain:
    """One session driven by lines of text. Time stands still between lines."""

    def __init__(self, place: str, case: str | None, controller: str, seed: int, folder: Path) -> None:
        self._seed = seed
        self._folder = folder
        self._controller = find(controller, folder)
        self._session = self._open(place, case)
        self.is_over = False

    def run(self, seconds: float) -> None:
        """Lets the world run, and says what was said and where that led."""
        session = self._session
        if not 0 < seconds <= LONGEST:
            raise Mistake(f"say how many seconds, above 0 and at most {LONGEST:g}")
        heard = len(session.messages)
        for _ in range(round(seconds / session.runner.simulation.step_size)):
            session.runner.tick()
            if session.failure is not None:
                break
        for record in list(session.messages)[heard:]:
            click.echo(f"{clock(record.time_ns / 1e9)} {record.name}: {record.text}")
        if session.failure is not None:
            click.echo(f"the controller stopped: {session.failure}")
        self.look()

    def drive(self, forward: float, turn: float, seconds: float) -> None:
        self._session.drive_with(None)
        node = self._session.graph.create_node("plain_driver")
        publisher = node.create_publisher(Twist, "/cmd_vel", 10)
        publisher.publish(Twist(linear=Vector3(x=forward), angular=Vector3(z=turn)))
        self.run(seconds)
        publisher.publish(Twist())
        node.destroy_node()

    def look(self) -> None:
        view = Showing(self._session).view()
        score = view.score
        click.echo(f"at {clock(view.time_s)}: {report(view.scene)}")
        for side, distance in view.nearest:
            click.echo(f"  {side}: {'nothing in range' if distance is None else f'{distance:.2f} m'}")
        done = "" if score.reached_s is None else f"; target reached after {score.reached_s:.1f} s"
        click.echo(f"  way {score.distance_m:.1f} m, bumps {score.bumps}{done}")

    def picture(self) -> None:
        click.echo("\n".join(plain_rows(Showing(self._session).view().scene, WIDTH, HEIGHT)))

    def use(self, name: str) -> None:
        self._controller = find(name, self._folder)
        self._seat()

    def open(self, place: str, case: str | None) -> None:
        session = self._open(place, case)
        self._session.close()
        self._session = session
        self.look()

    def reset(self) -> None:
        self._session.reset()
        self._session.wait_until_driven()
        self.look()

    def controllers(self) -> None:
        for each in (*in_folder(self._folder), *shipped()):
            click.echo(f"{each.name}: {each.title}")

    def close(self) -> None:
        self._session.close()

    def _open(self, place: str, case: str | None) -> Session:
        session = Session(find_place(place, case), seed=self._seed, watched=True)
        self._session = session
        self._seat()
        return session

    def _seat(self) -> None:
        self._session.drive_with(self._controller)
        self._session.wait_until_driven()
        if self._session.failure is not None:
            click.echo(f"the controller stopped: {self._session.failure}")
        else:
            click.echo(f"{self._controller.name} drives in {self._session.place.title}")


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
        raise Mistake("numbers are wanted there, such as 0.5") from None
    if len(numbers) != count:
        raise Mistake(f"{count} numbers are wanted, not {len(numbers)}")
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


def play_plainly(place: str, case: str | None, controller: str, seed: int, folder: Path, reason: str) -> None:
    """Reads lines from standard input until ``quit`` or its end."""
    click.echo(f"The kit, line by line. {reason}")
    try:
        plain = Plain(place, case, controller, seed, folder)
    except (LookupError, WorldError) as error:
        options.fail(str(error))
    try:
        plain.look()
        click.echo("Type help for what you can say, quit to leave.")
        while not plain.is_over:
            if sys.stdin.isatty():
                click.echo("> ", nl=False)
            line = sys.stdin.readline()
            if not line:
                break
            obey(plain, line)
    except KeyboardInterrupt:
        click.echo()
    finally:
        plain.close()
