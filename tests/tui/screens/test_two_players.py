"""Games for two from the list of levels: hosting one, joining one that waits, and what is kept of it."""

from __future__ import annotations

import threading
from pathlib import Path
from types import SimpleNamespace

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.host.node_process import NodeProcess
from kit.run.lockstep import Observer
from kit.run.recording import load_recording
from kit.run.session import Session
from kit.school.game import two_players as rules
from kit.school.game.levels import find_level
from kit.school.game.references import reference_recording
from kit.school.game.shared_sockets import SharedGameError, answering_games, find_game
from kit.school.game.two_players import SharedMode, SharedPhase
from kit.school.progress import ProgressJournal
from kit.sim.simulation import Simulation
from kit.tui.screens import two_players
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.picker import Picker
from kit.tui.screens.shared_game import SharedGuestScreen, SharedHostScreen
from kit.tui.screens.two_players import BEATEN
from kit.workspace import Workspace
from tests.tui.lesson_stage import seen, stage, text, until
from tests.tui.screens.test_shared_game import FakeClient


@pytest.fixture
def games(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(two_players, "games_folder", lambda: tmp_path / "games")
    return tmp_path / "games"


def on_the_levels(workspace: Workspace, scene: object) -> None:
    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelsScreen(theme, journal, workspace), scene)  # type: ignore[arg-type]


async def choose(pilot: Pilot[None], line: str) -> None:
    await seen(pilot, "First drive")
    await pilot.press("2")
    await until(pilot, lambda: isinstance(pilot.app.screen, Picker), "the list")
    await pilot.press(*line, "enter")


@pytest.mark.long
def test_a_game_is_hosted_until_its_screen_is_left(tmp_path: Path, games: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        await choose(pilot, "race")
        await until(pilot, lambda: isinstance(pilot.app.screen, SharedHostScreen), "the game")
        await until(pilot, lambda: answering_games(games), "a game that can be found")
        assert find_game(games, "first-drive")
        screen = pilot.app.screen
        assert isinstance(screen, SharedHostScreen)
        screen._film = reference_recording(find_level("first-drive"))  # as if it had been played
        await seen(pilot, "Esc back")
        await pilot.press("escape")
        await seen(pilot, "The game is saved")
        assert answering_games(games) == []

    on_the_levels(workspace, scene)
    (film,) = (workspace.recordings).iterdir()
    assert load_recording(film).ticks


def test_a_game_that_waits_is_joined(tmp_path: Path, games: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    waiting = SimpleNamespace(name="first_drive-7", owner=0)
    monkeypatch.setattr(two_players, "answering_games", lambda folder: [waiting])
    asked: list[object] = []

    def join(game: object, name: str, *, plays: bool) -> FakeClient:
        asked.append((game, plays))
        if len(asked) > 1:
            raise SharedGameError("nobody is there any more")
        return FakeClient(SharedMode.TAG)

    monkeypatch.setattr(two_players, "SharedGameClient", join)

    async def scene(pilot: Pilot[None]) -> None:
        await choose(pilot, "join")
        await until(pilot, lambda: isinstance(pilot.app.screen, SharedGuestScreen), "the game")
        await pilot.press("escape")
        await until(pilot, lambda: isinstance(pilot.app.screen, LevelsScreen), "the levels")
        await choose(pilot, "join")
        await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog), "why not")
        assert "nobody is there" in text(pilot)

    on_the_levels(prepare_workspace(tmp_path / "home"), scene)
    assert asked == [(waiting, True)] * 2


class PlayWatcher(Observer):
    """Says when a program is about to be called; a view would come after its first call, which may be the last."""

    def __init__(self, session: Session, plays: threading.Event) -> None:
        self._session, self._plays = session, plays

    def on_step(self, simulation: Simulation) -> None:
        if any(isinstance(each, NodeProcess) for each in self._session.runner.participants):
            self._plays.set()


@pytest.mark.long
def test_a_game_against_a_program_that_loops_is_left_at_once(tmp_path: Path, games: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    workspace.controllers.mkdir(exist_ok=True)
    (workspace.controllers / "endless.py").write_text(
        "import rclpy\nfrom rclpy.node import Node\n\n\ndef loop():\n    while True:\n        pass\n\n\n"
        "rclpy.init()\nnode = Node('endless')\nnode.create_timer(0.1, loop)\nrclpy.spin(node)\n"
    )

    async def scene(pilot: Pilot[None]) -> None:
        await choose(pilot, "against")
        await until(pilot, lambda: "endless" in text(pilot), "the programs")
        await pilot.press(*"endless", "enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, SharedHostScreen), "the game")
        screen = pilot.app.screen
        assert isinstance(screen, SharedHostScreen)
        plays = threading.Event()
        screen.host.observe(lambda session: PlayWatcher(session, plays))
        await until(pilot, plays.is_set, "the start")
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is not screen, "the list of levels")

    on_the_levels(workspace, scene)


@pytest.mark.long
def test_tag_is_played_against_a_program_of_the_house_and_who_was_beaten_has_its_mark(
    tmp_path: Path, games: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    monkeypatch.setattr(rules, "TAG_SECONDS", 3.0)

    async def scene(pilot: Pilot[None]) -> None:
        await choose(pilot, "against")
        await until(pilot, lambda: "quick" in text(pilot), "the programs")
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, SharedHostScreen), "the game")
        screen = pilot.app.screen
        assert isinstance(screen, SharedHostScreen)
        await until(pilot, lambda: screen.state and screen.state.phase is SharedPhase.RUNNING, "the start")
        assert not answering_games(games)  # nobody joins it
        before = screen.state and screen.state.poses[1]
        await until(pilot, lambda: screen.state and screen.state.poses[1] != before, "it drives")
        game = screen._game
        assert game is not None
        screen.host.post(lambda session: game._scores.__setitem__(1, 50.0))  # a game that is won
        await until(pilot, lambda: screen.state and screen.state.phase is SharedPhase.OVER, "the end")
        for told in ("You have won", "penalty", "who caught", "r plays again", "keeps a recording"):
            await seen(pilot, told)
        await pilot.press("escape")  # nobody's game but one's own
        await seen(pilot, "The game is saved")
        await pilot.press("escape")
        await choose(pilot, "against")
        await seen(pilot, "at 0.5 m/s")
        assert [BEATEN.strip() in line for line in text(pilot).splitlines() if "(house)" in line].count(
            True
        ) == 1

    on_the_levels(workspace, scene)
