"""The programs of the house: entrants that come with the kit, so that whoever enters first has somebody to meet.

They are one program at three speeds. Everybody meets them, and none of them wins a title. On the levels of a new league they have
met each other: what they drive and play there comes with the kit, so that ratings mean something from the start.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

from kit.controllers import ControllerFile

PROGRAM: Final = Path(__file__).with_name("house_program.py")
SPEEDS: Final = {"slow": 0.2, "steady": 0.35, "quick": 0.5}
"""The speed of each [m/s]."""
SPEED_LINE: Final = b"SPEED = 0.5\n"
"""Of the program, in whose place each has its own."""


def house_controllers(folder: Path) -> tuple[ControllerFile, ...]:
    """The programs as files in a folder, which are written there."""
    made = []
    for name, program in house_programs().items():
        file = folder / f"{name}.py"
        file.write_bytes(program)
        made.append(ControllerFile(f"{name} (house)", file, f"at {SPEEDS[name]:g} m/s"))
    return tuple(made)


@cache
def house_programs() -> dict[str, bytes]:
    """The programs by name.

    >>> [b"SPEED = 0.2" in program for program in house_programs().values()]
    [True, False, False]
    """
    program = PROGRAM.read_bytes()
    return {
        name: program.replace(SPEED_LINE, f"SPEED = {speed:g}\n".encode()) for name, speed in SPEEDS.items()
    }
