"""A level driven line by line."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from kit.cli import options
from kit.cli.plain import Plain, play_plainly
from kit.controllers import find_controller
from kit.run.recording import RecordingError, load
from kit.school.game.race import SEED, judged

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.school.game.levels import Level
    from kit.school.game.race import Finish
    from kit.workspace import Workspace


def drive_by_lines(level: Level, desk: Workspace) -> tuple[Finish, Recording]:
    """The player drives with lines of text; the clock is the world's. Ends the verb where nothing was driven."""
    with TemporaryDirectory(prefix="level-") as folder:
        file = Path(folder, "drive.npz")
        play_plainly(
            Plain(
                level.find(),
                find_controller("teleop", desk.controllers),
                seed=SEED,
                folder=desk.controllers,
                record=file,
                says_where=False,
            )
        )
        try:
            recording = load(file)
            return judged(level, recording), recording
        except (RecordingError, OSError, ValueError) as error:
            options.fail(f"No drive was kept: {error}")
