"""A drive by hand that is handed in: opened from its step, kept, checked, looked at again."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from textual.pilot import Pilot
from textual.screen import Screen

import kit
from kit.part_file import lock_part, part_path
from kit.run.recording import load_recording
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import read_lesson
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.screens.lesson import LessonScreen
from kit.tui.screens.lesson_drive import RecordedDriveScreen, ReplayScreen
from kit.tui.theme import Theme
from kit.workspace import open_workspace
from tests.tui.lesson_folder import write_drive
from tests.tui.lesson_stage import rows, seen, stage, text, until


@pytest.fixture
def progress(tmp_path: Path) -> Iterator[ProgressJournal]:
    with ProgressJournal(open_workspace(tmp_path / "home").folder) as opened:
        yield opened


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "home" / "lessons" / "01-by-hand" / "drive" / "drive.npz"


def opened(tmp_path: Path, progress: ProgressJournal, theme: Theme) -> Screen[None]:
    workspace = open_workspace(tmp_path / "home")
    return LessonScreen(
        theme, LessonSession(read_lesson(write_drive(tmp_path / "lessons")), progress, workspace), workspace
    )


async def drive(pilot: Pilot[None]) -> RecordedDriveScreen:
    """Opens the drive and waits until it can be driven."""
    await seen(pilot, "press d to drive")
    await pilot.press("d")
    await seen(pilot, "The clock starts with your first key.")
    screen = pilot.app.screen
    assert isinstance(screen, RecordedDriveScreen)
    return screen


@pytest.mark.long
def test_a_drive_is_kept_when_it_is_left_and_then_checked(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = await drive(pilot)
        assert "0:00.00" in rows(pilot)[0]
        await pilot.press("up")
        await until(pilot, lambda: screen.view is not None and screen.view.time_s > 0.5, "half a second")
        await pilot.press("escape")
        await seen(pilot, "[ok] It is a drive")
        assert "[no] It reaches the target" in text(pilot)
        assert "1 of 4 points" in text(pilot)
        await pilot.press("w")
        await seen(pilot, "Esc back")

    stage(lambda theme: opened(tmp_path, progress, theme), scene)
    recording = load_recording(file)
    assert (recording.place, recording.case) == ("turn", "turn_a_to_b")
    assert recording.ticks > 50
    [attempt] = progress.events(EventKind.ATTEMPT)
    assert attempt.content["lost"] == ["reached"]


@pytest.mark.long
def test_a_drive_that_never_began_is_not_kept_and_not_checked(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await drive(pilot)
        await pilot.press("escape")
        await seen(pilot, "Press d to drive")
        assert "Checking" not in text(pilot)

    stage(lambda theme: opened(tmp_path, progress, theme), scene)
    assert not file.exists()


@pytest.mark.long
def test_beginning_anew_is_a_new_recording(tmp_path: Path, progress: ProgressJournal, file: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = await drive(pilot)
        await pilot.press("left")
        await until(pilot, lambda: screen.view is not None and screen.view.time_s > 1.0, "a second")
        await pilot.press("r")
        await seen(pilot, "The clock starts with your first key.")
        await until(pilot, lambda: screen.view is not None and screen.view.tick == 0, "the beginning")
        await pilot.press("escape")
        await seen(pilot, "Press d to drive")

    stage(lambda theme: opened(tmp_path, progress, theme), scene)
    assert not file.exists()


@pytest.mark.long
def test_what_a_killed_drive_has_left_is_restored_by_the_next_and_said(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    """It is on the disk while it is driven: what lies there then is what a kill leaves."""
    part, left = part_path(file), b""

    async def first(pilot: Pilot[None]) -> None:
        nonlocal left
        screen = await drive(pilot)
        await pilot.press("left")
        await until(pilot, lambda: screen.view is not None and screen.view.time_s > 2.0, "two seconds")
        left = part.read_bytes()
        await pilot.press("escape")
        await until(pilot, file.exists, "the drive")

    async def second(pilot: Pilot[None]) -> None:
        await drive(pilot)
        assert "restored from a run that was killed" in text(pilot)

    stage(lambda theme: opened(tmp_path, progress, theme), first)
    assert not part.exists()
    whole = load_recording(file)
    part.write_bytes(left)
    shutil.rmtree(tmp_path / "lessons")  # to be written once more
    stage(lambda theme: opened(tmp_path, progress, theme), second)
    assert not part.exists()
    restored = load_recording(file.with_name("drive-2.npz"))
    assert 50 <= restored.ticks <= whole.ticks
    assert (restored.place, restored.case) == (whole.place, whole.case)


@pytest.mark.long
def test_a_drive_into_a_file_that_another_program_writes_is_refused(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    file.parent.mkdir(parents=True)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "press d to drive")
        await pilot.press("d")
        await seen(pilot, "The drive could not be saved")

    with lock_part(part_path(file), file):
        stage(lambda theme: opened(tmp_path, progress, theme), scene)


@pytest.mark.long
def test_the_target_ends_the_drive_and_keeps_it(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = await drive(pilot)
        await pilot.press("up")
        # Nobody can steer round a corner here: the robot is put there.

        def put(session: Session) -> None:
            assert session.scenario.case is not None
            session.runner.call_service(
                "move_model", session.scenario.robot, (*session.scenario.case.target, 0.0)
            )

        screen.host.post(put)
        await seen(pilot, "The target is reached, and the drive is saved.")
        await until(pilot, file.exists, "the file")
        await pilot.press("escape")
        await seen(pilot, "[error] It is a drive")  # for it was not driven all the way

    stage(lambda theme: opened(tmp_path, progress, theme), scene)


@pytest.mark.long
def test_who_leaves_the_kit_keeps_the_drive_too(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = await drive(pilot)
        await pilot.press("up")
        await until(pilot, lambda: screen.view is not None and screen.view.time_s > 0.3, "a moment")

    stage(lambda theme: opened(tmp_path, progress, theme), scene)
    assert load_recording(file).ticks > 30


def test_nothing_is_judged_that_was_not_driven(tmp_path: Path, progress: ProgressJournal) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Press d to drive")
        await pilot.press("c")
        await seen(pilot, "You have not driven yet: press d.")

    stage(lambda theme: opened(tmp_path, progress, theme), scene)
    assert not progress.events(EventKind.ATTEMPT)


@pytest.mark.long
def test_ctrl_c_in_a_drive_goes_back_to_the_lesson(
    tmp_path: Path, progress: ProgressJournal, file: Path
) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        screen = await drive(pilot)
        await pilot.press("up")
        await until(pilot, lambda: screen.view is not None and screen.view.time_s > 0.3, "a moment")
        await pilot.press("ctrl+c")
        await seen(pilot, "[ok] It is a drive")

    stage(lambda theme: opened(tmp_path, progress, theme), scene)
    assert file.exists()


def test_a_replay_goes_back_and_ahead_and_is_the_same_run_there(tmp_path: Path) -> None:
    file = tmp_path / "run.npz"
    kit.run_episode("maze", "avoid", seconds=20.0, seed=3, record=file)
    recording = load_recording(file)
    place = find_scenario("maze")
    track = recording.track(place.robot or "")

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, ReplayScreen)
        await until(pilot, lambda: screen.view is not None, "the world")
        await pilot.press("3")
        await until(pilot, lambda: screen.view is not None and screen.view.tick == 2000, "its end")
        screen.host.set_factor(1e-4)  # a second in which nothing moves
        await pilot.press("left", "left")
        await until(pilot, lambda: screen.view is not None and 1000 <= screen.view.tick < 1100, "10 s back")
        assert screen.view is not None
        assert screen.view.pose is not None
        assert tuple(screen.view.pose) == pytest.approx(tuple(track[screen.view.tick - 1]))
        assert "of 0:20.0" in rows(pilot)[0]
        await pilot.press("p")
        await until(pilot, lambda: screen.view is not None and screen.view.paused, "the pause")
        await pilot.press("right")
        await until(pilot, lambda: screen.view is not None and screen.view.tick >= 1500, "5 s ahead")
        assert screen.view.paused
        await pilot.press("left", "left", "left", "left")
        await until(pilot, lambda: screen.view is not None and screen.view.tick == 0, "not before its start")

    stage(lambda theme: ReplayScreen(theme, place, recording, "avoid"), scene)
