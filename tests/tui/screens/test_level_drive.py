"""A level while it is driven: what is drawn of the others' drives."""

from __future__ import annotations

import datetime
from dataclasses import replace
from pathlib import Path

import pytest
from textual.pilot import Pilot
from textual.widgets import TextArea

from kit.controllers import ControllerFile, find_controller, prepare_workspace
from kit.document.rows import row
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.run.session import Session
from kit.school.game.daily import daily_level
from kit.school.game.drive_commands import DriveCommand, ReferenceDrive
from kit.school.game.ghosts import load_ghost, load_reference_ghost
from kit.school.game.levels import find_level
from kit.school.game.medal import RUNGS
from kit.school.game.player_progress import ExtraRule
from kit.school.game.race import DriverKind
from kit.school.game.references import CommandPlayer
from kit.school.game.starts import OWN_SEED
from kit.school.lessons import aside
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.app import KitApp
from kit.tui.rows.drive_end_rows import finish_sentence
from kit.tui.screens import file_editor
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.level_drive import LEAD_INTERVAL, LevelDrive
from kit.tui.screens.level_result import DriveResultScreen
from kit.tui.textual_patches import FITTING_S
from tests.driving_program import driving_program
from tests.school.game.measured_drivers import LASER_PROGRAM, drive, keys_drive
from tests.tui.lesson_stage import seen, stage, text, until
from tests.tui.screens.test_dialog import row_of, shown_cells

DAYS = (datetime.date(2026, 3, day) for day in range(1, 29))
CLEAR = next(level for level in map(daily_level, DAYS) if not level.conditions.fog)


@pytest.mark.parametrize("has_run", [False, True])
def test_the_way_through_a_days_maze_is_drawn_after_the_first_run(tmp_path: Path, has_run: bool) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    reference = load_reference_ghost(CLEAR)
    assert reference is not None

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelDrive)
        await until(pilot, lambda: screen.view is not None, "the world")
        shown = screen._newest_scene()
        assert bool(shown.paths) is has_run
        assert [each.label for each in shown.marks] == ["P"]

    with ProgressJournal(workspace.folder) as journal:
        if has_run:
            content = {"driver": "hand", "reached": False, "seconds": 60.0, "bumps": 0, "medal": 0}
            journal.add(EventKind.FINISH, CLEAR.id, content)
        stage(lambda theme: LevelDrive(theme, CLEAR, [reference], journal, workspace), scene)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)])
def test_the_card_of_a_level_has_room_for_all_its_parts_beside_the_picture(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = find_level("first-drive")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, level.skill)
        page = text(pilot)
        assert "── robot" in page
        assert all(word in page for word in level.story.split())
        for told in (level.hint, level.skill, *(each.title for each in RUNGS)):
            assert told in page
        for rule in ExtraRule:
            assert rule.description(level) in page

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene, size=size)


def test_a_large_screen_draws_how_the_drive_has_stood_against_the_reference(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = find_level("first-drive")
    ghost = load_reference_ghost(level)
    assert ghost is not None

    async def scene(pilot: Pilot[None]) -> None:
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        await until(pilot, lambda: drive.view is not None, "the world")
        await seen(pilot, "speed of the reference")
        assert "ahead of the reference" not in text(pilot)
        drive.drive_keys_changed(("p_up",), drive.drive.state)
        await seen(pilot, "ahead of the reference")
        assert "speed of the reference" not in text(pilot)
        await until(pilot, lambda: drive._behind is not None and drive._behind > 0.5, "a slow drive")
        assert drive._leads[-1] < 0.0, "one that is behind is not ahead"
        assert drive.view is not None
        assert len(drive._leads) <= round(drive.view.time_s / LEAD_INTERVAL) + 1
        await pilot.press("r")
        await until(pilot, lambda: not drive._leads, "the next drive")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [ghost], journal, workspace), scene, size=(200, 50))


def test_a_drive_behind_a_dialog_is_fitted_to_a_terminal_that_is_resized(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = find_level("first-drive")

    async def scene(pilot: Pilot[None]) -> None:
        app = pilot.app
        assert isinstance(app, KitApp)
        await seen(pilot, "forward")
        await pilot.pause(2.0 * FITTING_S)
        app.push_screen(MessageDialog("Title", [row("what is asked")]))
        await seen(pilot, "what is asked")
        await pilot.resize_terminal(120, 35)
        await until(pilot, lambda: any("── robot" in row_of(line) for line in shown_cells(app)), "the panel")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene, size=(80, 24))


