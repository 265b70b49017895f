"""``kit quiz`` in a real terminal: costs nothing while one thinks, survives a kill, leaves a sane terminal."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator

import pytest

from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import open_workspace
from tests.tui.test_play_pty import KIT, User
from tests.tui.widgets.test_world_view_pty import assert_rests

Open = Callable[..., User]


@pytest.fixture
def quiz() -> Iterator[Open]:
    made: list[User] = []

    def run(*arguments: str, ready: str) -> User:
        user = User(KIT, "quiz", *arguments)
        made.append(user)
        user.until(lambda: ready in user.text, ready)
        return user

    yield run
    for user in made:
        user.close()


def kept() -> int:
    with ProgressJournal(open_workspace().folder) as progress:
        return len(progress.events(EventKind.ANSWER))


def test_answers_thoughts_and_out(quiz: Open) -> None:
    user = quiz(ready="question 1 of 12")
    user.send(b"2")
    user.until(lambda: "How sure are you?" in user.text, "how sure")
    assert_rests(user, 0.07)
    user.send(b"3")
    user.until(lambda: "See lesson" in user.text, "what is said")
    user.send(b"n")
    user.until(lambda: "question 2 of 12" in user.text, "the next question")
    user.send(b"\x1b")
    assert user.wait() == 0
    user.assert_sane()
    assert kept() == 1


def test_after_a_kill_it_goes_on_where_it_was(quiz: Open) -> None:
    user = quiz("9", ready="question 1 of 7")
    user.send(b"2")
    user.until(lambda: "How sure are you?" in user.text, "how sure")
    user.send(b"3")
    user.until(lambda: "See lesson" in user.text, "what is said")
    user.process.send_signal(signal.SIGKILL)
    user.process.wait()
    assert kept() == 1
    again = quiz("9", ready="question 2 of 7")
    again.send(b"\x03")
    assert again.wait() == 0
