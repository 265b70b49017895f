"""The end of a level's drive: what it earned, beside its map, in place of the whole screen."""

from __future__ import annotations

import math
import os
from asyncio import to_thread
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Final, Literal, TypeAlias

import numpy as np
from textual import events, work
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.screen import ModalScreen

from kit.arrays import FloatArray
from kit.dialogue.actions import ScreenActions
from kit.document.rows import MARGIN, Row, broken, row, row_text, row_width, side_by_side
from kit.render.role_looks import PEN_ROLES
from kit.render.roles import Role
from kit.render.scene import PenStroke, Scene, ScenePath
from kit.run.animation import ExportError
from kit.run.recording import Recording
from kit.school.game.drive_records import DriveRecord, card_rows, save_card, save_film
from kit.school.game.ghosts import Ghost, Split, gains_along
from kit.school.game.levels import GameLevel
from kit.school.game.players_histogram import histogram, seconds_needed
from kit.school.game.race import (
    DriverKind,
    RaceFinish,
)
from kit.school.game.starts import film_scenario
from kit.school.lessons.shell_lines import shell_path
from kit.tui.flourish import Flourish
from kit.tui.input.drive_keys import drive_key
from kit.tui.rows import drive_end_rows, level_rows
from kit.tui.rows.chart_rows import CHART_ROWS
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.ladder_rows import ladder_of_drive
from kit.tui.rows.medal_rows import SMALL, drawn_columns, medal_drawing, medal_size
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.lesson_drive import RecordingScreen
from kit.tui.screens.level_pictures import ghost_paths, picture_of, scene_of
from kit.tui.suspend import edit_aside
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import WorldView
from kit.workspace import Workspace

REVEAL_INTERVAL: Final = 0.3
"""Between two rows that appear [s]."""
BELL_VARIABLE: Final = "KIT_BELL"
"""If set to 1, the terminal's bell rings for a new medal."""
MOST_REVEALS: Final = 14
"""Of rows, in few enough steps that a long page is whole in a few seconds."""
WIDTH: Final = 74
FINISH_WIDTH: Final = 40
FINISH_ROWS: Final = 3
"""Columns of the photo finish, and how many are in it."""
FIXED_ROWS: Final = 2
"""Of a result: who drove, and the empty row below how it ended."""
ROWS_AROUND: Final = 2
"""Of the result: a note and the keys."""
NARROW: Final = 80
"""Columns from which on a small map stands beside medal, times and sectors."""
WIDE: Final = 110
"""Columns from which on the map stands beside the result."""
LEFT: Final = 46
"""Columns of medal, times and sectors where a small map stands beside these alone."""
LEAST_BESIDE_ROWS, MOST_BESIDE_ROWS = 9, 12
"""Of that map."""
LEAST_MAP_ROWS: Final = 7
"""Of the map below the result; where there are fewer it is left out. It comes there if it is larger than beside the result."""
LADDER_COLUMNS: Final = 46
"""Columns of the ladder beside the next level."""
NEXT_ROWS: Final = 7
"""Of the next level's picture."""
SPEED_INTERVAL: Final = 0.1
"""Between two speeds of a chart [s]."""
JUMP_SPEED: Final = 10.0
"""No robot drives so fast [m/s]: it was put elsewhere."""
QUICKER, SLOWER = 0.005, 0.03
"""A part of a drive is coloured as quicker than the ghost from this gain on, as slower from this loss on [s]."""

Wish: TypeAlias = Literal["next", "restart", "back"]
"""What the player wants after a drive."""


@dataclass(frozen=True, slots=True, eq=False)
class DriveResult:
    """Everything that is shown of a drive that has ended."""

    level: GameLevel
    driver: DriverKind
    finish: RaceFinish
    record: DriveRecord
    recording: Recording
    ghosts: Sequence[Ghost]
    reference: float | None
    splits: Sequence[Split]
    finishes: Sequence[RaceFinish] = ()
    """Of a program's drives from all starts; the middle one counts."""
    program: Path | None = None
    """The player's own program that drove; None: something else did."""


