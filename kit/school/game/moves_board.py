"""Boards on which arrows walk: each arrow adds a move to the answer, and the newest can be taken back."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from kit.plain_text import quoted
from kit.school.game.board import MOVES, Board, letters_of
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import Judgement


def read_moves(answer: str, most: int) -> str:
    """The moves of an answer, ``l``, ``r``, ``u`` and ``d``. Raises AnswerError."""
    moves = "".join(answer.split()).lower()
    if strange := sorted(set(moves) - set(MOVES)):
        raise AnswerError(f"{quoted(strange[0])} is not a move: write l, r, u and d.")
    if len(moves) > most:
        raise AnswerError(f"{len(moves)} moves are too many; there are at most {most}.")
    return moves


class MovesBoard(Board):
    """An answer of moves, which begins empty, or with the moves that its file holds beside the naive ones."""

    keys = "Arrows walk, u takes the last move back."

    def __init__(self, task: ChallengeTask, answer: str, most: int) -> None:
        self._task, self._most = task, most
        self.moves = ""
        with suppress(AnswerError):
            moves = read_moves(answer, most)
            self.moves = moves if moves != task.naive_answer().strip() else ""

    @property
    def answer(self) -> str:
        return f"{self.moves}\n"

    def judgement(self) -> Judgement:
        return self._task.judge(AnswerSubmission(self.moves, Path()))

    def move(self, columns: int, rows: int) -> None:
        if len(self.moves) < self._most:
            self.moves += letters_of(columns, rows)

    def undo(self) -> None:
        self.moves = self.moves[:-1]
