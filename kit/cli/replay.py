"""``kit replay``: a recorded run, again."""

from __future__ import annotations

import os
from pathlib import Path

import click

from kit.cli import options


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
        place = find_scenario(recording.place, recording.case, root)
    except (RecordingError, LookupError, WorldError) as error:
        options.fail(str(error))
    except OSError as error:
        options.fail(options.reason(error))
    terminal = options.terminal(plain=check, glyphs=glyphs, color=color)
    if not terminal.plain.value:
        from kit.tui.app import KitApp
        from kit.tui.screens.replay import ReplayScreen

        os.environ.update(terminal.environment())
        app = KitApp(terminal)
        app.begin(ReplayScreen(app.kit_theme, place, recording, file.name))
        app.run()
        raise SystemExit(app.return_code or 0)
    try:
        again = rerun(recording, place.world)
    except RecordingError as error:
        options.fail(str(error))
    seconds = recording.ticks * recording.step_size
    click.echo(
        f"{place.title}: {recording.ticks} ticks, {seconds:.2f} s, {len(recording.inputs)} inputs, seed {recording.seed}"
    )
    if np.array_equal(again.poses, recording.poses):
        click.echo("the same run, to the bit")
        return
    apart = (
        np.flatnonzero(np.any(again.poses != recording.poses, axis=1))
        if again.poses.shape == recording.poses.shape
        else [0]
    )
    click.echo(f"not the same run: poses differ from row {apart[0]} on. Has the world changed since?")
    raise SystemExit(1)
