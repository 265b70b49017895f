"""``kit replay``: shows a recorded run again, or checks that it runs the same."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import options
from kit.cli.full_screen import show_screen

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.replay import ReplayScreen


@click.command()
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--check", is_flag=True, help="Run it again without a screen and compare every pose, to the bit."
)
@options.root
@options.glyphs
@options.color
def command(file: Path, check: bool, root: Path | None, glyphs: str | None, color: str | None) -> None:
    """Watch a run again that `kit run --record FILE` kept; pause, step and speed work as in `kit play`.

    Exit code of --check: 0 the same run, 1 another one, 2 the file or its world cannot be read.
    """
    import numpy as np

    from kit.run.recording import RecordingError, load_recording, rerun
    from kit.run.scenario import find_scenario
    from kit.world.problems import WorldError

    try:
        recording = load_recording(file)
        scenario = find_scenario(recording.place, recording.case, root)
    except (RecordingError, LookupError, WorldError) as error:
        options.fail(str(error))
    except OSError as error:
        options.fail(options.describe_os_error(error))
    terminal = options.terminal(plain=check, glyphs=glyphs, color=color)
    if not terminal.plain.value:

        def make_screen(app: KitApp) -> ReplayScreen:
            from kit.tui.screens.replay import ReplayScreen

            return ReplayScreen(app.kit_theme, scenario, recording, file.name)

        show_screen(terminal, make_screen)
    try:
        again = rerun(recording, scenario.world)
    except RecordingError as error:
        options.fail(str(error))
    seconds = recording.ticks * recording.step_size
    click.echo(
        f"{scenario.title}: {recording.ticks} ticks, {seconds:.2f} s, {len(recording.inputs)} inputs, seed {recording.seed}"
    )
    if np.array_equal(again.poses, recording.poses):
        click.echo("the same run, to the bit")
        return
    differing_rows = (
        np.flatnonzero(np.any(again.poses != recording.poses, axis=1))
        if again.poses.shape == recording.poses.shape
        else [0]
    )
    click.echo(
        f"not the same run: poses differ from row {differing_rows[0]} on. Has the world changed since?"
    )
    raise SystemExit(1)
