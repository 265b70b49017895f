"""Two players and a spectator in three terminals of one machine, one of them killed in mid-race."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.tui.test_play_pty import User, terminals

pytestmark = [pytest.mark.pty, pytest.mark.long]


Open = Callable[..., User]


@pytest.fixture
def kit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Open]:
    """Runs ``kit`` in a terminal of its own."""
    monkeypatch.setenv("KIT_GAMES", str(tmp_path / "games"))
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path / "home"))
    with terminals() as run:
        yield run


def shows(terminal: User, words: str) -> None:
    terminal.until(lambda: words in terminal.text, words)


@pytest.mark.nightly
@pytest.mark.parametrize("end", ["SIGKILL", "SIGTERM", "the host leaves"])
def test_a_race_is_seen_by_three_and_goes_on_when_one_is_killed(kit: Open, tmp_path: Path, end: str) -> None:
    host = kit("game", "host", "first-drive", "--name", "Ada")
    shows(host, "Waiting for the second player")
    shows(host, "kit game guest first_drive")
    guest = kit("game", "guest", "first-drive", "--name", "Ben")
    shows(guest, "you against Ada")
    spectator = kit("watch")  # the only game, and there are no trainings
    told = kit("watch", "first-drive", "--plain")
    for terminal in (host, guest, spectator):
        shows(terminal, "0 targets")  # it has begun
    shows(host, "you against Ben")
    shows(host, " watch ")
    before = robots(spectator)
    assert len(before) >= 2
    guest.send(b"\x1b[1;1:1A")  # Up, and held
    spectator.until(lambda: robots(spectator) != before, "the guest's robot to move")
    guest.process.kill()
    shows(host, "You have won")
    shows(spectator, "Ada has won")
    shows(told, "Ada has won")
    assert told.wait() == 0
    if end == "SIGKILL":
        host.process.kill()
    else:
        if end == "SIGTERM":
            host.process.terminate()
            assert host.wait() == 143
        else:
            host.send(b"\x03")
            assert host.wait() == 0
            shows(host, "kit replay")
        (film,) = (tmp_path / "home" / "recordings").iterdir()
        replay = kit("replay", str(film))
        shows(replay, "0:03")  # the countdown is part of it
        replay.send(b"\x03")
    shows(spectator, "the host has gone")
    spectator.send(b"\x03")
    assert spectator.wait() == 0
    spectator.assert_sane()
    again = kit("game", "host", "first-drive", "--name", "Cleo")
    shows(again, "Waiting for the second player")
    assert len(list((tmp_path / "games").rglob("*.sock"))) == 1  # what the killed one has left is gone
    again.send(b"\x03")
    assert again.wait() == 0
    assert not list((tmp_path / "games").rglob("*.sock"))


def test_there_is_nobody_to_join(kit: Open) -> None:
    guest = kit("game", "guest")
    assert guest.wait() == 2
    shows(guest, "Nobody is hosting a game on this machine")


def robots(user: User) -> list[tuple[int, int]]:
    """Where arrows of robots are on the screen."""
    return [
        (row, column)
        for row, line in enumerate(user.text.splitlines()[1:-3])
        for column, sign in enumerate(line)
        if sign in "►◥▲◤◄◣▼◢▷◹△◸◁◺▽◿"
    ]
