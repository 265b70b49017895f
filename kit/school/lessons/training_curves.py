"""The trainings of a check as they go on, read from what the grader says it is doing: curves that grow, and the robot with its
newest policy."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from kit.render.drive_playback import DrivePlayback
    from kit.render.encode import Encoder, Frame


CURVE_ROWS: Final = 9
"""Rows of the picture; a lesson's text and result fit beside it on 24 rows."""
ROOMY_CURVE_ROWS: Final = 14
"""The same where there is room for more."""
DRIVE_COLUMNS: Final = 32
"""Columns of the robot's picture beside the curves."""
LEAST_CURVE_COLUMNS: Final = 40
"""The robot is left out where the curves would have fewer."""
LONGEST_SHOWN_S: Final = 3.0
"""Longest replay of a drive [s]."""
HOLD_S: Final = 0.8
"""How long its end stands still, to be read [s]."""
_TEST: Final = re.compile(
    r"^training (\d{1,3}) of (\d{1,3}), test: (\d{1,3}) % after ([\d,]{1,15}) of ([\d,]{1,15}) steps$",
    re.MULTILINE,
)
_EXAM: Final = re.compile(r"^training (\d{1,3}) of \d{1,3}, exam: (\d{1,3}) %$", re.MULTILINE)
_DRIVE: Final = re.compile(r"^training (\d{1,3}) of \d{1,3}, drive: (\{.*\})$", re.MULTILINE)


@dataclass(frozen=True, slots=True, eq=False)
class TestDrive:
    """One episode of the newest test of a training."""

    __test__ = False  # no test class for pytest

    training: int
    """From 1."""
    steps: int
    """After how many the policy was tested."""
    episode: DrivePlayback

    def describe(self) -> str:
        """What the robot did: ``training 1, test at 20,000 steps: turn_a_to_b, reached the target in 6.1 s``."""
        return f"training {self.training}, test at {self.steps:,} steps: {self.episode.case}, {self.episode.result}"

    def draw(self, columns: int, rows: int, encoder: Encoder, time_s: float | None) -> Frame:
        """The robot on its map ``time_s`` after the start, by default at the end. Below: which drive it is, and how long it
        has driven; at the end, how it ended."""
        from kit.render.camera import Camera
        from kit.render.encode import Frame
        from kit.render.frame_text import paste_frame, write_text
        from kit.render.painter import Painter

        episode, frame = self.episode, Frame.empty(columns, rows)
        time_s = episode.duration_s if time_s is None else min(time_s, episode.duration_s)
        scene, is_over = episode.scene_at(time_s), time_s >= episode.duration_s
        map_rows = rows - 2
        camera = Camera.fit(scene.bounds, columns, map_rows)
        paste_frame(frame, Painter(encoder).paint(scene, camera), 0, 0)
        write_text(frame, map_rows, 0, f"{self.steps:,} steps, {episode.case}"[:columns])
        ended = episode.result if len(episode.result) <= columns else episode.result.partition(" at (")[0]
        write_text(frame, map_rows + 1, 0, ended[:columns] if is_over else f"{time_s:.1f} s")
        return frame


