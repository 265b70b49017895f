"""The end of a level's drive: what it earned, beside its map, in place of the whole screen."""

from __future__ import annotations

import math
import os
from asyncio import to_thread
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import ClassVar, Final, Literal, TypeAlias

import numpy as np
from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.screen import ModalScreen

from kit.arrays import FloatArray
from kit.dialogue.actions import ScreenActions
from kit.document.rows import MARGIN, Row, row, side_by_side
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
from kit.school.game.references import reference_seconds
from kit.school.game.starts import film_scenario
from kit.school.lessons.shell_lines import shell_path
from kit.tui.flourish import Flourish
from kit.tui.input.drive_keys import drive_key
from kit.tui.rows import drive_end_rows, level_rows
from kit.tui.rows.drive_end_page import (
    CHARTS,
    LADDER_COLUMNS,
    LEFT,
    NARROW,
    NEXT_ROWS,
    WIDTH,
    DriveEnd,
    DriveEndPage,
    MapPlace,
    drive_end_page,
)
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.ladder_rows import ladder_of_drive
from kit.tui.rows.medal_rows import CORNER, drawn_columns, medal_drawing, medal_size
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.file_editor import EditsFile, edit_file
from kit.tui.screens.lesson_drive import RecordingScreen
from kit.tui.screens.level_pictures import ghost_paths, level_beside, picture_of, scene_of
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import WorldView
from kit.workspace import Workspace

REVEAL_INTERVAL: Final = 0.15
"""Between two rows that appear [s]."""
BELL_VARIABLE: Final = "KIT_BELL"
"""If set to 1, the terminal's bell rings for a new medal."""
MOST_REVEALS: Final = 14
"""Of rows, in few enough steps that a long page is whole in a few seconds."""
FINISH_WIDTH: Final = 40
FINISH_ROWS: Final = 3
"""Columns of the photo finish, and how many are in it."""
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


