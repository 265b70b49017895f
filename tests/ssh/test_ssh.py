"""The kit over a real SSH connection to this machine, through a slow link. Skips only where there is no sshd."""

from __future__ import annotations

import contextlib
import re
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from kit.controllers import prepare_workspace
from kit.render.palettes import COLOR_SCHEMES
from kit.render.roles import Role
from kit.school.game.drive_records import record_drive
from kit.school.game.ghosts import ghost_file
from kit.school.game.levels import find_level
from kit.school.game.player_progress import BY_HAND
from kit.school.game.race import DriverKind
from kit.school.game.references import drive_reference
from kit.school.progress import EventKind, ProgressJournal
from tests.ssh.connection import SSH, SSHD, open_kit, private_sshd
from tests.tui.test_play_pty import User
from tests.tui.widgets.test_world_view_pty import run_on
from tests.waiting import wait_until

CLOCK = re.compile(r"(\d+):(\d\d)\.(\d)")

pytestmark = pytest.mark.skipif(not SSHD or not SSH, reason="no sshd and ssh on this machine")


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[int, Path]]:
    """A private sshd on a port of its own: the port and the key that opens it."""
    with contextlib.ExitStack() as stack:
        try:
            found = stack.enter_context(private_sshd(tmp_path_factory.mktemp("sshd")))
        except OSError as error:
            pytest.skip(str(error))
        yield found


Connect = Callable[..., User]


@pytest.fixture
def connect(server: tuple[int, Path], tmp_path: Path) -> Iterator[Connect]:
    """Opens ``kit`` on the other side of a link of so many bytes a second and so much delay."""
    made: list[User] = []

    def run(rate: float, delay: float, *arguments: str) -> User:
        user = open_kit(server, tmp_path, rate, delay, *arguments)
        made.append(user)
        user.until(lambda: CLOCK.search(user.text), "the kit's clock", limit=40)
        return user

    yield run
    for user in made:
        user.close()


def running(workspace: Path) -> list[str]:
    """Processes on the other side: they have the workspace in their environment, or work in it."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if str(workspace).encode() in (process / "environ").read_bytes():
                found.append(process.name)
    return found


def shown_clock(user: User) -> float | None:
    found = CLOCK.search(user.text)
    return None if found is None else int(found[1]) * 60 + int(found[2]) + int(found[3]) / 10


def ages(user: User, seconds: float) -> list[float]:
    """Wall time less the simulated time on the screen, each time the latter changes: it grows as the link lags."""
    found: list[float] = []
    last = shown_clock(user)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        user.pump(0.005)
        clock = shown_clock(user)
        if clock is not None and clock != last:
            last = clock
            found.append(time.monotonic() - clock)
    return found


@pytest.mark.long
def test_the_picture_keeps_up_over_a_slow_link(connect: Connect) -> None:
    user = connect(30_000, 0.020, "drive", "--seed", "2")
    started = shown_clock(user)
    user.until(lambda: shown_clock(user) != started, "a world that is compiled and runs")
    run_on(user, 2.0)
    measured = ages(user, 6.0)
    assert len(measured) > 25  # it moves: most tenths of a second are seen
    # The freshest frame has only the link's own delay; how much older the others are is what piles up.
    assert statistics.median(measured) - min(measured) < 0.2
    reactions = []
    for _ in range(4):
        for key, sign in ((b"p", "paused"), (b"p", "speed x1")):
            start = time.monotonic()
            user.send(key)
            user.until(lambda sign=sign: sign in user.text, sign)  # type: ignore[misc]  # mypy on lambdas
            reactions.append(time.monotonic() - start)
            run_on(user, 0.3)
    assert statistics.median(reactions) < 0.04 + 0.2 + 0.05  # there and back, the allowed lag, one frame
    start = time.monotonic()
    user.send(b"\x03")
    user.until(lambda: b"\x1b[?1049l" in user.output, "the screen to be given back")
    left = time.monotonic() - start
    assert user.wait() == 0
    user.assert_sane()
    assert left < 0.5


@pytest.mark.long
def test_a_slow_link_keeps_the_themes_colours_and_the_clock_keeps_up(connect: Connect) -> None:
    user = connect(3_000, 0.020, "drive", "maze", "--controller", "random_walk", "--color", "true")
    lit = COLOR_SCHEMES["dark"].palette(reduced=False)[Role.LIT_NEAR].color
    assert isinstance(lit, tuple)
    code = f"48;2;{';'.join(map(str, lit))}".encode()
    user.until(lambda: code in user.output, "floor that the laser sees")
    for _ in range(3):
        told, clock = len(user.output), shown_clock(user)
        user.until(
            lambda clock=clock: (shown_clock(user) or 0.0) > (clock or 0.0) + 3.0,
            "three more seconds of the drive",
        )
        assert code in user.output[told:]


def test_exact_keys_pass_through_ssh(connect: Connect) -> None:
    user = connect(1e6, 0.005, "drive", "simple", "--controller", "teleop")
    user.until(lambda: "exact" in user.text, "the terminal's answer")
    user.send(b"\x1b[1;1:1A")
    user.until(lambda: "forward   0.50" in user.text, "full speed")
    user.send(b"\x1b[1;1:3A")
    user.until(lambda: "forward   0.00" in user.text, "the stop")


def test_a_dropped_link_leaves_nothing_behind(connect: Connect, tmp_path: Path) -> None:
    user = connect(1e6, 0.005, "drive")
    assert running(tmp_path)
    user.process.kill()
    wait_until(lambda: not running(tmp_path), lambda: f"the end of {running(tmp_path)}", every_s=0.1)


@pytest.mark.long
def test_a_link_that_is_dropped_in_the_middle_of_a_level_keeps_the_drives_before_it(
    connect: Connect, tmp_path: Path
) -> None:
    level = find_level("first-drive")
    workspace = prepare_workspace(tmp_path)
    finish, recording = drive_reference(level)
    with ProgressJournal(workspace.folder) as journal:
        record_drive(journal, workspace, level, DriverKind.HAND, [(finish, recording)], BY_HAND)
    kept = ghost_file(workspace, level, DriverKind.HAND).read_bytes()
    user = connect(1e6, 0.005, "game", "play", "first-drive")
    user.until(lambda: "The clock starts" in user.text, "the start")
    user.send(b"w" * 5)
    user.until(lambda: "0 of 2 targets" in user.text, "the race")
    user.process.kill()
    wait_until(lambda: not running(tmp_path), lambda: f"the end of {running(tmp_path)}", every_s=0.1)
    with ProgressJournal(workspace.folder) as journal:
        assert journal.notice == "", "it was closed well"
        assert [event.subject for event in journal.events(EventKind.FINISH)] == [level.id]
    assert ghost_file(workspace, level, DriverKind.HAND).read_bytes() == kept
