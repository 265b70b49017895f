"""A program that plays tag against whoever is at the keys: it chases, it plays again, and one that stops has lost."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from kit.controllers import ControllerFile
from kit.run.episode import run_until, when
from kit.run.session import Session
from kit.school.game.league.house import house_controllers
from kit.school.game.league.tag_opponent import PLAYER, TagOpponent
from kit.school.game.levels import find_level
from kit.school.game.two_players import SharedGame, SharedMode, SharedPhase, shared_scenario

pytestmark = pytest.mark.long


@contextmanager
def opened(program: ControllerFile) -> Iterator[tuple[Session, SharedGame, TagOpponent]]:
    scenario = shared_scenario(find_level("two-doors"))
    with Session(scenario, always_scan=True) as session:
        game = SharedGame(scenario, SharedMode.TAG, session.runner)
        session.runner.observers.append(game)
        opponent = TagOpponent(session, game, program)
        try:
            yield session, game, opponent
        finally:
            opponent.close()


def play(session: Session, game: SharedGame, opponent: TagOpponent, seconds: float) -> None:
    """A game from its countdown on, in which the host stands still."""
    session.reset()
    opponent.begin()
    run_until(session.runner, limit_s=3.5, ends=[when(lambda: game.state.phase is not SharedPhase.COUNTDOWN)])
    run_until(session.runner, limit_s=seconds, ends=[when(lambda: game.state.phase is SharedPhase.OVER)])


def test_it_drives_while_the_game_runs_and_again_in_a_rematch(tmp_path: Path) -> None:
    (program,) = (each for each in house_controllers(tmp_path) if each.file.stem == "quick")
    with opened(program) as (session, game, opponent):
        start = game.state.poses
        for _ in range(2):
            play(session, game, opponent, 95.0)
            state = game.state
            assert state.phase is SharedPhase.OVER
            assert not opponent.failure
            assert sum(state.scores) == pytest.approx(90.0, abs=0.1)
            assert state.winner == PLAYER  # against one that stands still
            assert state.poses[PLAYER][:2] != start[PLAYER][:2]
            game.rematch()
            assert game.state.phase is SharedPhase.COUNTDOWN


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("def main(:\n", "SyntaxError"),
        ("import rclpy\n\n\ndef main():\n    1 / 0\n\n\nmain()\n", "ZeroDivisionError"),
    ],
)
def test_a_program_that_stops_has_lost(tmp_path: Path, source: str, reason: str) -> None:
    file = tmp_path / "mine.py"
    file.write_text(source)
    with opened(ControllerFile("mine", file, "")) as (session, game, opponent):
        play(session, game, opponent, 5.0)
        assert game.state.phase is SharedPhase.OVER
        assert game.state.winner == 1 - PLAYER
        assert reason in opponent.failure
        game.rematch()
        assert game.state.phase is SharedPhase.COUNTDOWN