class DriveResultScreen(EditsFile, ModalScreen[Wish]):
    """What a drive earned, beside its map. A driving key that is still held does not close it."""

    screen_actions = ScreenActions(
        "level result", ("next", "restart", "edit_file", "replay", "share", "help", "back"), ("editor",)
    )
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    DriveResultScreen {{ layout: vertical; layers: text map; }}
    DriveResultScreen > #text {{ width: 1fr; height: 1fr; }}
    DriveResultScreen > #keys {{ dock: bottom; height: 1; }}
    DriveResultScreen > WorldView, DriveResultScreen > #charts {{ display: none; }}
    DriveResultScreen.-beside > WorldView {{ display: block; layer: map; dock: right; width: {NARROW - LEFT}; }}
    DriveResultScreen.-wide, DriveResultScreen.-vast {{ layout: horizontal; }}
    DriveResultScreen.-wide > #text, DriveResultScreen.-vast > #text {{ width: {WIDTH}; }}
    DriveResultScreen.-wide > WorldView, DriveResultScreen.-vast > WorldView {{ display: block; width: 1fr; }}
    DriveResultScreen.-vast > #charts {{ display: block; width: {CHARTS}; height: 1fr; padding: 0 1; }}
    DriveResultScreen.-high > #text {{ height: auto; }}
    DriveResultScreen.-high > WorldView {{ display: block; height: 1fr; }}
    """

    def __init__(self, theme: Theme, result: DriveResult, workspace: Workspace) -> None:
        super().__init__()
        self._theme = theme
        self._result = result
        self._workspace = workspace
        finish, record = result.finish, result.record
        rungs, ladder = (
            ladder_of_drive(result.level, finish, record, result.driver, result.reference, is_tall=is_tall)
            for is_tall in (True, False)
        )
        self._told = DriveEnd(
            result.level,
            result.driver,
            finish,
            record,
            ladder,
            rungs,
            drive_end_rows.how_it_ended(result.finishes or [finish], record.counts if result.finishes else 0),
            drive_end_rows.failed_line(finish.failure, result.program),
            level_rows.starts_rows(result.finishes, record.counts),
            [
                *drive_end_rows.compared(finish, record, result.reference, result.ghosts),
                *drive_end_rows.sector_rows(result.splits),
            ],
            photo_finish(result),
            drive_end_rows.won_besides(result.level, record),
            speeds_of(result),
        )
        self._page = DriveEndPage(MapPlace.NOWHERE, (), ())
        self._shown = 0
        self._note: Row = ()
        self._flourish = Flourish(theme, self._show)
        self._world = WorldView(lambda: theme.encoder, theme.palette)

    @property
    def _has_new_medal(self) -> bool:
        """Whether this medal is better than those of its driver here before."""
        record = self._result.record
        return record.medal > record.previous_medal

    def compose(self) -> ComposeResult:
        yield TextRows(id="text")
        yield self._world
        yield TextRows(id="charts")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._arrange()
        if os.environ.get(BELL_VARIABLE) == "1" and self._has_new_medal:
            self.app.bell()
        self._timer = self.set_interval(REVEAL_INTERVAL, self._reveal)
        if self._has_new_medal:
            self._flourish.begin(self)
        self._draw_map()

    @work(exclusive=True, group="map")
    async def _draw_map(self) -> None:
        result, told = self._result, self._told
        self._world.show(await to_thread(scene_of_drive, result))
        if result.record.following is not None and result.finish.reached:
            following, glyphs = result.record.following, self._theme.terminal.glyphs.value
            size = WIDTH - LADDER_COLUMNS - MARGIN, NEXT_ROWS
            told.next_picture = await to_thread(picture_of, following, *size, glyphs)
            told.next_reference = await to_thread(reference_seconds, following)
            self._arrange()
        was_all_shown = self._is_all_shown
        if result.finish.reached:
            seconds = await to_thread(seconds_needed, result.level, result.driver)
            told.needed = drive_end_rows.needed_rows(histogram(seconds, result.finish.seconds), WIDTH)
        told.leads = await to_thread(leads_over_reference, result)
        self._arrange()
        if was_all_shown:
            self._shown = len(self._page.revealed)
        self._show()

    def on_key(self, event: events.Key) -> None:
        """Any key ends the flourish, but one that may still be held from driving."""
        if self._flourish.number and drive_key(event.key) is None:
            self._flourish.end()
            self._show()

    @property
    def _is_all_shown(self) -> bool:
        return self._shown >= len(self._page.revealed)

    def _reveal(self) -> None:
        self._shown += max(1, len(self._page.revealed) // MOST_REVEALS)
        if self._is_all_shown:
            self._timer.stop()
        self._show()

    def on_resize(self, event: events.Resize) -> None:
        self._arrange()

    def _arrange(self) -> None:
        """Chooses rows and places anew: the size of the screen or what is known has changed."""
        self._page = drive_end_page(self._told, *self.app.size, self._theme.encoder)
        self._place_map()
        self._show()

    def _place_map(self) -> None:
        """Places the map beside or below the text."""
        page = self._page
        for place in MapPlace:
            self.set_class(place is page.place, place.value)
        is_small = page.place is MapPlace.BESIDE_TIMES
        self._world.styles.margin = (page.room_above if is_small else 0, 0, 0, 0)
        self._world.styles.height = len(page.beside) if is_small else "1fr"

    @property
    def _medal(self) -> list[Row]:
        """The medal as a drawing, where there is room for it."""
        return medal_drawing(
            self._result.record.medal, medal_size(self.app.size.height), self._flourish.number
        )

    @property
    def unavailable_actions(self) -> list[str]:
        return [
            *([] if self._result.finish.reached else ["next"]),
            *([] if self._result.program is not None else ["edit_file", "editor"]),
            *([] if self._is_all_shown else ["replay"]),
        ]

    def _show(self) -> None:
        page, without = self._page, self.unavailable_actions
        keys = footer(self.screen_actions, self.app.size.width, without=without, keys={"next": "Enter"})
        hidden = [row()] * max(0, len(page.revealed) - self._shown)  # what is below keeps its place
        rows = [*page.revealed[: self._shown], *hidden]
        size, medal, fixed = medal_size(self.app.size.height), self._medal, page.fixed
        if page.is_medal_in_corner:
            drawn = medal_drawing(self._result.record.medal, CORNER, self._flourish.number)
            beside = side_by_side(fixed[: len(drawn)], drawn, self.app.size.width - drawn_columns(CORNER))
            fixed = [*beside, *fixed[len(drawn) :]]
        elif medal and page.medal_rows:
            rows = [*medal, *rows]
        elif medal:
            rows = [*side_by_side(medal, rows[: len(medal)], drawn_columns(size)), *rows[len(medal) :]]
        shown = {"text": [*fixed, *rows, self._note], "charts": page.charts, "keys": [keys]}
        for text in self.query(TextRows):  # none where the kit is left meanwhile
            text.show(shown[text.id or ""])

    # Keys

    def action_next(self) -> None:
        """First everything is shown, then the next level comes."""
        if not self._is_all_shown:
            self._shown = len(self._page.revealed)
            self._timer.stop()
            self._show()
        elif self._result.finish.reached:
            self.dismiss("next")

    def action_restart(self) -> None:
        self.dismiss("restart")

    def edit(self, *, is_here: bool) -> None:
        """Opens the program that drove, where it failed if it did; once it is another one, it drives again."""
        program, failure = self._result.program, self._result.finish.failure
        if program is None:
            return
        is_there = failure is not None and failure.file == program.name
        line, problem = (failure.line or 1, failure.message) if failure is not None and is_there else (1, "")
        edit_file(
            self.app,
            program,
            self._theme.terminal,
            self.action_restart,
            line=line,
            problem=problem,
            is_here=is_here,
            beside=partial(level_beside, self._result.level, self._result.driver),
        )

    def action_help(self) -> None:
        notes = [level_rows.PROGRAM_NOTES] if len(self._result.finishes) > 1 else []
        self.app.push_screen(
            HelpDialog("The end of a drive", self.screen_actions, *notes, without=self.unavailable_actions)
        )

    def action_back(self) -> None:
        self.dismiss("back")

    def action_replay(self) -> None:
        """The film of this drive; not while its rows appear, when the key may still be held from driving."""
        if not self._is_all_shown:
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
        if not self.is_active:  # a replay of the drive, or a dialog, is above it
            self._note = row((f" {said.splitlines()[-1]}", "dim"))
            self._show()
            return
        self._note = ()
        self._show()
        shown = [*(row(each) for each in rows), row(), *map(row, said.splitlines())]
        self.app.push_screen(MessageDialog("A card to share", shown, passes_keys=True))


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
    """The speed ahead of a drive [m/s] from tenth to tenth of a second, up to where it ended."""
    tick_s = result.recording.step_size
    return speeds_along(_own_track(result)[: round(result.finish.seconds / tick_s) + 1], tick_s)


def speeds_along(track: FloatArray, tick_s: float) -> list[float]:
    """The speed ahead [m/s], negative backwards, from tenth to tenth of a second on a track, (ticks, 3) ``x y theta`` [m, m, rad], a
    pose for each ``tick_s``. Being put back to the start is none."""
    steps, headings = np.diff(track[:, :2], axis=0), track[:-1, 2]
    ahead = steps[:, 0] * np.cos(headings) + steps[:, 1] * np.sin(headings)
    ahead[np.hypot(*steps.T) > JUMP_SPEED * tick_s] = 0.0
    count = max(1, round(SPEED_INTERVAL / tick_s))
    whole = ahead[: len(ahead) // count * count].reshape(-1, count)
    speeds: list[float] = (whole.sum(axis=1) / (count * tick_s)).tolist()
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
        driven = drive_end_rows.FILL * column + "▶"
        rows.append(
            row(
                f"   {name:<15.15} ",
                (driven, "good" if name == "you" else ""),
                (f"{'─' * (FINISH_WIDTH - len(driven))}│", "dim"),
                f" {missing:.2f} m",
            )
        )
    return rows
