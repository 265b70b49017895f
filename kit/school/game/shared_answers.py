"""Answers of puzzles on the leaderboard's folder: what each player wrote, judged anew by everybody's own kit.

As with drives, no file says a figure, so none can be made up. Only puzzles with a board are shared: their answers are plain text
that no judging carries out.
"""

from __future__ import annotations

import os
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Final

from kit.school.game import leaderboard
from kit.school.game.challenge import AnswerError, Challenge
from kit.school.game.challenges import answers_folder, find_challenge
from kit.school.game.judgement import AnswerComparison, Judgement
from kit.school.game.medal import Medal
from kit.school.game.players_histogram import HistogramBin, histogram
from kit.workspace import Workspace, write_atomically
from kit.world.problems import WorldError

MAX_ANSWER_BYTES: Final = 16 * 1024
"""Of a shared answer."""
MAX_JUDGED: Final = 1024
"""Answers whose judgement is kept in memory."""


def publish_answer(folder: Path, challenge: Challenge, answer: str) -> None:
    """Puts this user's answer beside those of others, if they have joined, unless a better one of theirs is there already."""
    if challenge.task.board("") is None or not leaderboard.has_joined(folder):
        return
    with suppress(OSError, ValueError):  # the medal counts without it
        _publish_answer(folder, challenge, challenge.task.shared_text(answer))


def _publish_answer(folder: Path, challenge: Challenge, text: str) -> None:
    new = _judge_once(challenge.id, text)
    if new is None:
        return
    old = _shared_answer(folder, challenge, os.getuid())
    if old is not None and (new.answer <= old.answer if new.more_is_better else new.answer >= old.answer):
        return
    write_atomically(_answer_file(folder, challenge, os.getuid()), text.encode(), follows_links=False)


def publish_answers(folder: Path, workspace: Workspace, challenges: tuple[Challenge, ...]) -> None:
    """Publishes every answer that the workspace holds."""
    for challenge in challenges:
        file = answers_folder(workspace) / challenge.id / challenge.task.answer_file
        if challenge.task.answer_file and file.is_file():
            with suppress(AnswerError):
                publish_answer(folder, challenge, challenge.task.read_answer(file))


def figures_needed(folder: Path, challenge: Challenge) -> list[float]:
    """What everybody who has joined needed, of those whose answer earns a medal: lasers, moves, ticks or what else its unit is."""
    found = (_shared_answer(folder, challenge, user) for user in leaderboard.users_of(folder))
    return [each.answer for each in found if each is not None]


def share_answer(challenge: Challenge, answer: str, judgement: Judgement) -> tuple[HistogramBin, ...]:
    """Puts an answer that was judged beside those of others, where the player has joined the leaderboard; returns what all of them
    needed, as a histogram with one's own figure. Empty for an answer without a medal, and where there are few players."""
    folder = leaderboard.leaderboard_folder()
    publish_answer(folder, challenge, answer)
    if judgement.comparison is None or judgement.medal is Medal.NONE:
        return ()
    return histogram(figures_needed(folder, challenge), judgement.comparison.answer)


def _shared_answer(folder: Path, challenge: Challenge, user: int) -> AnswerComparison | None:
    """A user's shared answer beside others; None if there is none that earns a medal."""
    try:
        content = leaderboard.read_own(_answer_file(folder, challenge, user), user, MAX_ANSWER_BYTES)
        return _judge_once(challenge.id, content.decode())
    except (OSError, UnicodeDecodeError):
        return None


@lru_cache(MAX_JUDGED)
def _judge_once(name: str, text: str) -> AnswerComparison | None:
    """Judges an answer once; None for one that earns no medal, and for a challenge without a board."""
    task = find_challenge(name).task
    if len(text.encode()) > MAX_ANSWER_BYTES or task.board("") is None:
        return None
    with suppress(AnswerError, WorldError):
        judgement = task.judge_shared(text)
        return judgement.comparison if judgement.medal > Medal.NONE else None
    return None


def _answer_file(folder: Path, challenge: Challenge, user: int) -> Path:
    return folder / f"{user}.{challenge.id}.txt"
