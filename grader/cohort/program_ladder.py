"""A ladder of programs: all against all on the same levels, and how strong each is, with an interval.

Strengths are those of the model of Bradley and Terry (Biometrika 39, 1952): A beats B with probability a / (a + b). They are
found by the iteration of Hunter ("MM algorithms for generalized Bradley-Terry models", Annals of Statistics 32, 2004), and
printed as Elo points, 400 for ten times the strength. Half a win and half a loss against a program of average strength keep
them finite. Intervals are percentiles of a bootstrap over levels.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from grader.look_alikes import distinct_name
from grader.shown_names import readable_name
from grader.submission import submission_name
from grader.submitted_files import is_ignored_name
from kit.arrays import FloatArray
from kit.controllers import find_controller
from kit.host.private_folder import private_folder
from kit.plain_files import open_plain_file
from kit.plain_text import counted
from kit.school.game.levels import GameLevel
from kit.school.game.race import RaceFinish, race_controller

ITERATIONS: Final = 200
RESAMPLES: Final = 500
ELO_PER_DECADE: Final = 400.0


@dataclass(frozen=True, slots=True)
class LadderRace:
    """One program on one level."""

    program: str
    level: str
    reached: bool
    seconds: float
    collisions: int
    failure: str = ""
    """Why the program stopped; empty if it drove to the end."""

    @property
    def order(self) -> tuple[bool, bool, float]:
        """Smaller is better: at the goal, without a collision, soon."""
        return (
            not self.reached,
            self.reached and self.collisions > 0,
            self.seconds if self.reached else math.inf,
        )


@dataclass(frozen=True, slots=True)
class LadderRow:
    """One program's place."""

    program: str
    elo: float
    interval: tuple[float, float]
    """95 % of the bootstrap's values lie between these."""
    wins: float
    """Races won against others; half for each draw."""
    races: int
    """Comparisons with others."""


RACE_LIMIT_S: Final = 60.0
"""Wall clock of one race [s]: an honest one takes a second or two."""


def find_programs(folder: Path) -> tuple[dict[str, Path], list[str]]:
    """Returns the programs of a folder by name: each Python file, and of each folder in it the only one; and what is passed
    over, each with the reason. Links are no programs: what they lead to was not handed in."""
    programs: dict[str, Path] = {}
    passed_over: list[str] = []
    names: set[str] = set()
    for path in sorted(folder.iterdir(), key=lambda path: (path.is_dir(), path.name)):
        program, reason = _program_in(path)
        shown = readable_name(path.name)
        if program is None:
            passed_over.append(f"{shown} ({reason})")
        else:
            programs[distinct_name(names, submission_name(path), shown)] = program
    return programs, passed_over


def _program_in(path: Path) -> tuple[Path | None, str]:
    """Returns the program that a file or folder is, or None and why it is none."""
    if is_ignored_name(path.name):
        return None, "not a work, by its name"
    if path.is_symlink():
        return None, "a link"
    if not path.is_dir():
        is_program = path.is_file() and path.suffix == ".py"
        return (path, "") if is_program else (None, "no Python file")
    files = sorted(file for file in path.glob("*.py") if file.is_file() and not file.is_symlink())
    return (files[0], "") if len(files) == 1 else (None, f"{counted(len(files), 'Python file')} in it, not 1")


def race_all(
    programs: dict[str, Path],
    levels: Sequence[GameLevel],
    on_race: Callable[[LadderRace], object] = lambda race: None,
    *,
    wall_limit_s: float = RACE_LIMIT_S,
) -> list[LadderRace]:
    """Races every program on every level: the races of all pairs, since nobody is in another's way. Raises OSError if a program
    cannot be read."""
    races = []
    with private_folder() as folder:
        alone = {
            name: _alone(file.absolute(), programs.values(), folder / str(number))
            for number, (name, file) in enumerate(programs.items())
        }
        for level in levels:
            for name, file in alone.items():
                finish, _ = race_controller(level, find_controller(str(file)), wall_limit_s=wall_limit_s)
                races.append(_race_of(name, level, finish))
                on_race(races[-1])
    return races


def _alone(file: Path, programs: Iterable[Path], folder: Path) -> Path:
    """Copies a program that lies beside those of others into a folder of its own: it may read all of the folder it lies in."""
    if not any(
        other.absolute() != file and other.absolute().is_relative_to(file.parent) for other in programs
    ):
        return file
    folder.mkdir()
    copy = folder / file.name
    with open_plain_file(file, follows_links=False) as opened:
        copy.write_bytes(opened.read())
    return copy


def _race_of(name: str, level: GameLevel, finish: RaceFinish) -> LadderRace:
    failure = "" if finish.failure is None else str(finish.failure)
    return LadderRace(name, level.id, finish.reached, finish.seconds, finish.collisions, failure)


def rank(races: Sequence[LadderRace]) -> list[LadderRow]:
    """The ladder, the strongest first."""
    names = sorted({race.program for race in races})
    levels = sorted({race.level for race in races})
    wins = np.zeros((len(levels), len(names), len(names)))
    by_place = {(race.level, race.program): race.order for race in races}
    for number, level in enumerate(levels):
        for a, first in enumerate(names):
            for b, second in enumerate(names):
                mine, theirs = by_place[level, first], by_place[level, second]
                if a != b:
                    wins[number, a, b] = 0.5 if mine == theirs else float(mine < theirs)
    elo = fit_elo(wins.sum(axis=0))
    random = np.random.default_rng(0)
    chosen = random.integers(len(levels), size=(RESAMPLES, len(levels)))
    samples = fit_elo(wins[chosen].sum(axis=1))
    low, high = np.percentile(samples, [2.5, 97.5], axis=0)
    rows = [
        LadderRow(
            name,
            float(elo[at]),
            (float(low[at]), float(high[at])),
            float(wins[:, at].sum()),
            len(levels) * (len(names) - 1),
        )
        for at, name in enumerate(names)
    ]
    return sorted(rows, key=lambda each: (-each.elo, each.program))


def fit_elo(wins: FloatArray) -> FloatArray:
    """(..., n) Elo points, 0 on average, of wins (..., n, n): how often the row's program beat the column's."""
    games = wins + np.swapaxes(wins, -1, -2)
    won = wins.sum(axis=-1) + 0.5
    strength = np.ones_like(won)
    for _ in range(ITERATIONS):
        pair_sums = strength[..., :, None] + strength[..., None, :]
        expected = (games / pair_sums).sum(axis=-1) + 1.0 / (strength + 1.0)  # one game against strength 1
        strength = won / expected
        strength /= np.exp(np.log(strength).mean(axis=-1, keepdims=True))
    points: FloatArray = ELO_PER_DECADE * np.log10(strength)
    return points
