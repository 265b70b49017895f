"""The drivers that the medals are measured by, each on every level, from all five starts: what they drive, and what it earns.

    python -m tests.school.game.measured_drivers [--level ID ...] [--driver tape keys laser] [--agent RUN_FOLDER]

``keys`` presses the keys of a hand with ordinary skill, ``laser`` is a tidy program, ``tape`` plays the commands of the
reference drive back, ``agent`` is what ``kit train`` makes with the preset's settings.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from kit.controllers import find_controller
from kit.run.recording import Recording
from kit.run.session import Session
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.medal import Medal, medal_of
from kit.school.game.race import (
    DriverKind,
    RaceFinish,
    agent_controller,
    middle_drive,
    race_from_all_starts,
    run_race,
)
from kit.school.game.references import CommandPlayer, find_drive, reference_seconds
from kit.school.game.starts import OWN_SEED, scenario_from, seeds_of
from tests.school.game.ordinary import OrdinaryDriver

LASER_PROGRAM: Final = Path(__file__).with_name("laser_program.py")

Install = Callable[[Session], None]


def drive(level: GameLevel, seed: int, install: Install) -> tuple[RaceFinish, Recording]:
    """One drive from one start."""
    return run_race(level, scenario_from(level, seed), install, seed=seed)


def keys_drive(level: GameLevel, seed: int = OWN_SEED) -> tuple[RaceFinish, Recording]:
    """The ordinary hand's drive."""
    return drive(
        level, seed, lambda session: session.runner.participants.append(OrdinaryDriver(session, level))
    )


def tape_drives(level: GameLevel) -> list[tuple[RaceFinish, Recording]]:
    """The reference's commands from all starts."""
    reference = find_drive(level)
    assert reference is not None
    return [
        drive(
            level, seed, lambda session: session.runner.participants.append(CommandPlayer(session, reference))
        )
        for seed in seeds_of(level)
    ]


def judged(
    level: GameLevel, driver: DriverKind, drives: Sequence[tuple[RaceFinish, Recording]]
) -> tuple[RaceFinish, Medal]:
    """The drive that counts, and its medal."""
    finishes = [finish for finish, _ in drives]
    finish = finishes[middle_drive(finishes)]
    return finish, medal_of(finish, reference_seconds(level), driver)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--level", nargs="*", default=[level.id for level in all_levels()])
    parser.add_argument("--driver", nargs="*", default=["keys", "laser", "tape"])
    parser.add_argument("--agent", type=Path, help="folder of a training run, or a policy file")
    options = parser.parse_args()
    for level in all_levels():
        if level.id not in options.level:
            continue
        reference = reference_seconds(level) or 0.0
        cells = []
        for name in (*options.driver, *(["agent"] if options.agent else [])):
            if name == "keys":
                finish, medal = judged(level, DriverKind.KEYS, [keys_drive(level)])
            elif name == "laser":
                program = find_controller(str(LASER_PROGRAM))
                finish, medal = judged(level, DriverKind.CONTROLLER, race_from_all_starts(level, program))
            elif name == "tape":
                finish, medal = judged(level, DriverKind.CONTROLLER, tape_drives(level))
            else:
                finish, medal = _agent(level, options.agent)
            time = (
                f"{finish.seconds / reference:5.2f} b{finish.collisions:<2}"
                if finish.reached
                else "  --     "
            )
            cells.append(f"{name} {time} {medal.title:<9}")
        print(f"{level.id:<18} {reference:6.2f} s  {'  '.join(cells)}", flush=True)


def _agent(level: GameLevel, place: Path) -> tuple[RaceFinish, Medal]:
    from kit.learning.policies.policy_file import load_policy
    from kit.learning.training.run_folders import find_run

    policy = load_policy(place) if place.is_file() else find_run(place.parent, place.name).policy()
    with agent_controller(policy) as program:
        return judged(level, DriverKind.AGENT, race_from_all_starts(level, program))


if __name__ == "__main__":
    main()
