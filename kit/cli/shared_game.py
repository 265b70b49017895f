"""``kit game host`` and ``kit game guest``: two players in one world, and how a spectator is told line by line."""

from __future__ import annotations

from pathlib import Path
from queue import Queue
from typing import TYPE_CHECKING

import click

from kit.cli import messages, terminal_options
from kit.cli.full_screen import run_screen
from kit.cli.process import ScreenClosed
from kit.controllers import prepare_workspace
from kit.school.game.shared_sockets import Audience, SharedGameError, find_game, games_folder, own_user_name
from kit.workspace import Workspace, WorkspaceError
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.school.game.shared_server import SharedGameClient
    from kit.tui.app import KitApp
    from kit.tui.screens.shared_game import SharedGuestScreen, SharedHostScreen

TELL_INTERVAL = 2.0
"""Simulated seconds between two lines about a shared game in which nothing else changes."""
MAX_TOLD = 100
"""States that wait to be printed: a host that sends without end has to wait itself, and fills no memory."""


@click.command("host")
@click.argument("level")
@click.option(
    "--tag", is_flag=True, help="Play tag instead of a race: catch the other robot, and do not get caught."
)
@click.option("--group", help="Let users of this group join too (default: only your own terminals).")
@click.option("--everybody", is_flag=True, help="Let all users of this machine join.")
@click.option("--name", help="Your name in the game (default: your login name).")
@click.pass_obj
def host(
    workspace: Path | None, level: str, tag: bool, group: str | None, everybody: bool, name: str | None
) -> None:
    """Host LEVEL for a second player and spectators. They join on this machine, for a race or tag.

    \b
    kit game host two-doors --group students
    kit game guest two-doors      the second player, in another terminal
    kit watch two-doors           a spectator

    Your process runs the world. Guests only send their key presses and receive the positions of both robots. The
    recording of a game is saved in your workspace, for `kit replay`.
    """
    from kit.school.game.levels import UnknownLevel, find_level
    from kit.school.game.two_players import CannotShare, SharedMode, shared_scenario

    try:
        own_workspace = prepare_workspace(workspace)
        chosen = find_level(level)
        shared_scenario(chosen)
        audience = Audience.of_group(group) if group is not None else Audience(everybody=everybody)
    except (UnknownLevel, WorkspaceError, WorldError, CannotShare, SharedGameError) as error:
        messages.fail(str(error))
    terminal = terminal_options.full_screen("A shared game")
    mode = SharedMode.TAG if tag else SharedMode.RACE

    def make_screen(app: KitApp) -> SharedHostScreen:
        from kit.tui.screens.shared_game import SharedHostScreen

        return SharedHostScreen(
            app.kit_theme, chosen, mode, name or own_user_name(), games_folder(), audience, own_workspace
        )

    screen, code = run_screen(terminal, make_screen)
    try:
        film = screen.save_film()
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    if film is not None:
        click.echo(f"To replay this game: kit replay {film}")
    raise ScreenClosed(code)


@click.command("guest")
@click.argument("game", required=False)
@click.option("--name", help="Your name in the game (default: your login name).")
@click.pass_obj
def guest(workspace: Path | None, game: str | None, name: str | None) -> None:
    """Join GAME on this machine as the second player (default: the only game)."""
    try:
        own_workspace = prepare_workspace(workspace)
    except WorkspaceError as error:
        messages.fail(str(error))
    join_shared_game(game, name, plays=True, workspace=own_workspace)


def join_shared_game(
    game: str | None,
    name: str | None,
    *,
    plays: bool,
    plain: bool = False,
    workspace: Workspace | None = None,
) -> None:
    """Opens a guest's screen until the user leaves it, and tells a spectator of ``plain`` line by line; ends the verb with a
    message if there is no such game. ``workspace``: whose best drives are ghosts."""
    from kit.school.game.levels import UnknownLevel
    from kit.school.game.shared_server import SharedGameClient
    from kit.school.game.two_players import CannotShare

    if plays:
        terminal = terminal_options.full_screen(
            "Playing a shared game", "`kit watch GAME` prints its progress line by line."
        )
    else:
        terminal = terminal_options.decide(plain=plain)
    own_name = name or own_user_name()
    try:
        with SharedGameClient(find_game(games_folder(), game), own_name, plays=plays) as client:
            if terminal.plain.value:
                _tell_shared_game(client)
                raise SystemExit(0)
            if plays and not client.offer.plays:
                click.echo("The game already has two players; you watch.")

            def make_screen(app: KitApp) -> SharedGuestScreen:
                from kit.tui.screens.shared_game import SharedGuestScreen

                return SharedGuestScreen(app.kit_theme, client, workspace)

            screen, code = run_screen(terminal, make_screen)
    except (SharedGameError, UnknownLevel, CannotShare, WorldError) as error:
        messages.fail(str(error))
    if screen.ended:
        click.echo(f"The game has ended: {screen.ended}.")
    elif screen.has_left:
        click.echo("You have left the game; the other player has won.")
    raise SystemExit(code)


def _tell_shared_game(client: SharedGameClient) -> None:
    """Prints how a shared game stands, whenever that has changed and every few seconds, until it ends."""
    from kit.school.game.levels import find_level
    from kit.school.game.two_players import SharedGameState, SharedMode, SharedPhase
    from kit.tui.rows.shared_game_rows import shared_message

    told: Queue[SharedGameState | str] = Queue(MAX_TOLD)
    client.follow(told.put, told.put)
    offer, before = client.offer, None
    click.echo(f"{find_level(offer.level).title}, {offer.mode.value}")
    while not isinstance(state := told.get(), str):
        part = int(state.seconds / TELL_INTERVAL) if state.phase is SharedPhase.RUNNING else 0
        news = state.phase, state.catcher, part, state.scores if offer.mode is SharedMode.RACE else ()
        if news != before:
            before = news
            rows = shared_message(offer.mode, state, None)
            words = " ".join("".join(text for text, _ in each).strip() for each in rows)
            places = "; ".join(
                f"{name or 'nobody yet'} at x {pose.x:.1f}, y {pose.y:.1f}"
                for name, pose in zip(state.names, state.poses, strict=True)
            )
            click.echo(f"{state.seconds:5.1f} s  {words.strip()}  {places}")
        if state.phase is SharedPhase.OVER:
            return
    click.echo(f"The game has ended: {state}.")
