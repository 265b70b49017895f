"""The ghosts in a race of two: each side's own, where they were at this time of the race, shown and hidden."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.controllers import prepare_workspace
from kit.geometry import Pose
from kit.run.recording import load_recording
from kit.school.game.ghosts import save_ghost
from kit.school.game.levels import find_level
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_recording
from kit.school.game.shared_protocol import GameOffer
from kit.school.game.shared_server import SharedGameClient
from kit.school.game.shared_sockets import Audience, find_game
from kit.school.game.two_players import TAG_SECONDS, SharedGameState, SharedMode, SharedPhase, shared_scenario
from kit.tui.screens.shared_game import SharedGuestScreen, SharedHostScreen, SharedScreen
from kit.workspace import Workspace
from tests.tui.lesson_stage import seen, stage, text, until

LEVEL = find_level("first-drive")


class FakeClient:
    """A host that says what the test says."""

    def __init__(self, mode: SharedMode) -> None:
        self.offer = GameOffer(LEVEL.id, mode, "Ada", True)
        self.say: Callable[[SharedGameState], object] = lambda state: None

    def follow(self, on_state: Callable[[SharedGameState], object], on_end: Callable[[str], object]) -> None:
        self.say = on_state

    def push(self, linear: float, angular: float) -> None:
        """Nobody listens."""

    def close(self) -> None:
        """Nothing is open."""


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """A player who drove the level by hand, just as the reference."""
    home = prepare_workspace(tmp_path / "home")
    recording = reference_recording(LEVEL)
    assert recording is not None
    save_ghost(home, LEVEL, DriverKind.HAND, [recording])
    return home


def state(phase: SharedPhase, seconds: float) -> SharedGameState:
    first, second = shared_scenario(LEVEL).world.models[0].pose, Pose(1.0, 1.0)
    return SharedGameState(phase, seconds, (first, second), (0.0, 0.0), catcher=0)


def marks(screen: SharedScreen) -> dict[str, tuple[float, float]]:
    return {each.label: (each.x, each.y) for each in screen._newest_scene().marks}


@pytest.mark.long
def test_a_guest_sees_its_own_ghosts_at_the_time_of_the_race(workspace: Workspace) -> None:
    client = FakeClient(SharedMode.RACE)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, SharedGuestScreen)
        await until(pilot, lambda: screen.ghosts, "the ghosts")
        assert {each.name for each in screen.ghosts} == {"hand", "reference"}
        (reference,) = (each for each in screen.ghosts if each.name == "reference")
        for phase, seconds, wanted in (
            (SharedPhase.WAITING, 9.0, 0.0),
            (SharedPhase.COUNTDOWN, 2.0, 0.0),
            (SharedPhase.RUNNING, 1.5, 1.5),
            (SharedPhase.RUNNING, 2.0, 2.0),
            (SharedPhase.OVER, 1.0, 2.0),
        ):
            client.say(state(phase, seconds))
            found = marks(screen)
            assert found.keys() == {"K", "P"}
            assert found["P"] == found["K"] == pytest.approx(reference.poses_at(wanted)[0][:2])
        assert screen._newest_scene().paths
        await pilot.press("o")
        assert not marks(screen)
        assert not screen._newest_scene().paths
        await pilot.press("o")
        assert marks(screen)

    stage(lambda theme: SharedGuestScreen(theme, client, workspace), scene)  # type: ignore[arg-type]  # all it uses


@pytest.mark.long
def test_tag_has_no_ghosts(workspace: Workspace) -> None:
    client = FakeClient(SharedMode.TAG)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, SharedGuestScreen)
        client.say(state(SharedPhase.RUNNING, 1.0))
        await pilot.app.workers.wait_for_complete()
        assert not screen.ghosts
        assert not marks(screen)

    stage(lambda theme: SharedGuestScreen(theme, client, workspace), scene)  # type: ignore[arg-type]  # all it uses


@pytest.mark.long
def test_who_leaves_a_game_that_is_not_over_is_warned_while_it_goes_on_in_sight(
    workspace: Workspace,
) -> None:
    client = FakeClient(SharedMode.TAG)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, SharedGuestScreen)
        client.say(state(SharedPhase.OVER, 9.0))
        await seen(pilot, "r restart")
        client.say(state(SharedPhase.RUNNING, 1.0))
        await seen(pilot, "Esc back")
        await until(pilot, lambda: "r restart" not in text(pilot), "keys of a game that runs")
        await pilot.press("question_mark")
        await seen(pilot, "penalty")
        assert "your best so far" not in text(pilot)
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is screen, "the game")
        await pilot.press("escape")
        await seen(pilot, "The game is not over")
        assert pilot.app.screen is screen
        client.say(state(SharedPhase.RUNNING, 5.0))
        await seen(pilot, f"{TAG_SECONDS - 5.0:.1f} s")
        assert not screen.has_left
        screen._forget_warning()
        assert "The game is not over" not in text(pilot)
        await pilot.press("escape")
        await seen(pilot, "The game is not over")
        await pilot.press("escape")
        await until(pilot, lambda: screen.has_left, "the end")

    stage(lambda theme: SharedGuestScreen(theme, client, workspace), scene)  # type: ignore[arg-type]  # all it uses


@pytest.mark.long
def test_the_hosts_ghosts_wait_for_the_start_and_drive_with_the_race(
    workspace: Workspace, tmp_path: Path
) -> None:
    folder = tmp_path / "games"

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, SharedHostScreen)
        await until(pilot, lambda: screen.view is not None and screen.ghosts and screen.state, "the world")
        start = marks(screen)
        assert start.keys() == {"K", "P"}
        with SharedGameClient(find_game(folder, None), "Ben", plays=True):
            await until(pilot, lambda: _is_running(screen), "the race")
            await until(pilot, lambda: marks(screen)["P"] != start["P"], "the reference to drive")

    stage(
        lambda theme: SharedHostScreen(theme, LEVEL, SharedMode.RACE, "Ada", folder, Audience(), workspace),
        scene,
    )


def _is_running(screen: SharedScreen) -> bool:
    return screen.state is not None and screen.state.phase is SharedPhase.RUNNING


@pytest.mark.long
def test_a_game_that_the_hosts_terminal_ends_is_kept_as_far_as_it_was_played(
    workspace: Workspace, tmp_path: Path
) -> None:
    folder = tmp_path / "games"
    with ExitStack() as guests:

        async def scene(pilot: Pilot[None]) -> None:
            screen = pilot.app.screen
            assert isinstance(screen, SharedHostScreen)
            await until(pilot, lambda: screen.view is not None and screen.state, "the world")
            guests.enter_context(SharedGameClient(find_game(folder, None), "Ben", plays=True))
            await until(pilot, lambda: _is_running(screen), "the race")
            await until(pilot, lambda: screen.state is not None and screen.state.seconds > 0.3, "some of it")

        stage(
            lambda theme: SharedHostScreen(
                theme, LEVEL, SharedMode.RACE, "Ada", folder, Audience(), workspace
            ),
            scene,
        )
    file = workspace.recordings / f"{LEVEL.id}.{SharedMode.RACE.value}.npz"
    assert load_recording(file).ticks > 0
