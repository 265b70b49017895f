"""The league on a full screen: its standings, an entrant's matches, a replay with both."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.school.game.league.entries import HOLDERS
from kit.school.game.league.league import own_league
from kit.tui.screens.league import LeagueScreen
from kit.tui.screens.match_replay import MatchReplayScreen
from kit.workspace import open_workspace
from tests.school.game.league.test_league import GIVES_UP, LASER, make_league, run
from tests.tui.lesson_stage import seen, stage, text, until


def test_an_empty_league_says_how_to_enter_and_a_program_enters_by_a_key(tmp_path: Path) -> None:
    workspace = open_workspace(tmp_path / "home")
    (workspace.controllers / "mine.py").write_bytes(LASER)
    league = own_league(workspace)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Nobody is entered")
        assert "kit league" not in text(pilot), "keys do it here"
        await pilot.press("enter", "down")  # nothing to open or choose
        await pilot.press("e")
        await seen(pilot, "Which of yours enters")
        await pilot.press("enter")
        await seen(pilot, "mine is entered.")
        await seen(pilot, "drives and games are still to be run")
        (workspace.controllers / "mine.py").write_bytes(LASER + b"second = True\n")
        await pilot.press("e")
        await seen(pilot, "Which of yours enters")
        await pilot.press("enter")
        await seen(pilot, "Another mine is entered")
        await pilot.press("down", "enter")
        await until(pilot, lambda: "mine-1" in {each.name for each in league.entrants()}, "the rival")

    stage(lambda theme: LeagueScreen(theme, league, workspace), scene)


def test_a_wide_screen_shows_what_is_driven_in_a_league_that_nobody_has_entered(tmp_path: Path) -> None:
    workspace = open_workspace(tmp_path / "home")
    league = own_league(workspace)

    async def scene(pilot: Pilot[None]) -> None:
        for level in (*league.programme().races, *league.programme().tag):
            await until(
                pilot,
                lambda level=level: any(level.title in each[68:] for each in text(pilot).splitlines()),
                level.title,
            )
        assert "◎" in text(pilot), "the targets of the maps"

    stage(lambda theme: LeagueScreen(theme, league, workspace), scene, size=(200, 50))


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (120, 35), (200, 50)])
def test_from_the_standings_to_a_match_and_its_replay(tmp_path: Path, size: tuple[int, int]) -> None:
    workspace = open_workspace(tmp_path / "home")
    league = make_league(tmp_path, laser=LASER, stands=GIVES_UP)
    run(league)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "laser leads")
        await seen(pilot, "Matches of laser")  # beside the standings or below them
        await pilot.press("enter")
        await seen(pilot, "Enter replay")
        assert "Matches of laser" in text(pilot)
        await seen(pilot, "laser: ")  # what both did, at every size
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.screen, MatchReplayScreen), "the replay")
        await seen(pilot, "laser against stands")
        await seen(pilot, "the robot: laser   the letter S: stands")
        await pilot.press("3")
        await seen(pilot, "laser won: only the winner arrived")
        await pilot.press("escape")
        await seen(pilot, "Matches of laser")
        await pilot.press("escape")
        await seen(pilot, "Enter matches")

    stage(lambda theme: LeagueScreen(theme, league, workspace), scene, size=size)


@pytest.mark.long
def test_the_screen_runs_the_matches_as_the_command_does(tmp_path: Path) -> None:
    workspace = open_workspace(tmp_path / "home")
    league = make_league(tmp_path, laser=LASER, stands=GIVES_UP)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "No match has been driven yet")
        await pilot.press("t")
        await seen(pilot, "laser leads")

    stage(lambda theme: LeagueScreen(theme, league, workspace), scene)
    assert league.waiting() == ()
    assert (league.folder / HOLDERS).is_file(), "so that nobody else can take a name"
