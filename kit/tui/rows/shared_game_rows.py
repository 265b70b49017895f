"""A shared game as rows of text: who plays, what the score is, how it ended."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from kit.document.blocks import Tone, ToneText, labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, StyledText, at_both_edges, row, row_width
from kit.plain_text import counted, wrap
from kit.school.game.two_players import (
    COUNTDOWN,
    STILL_SECONDS,
    TAG_RULE,
    TAG_SECONDS,
    SharedGameState,
    SharedMode,
    SharedPhase,
)
from kit.tui.rows.ruled_title import ruled_title

HOST: Final = 0
"""The number of the player whose process runs the world."""
NOBODY: Final = "nobody yet"
PLAYER_STYLES: Final = ("code", "bold")
"""Of the players' names: the first one's is that of the first robot."""
LEAST_WIDTH: Final = 16
"""Columns of the players' card."""
END_FIGURE: Final = 8
"""Columns of a score behind its bar."""
RULES: Final = {
    SharedMode.RACE: "First at the target wins.",
    SharedMode.TAG: f"A touch makes the other one the catcher. {TAG_RULE}",
}


def shared_heading(level: str, mode: SharedMode, state: SharedGameState, me: int | None, width: int) -> Row:
    """The level and both players on the left, spectators and the clock on the right: by name where there is room. ``me``: this
    player, who is named first; None watches."""
    first = HOST if me is None else me
    left = row(
        (level, "bold"),
        f"  {mode.value}  ",
        (_name_of(state, first, me), PLAYER_STYLES[first]),
        " against ",
        (_name_of(state, 1 - first, me), PLAYER_STYLES[1 - first]),
    )
    seconds = state.seconds
    if mode is SharedMode.TAG and state.phase is SharedPhase.RUNNING:
        seconds = max(0.0, TAG_SECONDS - seconds)
    clock = f"{seconds:.1f} s" if state.phase is SharedPhase.RUNNING else state.phase.value
    watched = f"{', '.join(state.watching)} {'watches' if len(state.watching) == 1 else 'watch'}  "
    if row_width(left) + len(watched) + len(clock) >= width:
        watched = f"{counted(len(state.watching), 'spectator')}  "
    return at_both_edges(left, row((watched if state.watching else "", "dim"), (clock, "bold")), width)


def shared_message(
    mode: SharedMode, state: SharedGameState, me: int | None, join: str = ""
) -> tuple[Row, ...]:
    """Says what to do now, and the score. ``me``: this player; None watches. ``join``: how another comes in."""
    if state.phase is SharedPhase.WAITING:
        left = f"{state.names[1] or 'The second player'} has left. " if state.has_left else ""
        return (
            row((f" {left}Waiting for the second player.", "bold")),
            row((f" In another terminal of this machine: {join}" if join else "", "dim")),
        )
    if state.phase is SharedPhase.COUNTDOWN:
        return (
            row(
                (f" {max(1, round(COUNTDOWN - state.seconds + 0.5))}", "warn"),
                f"   {_task_text(mode, state, me)}",
            ),
        )
    scores = row(
        " ",
        *(
            f"{_name_of(state, number, me)}: {_score_text(mode, state, number)}   "
            for number in range(len(state.names))
        ),
    )
    if state.phase is SharedPhase.OVER:
        again = _rematch_text(state, me)
        end = row(
            (f" {_end_text(state, me)}", "good" if state.winner == me is not None else "bold"),
            (f"  {again}." if again else "", "dim"),
        )
        return end, scores
    return row((f" {_task_text(mode, state, me)}", "bold")), scores


def players_card(mode: SharedMode, state: SharedGameState, me: int | None, width: int) -> list[Row]:
    """Both players with their scores, how far apart their robots are, and the rule of the game. ``me``: as of
    ``shared_message``."""
    if width < LEAST_WIDTH:  # the screen has no size yet
        return []
    rows = [ruled_title("players", width)]
    for number in range(len(state.names)):
        catches = mode is SharedMode.TAG and number == state.catcher
        rows += [
            row(
                (f"{number + 1} ", "dim"),
                (_name_of(state, number, me), PLAYER_STYLES[number]),
                ("  catches" if catches else "", "warn"),
            ),
            row(f"  {_score_text(mode, state, number)}"),
            *([row(f"  {counted(state.wins[number], 'game')} won")] if any(state.wins) else []),
        ]
    one, other = state.poses
    rows.append(row(f"apart {math.dist(one[:2], other[:2]):.2f} m"))
    return [*rows, ruled_title(mode.value, width), *(row((line, "dim")) for line in wrap(RULES[mode], width))]


def game_end(mode: SharedMode, state: SharedGameState, me: int | None, width: int, leaving: str) -> list[Row]:
    """A game that is over: who has won it, the penalties of tag as bars, who caught when, and what can be done now. ``me``: as of
    ``shared_message``; ``leaving``: what Esc does."""
    if width < LEAST_WIDTH:  # the screen has no size yet
        return []
    won = " : ".join(map(str, state.wins)) + " games" if any(state.wins) else ""
    style = "good" if state.winner == me is not None else "bold"
    rows = [
        ruled_title("the end", width, won),
        *(row((line, style)) for line in wrap(_end_text(state, me), width)),
    ]
    names = [_name_of(state, number, me) for number in range(len(state.names))]
    column = max(map(len, names)) + 3
    note = "the lower one wins" if mode is SharedMode.TAG else ""
    rows += [row(), ruled_title("penalty" if mode is SharedMode.TAG else "targets", width, note)]
    longest, most = width - column - END_FIGURE, max(*state.scores, 1.0)
    for number in range(len(names)):
        score = state.scores[number]
        figure = f"{score:.1f} s" if mode is SharedMode.TAG else f"{score:.0f}"
        bar = "█" * max(0, round(longest * score / most))
        rows.append(
            row(
                *_numbered(names, number, column),
                (bar.ljust(max(0, longest)), PLAYER_STYLES[number]),
                f"{figure:>{END_FIGURE}}",
            )
        )
    if mode is SharedMode.TAG:
        rows += [row(), *_catch_rows(state, names, width, column)]
    again = _rematch_text(state, me)
    now = [line for text in (again, leaving) if text for line in wrap(f"{text}.", width)]
    return [*rows, row(), *(row((line, "bold")) for line in now)]


