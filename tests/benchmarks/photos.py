"""Judges the reader of photographs: ``python tests/benchmarks/photos.py [FIRST COUNT]``.

Draws that many photographs (by default 200, from seed 4000, which were not looked at while the reader was built), reads
each, and prints how many give the true walls to 2 cm at 5 m, and what the reader says to the others.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.mapmaking.judging import judge  # after the path
from tests.mapmaking.photos import draw_photo

FIRST, COUNT = 4000, 200


def main() -> None:
    """Reads the arguments, judges, and prints."""
    first, count = (*map(int, sys.argv[1:]), *(FIRST, COUNT)[len(sys.argv) - 1 :])
    right = 0
    for seed in range(first, first + count):
        photo = draw_photo(seed)
        found = judge(photo)
        right += found.is_right
        if not found.is_right:
            settings = ", ".join(f"{name} {value:.2f}" for name, value in photo.settings.items())
            wrong = found.refusal or f"{found.missing} pixels of wall missing, {found.extra} too many"
            print(f"seed {seed}: {wrong}\n    {settings}", flush=True)
        if (seed - first) % 20 == 19:
            print(f"{right} of {seed - first + 1} right", flush=True)
    print(f"{right} of {count} give the true walls to 2 cm at 5 m (asked: 190 of 200)")


if __name__ == "__main__":
    main()
