"""``kit`` and ``kit play``: the full screen, or line by line where there is none."""

from __future__ import annotations

import os
from pathlib import Path

import click

from kit.cli import options


@click.command()
@click.argument("place", default="maze", metavar="[MAP or WORLD.yaml]")
@options.case
@options.controller
@options.seed
@options.root
@options.workspace
@click.option(
    "--plain", is_flag=True, help="Text line by line instead of a full screen: for screen readers and pipes."
)
@options.glyphs
@options.color
def command(
    place: str,
    case: str | None,
    controller: str,
    seed: int,
    root: Path | None,
    workspace: Path | None,
    plain: bool,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Open the kit on a map: watch the robot, drive it, change what drives it.

    Press an arrow key to take over, `?` for every key, Ctrl-C to leave.

    \b
    kit play                          the maze, with a robot finding its own way
    kit play house --controller teleop
    kit play my_world/world.yaml --controller my_controller.py
    """
    from kit.controllers import find
    from kit.desk import open_desk
    from kit.workspace import WorkspaceError

    try:
        desk = open_desk(workspace)
        driver = find(controller, desk.controllers)
    except (LookupError, WorkspaceError) as error:
        options.fail(str(error))
    terminal = options.terminal(plain=plain, glyphs=glyphs, color=color)
    if terminal.plain.value:
        from kit.cli.plain import Plain, play_plainly
        from kit.places import find_place
        from kit.world.problems import WorldError

        click.echo(f"The kit, line by line. {terminal.plain.reason}")
        try:
            where = find_place(place, case, root)
        except (LookupError, WorldError) as error:
            options.fail(str(error))
        play_plainly(Plain(where, driver, seed=seed, folder=desk.controllers, root=root))
        return
    os.environ.update(terminal.environment())
    from kit.inspection.sockets import sockets_folder
    from kit.tui.app import KitApp
    from kit.tui.screens.play import PlayScreen

    app = KitApp(terminal)
    doors = sockets_folder(desk.folder)
    screen = PlayScreen(
        app.look,
        place,
        controller,
        case=case,
        root=root,
        folder=desk.controllers,
        runs=desk.runs,
        seed=seed,
        doors=doors,
    )
    app.begin(screen)
    app.run()
    if app.return_code:
        raise SystemExit(app.return_code)