def test_a_drive_waits_behind_a_dialog_and_goes_on_after_it(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = find_level("first-drive")

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelDrive)
        await until(pilot, lambda: screen.view is not None, "the world")
        screen.drive_keys_changed(("p_up",), screen.drive.state)
        await until(pilot, lambda: screen.view is not None and screen.view.time_s > 0.0, "the clock")
        await pilot.press("question_mark")
        await until(pilot, lambda: screen.view is not None and screen.view.paused, "the pause")
        await pilot.press("escape")
        await until(pilot, lambda: screen.view is not None and not screen.view.paused, "the drive")
        await pilot.press("p", "question_mark", "escape")
        await until(pilot, lambda: pilot.app.screen is screen, "the screen")
        await until(pilot, lambda: screen.view is not None and screen.view.paused, "the player's own pause")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene)


@pytest.mark.long
def test_a_kept_drive_ends_when_it_was_judged(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = replace(find_level("first-drive"), goal=REACH_TARGET, targets=())

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, LevelDrive)
        await until(pilot, lambda: screen.view is not None, "the world")
        screen.drive_keys_changed(("p_up",), screen.drive.state)
        await until(pilot, lambda: isinstance(pilot.app.screen, DriveResultScreen), "the end")

    with ProgressJournal(workspace.folder) as journal:
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene)
        (finish,) = journal.events(EventKind.FINISH)
    ghost = load_ghost(workspace, level, DriverKind.HAND)
    assert ghost is not None
    assert ghost.seconds == pytest.approx(finish.content["seconds"], abs=1e-6)


STOPS = "raise RuntimeError('not yet')\n"


@pytest.mark.long
def test_a_program_that_is_edited_after_its_drive_drives_again_and_is_judged_as_it_is_then(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = replace(find_level("first-drive"), goal=REACH_TARGET, targets=())
    program = workspace.controllers / "mine.py"
    program.write_text("\n" + STOPS)
    own = LASER_PROGRAM.read_text().replace(
        "SPEED = 0.5", "SPEED = 0.49"
    )  # itself it is a program of the house
    contents = iter([program.read_text(), own])
    lines = []

    def edit(app: KitApp, file: Path, line: int, terminal: object) -> str:
        lines.append(line)
        file.write_text(next(contents))
        return ""

    monkeypatch.setenv("EDITOR", "some")
    monkeypatch.setattr(file_editor, "edit_aside", edit)

    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: isinstance(pilot.app.screen, DriveResultScreen), "the end")
        stopped = pilot.app.screen
        await seen(pilot, "RuntimeError")
        await pilot.press("e")
        assert pilot.app.screen is stopped, "nothing was changed"
        await pilot.press("e")
        await until(pilot, lambda: pilot.app.screen is not stopped, "the drive")
        await until(pilot, lambda: isinstance(pilot.app.screen, DriveResultScreen), "its end")

    with ProgressJournal(workspace.folder) as journal:
        driven = ControllerFile("mine", program, "")
        stage(
            lambda theme: LevelDrive(
                theme, level, [], journal, workspace, driver=DriverKind.PROGRAM, program=driven
            ),
            scene,
        )
        first, second = journal.events(EventKind.FINISH)
    assert lines == [2, 2], "where it stopped"
    assert (first.content["reached"], second.content["reached"]) == (False, True)
    assert ExtraRule.CLEAN in second.content["rules"]
    assert ExtraRule.FEW_LINES not in second.content["rules"], "they are counted anew"


@pytest.mark.parametrize("driver", [DriverKind.HAND, DriverKind.PROGRAM])
def test_the_help_of_a_drive_names_no_key_that_does_nothing(tmp_path: Path, driver: DriverKind) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    program = find_controller("circle") if driver is DriverKind.PROGRAM else None

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "forward")
        await pilot.press("question_mark")
        await seen(pilot, "show or hide the ghosts")
        assert ("full speed" in text(pilot)) is (program is not None)
        assert ("you take over" in text(pilot)) is (program is None)

    with ProgressJournal(workspace.folder) as journal:
        level = find_level("first-drive")
        stage(
            lambda theme: LevelDrive(theme, level, [], journal, workspace, driver=driver, program=program),
            scene,
        )


