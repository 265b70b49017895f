"""What a challenge without driving is: its contract for every kind, an answer that is handed in, and what it is worth."""

from __future__ import annotations

import math
import os
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final, Self

from kit.school.game.judgement import AnswerComparison, Judgement
from kit.school.game.medal import Medal
from kit.workspace import write_atomically
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from kit.school.game.board import Board

NO_RUNS: Final = Path(os.devnull) / "runs"
"""A folder without trainings."""
COMMENT: Final = "#"
"""Begins a line of an answer's file that is not part of the answer."""
GAINS: Final = {Medal.BRONZE: 0.25, Medal.SILVER: 0.75, Medal.GOLD: 0.98}
"""Shares of what the best answer gains on the shortest way that earn medals, where more is better."""


class AnswerError(ValueError):
    """An answer cannot be judged; the message says why."""


def _say_nothing(_: str) -> None:
    """Shows no progress."""


@dataclass(frozen=True, slots=True)
class AnswerSubmission:
    """An answer that is handed in."""

    answer: str
    """As ``ChallengeTask.read_answer`` or ``parse_answer`` returned it; the name of a training run where that is the answer."""
    runs: Path
    """The folder of the training runs."""
    seconds: float = math.inf
    """Since the first look at the challenge."""
    show_progress: Callable[[str], None] = _say_nothing
    """Called a few times a second while a program is checked, with what is being done; what it raises ends the check."""


class ChallengeTask(ABC):
    """What one challenge asks for. Each kind is a subclass in a file of its own in ``challenge_kinds``."""

    kind: ClassVar[str]
    """Its name in ``challenges.yaml``."""
    answer_file: ClassVar[str] = ""
    """Name of the file that an answer is written in; empty where it is no file of its own."""
    clock: tuple[float, float] | None = None
    """Until how many seconds since the first look an answer earns gold, and silver; None: no clock runs."""

    @classmethod
    @abstractmethod
    def read(cls, section: Section, folder: Path) -> Self:
        """Reads the kind's keys of one challenge. ``folder``: of the lessons. Mistakes are noted in the section."""

    @abstractmethod
    def judge(self, submission: AnswerSubmission) -> Judgement:
        """Judges an answer. Raises AnswerError and WorldError."""

    def lines(self) -> list[str]:
        """What is shown beside the text: a drawing, prices, a list."""
        return []

    @property
    def learning_task(self) -> str:
        """The name of the task that is to be trained; empty where nothing is."""
        return ""

    def naive_answer(self) -> str:
        """The content of an answer's file before anybody has written in it: an answer that earns no medal."""
        return ""

    def board(self, answer: str) -> Board | None:
        """The board on which the puzzle is played by keys, with an answer as ``read_answer`` read it, or the naive one where
        that cannot be read; None for a kind that has none."""
        return None

    def shared_text(self, answer: str) -> str:
        """What everybody else's kit needs to judge an answer that ``judge`` took. Raises OSError and ValueError."""
        return answer

    def judge_shared(self, text: str) -> Judgement:
        """Judges what ``shared_text`` gave. Reads nothing of this machine that the text names, and carries nothing out. Raises as
        ``judge``."""
        return self.judge(AnswerSubmission(text, NO_RUNS))

    def prepare(self, folder: Path, about: Sequence[str]) -> Path | None:
        """Makes the answer's file in ``folder`` unless it is there, and returns it; None where the answer is no file.

        ``about``: lines that stand above the naive answer as comments. Raises OSError.
        """
        if not self.answer_file:
            return None
        file = folder / self.answer_file
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            comments = [*about, "Below is a simple answer, which earns no medal.", *self.lines()]
            write_atomically(file, (as_comments(comments) + self.naive_answer()).encode())
        return file

    def read_answer(self, file: Path) -> str:
        """Reads what ``judge`` takes from an answer's file. Raises AnswerError."""
        try:
            lines = file.read_text().splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise AnswerError(f"{file} cannot be read: {error}") from None
        return " ".join(line for line in lines if not line.lstrip().startswith(COMMENT))

    def parse_answer(self, argument: str) -> str:
        """What ``judge`` takes of a command's argument: the name of an answer's file, or the answer itself. Raises AnswerError."""
        file = Path(argument)
        with suppress(OSError):  # moves may be longer than a file's name
            if file.is_file():
                return self.read_answer(file)
        ending = Path(self.answer_file).suffix
        if ending and argument.endswith(ending):
            raise AnswerError(f"There is no file {argument}.")
        return argument


def judge_return(text: str, answer: float, naive: float, best: float) -> Judgement:
    """Judges a return by its share of what the best one gains on ``naive``, that of the shortest way."""
    others = (("shortest way", naive), ("best answer", best))
    rungs = tuple((medal, naive + gain * (best - naive)) for medal, gain in GAINS.items())
    comparison = AnswerComparison("return", answer, others, rungs, more_is_better=True)
    return Judgement(comparison.medal, text, comparison)


def as_comments(lines: Sequence[str]) -> str:
    """Lines of an answer's file that are not part of the answer."""
    return "".join(f"{COMMENT} {line}\n" for line in lines)


@dataclass(frozen=True, slots=True)
class Challenge:
    """One challenge."""

    id: str
    title: str
    story: str
    task_text: str
    form: str
    """How an answer is written down, where that is not how it is found; may be empty."""
    lesson: str
    task: ChallengeTask

    @property
    def written_task(self) -> str:
        """The task of whoever writes the answer down."""
        return f"{self.task_text} {self.form}".rstrip()
