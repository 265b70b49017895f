"""Makes the recordings among the solutions: drives that somebody with a steady hand might have driven.

``python -m tests.solutions.drives`` writes them all again, when a map has changed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from kit.controllers import find_controller
from kit.run.scenario import Scenario, find_scenario
from kit.run.recording import Recorder, Recording, save_recording
from kit.run.session import Session

FOLDER: Final = Path(__file__).parent
LESSONS: Final = FOLDER.parents[1] / "lessons"

FORWARD: Final = 0.5
"""m/s: what teleop drives at."""
TURN: Final = 1.5
"""rad/s"""


class Leg(NamedTuple):
    """A key held for so long; or a reset before it."""

    key: str
    seconds: float


def ahead(metres: float) -> Leg:
    return Leg("up", metres / FORWARD)


def left(degrees: float) -> Leg:
    return Leg("left", math.radians(degrees) / TURN)


def right(degrees: float) -> Leg:
    return Leg("right", math.radians(degrees) / TURN)


STILL: Final = Leg("", 0.5)
AGAIN: Final = Leg("reset", 0.0)


def driven(place: Scenario, legs: Sequence[Leg], seed: int = 0) -> Recording:
    """What the screen would have kept: keys to teleop, teleop to the wheels."""
    with Session(place, seed=seed) as session:
        case = place.case.name if place.case else None
        recorder = Recorder(place.name, case, session.runner.simulation)
        session.runner.observers.append(recorder)
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        for leg in legs:
            if leg == AGAIN:
                session.reset()
                session.wait_until_driven()
                continue
            if leg.key:
                session.keys.publish([f"p_{leg.key}"])
            for _ in range(round(leg.seconds * 100)):
                session.runner.tick()
            if leg.key:
                session.keys.publish([f"r_{leg.key}"])
        session.runner.tick()
        return recorder.recording()


ROUND_THE_PILLAR: Final = (left(90), ahead(0.95), left(90), ahead(1.9), right(90), ahead(2.4), STILL)
FLAG: Final[Mapping[str, tuple[str, tuple[Leg, ...]]]] = {
    "lessons:starter": ("simple", (STILL,)),
    "solution": ("simple", (ahead(1.0), AGAIN, *ROUND_THE_PILLAR)),
    "wrong/bumps__straight_at_the_pillar": (
        "simple",
        (left(100), Leg("up", 4.0), STILL, *ROUND_THE_PILLAR),
    ),
    "wrong/reached__left_when_the_pillar_was_passed": ("simple", (*ROUND_THE_PILLAR[:5], ahead(0.6))),
    "wrong/in_time__looked_about_first": ("simple", (left(360), left(360), Leg("", 30.0), *ROUND_THE_PILLAR)),
}
"""By name: where, and which keys."""


def main() -> None:
    for name, (place, legs) in FLAG.items():
        where, _, stem = name.rpartition(":")
        folder = (LESSONS if where else FOLDER) / "01-drive" / "flag"
        file = folder / f"{stem}.npz"
        file.parent.mkdir(parents=True, exist_ok=True)
        save_recording(driven(find_scenario(place), legs), file)


if __name__ == "__main__":
    main()
