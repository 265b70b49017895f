"""The trainings of a check as curves that grow: read from the lines in which the grader says what it is doing."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from kit.render.encode import Encoder

CURVE_ROWS: Final = 9
"""Of the picture, so that a lesson's words and its verdict keep their room on 24 rows."""
_TEST: Final = re.compile(
    r"^training (\d{1,3}) of (\d{1,3}), test: (\d{1,3}) % after ([\d,]{1,15}) of ([\d,]{1,15}) steps$",
    re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class TrainingCurves:
    """The tests of the trainings of one check, so far."""

    count: int
    """Of trainings, those that have not begun too."""
    steps: int
    """The most steps of each."""
    tests: tuple[tuple[tuple[int, int], ...], ...]
    """Of each training that was tested, in order: after how many steps, and the share that arrived [%]."""

    def describe(self) -> list[str]:
        """One line for each training: the success in its tests, from first to last."""
        return [
            f"training {number} of {self.count}: tests {' '.join(str(share) for _, share in tests)} %"
            for number, tests in enumerate(self.tests, 1)
        ]

    def picture(self, columns: int, encoder: Encoder) -> list[str]:
        """The curves over the steps, one for each training, in rows of ``columns`` characters."""
        import numpy as np

        from kit.render.curve import Axes, Curve, draw_curves

        curves = [
            Curve(
                f"training {number}",
                np.array([step for step, _ in tests], dtype=float),
                np.array([share / 100 for _, share in tests]),
            )
            for number, tests in enumerate(self.tests, 1)
        ]
        axes = Axes(unit="steps", low=0.0, high=1.0, end=float(self.steps))
        return draw_curves(curves, axes, columns, CURVE_ROWS, encoder).rows()


def read_training_curves(progress: str) -> TrainingCurves | None:
    """Reads the lines of a check's progress; None where no training was tested.

    >>> read_training_curves("training 1 of 3, test: 40 % after 5,000 of 20,000 steps").tests
    (((5000, 40),),)
    """
    tests: dict[int, list[tuple[int, int]]] = {}
    count = steps = 0
    for found in _TEST.finditer(progress):
        number, count, share, after, steps = (int(each.replace(",", "")) for each in found.groups())
        tests.setdefault(number, []).append((after, share))
    if not tests:
        return None
    return TrainingCurves(count, steps, tuple(tuple(tests[number]) for number in sorted(tests)))
