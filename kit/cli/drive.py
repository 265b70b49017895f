"""``kit drive``: opens a map on the full screen, or line by line where there is none."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from kit.cli import messages, opening, options, terminal_options
from kit.cli.full_screen import run_screen
from kit.cli.process import ScreenClosed
from kit.controllers import find_controller, prepare_workspace
from kit.workspace import WorkspaceError

if TYPE_CHECKING:
    from kit.tui.app import KitApp
    from kit.tui.screens.play import PlayScreen


@click.command()
@click.argument("place", default="maze", metavar="[MAP or WORLD.yaml]")
@options.case
@options.controller
@options.seed
@options.root
@options.workspace
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Save the drive to this file when you leave, for `kit replay` and exercises.",
)
@click.option(
    "--plain",
    is_flag=True,
    help="Print lines of text instead of a full screen: for screen readers and pipes.",
)
@terminal_options.glyphs
@terminal_options.color
def command(
    place: str,
    case: str | None,
    controller: str,
    seed: int,
    root: Path | None,
    workspace: Path | None,
    record: Path | None,
    plain: bool,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Open a map: watch the robot, drive it, change its controller.

    Press an arrow key to take over, `?` for all keys, Ctrl-C to leave.

    \b
    kit drive                         the maze, driven by a random walk
    kit drive house --controller teleop
    kit drive my_world/world.yaml --controller my_controller.py
    kit drive simple --controller teleop --record drive.npz
    """
    from kit.inspection.sockets import sockets_folder

    try:
        opened_workspace = prepare_workspace(workspace)
        driver = find_controller(controller, opened_workspace.controllers)
    except (LookupError, WorkspaceError) as error:
        messages.fail(str(error))
    terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
    socket_dir = sockets_folder(opened_workspace.folder)
    if terminal.plain.value:
        from kit.cli.plain import PlainSession, run_plain_session
        from kit.run.scenario import find_scenario
        from kit.world.problems import WorldError

        click.echo(f"The kit, line by line. {terminal.plain.reason}")
        try:
            where = find_scenario(place, case, root)
        except (LookupError, WorldError) as error:
            messages.fail(str(error))
        kept = opening.open_recording_file(record)
        line_by_line = PlainSession(
            where,
            driver,
            seed=seed,
            folder=opened_workspace.controllers,
            root=root,
            socket_dir=socket_dir,
            record=kept,
        )
        try:
            run_plain_session(line_by_line)
        except OSError as error:
            messages.fail(messages.describe_os_error(error))
        return
    kept = opening.open_recording_file(record)

    def make_screen(app: KitApp) -> PlayScreen:
        from kit.tui.screens.play import PlayScreen

        return PlayScreen(
            app.kit_theme,
            place,
            controller,
            case=case,
            root=root,
            folder=opened_workspace.controllers,
            runs=opened_workspace.runs,
            seed=seed,
            socket_dir=socket_dir,
            record=kept,
        )

    screen, code = run_screen(terminal, make_screen)
    if screen.draft_problem:
        click.echo(f"What you typed last and did not save is {screen.draft_problem}.", err=True)
    recording = screen.recording()
    if kept is not None and recording is not None:
        try:
            kept.complete(recording)
        except OSError as error:
            messages.fail(messages.describe_os_error(error))
        click.echo(f"Drive saved to {record}. {kept.remark}".rstrip())
    raise ScreenClosed(code)
