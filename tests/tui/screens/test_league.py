"""The league on a full screen: its standings, an entrant's matches, a replay with both."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.document.rows import Row, broken
from kit.document.tables import list_rows
from kit.run.metrics import DriveMetrics
from kit.school.game.league.entries import HOLDERS, Entry
from kit.school.game.league.league import League, LeagueJob, own_league
from kit.school.game.league.league_blocks import matches_table
from kit.school.game.league.standings import Match, Standings, match_film, read_standings
from kit.school.game.levels import find_level
from kit.school.game.race import DriverKind
from kit.tui.screens import league as league_screen
from kit.tui.screens.league import STANDINGS_WIDTH, LeagueScreen, driving_row
from kit.tui.screens.level_drive import LeftError
from kit.tui.screens.level_pictures import pictures_of
from kit.tui.screens.match_replay import MatchReplayScreen
from kit.workspace import open_workspace
from tests.kit_content import kit_levels
from tests.school.game.league.house_results import house_jobs
from tests.school.game.league.test_league import GIVES_UP, LASER, make_league, run
from tests.tui.lesson_stage import row_text, seen, stage, text, until


def test_an_empty_league_says_how_to_enter_and_a_program_enters_by_a_key(tmp_path: Path) -> None:
    workspace = open_workspace(tmp_path / "home")
    (workspace.controllers / "mine.py").write_bytes(LASER)
    league = own_league(workspace)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Nobody is entered")
        assert "kit league" not in text(pilot), "keys do it here"
        await seen(pilot, "quick (house)")
        await seen(pilot, "Enter matches")
        await pilot.press("enter")
        await seen(pilot, "Matches of quick (house)")
        await pilot.press("escape")
        await seen(pilot, "Nobody is entered")
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


def test_a_small_picture_has_its_walls_dim_and_its_target_in_its_colour() -> None:
    shown = pictures_of(kit_levels()[:2], 90, 12, "braille")
    styles = {text.strip(): style for each in shown for text, style in each if text.strip()}
    assert styles["◎"] == "good"
    assert styles["S"] == "bold"
    assert {style for text, style in styles.items() if set(text) & set("█▀▄▌▐")} == {"dim"}


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
def test_the_screen_runs_the_matches_as_the_command_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = open_workspace(tmp_path / "home")
    league = make_league(tmp_path, laser=LASER, stands=GIVES_UP)
    jobs = league.jobs()
    league.run_job(jobs[0].key)
    counts: list[tuple[int, int]] = []

    def noted(jobs: Sequence[LeagueJob], done: Collection[str], left_s: float | None) -> Row:
        counts.append((len(done), len(jobs)))
        return driving_row(jobs, done, left_s)

    monkeypatch.setattr(league_screen, "driving_row", noted)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, f"{len(jobs) - 1} of {len(jobs)} drives and games are still to be run")
        await pilot.press("t")
        await seen(pilot, "laser leads")

    stage(lambda theme: LeagueScreen(theme, league, workspace), scene)
    assert counts == [(done, len(jobs)) for done in range(1, len(jobs) + 1)], "as the standings count"
    assert league.waiting() == ()
    assert (league.folder / HOLDERS).is_file(), "so that nobody else can take a name"


def test_the_standings_are_read_once_at_a_time_and_no_more_when_the_screen_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = open_workspace(tmp_path / "home")
    league = own_league(workspace)
    begun: list[int] = []
    ended: list[BaseException] = []
    goes_on, within = threading.Semaphore(0), threading.Lock()

    def read(league: League, on_progress: Callable[[Standings], object]) -> Standings:
        standings = read_standings(league)
        begun.append(len(begun))
        assert within.acquire(blocking=False), "another reading goes on"
        try:
            while not goes_on.acquire(timeout=0.01):
                on_progress(standings)
        except LeftError as error:
            ended.append(error)
            raise
        finally:
            within.release()
        return standings

    monkeypatch.setattr(league_screen, "read_standings", read)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LeagueScreen)
        await until(pilot, lambda: begun, "the first reading")
        for _ in range(5):  # as five drives do that are through
            screen._read(None)
        await pilot.pause()
        goes_on.release(2)
        await until(pilot, lambda: screen._read_for == 6, "the one that all five share")
        assert len(begun) == 2
        screen._read(None)
        await until(pilot, lambda: len(begun) == 3, "one more")
        await pilot.press("escape")
        await until(pilot, lambda: ended, "its end")

    try:
        stage(lambda theme: LeagueScreen(theme, league, workspace), scene)
    finally:
        goes_on.release(20)
    assert len(begun) == 3


@pytest.mark.long
def test_a_game_of_tag_is_replayed_without_a_target(tmp_path: Path) -> None:
    league = make_league(tmp_path, races=False, tag=True, laser=LASER, stands=GIVES_UP)
    match = run(league).matches[0]
    film = match_film(league, match)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, MatchReplayScreen)
        await seen(pilot, "players")
        assert "target" not in text(pilot)
        assert all(f"{number} {name}" in text(pilot) for number, name in ((1, "laser"), (2, "stands")))
        assert "s penalty" in text(pilot)
        assert screen.view is not None
        arrived = replace(screen.view, metrics=DriveMetrics(target_m=0.0, reached_s=14.3))
        screen._view_arrived(arrived)
        assert (screen.view.metrics.target_m, screen.view.metrics.reached_s) == (None, None)

    stage(lambda theme: MatchReplayScreen(theme, match, film), scene)


@pytest.mark.parametrize("is_first", [True, False])
def test_a_match_is_one_row_beside_the_standings(is_first: bool) -> None:
    level = find_level("left-turn")
    own, other = (
        Entry(name, DriverKind.PROGRAM, Path(name), name, name, is_mine=True)
        for name in ("my_controller", "the_other_one")
    )
    entrants = (own, other) if is_first else (other, own)
    match = Match(level, False, entrants, 1.0, "by 10.52 s", ("10.00 s", "20.52 s"), (), True)
    shown = list_rows(matches_table([match], own.name), 120 - STANDINGS_WIDTH, 20, 0)
    (only,) = [row_text(each) for each in shown if "Left turn" in row_text(each)]
    assert "the_other_one" in only
    assert own.name not in only
    assert len(shown) == 1


def test_a_run_shows_how_far_it_is_and_who_drives_where() -> None:
    jobs = house_jobs()
    for count in range(len(jobs)):
        shown = row_text(driving_row(jobs, {each.key for each in jobs[:count]}, None))
        assert f"{count} of {len(jobs)}" in shown
        assert all(
            word in shown for word in (jobs[count].level.title, *(each.name for each in jobs[count].entrants))
        )
        assert len(broken(driving_row(jobs, set(), 3600.0), 78)) <= 2
    assert driving_row(jobs, {each.key for each in jobs}, 0.0) == ()
