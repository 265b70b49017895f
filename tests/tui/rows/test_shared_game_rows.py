"""The rows of a shared game: who watches, and what each side can do about another game."""

from __future__ import annotations

from dataclasses import replace

import pytest

from kit.document.rows import row_text, row_width
from kit.geometry import Pose
from kit.school.game.two_players import SharedGameState, SharedMode, SharedPhase
from kit.tui.rows.shared_game_rows import (
    HOST,
    RobotMotion,
    game_end,
    players_card,
    shared_heading,
    shared_message,
)

OVER = SharedGameState(
    SharedPhase.OVER, 1.0, (Pose(0.0, 0.0), Pose(1.0, 0.0)), (30.0, 60.0), 0, 0, ("Ada", "Ben")
)


def said(state: SharedGameState, me: int | None) -> str:
    return " ".join(row_text(each) for each in shared_message(SharedMode.TAG, state, me))


@pytest.mark.parametrize(
    ("me", "before", "after"),
    [
        (HOST, "r plays again", "Ben asks for a rematch"),
        (1, "r asks Ada", "You have asked Ada"),
        (None, "Ada has won", "Ada has won"),
    ],
)
def test_a_rematch_is_offered_and_asked_for(me: int | None, before: str, after: str) -> None:
    assert before in said(OVER, me)
    assert after in said(replace(OVER, asks_again=True), me)
    assert ("rematch" in said(OVER, me)) == (me == 1)
    assert ("Ada has won" in said(OVER, me)) == (me != HOST), "by name"


@pytest.mark.parametrize("width", [21, 44, 58])
@pytest.mark.parametrize("me", [HOST, 1, None])
def test_the_end_of_tag_tells_both_penalties_and_when_each_caught(me: int | None, width: int) -> None:
    caught = replace(OVER, catches=(30.0, 75.0), catcher=0, scores=(45.0, 45.0), wins=(2, 1))
    rows = game_end(SharedMode.TAG, caught, me, width, "Esc leaves")
    assert max(map(row_width, rows)) <= width
    told = [row_text(each) for each in rows]
    assert sum("45.0 s" in line for line in told) == 2
    first, second = (
        next(line for line in told if line.startswith(f"{number} ") and "·" in line) for number in (1, 2)
    )
    assert all(
        (one == "█") is (other == "·") for one, other in zip(first, second, strict=True) if one in "█·"
    )
    assert first.count("█") == pytest.approx(second.count("█"), abs=1)
    assert any("30.0" in line for line in told)
    assert any("Esc leaves" in line for line in told)
    left = replace(caught, scores=(20.0, 5.0), catches=())
    told = [row_text(each) for each in game_end(SharedMode.TAG, left, me, width, "")]
    assert sum(line.count("█") for line in told if "·" in line) < width / 2, (
        "a game that was left ends where it was"
    )


@pytest.mark.parametrize("me", [HOST, None])
def test_who_wins_because_the_other_one_has_left_is_told_so(me: int | None) -> None:
    assert "Ben has left" in said(replace(OVER, has_left=True), me)
    assert "has left" not in said(OVER, me)
    waits = replace(OVER, phase=SharedPhase.WAITING, winner=None)
    assert "Ben has left. Waiting" in said(replace(waits, has_left=True), me)
    assert "has left" not in said(waits, me)


@pytest.mark.parametrize(
    ("me", "players"), [(HOST, "you against Ben"), (1, "you against Ada"), (None, "Ada against Ben")]
)
def test_a_player_is_told_who_the_other_one_is(me: int | None, players: str) -> None:
    assert players in row_text(shared_heading("The maze", SharedMode.TAG, OVER, me, 80))


def test_spectators_are_named_where_there_is_room() -> None:
    watched = replace(OVER, watching=("Eve", "Mallory"))
    assert "Eve, Mallory watch" in row_text(shared_heading("The maze", SharedMode.TAG, watched, None, 80))
    narrow = row_text(shared_heading("The maze", SharedMode.TAG, watched, None, 50))
    assert "2 spectators" in narrow
    assert len(narrow) <= 50
    assert "watch" not in row_text(shared_heading("The maze", SharedMode.TAG, OVER, None, 80))


@pytest.mark.parametrize("me", [HOST, 1, None])
def test_the_card_of_the_players_has_both_scores_and_who_catches(me: int | None) -> None:
    running = replace(OVER, phase=SharedPhase.RUNNING, catcher=1)
    card = [row_text(each) for each in players_card(SharedMode.TAG, running, me, 23)]
    assert all(len(each) <= 23 for each in card)
    first, second = (number for number, line in enumerate(card) if line[:2] in ("1 ", "2 "))
    assert card[first] == ("1 you" if me == HOST else "1 Ada")
    assert "30.0 s" in card[first + 1]
    assert card[second] == ("2 you  catches" if me == 1 else "2 Ben  catches")
    assert "60.0 s" in card[second + 1]
    assert "apart 1.00 m" in card


def test_a_panel_without_a_size_yet_has_no_card() -> None:
    assert players_card(SharedMode.TAG, OVER, HOST, -1) == []


def test_a_guest_is_told_how_its_robot_moves() -> None:
    motion = RobotMotion(1)
    for seconds, x, theta in ((0.0, 1.0, 0.0), (0.5, 1.2, 0.1), (1.0, 1.4, 0.2)):
        poses = Pose(), Pose(x, 0.0, theta)
        motion.take(SharedGameState(SharedPhase.RUNNING, seconds, poses, (0.0, 0.0), catcher=0))
    assert motion.speed == pytest.approx(0.4, abs=0.01)
    assert motion.turn_rate == pytest.approx(0.2)
    assert motion.driven == pytest.approx(0.4)
    motion.take(SharedGameState(SharedPhase.OVER, 0.0, (Pose(), Pose()), (0.0, 0.0), catcher=0))
    assert (motion.speed, motion.driven) == (0.0, pytest.approx(0.4))
    motion.take(SharedGameState(SharedPhase.COUNTDOWN, 0.0, (Pose(), Pose()), (0.0, 0.0), catcher=0))
    assert motion.driven == 0.0