class DriveResultScreen(ModalScreen[Wish]):
    """What a drive earned, beside its map. A driving key that is still held does not close it."""

    screen_actions = ScreenActions(
        "level result", ("next", "restart", "edit_file", "replay", "share", "help", "back")
    )
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    DriveResultScreen {{ layout: vertical; layers: text map; }}
    DriveResultScreen > #text {{ width: 1fr; height: 1fr; }}
    DriveResultScreen > #keys {{ dock: bottom; height: 1; }}
    DriveResultScreen > WorldView {{ display: none; }}
    DriveResultScreen.-beside > WorldView {{ display: block; layer: map; dock: right; width: {NARROW - LEFT}; }}
    DriveResultScreen.-wide {{ layout: horizontal; }}
    DriveResultScreen.-wide > #text {{ width: {WIDTH}; }}
    DriveResultScreen.-wide > WorldView {{ display: block; width: 1fr; }}
    DriveResultScreen.-high > #text {{ height: auto; }}
    DriveResultScreen.-high > WorldView {{ display: block; height: 1fr; }}
    """

    def __init__(self, theme: Theme, result: DriveResult, workspace: Workspace) -> None:
        super().__init__()
        self._theme = theme
        self._result = result
        self._workspace = workspace
        finish, record = result.finish, result.record
        self._rungs, self._ladder = (
            ladder_of_drive(finish, record, result.driver, result.reference, is_tall=is_tall)
            for is_tall in (True, False)
        )
        self._starts = level_rows.starts_rows(result.finishes, record.counts)
        self._times = [
            *drive_end_rows.compared(finish, record, result.reference, result.ghosts),
            *drive_end_rows.sector_rows(result.splits),
        ]
        self._photo_finish = photo_finish(result)
        self._leads: list[float] = []
        """How far ahead of the reference it was on its way [s], once that is known."""
        self._speeds = speeds_of(result)
        self._next_picture: list[str] = []
        """The next level, once it is drawn."""
        self._won = drive_end_rows.won_besides(result.level, record)
        self._needed: list[Row] = []
        """What all players needed, once that is known."""
        self._shown = 0
        self._note: Row = ()
        self._flourish = Flourish(theme, self._show_flourish)
        self._world = WorldView(lambda: theme.encoder, theme.palette)

    @property
    def _fixed(self) -> list[Row]:
        """The rows above those that appear: who drove, how it ended, and what came of it, where there is room for that."""
        result, width = self._result, min(WIDTH, self.app.size.width)
        sentence = broken(row(f" {drive_end_rows.finish_sentence(result.finish)}"), width)
        ending = drive_end_rows.ending(result.level, result.finish, width - MARGIN)
        others = (sentence, self._above, self._earned, self._times, self._ladder, self._won, ending)
        has_room = sum(map(len, others)) + FIXED_ROWS + ROWS_AROUND <= self.app.size.height
        return [
            row((f" {result.level.title}, {result.driver.phrase}", "bold")),
            *sentence,
            *(ending if has_room else []),
            row(),
        ]

    @property
    def _has_new_medal(self) -> bool:
        """Whether this medal is better than those of its driver here before."""
        record = self._result.record
        return record.medal > record.previous_medal

    def compose(self) -> ComposeResult:
        yield TextRows(id="text")
        yield self._world
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._show()
        if os.environ.get(BELL_VARIABLE) == "1" and self._has_new_medal:
            self.app.bell()
        self._timer = self.set_interval(REVEAL_INTERVAL, self._reveal)
        if self._has_new_medal:
            self._flourish.begin(self)
        self._draw_map()

    @work(exclusive=True, group="map")
    async def _draw_map(self) -> None:
        result = self._result
        self._world.show(await to_thread(scene_of_drive, result))
        if result.record.following is not None and result.finish.reached:
            glyphs = self._theme.terminal.glyphs.value
            size = WIDTH - LADDER_COLUMNS - MARGIN, NEXT_ROWS
            self._next_picture = await to_thread(picture_of, result.record.following, *size, glyphs)
            self._show()
        was_all_shown = self._shown >= len(self._revealed)
        if result.finish.reached:
            seconds = await to_thread(seconds_needed, result.level, result.driver)
            self._needed = drive_end_rows.needed_rows(histogram(seconds, result.finish.seconds), WIDTH)
        self._leads = await to_thread(leads_over_reference, result)
        if was_all_shown:
            self._shown = len(self._revealed)
        self._show()

    def _show_flourish(self) -> None:
        if not self._flourish.number:
            self._place_map()
        self._show()

    def on_key(self, event: events.Key) -> None:
        """Any key ends the flourish, but one that may still be held from driving."""
        if self._flourish.number and drive_key(event.key) is None:
            self._flourish.end()
            self._show_flourish()

    def _reveal(self) -> None:
        self._shown += max(1, len(self._revealed) // MOST_REVEALS)
        if self._shown >= len(self._revealed):
            self._timer.stop()
        self._show()

    def on_resize(self, event: events.Resize) -> None:
        self._place_map()
        self._show()

    def _place_map(self) -> None:
        """Places the map beside or below the text; a small one comes after the flourish, which has its place."""
        width, height = self.app.size
        self.set_class(width >= WIDE, "-wide")
        self.set_class(False, "-high")
        self.set_class(False, "-beside")
        rows = len(self._fixed) + len(self._above) + len(self._revealed) + ROWS_AROUND
        least = LEAST_MAP_ROWS if width < NARROW else MOST_BESIDE_ROWS + 1
        is_high = width < WIDE and height >= rows + least
        self.set_class(is_high, "-high")
        self.set_class(NARROW <= width < WIDE and not is_high, "-beside")
        is_beside = self.has_class("-beside")
        self._world.visible = not (is_beside and self._flourish.number and not self._above)
        self._world.styles.margin = (len(self._fixed) + len(self._above) if is_beside else 0, 0, 0, 0)
        self._world.styles.height = len(self._beside_map) if is_beside else "1fr"

    @property
    def _medal(self) -> list[Row]:
        """The medal as a drawing, where there is room for it."""
        return medal_drawing(
            self._result.record.medal, medal_size(self.app.size.height), self._flourish.number
        )

    @property
    def _above(self) -> list[Row]:
        """The medal where a map stands beside the text: elsewhere the text stands beside the medal."""
        return self._medal if self.has_class("-beside") else []

    @property
    def _earned(self) -> list[Row]:
        column = drawn_columns(medal_size(self.app.size.height))
        width = LEFT if self.has_class("-beside") else WIDTH - MARGIN - (column if self._medal else 0)
        return drive_end_rows.earned(self._result.level, self._result.finish, self._result.record, width)

    @property
    def _is_won_beside(self) -> bool:
        """Whether what was won besides has room beside a small map."""
        count = len(self._earned) + len(self._times) + len(self._won)
        has_room = count <= MOST_BESIDE_ROWS and all(row_width(each) <= LEFT for each in self._won)
        return self.has_class("-beside") and has_room

    @property
    def _are_rungs_beside(self) -> bool:
        """Whether the rungs have room beside a small map, each on a row."""
        count = len(self._earned) + len(self._times) + len(self._won) * self._is_won_beside
        has_room = count + len(self._rungs) <= MOST_BESIDE_ROWS
        return has_room and all(row_width(each) <= LEFT for each in self._rungs)

    @property
    def _after_finish(self) -> list[Row]:
        """What was won besides, where it stands below."""
        return [] if self._is_won_beside else self._won

    @property
    def _beside_map(self) -> list[Row]:
        """The rows that a small map stands beside."""
        rows = [*self._earned, *self._times, *(self._won if self._is_won_beside else [])]
        rows += self._rungs if self._are_rungs_beside else []
        below = len(self._ladder_below) + len(self._after_finish)
        room = self._room - below
        if room - len(self._photo_finish) >= max(LEAST_BESIDE_ROWS, len(rows)):
            room -= len(self._photo_finish)
        blank = min(max(LEAST_BESIDE_ROWS, room), MOST_BESIDE_ROWS) - len(rows)
        speed = drive_end_rows.speed_rows(self._speeds, LEFT, blank)
        return [*rows, *speed, *[row()] * (blank - len(speed))]

    @property
    def _ladder_below(self) -> list[Row]:
        """The ladder below a small map."""
        return [*([] if self._are_rungs_beside else self._ladder), *self._starts]

    @property
    def _before_finish(self) -> list[Row]:
        if self.has_class("-beside"):
            return [*self._beside_map, *self._ladder_below]
        size = medal_size(self.app.size.height)
        if not size:
            return [*self._earned, *self._ladder, *self._starts, *self._times]
        rows = [*self._earned, *self._times]
        rungs = side_by_side(self._rungs, self._next_rows, LADDER_COLUMNS)
        return [*rows, *[row()] * (len(self._medal) - len(rows)), row(), *rungs, *self._starts]

    @property
    def _next_rows(self) -> list[Row]:
        """The next level as a picture below its title; none after the last one, and where this one was not finished."""
        following = self._result.record.following
        if following is None or not self._result.finish.reached:
            return []
        picture = self._next_picture or [""] * NEXT_ROWS
        return [row(("next level  ", "dim"), (following.title, "bold")), *map(row, picture)]

    @property
    def _revealed(self) -> list[Row]:
        """The rows that appear one after the other; without the photo finish, and then what others needed, where they would
        push others off the screen."""
        before, finish, needed = self._before_finish, self._photo_finish, self._needed
        rows = [*before, *finish, *self._after_finish, *needed]
        if (room := self._room - len(rows)) >= 0:
            if self.app.size.width < WIDE and not self.has_class("-beside"):
                return rows  # the room is the map's
            is_told = self.has_class("-beside") and any(
                "speed" in row_text(each) for each in self._beside_map
            )
            speed = drive_end_rows.speed_rows(self._speeds, WIDTH - MARGIN, 0 if is_told else room)
            lead = drive_end_rows.lead_rows(
                self._leads, WIDTH - MARGIN, max(CHART_ROWS + 2, room - len(speed))
            )
            lead = lead if len(lead) <= room else []
            speed = speed if len(speed) + len(lead) <= room else []
            return [*rows, *speed, *lead]
        rows = [*before, *self._after_finish, *needed]
        return rows if len(rows) <= self._room else [*before, *self._after_finish]

    @property
    def _room(self) -> int:
        """Rows for what appears."""
        return self.app.size.height - len(self._fixed) - len(self._above) - ROWS_AROUND

    @property
    def _unavailable(self) -> list[str]:
        return [
            *([] if self._result.finish.reached else ["next"]),
            *([] if self._result.program is not None else ["edit_file"]),
            *(["replay"] if self._shown < len(self._revealed) else []),
        ]

    def _show(self) -> None:
        revealed, without = self._revealed, self._unavailable
        keys = footer(self.screen_actions, self.app.size.width, without=without, keys={"next": "Enter"})
        hidden = [row()] * max(0, len(revealed) - self._shown)  # what is below keeps its place
        rows = [*revealed[: self._shown], *hidden]
        size = medal_size(self.app.size.height)
        if medal := self._medal if not self._above else []:
            rows = [*side_by_side(medal, rows[: len(medal)], drawn_columns(size)), *rows[len(medal) :]]
        elif self._flourish.number and self.has_class("-beside") and not size:
            drawn = medal_drawing(self._result.record.medal, SMALL, self._flourish.number)
            rows = [*side_by_side(rows[: len(drawn)], drawn, LEFT), *rows[len(drawn) :]]
        rows = [*self._fixed, *self._above, *rows, self._note]
        for text in self.query(TextRows):  # none where the kit is left meanwhile
            text.show([keys] if text.id == "keys" else rows)

    # Keys

    def action_next(self) -> None:
        """First everything is shown, then the next level comes."""
        if self._shown < len(self._revealed):
            self._shown = len(self._revealed)
            self._timer.stop()
            self._show()
        elif self._result.finish.reached:
            self.dismiss("next")

    def action_restart(self) -> None:
        self.dismiss("restart")

    def action_edit_file(self) -> None:
        """Opens the program that drove, where it failed if it did; once it is another one, it drives again."""
        program, failure = self._result.program, self._result.finish.failure
        if program is None:
            return
        line = failure.line if failure is not None and failure.file == program.name else None
        if edit_program(self.app, program, line or 1, self._theme):
            self.dismiss("restart")

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("The end of a drive", self.screen_actions, without=self._unavailable))

    def action_back(self) -> None:
        self.dismiss("back")

    def action_replay(self) -> None:
        """The film of this drive; not while its rows appear, when the key may still be held from driving."""
        if self._shown < len(self._revealed):
            return
        result = self._result
        scenario = film_scenario(result.level, result.recording.seed)
        self.app.push_screen(RecordingScreen(self._theme, scenario, result.recording, result.driver.phrase))

    @work(exclusive=True, group="share")
    async def action_share(self) -> None:
        """Copies the card of this drive, and writes it and a moving picture as files."""
        result = self._result
        rows = card_rows(result.level, result.driver, result.finish, result.record.medal, result.recording)
        self.app.copy_to_clipboard("\n".join(rows))
        self._note = row((" Writing the moving picture ...", "dim"))
        self._show()
        try:
            card = await to_thread(save_card, self._workspace, result.level, result.driver, rows)
            film = await to_thread(save_film, card, result.level, result.recording)
            said = f"Copied to the terminal's clipboard.\nThe card: {shell_path(card)}\nThe moving picture: {shell_path(film)}"
        except (OSError, ExportError) as error:
            said = f"It could not be saved: {error}"
        self._note = ()
        self._show()
        shown = [*(row(each) for each in rows), row(), *map(row, said.splitlines())]
        self.app.push_screen(MessageDialog("A card to share", shown))


def edit_program(app: App[Any], program: Path, line: int, theme: Theme) -> bool:
    """Opens the player's program in the editor; whether it is another one now."""
    before = _content(program)
    if problem := edit_aside(app, program, line, theme.terminal):
        app.push_screen(MessageDialog("No editor opened", problem))
    return _content(program) != before


