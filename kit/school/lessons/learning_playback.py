"""Plays a lesson's learning scene: tables that learn while they are watched, slowly at first and then ever faster."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from kit.learning.grid.grid_learner import GridLearner
from kit.learning.grid.grid_world import CLIFF, MOVE_NAMES, GridCell
from kit.learning.grid.registry import make_grid_learner
from kit.plain_text import counted, wrap
from kit.render.curve import Axes, Curve, draw_curves
from kit.render.encode import AsciiEncoder, Encoder, Frame
from kit.render.frame_text import paste_frame, write_text
from kit.render.value_grid import ValueGrid, draw_value_grids, value_grids_height, value_grids_width
from kit.school.lessons.own_learners import make_own_learner
from kit.school.lessons.records import LearningScene

PACE_EXPONENT: Final = 3.0
"""Of n updates in T seconds, n (t / T)^3 are done after t: the first ones can be followed one by one."""
MIN_CURVE_COLUMNS: Final = 24
VALUE_COLUMNS: Final = 10
"""Of a curve's mark and its newest value, beside its name."""
MAX_CURVE_COLUMNS: Final = 92
MIN_CURVE_ROWS: Final = 7
MAX_CURVE_ROWS: Final = 20
UPDATE_ROWS: Final = 3
"""Rows for the last update in words, in a narrow and high picture."""
PLAIN_SHARES: Final = (0.15, 0.4, 1.0)
"""Shares of the episodes after which the plain form shows the tables."""
PLAIN_COLUMNS: Final = 76


class LearningPlayback:
    """Advances all learners of a scene. The same scene plays the same each time."""

    def __init__(self, scene: LearningScene) -> None:
        self.scene = scene
        self._learners = _new_learners(scene)
        self._totals = (
            [scene.updates] * len(scene.learners)
            if scene.updates
            else [_updates_of(learner, scene.episodes) for learner in _new_learners(scene)]
        )
        self.time_s = 0.0

    @property
    def learners(self) -> tuple[GridLearner, ...]:
        return self._learners

    @property
    def height(self) -> int:
        """Rows that it has a use for; 0: as many as there are."""
        return 0

    @property
    def is_over(self) -> bool:
        """Whether every learner has had all its episodes."""
        return all(
            learner.updates >= total for learner, total in zip(self._learners, self._totals, strict=True)
        )

    def advance_to(self, time_s: float) -> None:
        """Lets every learner learn as much as it has learned ``time_s`` seconds after the beginning."""
        self.time_s = min(max(time_s, self.time_s), self.scene.seconds)
        share = (self.time_s / self.scene.seconds) ** PACE_EXPONENT
        for learner, total in zip(self._learners, self._totals, strict=True):
            while learner.updates < round(total * share):
                learner.step()

    def step(self) -> None:
        """Lets every learner make one more update; the time goes along."""
        for learner, total in zip(self._learners, self._totals, strict=True):
            if learner.updates < total:
                learner.step()
        share = max(each.updates / total for each, total in zip(self._learners, self._totals, strict=True))
        self.time_s = max(self.time_s, self.scene.seconds * share ** (1 / PACE_EXPONENT))

    def finish(self) -> None:
        """Goes to the end."""
        self.advance_to(self.scene.seconds)

    def frame(self, columns: int, rows: int, encoder: Encoder) -> Frame:
        """The tables as they are now, the returns beside them where there is room, and the last update below."""
        grids, curves = [self._grid(number) for number in range(len(self._learners))], self._curves()
        names = sum(len(each.name) + VALUE_COLUMNS for each in curves)

        def sizes() -> tuple[int, int, bool, bool]:
            """Columns and rows of the tables, and whether there is room for curves beside and below them."""
            used, high = (
                measure(grids, columns, rows - 1) for measure in (value_grids_width, value_grids_height)
            )
            is_beside = columns - used > max(MIN_CURVE_COLUMNS, names) and rows > MIN_CURVE_ROWS
            return used, high, is_beside, rows - high > MIN_CURVE_ROWS + UPDATE_ROWS

        used, high, is_beside, is_below = sizes()
        if not is_beside and not is_below:  # the curves come before the values of all moves
            grids = [replace(grid, all_values=None) for grid in grids]
            used, high, is_beside, is_below = sizes()
        frame = Frame.empty(columns, rows)
        paste_frame(frame, draw_value_grids(grids, columns, rows - 1, encoder), 0, 0)
        if is_beside:
            self._add_curves(frame, (0, used + 2), (rows - 1, columns - used - 2), encoder)
            write_text(frame, rows - 1, 0, self.update_text(columns))
        elif is_below:
            # Always as many rows, so that nothing below them moves.
            lines = wrap(self.update_text(UPDATE_ROWS * columns), columns)[:UPDATE_ROWS]
            for number, line in enumerate(lines):
                write_text(frame, high + number, 0, line)
            self._add_curves(
                frame, (high + UPDATE_ROWS + 1, 0), (rows - high - UPDATE_ROWS - 1, columns), encoder
            )
        else:
            write_text(frame, rows - 1, 0, self.update_text(columns))
        return frame

    def _add_curves(
        self, frame: Frame, corner: tuple[int, int], size: tuple[int, int], encoder: Encoder
    ) -> None:
        """Draws the curves into a part of the frame: its top left corner, and its rows and columns."""
        (top, left), (rows, columns) = corner, size
        rows, columns = min(rows, MAX_CURVE_ROWS), min(columns, MAX_CURVE_COLUMNS)
        part = draw_curves(self._curves(), self._axes(), columns, rows, encoder)
        paste_frame(frame, part, top, left)

    def update_text(self, width: int = PLAIN_COLUMNS) -> str:
        """The first learner's last update in words."""
        learner = self._learners[0]
        update = learner.last_update
        if update is None:
            return "Nothing is learned yet."
        step = f"step {learner.episode_step}" if not update.ended else "the end"
        episode = learner.episodes + (0 if update.ended else 1)
        return f"Episode {episode}, {step}: {learner.describe_update()}"[:width]

    def describe(self) -> list[str]:
        """What each learner can do now, one line each."""
        return [
            _described(name, learner) for name, learner in zip(self.scene.titles, self._learners, strict=True)
        ]

    def _grid(self, number: int) -> ValueGrid:
        learner = self._learners[number]
        world = learner.world
        values, moves = np.full(world.shape, np.nan), np.full(world.shape, -1, dtype=np.int64)
        all_values = np.full((*world.shape, len(MOVE_NAMES)), np.nan)
        for cell in world.cells():
            if learner.values[cell].any():
                values[cell] = learner.values[cell].max()
                all_values[cell] = learner.values[cell]
            if (move := learner.greedy_move(cell)) is not None:
                moves[cell] = move
        update = learner.last_update
        count = f"{learner.episodes} of {counted(self.scene.episodes, 'episode')}"
        if self.scene.updates:
            count = counted(learner.episodes, "episode")
        elif any(CLIFF in row for row in world.rows):  # two titles fit beside each other
            count = f"{learner.episodes} of {self.scene.episodes}, {counted(learner.falls, 'fall')}"
        return ValueGrid(
            f"{self.scene.titles[number]}: {count}",
            world.rows,
            values,
            moves,
            robot=None if self.is_over else learner.cell,
            heading=0 if update is None else update.move,
            path=frozenset(learner.greedy_path()) if learner.is_solved else frozenset(),
            changed=None if update is None or self.is_over else update.cell,
            all_values=all_values,
        )

    def _curves(self) -> list[Curve]:
        of_steps = self.scene.curve == "steps"
        name = "steps of each episode" if of_steps else "return of each episode"
        return [
            Curve(
                name if len(self._learners) == 1 else title,
                np.arange(1, learner.episodes + 1, dtype=float),
                _smoothed(learner.lengths if of_steps else learner.returns, self.scene.curve_mean),
            )
            for title, learner in zip(self.scene.titles, self._learners, strict=True)
        ]

    def _axes(self) -> Axes:
        return Axes(
            unit="episodes",
            low=self.scene.curve_low,
            high=self.scene.curve_high,
            end=float(self.scene.episodes) or None,
        )


