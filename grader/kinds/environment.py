"""A Gymnasium environment that wraps a robot in a world: lived with for some episodes, and checked against that world.

The sheet says where it lives and what its actions do::

    environment:
      class: HallwayEnv
      place: turn
      case: turn_a_to_b
      moves: [[0.5, 0], [0, 1.57], [0, -1.57]]    # m/s, rad/s of each action
      step_time: 0.1
      max_steps: 200
      way: [[0, 1.6], [1.6, 1.6]]                 # points by which the target is reached
      scan: /static_laser
      clip: 2.0
    seed: 1
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from grader.assignment import Assignment
from grader.checks.environments import CHECKS, complaint
from grader.evidence.environment import Visit, Wish, visit
from grader.kinds.contract import Conditions, Look, Looks, Sheet, Sort, Task
from grader.kinds.controller import place_of
from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.sandbox.confinement import Level
from kit.host.wire import printable
from kit.world.problems import quoted

if TYPE_CHECKING:
    from grader.grading import Gatherer

MOST_STEPS: Final = 400
"""Of an episode: one is driven to its very end."""


def read(sheet: Sheet) -> Task:
    """Where the environment lives, and what its actions do."""
    section = sheet.public.section("environment")
    place = place_of(section, sheet.folder)
    moves = section.points("moves", at_least=2, at_most=20)
    seed = sheet.public.integer("seed", 1, minimum=0, maximum=10**6)
    secret = None if sheet.secret is None else sheet.secret.integer("seed", minimum=0, maximum=10**6)
    cls = section.name("class")
    step_s = section.number("step_time", 0.1, above=0, maximum=2)
    max_steps = section.integer("max_steps", 200, minimum=10, maximum=MOST_STEPS)
    way = section.points("way", at_least=1, at_most=50)
    scan, clip = section.name("scan", "/static_laser"), section.number("clip", 2.0, above=0)
    section.finish()
    if place is None:
        return Task()
    if place.case is None or place.robot is None:
        section.error("the place must have a robot and a target: give a case of a map of the kit", "place")
        return Task()
    return Task(content=Wish(cls, place, moves, step_s, max_steps, way, scan, clip, seed, secret))


def gather(assignment: Assignment, file: Path, conditions: Conditions) -> AbstractContextManager[Gatherer]:
    """Lives with it once; with the secret seed where secrets are used."""
    level = conditions.level
    while True:
        look = _look(assignment, file, level, conditions)
        failure = look.failure
        if (
            failure is None
            or failure.kind is not FailureKind.CONFINEMENT
            or not conditions.may_fall
            or level == Level.LIMITED
        ):
            return nullcontext(Looks([look], level))
        level = Level(level - 1)


def _look(assignment: Assignment, file: Path, level: Level, conditions: Conditions) -> Look:
    wish: Wish = assignment.task
    seed = wish.secret_seed if conditions.secret and wish.secret_seed is not None else wish.seed
    try:
        seen = visit(wish, assignment, file, level, seed)
    except GuestError as error:
        failure = error.failure
        if failure.file == "examiner.py":  # where it was asked from is nothing to tell
            failure = replace(failure, file=file.name, line=None)
        return Look(failure=failure, label="the environment", outcome=f"stopped ({failure.kind.value})")
    wrong = _no_environment(seen, wish, file.name)
    if wrong:
        failure = Failure(FailureKind.IMPORT, printable(wrong), file.name)
        return Look(failure=failure, label="the environment", printed=seen.printed)
    return Look(
        seen,
        label="the environment",
        steps=seen.steps,
        printed=seen.printed,
        remarks=lambda check, params: complaint(seen, check),
    )


def _no_environment(seen: Visit, wish: Wish, file: str) -> str:
    """Why there is nothing to live with."""
    if "missing" in seen.about:
        missing = seen.about["missing"]
        names: Sequence[str] = [str(each) for each in missing] if isinstance(missing, list) else []
        return f"there is no class {quoted(wish.cls)} in it. Its classes: {', '.join(names) or 'none'}."
    if not seen.about.get("is_env"):
        return f"{wish.cls} is no gymnasium.Env yet: write `class {wish.cls}(gymnasium.Env):`."
    return ""


SORT: Final = Sort((".py",), CHECKS, read, gather)
