"""Judges the reader of photographs: ``python tests/benchmarks/photos.py [FIRST COUNT] [--nuisances]``.

Draws that many photographs (by default 200, from seed 4000, which were not looked at while the reader was built), reads
each, and prints how many give the true walls to 2 cm at 5 m, and what the reader says to the others. With ``--nuisances`` each
has rules, folds, writing or another nuisance of ``tests/mapmaking/nuisances.py`` on its paper in turn; a row for each kind:
how many are right, how many are wrong without a warning, and how many are warned of.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.mapmaking.judging import judge  # after the path
from tests.mapmaking.nuisances import KINDS
from tests.mapmaking.photos import draw_photo

FIRST, COUNT = 4000, 200


@dataclass
class Tally:
    """Photographs of one kind."""

    count: int = 0
    right: int = 0
    unwarned: int = 0
    """Wrong, and nothing was doubted."""
    warned: int = 0


def main() -> None:
    """Reads the arguments, judges, and prints."""
    has_nuisances = "--nuisances" in sys.argv
    numbers = [int(each) for each in sys.argv[1:] if each != "--nuisances"]
    first, count = (*numbers, *(FIRST, COUNT)[len(numbers) :])
    tallies: dict[str, Tally] = defaultdict(Tally)
    for number in range(count):
        kind = KINDS[number % len(KINDS)] if has_nuisances else ""
        photo = draw_photo(first + number, kind)
        found, tally = judge(photo), tallies[kind]
        is_warned = bool(found.refusal or found.remarks)
        tally.count += 1
        tally.right += found.is_right
        tally.warned += is_warned
        tally.unwarned += not found.is_right and not is_warned
        if not found.is_right:
            settings = ", ".join(f"{name} {value:.2f}" for name, value in photo.settings.items())
            wrong = found.refusal or f"{found.missing} pixels of wall missing, {found.extra} too many"
            print(
                f"seed {photo.seed} {kind}: {wrong}; {'; '.join(found.remarks)}\n    {settings}", flush=True
            )
    for kind, each in tallies.items():
        print(
            f"{kind or 'plain'}: {each.right} of {each.count} right, {each.unwarned} wrong without a warning, "
            f"{each.warned} warned of"
        )
    right, unwarned = (
        sum(getattr(each, name) for each in tallies.values()) for name in ("right", "unwarned")
    )
    asked = "130 of 200, none wrong without a warning" if has_nuisances else "98 of 100"
    print(f"{right} of {count} right to 2 cm at 5 m, {unwarned} wrong without a warning (asked: {asked})")


if __name__ == "__main__":
    main()
