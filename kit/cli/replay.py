"""``kit replay``: shows a recorded run again, checks that it runs the same, or writes it as a moving picture."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click
import numpy as np

from kit.cli import learning_options, messages, options, terminal_options
from kit.cli.full_screen import show_screen
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_file import load_policy
from kit.learning.training.run_folders import find_run
from kit.plain_files import nearest_file
from kit.plain_text import counted, escape_controls
from kit.run.animation import AnimationSettings, ExportError, count_frames, export_recording
from kit.run.recording import Recording, RecordingError, load_recording, rerun
from kit.run.recording_file import restore_recordings
from kit.run.scenario import Scenario, find_recorded_scenario
from kit.school.game.daily import find_playable_level
from kit.school.game.replayed_goal import show_goal
from kit.school.game.two_players import CannotShare, recorded_scenario
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.lesson_drive import ReplayScreen


@click.command()
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--check", is_flag=True, help="Run it again without a screen and compare every pose, bit for bit."
)
@click.option(
    "--export",
    "exported",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Export to this file; its extension sets the format: .cast (asciicast), .gif or .svg.",
)
@click.option(
    "--speed",
    type=click.FloatRange(0.1, 1000),
    default=1.0,
    show_default=True,
    help="With --export: simulated seconds per second.",
)
@click.option(
    "--fps",
    type=click.FloatRange(1, 50),
    default=10.0,
    show_default=True,
    help="With --export: frames per second.",
)
@click.option(
    "--size",
    metavar="WxH",
    help="With --export: columns and rows of a .cast (default 80x24), or the largest size of a picture in pixels (default 640x480).",
)
@click.option(
    "--background",
    type=click.Choice(["light", "dark"]),
    default="light",
    show_default=True,
    help="With --export: background colour; a light .cast uses the colours of the terminal that plays it.",
)
@click.option(
    "--agent",
    metavar="RUN or FILE",
    help="Training run or policy (.npz) that drove the robot; `i` shows what it perceived and expected.",
)
@options.root
@options.workspace
@terminal_options.glyphs
@terminal_options.color
def command(
    file: Path,
    check: bool,
    exported: Path | None,
    speed: float,
    fps: float,
    size: str | None,
    background: Literal["light", "dark"],
    agent: str | None,
    root: Path | None,
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Replay a run recorded by `kit run --record FILE`; pause, step and speed work as in `kit drive`.
    A drive from the game is shown under its level's conditions.

    \b
    kit replay run.npz                         on the screen
    kit replay run.npz --export run.gif --speed 4   an animation, 4x speed
    kit replay run.npz --export run.cast       for asciinema play
    kit replay run.npz --agent turn-ppo-kit-0  `i` shows what the agent perceived

    Exit code of --check: 0 the same run; 1 a different run; 2 the file or its world cannot be read.
    """
    for notice in restore_recordings(file.absolute().parent) if not file.exists() else ():
        click.echo(escape_controls(notice), err=True)
    try:
        recording = load_recording(file)
        scenario = _scenario(recording, file, root)
    except FileNotFoundError:
        near = nearest_file(file)
        hint = f": did you mean {near}?" if near else "."
        messages.fail(
            f"There is no recording {file}{hint} `kit run --record FILE` makes one; drives of the game are shown by "
            "`kit game replay LEVEL`, matches by `kit league replay NUMBER`."
        )
    except (RecordingError, LookupError, WorldError, CannotShare) as error:
        messages.fail(str(error))
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    if exported is not None:
        _export_animation(
            recording,
            scenario,
            exported,
            AnimationSettings(speed, fps, _parse_size(size, exported.suffix), background),
        )
        return
    policy = None if agent is None else _best_policy(agent, workspace)
    terminal = terminal_options.decide(plain=check, glyphs=glyphs, color=color)
    if not terminal.plain.value:

        def make_screen(app: KitApp) -> ReplayScreen:
            from kit.tui.screens.lesson_drive import ReplayScreen

            screen = ReplayScreen(app.kit_theme, scenario, recording, file.name)
            screen.watch_agent(agent or "", policy)
            return screen

        show_screen(terminal, make_screen)
    try:
        again = rerun(recording, scenario.world)
    except RecordingError as error:
        messages.fail(str(error))
    seconds = recording.ticks * recording.step_size
    click.echo(
        f"{scenario.title}: {counted(recording.ticks, 'tick')}, {seconds:.2f} s, "
        f"{counted(len(recording.inputs), 'input')}, seed {recording.seed}"
    )
    if np.array_equal(again.poses, recording.poses):
        click.echo("the same run, to the bit")
        return
    differing_rows = (
        np.flatnonzero(np.any(again.poses != recording.poses, axis=1))
        if again.poses.shape == recording.poses.shape
        else [0]
    )
    messages.say(
        f"not the same run: the poses differ from row {differing_rows[0]} on. Has the world changed since?"
    )
    raise SystemExit(1)


def _best_policy(agent: str, workspace: Path | None) -> Policy:
    """The best policy of a run; ends with a message where there is none, or it drives another number of robots."""
    with learning_options.explained_errors():
        if Path(agent).suffix == ".npz":
            return load_policy(agent)
        return find_run(learning_options.runs_folder(workspace), agent).policy()


def _scenario(recording: Recording, file: Path, root: Path | None) -> Scenario:
    """The world that was driven in: that of the game's level, where the recording is one of a level."""
    if recording.level is None:
        return find_recorded_scenario(recording.place, recording.case, file, root)
    return recorded_scenario(find_playable_level(recording.level), recording)


def _parse_size(text: str | None, ending: str) -> tuple[int, int] | None:
    """The size as two numbers, within what a terminal or a picture can have."""
    if text is None:
        return None
    least, most = ((20, 6), (400, 200)) if ending.lower() == ".cast" else ((64, 48), (4096, 4096))
    width, _, height = text.partition("x")
    size = (int(width), int(height)) if width.isdecimal() and height.isdecimal() else (0, 0)
    if not (least[0] <= size[0] <= most[0] and least[1] <= size[1] <= most[1]):
        raise click.UsageError(
            f"--size takes two numbers from {least[0]}x{least[1]} to {most[0]}x{most[1]}, such as "
            f"{'80x24' if ending.lower() == '.cast' else '640x480'}; got {text}."
        )
    return size


def _export_animation(
    recording: Recording, scenario: Scenario, file: Path, settings: AnimationSettings
) -> None:
    count = count_frames(recording, settings)
    try:
        with click.progressbar(length=count, label=file.name, file=sys.stderr) as progress:
            export_recording(
                recording, scenario, file, settings, on_frame=lambda: progress.update(1), prepare=show_goal
            )
    except (ExportError, RecordingError) as error:
        messages.fail(str(error))
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    click.echo(f"{file}: {counted(count, 'frame')}, {file.stat().st_size / 1e3:,.0f} kB")