def _numbered(names: Sequence[str], number: int, column: int) -> tuple[StyledText, ...]:
    """A player's number and name, in a column."""
    return (f"{number + 1} ", "dim"), (f"{names[number]:<{column - 2}}", PLAYER_STYLES[number])


def _catch_rows(state: SharedGameState, names: Sequence[str], width: int, column: int) -> list[Row]:
    """When each player was the catcher, as bars over the time of a game of tag."""
    assert state.catcher is not None
    # Each second of a game counts against one of the two.
    turns, catcher = [0.0, *state.catches, sum(state.scores)], state.catcher
    if len(state.catches) % 2:
        catcher = 1 - catcher
    columns = max(1, width - column)
    drawn = [["·"] * columns for _ in names]
    for start, end in pairwise(turns):
        for at in range(round(columns * start / TAG_SECONDS), round(columns * end / TAG_SECONDS)):
            drawn[catcher][at] = "█"
        catcher = 1 - catcher
    bars = [
        row(*_numbered(names, number, column), ("".join(drawn[number]), PLAYER_STYLES[number]))
        for number in range(len(names))
    ]
    told = ", ".join(f"{each:.1f}" for each in state.catches)
    limit = f"{TAG_SECONDS:.0f} s"
    return [
        ruled_title("who caught", width, counted(len(state.catches), "catch", "catches")),
        *bars,
        row((" " * column + "0" + limit.rjust(columns - 1), "dim")),
        *(
            row((line, "dim"))
            for line in wrap(f"Caught after {told} s." if told else "Nobody was caught.", width)
        ),
    ]


@dataclass(slots=True)
class RobotMotion:
    """How one robot moves, by the instants of a game that somebody else's process runs."""

    number: int
    """The player's."""
    speed: float = 0.0
    """Forward [m/s]."""
    turn_rate: float = 0.0
    """[rad/s], counter-clockwise."""
    driven: float = 0.0
    """Since the game began [m]."""
    _last: SharedGameState | None = None

    def take(self, state: SharedGameState) -> None:
        """Takes the next instant; one of another phase begins anew."""
        last, self._last = self._last, state
        seconds = 0.0 if last is None else state.seconds - last.seconds
        if last is None or last.phase is not state.phase or seconds < 0.0:
            self.speed = self.turn_rate = 0.0
            self.driven = 0.0 if state.phase is not SharedPhase.OVER else self.driven
        elif seconds > 0.0:
            moved = last.poses[self.number].relative(state.poses[self.number])
            self.speed, self.turn_rate = moved.x / seconds, moved.theta / seconds
            self.driven += math.hypot(moved.x, moved.y)

    def rows(self, width: int) -> list[Row]:
        """Its figures, below a title."""
        figures = (
            ("forward", f"{self.speed:5.2f} m/s"),
            ("turning", f"{self.turn_rate:5.2f} rad/s"),
            ("distance", f"{self.driven:5.1f} m"),
        )
        table = labelled_table((ToneText(name, Tone.DIM), figure) for name, figure in figures)
        return [ruled_title(f"robot {self.number + 1}", width), *rows_of([table], Page(width))]


def _name_of(state: SharedGameState, number: int, me: int | None) -> str:
    return "you" if number == me else state.names[number] or NOBODY


def _rematch_text(state: SharedGameState, me: int | None) -> str:
    """What can be done about another game; empty for whoever watches."""
    if me is None:
        return ""
    if me == HOST:
        asked = f"{state.names[1] or NOBODY} asks for a rematch: " if state.asks_again else ""
        return f"{asked}r plays again"
    if state.asks_again:
        return f"You have asked {state.names[HOST]} for a rematch"
    return f"r asks {state.names[HOST]} for a rematch"


def _task_text(mode: SharedMode, state: SharedGameState, me: int | None) -> str:
    if mode is SharedMode.RACE:
        return RULES[mode]
    assert state.catcher is not None
    if me is None:
        return f"{state.names[state.catcher]} catches."
    return (
        "You catch: touch the other robot."
        if state.catcher == me
        else f"Do not get caught, nor stay on one spot for {STILL_SECONDS:.0f} s."
    )


def _score_text(mode: SharedMode, state: SharedGameState, number: int) -> str:
    score = state.scores[number]
    return counted(round(score), "target") if mode is SharedMode.RACE else f"{score:.1f} s penalty"


def _end_text(state: SharedGameState, me: int | None) -> str:
    if state.winner is None:
        return "Nobody has won."
    left = f": {state.names[1 - state.winner] or 'the other player'} has left" if state.has_left else ""
    winner = state.names[state.winner] or "The other player"
    return f"{'You have' if state.winner == me else f'{winner} has'} won{left}."
