"""What the drivers by whom the medals are set drive on every level, and what it earns.

    python -m tests.school.game.measured_drivers              # the table of what has been measured
    python -m tests.school.game.measured_drivers --measure    # drives what is missing in it, a line as soon as it is known

``keys`` presses the keys of a hand with ordinary skill, and the best of its five tries counts; ``laser`` is a tidy program
without a map, ``map`` one that follows points read off the map, ``agent`` is trained for the level by the kit's preset, and
``tape`` turns to the level's own heading and plays the commands of the reference drive back. The drives stand in
``lessons/measured_drivers.csv``, of which the ladders show all but the tape; the medals are not in it, but derived from the bars as they are now.
"""

from __future__ import annotations

import argparse
import csv
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Final

from kit.controllers import find_controller
from kit.run.recording import Recording
from kit.run.session import Session
from kit.school.game import ordinary_drives
from kit.school.game.drive_commands import DriveCommand
from kit.school.game.league import house
from kit.school.game.levels import TURN_RATE, GameLevel, all_levels
from kit.school.game.medal import Medal, medal_of
from kit.school.game.ordinary_drives import MEASURED_FILE
from kit.school.game.race import (
    DriverKind,
    RaceFinish,
    agent_controller,
    finish_order,
    middle_drive,
    race_controller,
    run_race,
)
from kit.school.game.references import CommandPlayer, find_drive, reference_seconds
from kit.school.game.starts import OWN_SEED, draw_seeds, scenario_from
from kit.school.lessons.reading import lessons_folder
from kit.sim.simulation import STEP_SIZE_S
from tests.school.game.level_agents import train_agent
from tests.school.game.map_plans import write_program
from tests.school.game.ordinary import REACTION_TICKS, KeyPresser

LASER_PROGRAM: Final = house.PROGRAM
MEASURED: Final = lessons_folder() / MEASURED_FILE
DRIVERS: Final = {**ordinary_drives.MEASURED, "tape": DriverKind.PROGRAM}
TRIES: Final = (16, 18, 20, 22, 24)
"""A hand drives so often, and is not equally quick each time: its delay, in ticks."""
LONGEST: Final = 3.0
"""So many times as long as the reference drive a measured drive may take: later, it has not arrived."""

APART: Final = "apart"
"""The remark on a pair that was not side by side for as long as the level asks."""

Install = Callable[[Session], None]
Drive = tuple[RaceFinish, Recording]


@dataclass(frozen=True, slots=True)
class MeasuredDrive:
    """The drive that counts of one driver on one level."""

    level: str
    driver: str
    reached: bool
    seconds: float
    collisions: int
    remark: str = ""
    """Why nothing was driven."""

    @property
    def finish(self) -> RaceFinish:
        return RaceFinish(self.reached, self.seconds, self.collisions, is_apart=self.remark == APART)

    def medal(self, level: GameLevel) -> Medal:
        """What it earns by the bars as they are."""
        return medal_of(self.finish, reference_seconds(level), DRIVERS[self.driver])


def drive(level: GameLevel, seed: int, install: Install) -> Drive:
    """One drive from one start."""
    return run_race(level, scenario_from(level, seed), install, seed=seed)


def keys_drive(level: GameLevel, reaction_ticks: int = REACTION_TICKS) -> Drive:
    """The ordinary hand's drive, through the kit's teleop."""
    return drive(
        level,
        OWN_SEED,
        lambda session: session.runner.participants.append(KeyPresser(session, level, reaction_ticks)),
    )


def best_keys_drive(level: GameLevel) -> Drive:
    """The best of the ordinary hand's tries, which is what counts for a hand."""
    return min((keys_drive(level, ticks) for ticks in TRIES), key=lambda tried: finish_order(tried[0]))


def tape_drive(level: GameLevel, seed: int) -> Drive:
    """The reference's commands from one start; a single robot turns to the level's own heading first, as a program can that
    is told where it stands."""
    reference = find_drive(level)
    assert reference is not None
    own, *others = level.find_scenario().starts
    excess = 0.0 if others else scenario_from(level, seed).starts[0].theta - own.theta
    ticks = math.ceil(abs(excess) / TURN_RATE / STEP_SIZE_S)
    if ticks:
        turn = DriveCommand(ticks, 0.0, -excess / (ticks * STEP_SIZE_S))
        reference = replace(reference, commands=(turn, *reference.commands))
    return drive(
        level, seed, lambda session: session.runner.participants.append(CommandPlayer(session, reference))
    )


def tape_drives(level: GameLevel) -> list[Drive]:
    """The tape's drives from all starts."""
    return [tape_drive(level, seed) for seed in draw_seeds(level, Random(level.id))]


def judged(level: GameLevel, driver: DriverKind, drives: Sequence[Drive]) -> tuple[RaceFinish, Medal]:
    """The drive that counts, and its medal."""
    finishes = [finish for finish, _ in drives]
    finish = finishes[middle_drive(finishes)]
    return finish, medal_of(finish, reference_seconds(level), driver)


def measure(level: GameLevel, driver: str) -> MeasuredDrive:
    """Drives a level as the driver does; an agent that earns nothing is trained once more, for longer."""
    drive = _measure(level, driver)
    is_worth_more = driver == "agent" and not drive.medal(level)
    return _measure(level, driver, is_second=True) if is_worth_more else drive