def test_the_end_of_a_drive_that_does_not_arrive_says_what_was_achieved(tmp_path: Path) -> None:
    level = find_level("first-drive")
    twitch = ReferenceDrive((DriveCommand(10, 0.1, 0.0), DriveCommand(10, 0.0, 0.0)), 0.1)

    def install(session: Session) -> None:
        session.runner.participants.append(CommandPlayer(session, twitch))

    finish, _ = drive(level, OWN_SEED, install)
    assert not finish.reached
    distance = level.targets[0][1] - level.find_scenario().starts[0].y
    assert finish.shortfall.startswith("0 of 2 targets, ")
    left = float(finish.shortfall.partition(", ")[2].partition(" m")[0])
    assert 0.8 * distance < left < distance  # from the hull
    assert finish.shortfall in finish_sentence(finish)
    arrived, _ = keys_drive(level)
    assert not arrived.shortfall


@pytest.mark.long
def test_a_program_is_edited_while_it_drives_and_drives_again_if_it_is_another_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = prepare_workspace(tmp_path / "home")
    level = replace(find_level("first-drive"), goal=REACH_TARGET, targets=())
    program = workspace.controllers / "mine.py"
    still = driving_program()
    program.write_text(still)
    contents = iter([still, LASER_PROGRAM.read_text().replace("SPEED = 0.5", "SPEED = 0.49")])

    def edit(app: KitApp, file: Path, line: int, terminal: object) -> str:
        file.write_text(next(contents))
        return ""

    monkeypatch.setenv("EDITOR", "some")
    monkeypatch.setattr(file_editor, "edit_aside", edit)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "sends no speed")
        await seen(pilot, "e edits it")
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        referee = drive._referee
        await pilot.press("e")
        assert drive._referee is referee, "nothing was changed"
        await pilot.press("e")
        await until(pilot, lambda: isinstance(pilot.app.screen, DriveResultScreen), "the end")
        await seen(pilot, "Finished after")

    with ProgressJournal(workspace.folder) as journal:
        driven = ControllerFile("mine", program, "")
        stage(
            lambda theme: LevelDrive(
                theme, level, [], journal, workspace, driver=DriverKind.PROGRAM, program=driven
            ),
            scene,
        )


def test_a_drive_by_hand_has_no_program_to_edit(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "forward")
        assert "edit" not in text(pilot)
        await pilot.press("e")
        assert isinstance(pilot.app.screen, LevelDrive)

    with ProgressJournal(workspace.folder) as journal:
        stage(
            lambda theme: LevelDrive(theme, find_level("first-drive"), [], journal, workspace),
            scene,
            size=(120, 35),
        )


def test_where_no_editor_is_named_the_kits_own_opens_and_what_is_saved_drives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("EDITOR", "VISUAL"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(aside.shutil, "which", lambda name: name if name == "vi" else None)
    workspace = prepare_workspace(tmp_path / "home")
    program = workspace.controllers / "mine.py"
    program.write_text(driving_program())

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "sends no speed")
        drive = pilot.app.screen
        assert isinstance(drive, LevelDrive)
        for key, leave in (("e", "escape"), ("ctrl+e", "ctrl+e")):
            referee = drive._referee
            await pilot.press(key)
            await until(pilot, lambda: isinstance(pilot.app.focused, TextArea), "the editor")
            await pilot.press("enter", leave)
            await until(pilot, lambda: pilot.app.screen is drive, "the drive")
            assert drive._referee is referee, "nothing was saved"
            await pilot.press(key)
            await until(pilot, lambda: isinstance(pilot.app.focused, TextArea), "the editor")
            await pilot.press("ctrl+s", leave)
            await until(
                pilot,
                lambda referee=referee: drive._referee not in (referee, None),
                "the drive of what was saved",
            )
            await seen(pilot, "sends no speed")
        assert program.read_text().startswith("\n\n"), "what was typed and not saved was there again"

    with ProgressJournal(workspace.folder) as journal:
        level, driven = find_level("first-drive"), ControllerFile("mine", program, "")
        stage(
            lambda theme: LevelDrive(
                theme, level, [], journal, workspace, driver=DriverKind.PROGRAM, program=driven
            ),
            scene,
        )


@pytest.mark.long
def test_by_hand_it_is_the_robot_that_tells_of_walls(tmp_path: Path) -> None:
    workspace = prepare_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "forward")
        await pilot.press("z", "s")
        await seen(pilot, "robot: Obstacle near")
        assert "teleop: " not in text(pilot)

    with ProgressJournal(workspace.folder) as journal:
        level = find_level("first-drive")
        stage(lambda theme: LevelDrive(theme, level, [], journal, workspace), scene)