def plain_rows(scene: LearningScene) -> list[str]:
    """The scene as rows of ASCII: the tables at three times, with what they can do in words."""
    playback, encoder, rows = LearningPlayback(scene), AsciiEncoder(), []
    for share in PLAIN_SHARES:
        for learner in playback.learners:
            while (
                learner.updates < round(scene.updates * share)
                if scene.updates
                else learner.episodes < max(1, round(scene.episodes * share))
            ):
                learner.step()
        grids = [playback._grid(number) for number in range(len(scene.learners))]
        height = 3 + 2 * grids[0].shape[0]
        rows += draw_value_grids(grids, PLAIN_COLUMNS, height, encoder).rows()
        rows += [*playback.describe(), ""]
    return rows


def _described(name: str, learner: GridLearner) -> str:
    path, start = learner.greedy_path(), GridCell(*learner.world.start)
    best = float(learner.values[start].max())
    quantity = "chance" if learner.settings.algorithm == "ppo" else "value"
    leads = f"reach the target in {len(path) - 1} steps" if learner.is_solved else "do not reach the target"
    falls = f" and {counted(learner.falls, 'fall')}" if learner.falls else ""
    episodes = counted(learner.episodes, "episode")
    return f"{name}, after {episodes}{falls}: the best moves {leads}; {quantity} at S {best:.2f}."


def _new_learners(scene: LearningScene) -> tuple[GridLearner, ...]:
    if scene.lines is not None:
        return tuple(make_own_learner(scene.world, each, scene.lines.opened()) for each in scene.learners)
    return tuple(make_grid_learner(scene.world, settings) for settings in scene.learners)


def _updates_of(learner: GridLearner, episodes: int) -> int:
    """Updates until this many episodes have ended."""
    while learner.episodes < episodes:
        learner.step()
    return learner.updates


def _smoothed(values: Sequence[float], window: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """The mean of each value and the ones before it, ``window`` at most."""
    sums = np.concatenate(([0.0], np.cumsum(values)))
    ends = np.arange(1, len(sums))
    starts = np.maximum(0, ends - window)
    means: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = (sums[ends] - sums[starts]) / (ends - starts)
    return means