@dataclass(frozen=True, slots=True)
class TrainingCurves:
    """The tests of the trainings of one check, so far."""

    count: int
    """Number of trainings, including those that have not started."""
    steps: int
    """The most steps of each."""
    tests: tuple[tuple[tuple[int, int], ...], ...]
    """Steps and success [%] of each test of each training."""
    drive: TestDrive | None = None
    """A drive with the newest policy; None if there is none."""
    exams: Mapping[int, int] = field(default_factory=dict)
    """By the number of the training: the success [%] in its exam, which is what the check judges. Of those that are over."""

    def describe(self) -> list[str]:
        """One line for each training: the success in its tests, from first to last; then the newest drive."""
        lines = [
            f"training {number} of {self.count}: tests {' '.join(str(share) for _, share in tests)} %"
            + (f", exam {self.exams[number]} %" if number in self.exams else "")
            for number, tests in enumerate(self.tests, 1)
        ]
        return lines if self.drive is None else [*lines, self.drive.describe()]

    def picture(
        self,
        columns: int,
        encoder: Encoder,
        drive: TestDrive | None = None,
        time_s: float | None = None,
        rows: int = CURVE_ROWS,
    ) -> list[str]:
        """The curves over the steps, one for each training, in ``rows`` rows of ``columns`` characters.

        ``drive``: is drawn beside them, ``time_s`` after its start, by default at its end.
        """
        import numpy as np

        from kit.render.curve import Axes, Curve, draw_curves
        from kit.render.encode import Frame
        from kit.render.frame_text import paste_frame

        curves = [
            Curve(
                # Short, so that the value of three curves beside each other is never cut.
                f"exam {self.exams[number] / 100:.2f}; last"
                if number in self.exams
                else f"training {number}",
                np.array([step for step, _ in tests], dtype=float),
                np.array([share / 100 for _, share in tests]),
            )
            for number, tests in enumerate(self.tests, 1)
        ]
        axes = Axes(unit="steps", low=0.0, high=1.0, end=float(self.steps))
        left = columns - DRIVE_COLUMNS - 2
        whole = draw_curves(curves, axes, columns, rows, encoder)
        if drive is None or left < LEAST_CURVE_COLUMNS:
            return whole.rows()
        # The names of the curves stand above both.
        names = Frame(whole.glyphs[:1], whole.fg[:1], whole.bg[:1])
        frame = Frame.empty(columns, rows)
        paste_frame(frame, draw_curves(curves, axes, left, rows, encoder), 0, 0)
        paste_frame(frame, names, 0, 0)
        paste_frame(frame, drive.draw(DRIVE_COLUMNS, rows - 1, encoder, time_s), 1, left + 2)
        return frame.rows()


class DriveLoop:
    """Plays the newest drive again and again. One that is newer waits until the one before has come to its end."""

    def __init__(self) -> None:
        self._playing: TestDrive | None = None
        self._began_s = 0.0

    def advance(self, newest: TestDrive | None, now_s: float) -> tuple[TestDrive | None, float]:
        """Returns the drive to show ``now_s``, on any clock, and the time after its start. Long ones run faster than real
        time, so that all are over within ``LONGEST_SHOWN_S``."""
        if (
            self._playing is None
            or newest is None
            or now_s - self._began_s >= _shown_s(self._playing) + HOLD_S
        ):
            self._playing, self._began_s = newest, now_s
        if self._playing is None:
            return None, 0.0
        factor = self._playing.episode.duration_s / max(1e-9, _shown_s(self._playing))
        return self._playing, (now_s - self._began_s) * factor


def _shown_s(drive: TestDrive) -> float:
    return min(drive.episode.duration_s, LONGEST_SHOWN_S)


def is_drive_line(line: str) -> bool:
    """Whether a line of a check's progress is data for the picture, not text."""
    return _DRIVE.match(line) is not None


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
    shown = tuple(tuple(tests[number]) for number in sorted(tests))
    exams = {int(number): int(share) for number, share in _EXAM.findall(progress)}
    return TrainingCurves(count, steps, shown, _newest_drive(progress, tests), exams)


def _newest_drive(progress: str, tests: dict[int, list[tuple[int, int]]]) -> TestDrive | None:
    """The newest drive; its place may have been told with an earlier one of the same case and training."""
    drives = list(_DRIVE.finditer(progress))
    if not drives:
        return None
    from kit.render.drive_playback import DrivePlayback

    number = int(drives[-1][1])
    mine = [each[2] for each in drives if int(each[1]) == number]
    try:
        last = DrivePlayback.from_text(mine[-1], mine)
    except ValueError:
        return None
    return TestDrive(number, tests[number][-1][0], last) if number in tests else None
