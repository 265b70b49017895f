"""Challenges on a map whose answer is moves, and their board, on which each arrow adds a move or the newest is taken back."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from kit.document.rows import Row, row
from kit.plain_text import quoted, wrap
from kit.school.game.board import MOVES, Board, letters_of
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.judgement import Judgement
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class MovesTask(ChallengeTask):
    """A challenge on a map whose answer is moves."""

    answer_file = "moves.txt"

    grid: tuple[str, ...]
    """``#`` is a wall; the docstring of each kind says what its letters are."""

    @classmethod
    def read(cls, section: Section, folder: Path) -> Self:
        return cls(section.texts("map", at_least=1))

    def lines(self) -> list[str]:
        return [*self.grid]


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

    keys = "Arrows walk, u undoes the last move."

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

    def moves_made(self, width: int) -> list[Row]:
        """The moves so far, ten to a group."""
        groups = [self.moves[at : at + 10] for at in range(0, len(self.moves), 10)]
        lines = wrap(" ".join(groups), width, "  ", "  ")
        return [row(("moves so far", "title")), *map(row, lines)] if groups else []

    def undo(self) -> None:
        self.moves = self.moves[:-1]
