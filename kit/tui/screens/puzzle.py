"""A challenge that is played on the screen: arrows and the space bar change its board, and what it is worth is shown at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Final

from textual.binding import BindingType

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.rows import Row
from kit.school.game.board import Board
from kit.school.game.challenge import AnswerError, Challenge, as_comments
from kit.school.game.challenges import challenge_events
from kit.school.game.judgement import Judgement
from kit.school.game.medal import Medal
from kit.school.progress import ProgressEvent, ProgressJournal
from kit.tui.rows.challenge_rows import (
    LEAST_TEXT,
    PuzzleCheck,
    PuzzleView,
    answers_needed_rows,
    puzzle_beside,
    puzzle_page,
)
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.medal_rows import SMALL, medal_drawing, medal_size
from kit.tui.screens.challenge import WIDE, ChallengeScreen
from kit.tui.screens.dialogs import HelpDialog
from kit.workspace import Workspace, write_atomically

if TYPE_CHECKING:
    from kit.tui.theme import Theme


ROWS_AROUND: Final = 3
"""Of the screen: the heading, and the line of keys with an empty row above it."""
BOARD_KEYS: Final = ("move_cursor", "mark_cell", "switch_robot", "undo")
"""Actions whose meaning each board says itself."""


class PuzzleScreen(ChallengeScreen, inherit_bindings=False):
    """Plays a challenge. The answer's file is written when it is checked or left, and read again when it was edited."""

    has_beside = False  # the page has both
    screen_actions = ScreenActions(
        "puzzle",
        ("move_cursor", "mark_cell", "undo", "check", "next", "help", "back"),
        ("restart", "switch_robot", "edit_file", "editor"),
        own=(
            letter("mark_cell", "Space", "mark", "mark the place of the cursor, or wait", name="space"),
            letter("switch_robot", "Tab", "other robot", "plan the other robot's way", name="tab", has_priority=True),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(
        self,
        theme: Theme,
        challenge: Challenge,
        journal: ProgressJournal,
        workspace: Workspace,
        following: str | None = None,
    ) -> None:
        """``challenge``: one that has a board. Raises ProgressError and OSError."""
        super().__init__(theme, challenge, journal, workspace, following)
        self._board = self._read_board()
        self._written = self._board.answer
        self._before_restart: Board | None = None
        """What was given up by the last key; None where that was another one."""
        self._checked: PuzzleCheck | None = None
        """What came of the check, until the board changes."""
        self._tries = self._checks_so_far()

    def _read_board(self) -> Board:
        """The board with the answer that its file holds."""
        assert self._file is not None  # a board's answer is a file
        try:
            answer = self._challenge.task.read_answer(self._file)
        except AnswerError:
            answer = ""
        return self._board_of(answer)

    def _board_of(self, answer: str) -> Board:
        board = self._challenge.task.board(answer)
        assert board is not None  # only challenges that have one come here
        return board

    def _page(self, width: int) -> list[Row]:
        judgement: Judgement | str
        try:
            judgement = self._board.judgement()
        except AnswerError as error:  # which says how an answer is written: nobody writes who has not begun
            judgement = str(error) if self._board.answer.strip() else ""
        is_wide = width >= WIDE
        needed: list[Row] = []
        if not isinstance(judgement, str) and judgement.comparison is not None:
            needed = answers_needed_rows(self._bins, judgement.comparison, LEAST_TEXT)
        place = puzzle_beside if is_wide else puzzle_page
        view = PuzzleView(
            self._challenge,
            self._board,
            judgement,
            self._theme.graph_glyphs,
            self._checked,
            (needed, self._drawing),
            self._tries,
        )
        return place(view, width - 1, self.size.height - ROWS_AROUND)

    @property
    def _drawing(self) -> list[Row]:
        """Beside the board, however small the screen."""
        return medal_drawing(self._won, medal_size(self.size.height) or SMALL, self._flourish.number)

    def _result_rows(self) -> list[Row]:
        """None: the page says it, so that no row changes its place."""
        return []

    @property
    def unavailable_actions(self) -> list[str]:
        board = self._board
        return [
            *super().unavailable_actions,
            *([] if board.marks() else ["mark_cell"]),
            *([] if board.switches() else ["switch_robot"]),
        ]

    def _keys(self) -> Row:
        labels = {"mark_cell": self._board.mark_word}
        return footer(self.screen_actions, self.size.width, labels=labels, without=self.unavailable_actions)

    def _changed(self, before_restart: Board | None = None) -> None:
        self._before_restart = before_restart
        self._checked, self._bins, self._won = None, (), Medal.NONE
        self._renew()

    def _tell(self, judgement: Judgement, previous: Medal) -> None:
        self._checked = PuzzleCheck(previous, self._following)
        self._tries = self._checks_so_far()

    def _tell_problem(self, problem: str) -> None:
        self._checked = PuzzleCheck(problem=problem)

    def _checks_so_far(self) -> list[ProgressEvent]:
        """Raises ProgressError."""
        return challenge_events(self._progress, self._challenge)

    def _prepare_check(self) -> None:
        self._write()

    def _write(self) -> None:
        """Writes the answer's file, where the board has changed since it was read or written."""
        if self._file is None or self._board.answer == self._written:
            return
        self._written = self._board.answer
        about = as_comments([self._challenge.written_task, *self._challenge.task.lines()])
        write_atomically(self._file, (about + self._written).encode())
        if self._watch is not None:
            self._watch.take_as_known()

    def _file_was_saved(self) -> None:
        """Shows and checks the answer that an editor has saved."""
        self._board = self._read_board()
        self._written = self._board.answer
        self._renew()
        self.action_check()

    # Keys

    def action_move(self, columns: int, rows: int) -> None:
        self._board.move(columns, rows)
        self._changed()

    def action_mark_cell(self) -> None:
        self._board.mark()
        self._changed()

    def action_undo(self) -> None:
        if self._before_restart is None:
            self._board.undo()
        else:
            self._board = self._before_restart
        self._changed()

    def action_restart(self) -> None:
        """The board as it was before anybody played; undo brings the present one back."""
        before, self._board = self._board, self._board_of("")
        self._changed(before)

    def action_switch_robot(self) -> None:
        self._board.switch()
        self._changed()

    def edit(self, *, is_here: bool) -> None:
        self._write()
        super().edit(is_here=is_here)

    def on_unmount(self) -> None:
        self._write()
        super().on_unmount()

    def action_help(self) -> None:
        """What the keys of the board do is told as on the page."""
        without = [*self.unavailable_actions, *BOARD_KEYS]
        note = ("board", f"{self._board.keys} {self._board.signs}".strip())
        self.app.push_screen(HelpDialog("A puzzle", self.screen_actions, (note,), without=without))