def _measure(level: GameLevel, driver: str, is_second: bool = False) -> MeasuredDrive:
    """Drives a level: a hand from the level's own start, the others from the starts, until it is known which drive is the middle one or that most do
    not arrive."""
    with TemporaryDirectory() as folder, _driver(level, driver, Path(folder), is_second) as drive_from:
        if isinstance(drive_from, str):
            return MeasuredDrive(level.id, driver, False, 0.0, 0, drive_from)
        seeds = draw_seeds(level, Random(level.id)) if driver != "keys" else (OWN_SEED,)
        shorter = replace(
            level, time_limit=min(level.time_limit, LONGEST * (reference_seconds(level) or 1e3))
        )
        finishes: list[RaceFinish] = []
        for seed in seeds:
            finishes.append(drive_from(shorter, seed)[0])
            if 2 * sum(not each.reached for each in finishes) > len(seeds):
                break
        middle = finishes[middle_drive(finishes)]
        remark = APART if middle.is_apart else ""
        return MeasuredDrive(
            level.id, driver, middle.reached, round(middle.seconds, 2), middle.collisions, remark
        )


@contextmanager
def _driver(
    level: GameLevel, name: str, folder: Path, is_second: bool
) -> Iterator[Callable[[GameLevel, int], Drive] | str]:
    """What drives a level from the start of a seed; or why nothing can."""
    if name == "keys":
        yield lambda each, seed: best_keys_drive(each)
    elif name == "tape":
        yield tape_drive
    elif name in ("laser", "map"):
        program = find_controller(str(LASER_PROGRAM if name == "laser" else write_program(level, folder)))
        yield lambda each, seed: race_controller(each, program, seed=seed)
    else:
        policy = train_agent(level, folder, is_second)
        if isinstance(policy, str):
            yield policy
        else:
            with agent_controller(policy) as node:
                yield lambda each, seed: race_controller(each, node, seed=seed)


def measured() -> dict[tuple[str, str], MeasuredDrive]:
    """What has been measured, by level and driver."""
    with MEASURED.open(newline="") as file:
        rows = [
            MeasuredDrive(
                row["level"],
                row["driver"],
                row["reached"] == "yes",
                float(row["seconds"]),
                int(row["collisions"]),
                row["remark"],
            )
            for row in csv.DictReader(file)
        ]
    return {(row.level, row.driver): row for row in rows}


def write_measured(drives: dict[tuple[str, str], MeasuredDrive]) -> None:
    """Writes the file anew, in the order of the levels and drivers; a kill leaves the old one."""
    draft = MEASURED.with_suffix(".draft")
    with draft.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(("level", "driver", "reached", "seconds", "collisions", "remark"))
        for level in all_levels():
            for driver in DRIVERS:
                row = drives.get((level.id, driver))
                if row is not None:
                    reached = "yes" if row.reached else "no"
                    table.writerow((row.level, row.driver, reached, row.seconds, row.collisions, row.remark))
    draft.replace(MEASURED)


def table_lines(drives: dict[tuple[str, str], MeasuredDrive]) -> Iterator[str]:
    """A line for each level: the reference's time, and for each driver its time as a multiple of that, and its medal."""
    yield f"{'level':<18} {'reference':>9}  " + "".join(f"{driver:<18}" for driver in DRIVERS)
    counts = {driver: dict.fromkeys(Medal, 0) for driver in DRIVERS}
    for level in all_levels():
        reference = reference_seconds(level)
        assert reference is not None
        cells = []
        for driver in DRIVERS:
            row = drives.get((level.id, driver))
            if row is None:
                cells.append("not measured")
                continue
            counts[driver][row.medal(level)] += 1
            touched = "*" if row.collisions else " "
            share = f"{row.seconds / reference:.2f}{touched}" if row.reached else " --  "
            cells.append(f"{share} {row.medal(level).title if row.medal(level) else ''}")
        yield f"{level.id:<18} {reference:7.2f} s  " + "".join(f"{cell:<18}" for cell in cells).rstrip()
    yield ""
    for driver, count in counts.items():
        told = ", ".join(f"{number} {medal.title}" for medal, number in reversed(count.items()) if number)
        yield f"{driver:<6} {told}"
    yield "Times are multiples of the reference's; * touched something; -- did not arrive."


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    levels = [level.id for level in all_levels()]
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("--again", action="store_true", help="also what has been measured")
    parser.add_argument("--level", nargs="*", default=levels, choices=levels, metavar="ID")
    parser.add_argument("--driver", nargs="*", default=list(DRIVERS), choices=DRIVERS)
    options = parser.parse_args()
    if options.measure:
        for driver in options.driver:
            for level in all_levels():
                drives = measured() if MEASURED.exists() else {}
                if level.id in options.level and (options.again or (level.id, driver) not in drives):
                    row = measure(level, driver)
                    print(f"{row} {row.medal(level).title}", flush=True)
                    write_measured((measured() if MEASURED.exists() else {}) | {(level.id, driver): row})
    print("\n".join(table_lines(measured())))


if __name__ == "__main__":
    main()