def _content(file: Path) -> bytes:
    """Empty where it cannot be read."""
    with suppress(OSError):
        return file.read_bytes()
    return b""


def scene_of_drive(result: DriveResult) -> Scene:
    """The level with the way of a drive, each part of it coloured by what it gained on the reference; without one plain."""
    scene = scene_of(result.level)
    reference = _reference_of(result)
    track = _own_track(result)
    if reference is None or len(track) < 2:
        return replace(scene, paths=(ScenePath(track[::5, :2]),) if len(track) > 1 else ())
    strokes = tuple(
        PenStroke(np.array([[x, y], [to_x, to_y]]), gain_color(gain))
        for x, y, to_x, to_y, gain in gains_along(track, result.recording.step_size, reference)
    )
    return replace(scene, paths=tuple(ghost_paths(reference)), strokes=strokes)


def leads_over_reference(result: DriveResult) -> list[float]:
    """How far ahead of the reference a drive was on its way [s]; nothing without a reference."""
    reference = _reference_of(result)
    if reference is None:
        return []
    gains = gains_along(_own_track(result), result.recording.step_size, reference)[:, 4]
    leads: list[float] = np.nancumsum(gains).tolist()
    return leads


def speeds_of(result: DriveResult) -> list[float]:
    """The speed of a drive [m/s] from tenth to tenth of a second, up to where it ended. Being put back to the start is none."""
    tick_s = result.recording.step_size
    places = _own_track(result)[: round(result.finish.seconds / tick_s) + 1, :2]
    distances = np.hypot(*np.diff(places, axis=0).T)
    distances[distances > JUMP_SPEED * tick_s] = 0.0
    step = max(1, round(SPEED_INTERVAL / tick_s))
    whole = distances[: len(distances) // step * step].reshape(-1, step)
    speeds: list[float] = (whole.sum(axis=1) / (step * tick_s)).tolist()
    return speeds


def _reference_of(result: DriveResult) -> Ghost | None:
    return next((each for each in result.ghosts if each.name == "reference"), None)


def _own_track(result: DriveResult) -> FloatArray:
    return result.recording.track(result.level.find_scenario().partners[0])


def gain_color(gain: float) -> tuple[int, int, int]:
    """Green where a part of a drive was quicker than the ghost [s], yellow where about as quick, red where slower, white away
    from its way."""
    if math.isnan(gain):
        return PEN_ROLES[Role.PEN_WHITE]
    if gain > QUICKER:
        return PEN_ROLES[Role.PEN_GREEN]
    return PEN_ROLES[Role.PEN_YELLOW if gain > -SLOWER else Role.PEN_RED]


def photo_finish(result: DriveResult) -> list[Row]:
    """Where everybody was when the first one was at the goal: a line each, the goal at its right end."""
    mine = result.level.find_scenario().partners
    tracks = [
        ("you", result.finish.seconds, result.recording.track(mine[0])[:, :2], result.recording.step_size)
    ]
    own = {each.value: f"best {each.phrase}" for each in DriverKind}
    tracks += [
        (own.get(ghost.name, ghost.name), ghost.seconds, ghost.tracks[0][:, :2], ghost.step_size)
        for ghost in result.ghosts
        if ghost.tracks
    ]
    if not result.finish.reached or len(tracks) < 2:
        return []
    first = min(seconds for _, seconds, _, _ in tracks)
    rows: list[Row] = [row(("   where each was when the first one arrived", "dim"))]
    in_order = sorted(tracks, key=lambda each: each[1])
    shown = in_order[:FINISH_ROWS]
    for name, seconds, track, step in shown if tracks[0] in shown else [*shown[:-1], tracks[0]]:
        missing = 0.0
        if seconds > first:
            rest = track[min(round(first / step), len(track) - 1) :]
            missing = float(sum(((rest[1:] - rest[:-1]) ** 2).sum(axis=1) ** 0.5))
        column = FINISH_WIDTH - 1 - min(FINISH_WIDTH - 1, round(missing * 10.0))
        line = "." * column + ">" + " " * (FINISH_WIDTH - 1 - column) + "|"
        rows.append(
            row(f"   {name:<15.15} ", (line, "good" if name == "you" else "dim"), f" {missing:.2f} m")
        )
    return rows
