"""Medals and stars of a drive: time against the level's reference drive, and the extra rules that it kept.

The shares were set after ``tests/school/game/tidy.py`` was fixed: gold is near the reference drive, which a search over the
exact simulation has found.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Final

from kit.controllers import kit_controllers

if TYPE_CHECKING:
    from kit.school.game.levels import GameLevel
    from kit.school.game.race import RaceFinish

GOLD_SHARE: Final = 1.02
"""Gold: at most this many times the reference drive's time, and nothing touched."""
SILVER_SHARE: Final = 1.05
"""Silver, likewise."""


class Medal(IntEnum):
    """The medal of a drive; a greater one is better."""

    NONE = 0
    BRONZE = 1
    """The goal was reached."""
    SILVER = 2
    GOLD = 3

    @property
    def title(self) -> str:
        return "no medal" if self is Medal.NONE else self.name.lower()


class ExtraRule(StrEnum):
    """A rule that nobody has to keep; each earns one star on each level."""

    CLEAN = "clean"
    NO_STOP = "no stop"
    ONE_SENSOR = "one sensor"
    FEW_LINES = "few lines"
    FEW_STEPS = "few steps"

    def description(self, level: GameLevel) -> str:
        """The rule in words, with the level's limits."""
        return {
            ExtraRule.CLEAN: "touched nothing",
            ExtraRule.NO_STOP: "never stood still on the way",
            ExtraRule.ONE_SENSOR: "a program or agent that listens to one sensor",
            ExtraRule.FEW_LINES: f"a program of at most {level.rules.max_lines} lines of code",
            ExtraRule.FEW_STEPS: f"an agent of at most {level.rules.max_training_steps:,} training steps",
        }[self]


@dataclass(frozen=True, slots=True)
class DriverFacts:
    """What counts about who drove, beside the drive."""

    is_shipped: bool = False
    """Whether it is one of the kit's own controllers, or a copy of one: its drives earn nothing."""
    code_lines: int | None = None
    """Lines of code of the program; None for any other driver."""
    training_steps: int | None = None
    """Of the agent; None for any other driver."""


BY_HAND: Final = DriverFacts()


def medal_of(finish: RaceFinish, reference_s: float | None) -> Medal:
    """The medal of a finish. ``reference_s``: the reference drive's time [s]; None: there is only bronze."""
    if not finish.reached:
        return Medal.NONE
    if finish.collisions or reference_s is None:
        return Medal.BRONZE
    if finish.seconds <= GOLD_SHARE * reference_s:
        return Medal.GOLD
    return Medal.SILVER if finish.seconds <= SILVER_SHARE * reference_s else Medal.BRONZE


def kept_rules(level: GameLevel, finish: RaceFinish, facts: DriverFacts) -> tuple[ExtraRule, ...]:
    """The extra rules that a drive kept; none where it did not reach the goal."""
    if not finish.reached or facts.is_shipped:
        return ()
    kept = {
        ExtraRule.CLEAN: finish.collisions == 0,
        ExtraRule.NO_STOP: not finish.has_stopped,
        ExtraRule.ONE_SENSOR: finish.sensors is not None and finish.sensors <= 1,
        ExtraRule.FEW_LINES: facts.code_lines is not None and facts.code_lines <= level.rules.max_lines,
        ExtraRule.FEW_STEPS: facts.training_steps is not None
        and facts.training_steps <= level.rules.max_training_steps,
    }
    return tuple(rule for rule in ExtraRule if kept[rule])


def facts_of_program(file: Path) -> DriverFacts:
    """The facts that a program's file shows."""
    try:
        tree = _without_docstrings(file.read_bytes())
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return DriverFacts()  # it cannot drive either, and says so itself
    text = ast.unparse(tree)
    shipped = {ast.unparse(_without_docstrings(each.file.read_bytes())) for each in kit_controllers()}
    return DriverFacts(is_shipped=text in shipped, code_lines=len(text.splitlines()) - text.count("\n\n"))


def _without_docstrings(source: bytes) -> ast.Module:
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and (
            ast.get_docstring(node, clean=False) is not None
        ):
            node.body = node.body[1:] or [ast.Pass()]
    return tree
