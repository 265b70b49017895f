"""A level driven line by line."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from kit.cli import options
from kit.cli.plain import Plain, play_plainly
from kit.controllers import find_controller
from kit.run.recording import RecordingError, load_recording
from kit.school.game.race import SEED, judge_recording

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.school.game.levels import GameLevel
    from kit.school.game.race import RaceFinish
    from kit.workspace import Workspace


def drive_by_lines(level: GameLevel, desk: Workspace) -> tuple[RaceFinish, Recording]:
    """The player drives with lines of text; the clock is the world's. Ends the verb where nothing was driven."""
    with TemporaryDirectory(prefix="level-") as folder:
        file = Path(folder, "drive.npz")
        play_plainly(
            Plain(
                level.find_scenario(),
                find_controller("teleop", desk.controllers),
                seed=SEED,
                folder=desk.controllers,
                record=file,
                says_where=False,
            )
        )
        try:
            recording = load_recording(file)
            return judge_recording(level, recording), recording
        except (RecordingError, OSError, ValueError) as error:
            options.fail(f"No drive was kept: {error}")
