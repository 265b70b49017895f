"""Two players from the list of levels: who hosts a game on one, or joins one that waits for a second player."""

from __future__ import annotations

from asyncio import to_thread
from typing import Any, Final

from textual.app import App

from kit.controllers import user_controllers
from kit.document.rows import row
from kit.host.private_folder import private_folder
from kit.school.game.league.house import house_controllers
from kit.school.game.levels import GameLevel, UnknownLevel
from kit.school.game.shared_server import SharedGameClient
from kit.school.game.shared_sockets import (
    Audience,
    SharedGameError,
    answering_games,
    games_folder,
    own_user_name,
    user_name,
)
from kit.school.game.two_players import CannotShare, SharedMode
from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.shared_game import SharedGuestScreen, SharedHostScreen
from kit.tui.theme import Theme
from kit.workspace import Workspace
from kit.world.problems import WorldError

HOSTED: Final = {
    f"{mode.value} {whom}": (mode, Audience(everybody=whom == "all"))
    for mode in (SharedMode.TAG, SharedMode.RACE)
    for whom in ("own", "all")
}
"""The games that can be hosted, by the key of their line."""
BEATEN: Final = "   * beaten"
"""Behind a program against which the player has won a game."""
PROGRAM: Final = "program"
"""The key of the line of a game against a program."""
WHO_MAY_JOIN: Final = {
    "all": "a new game, which anybody on this machine may join",
    "own": "a new game, joined from another terminal of yours",
}


async def play_together(
    app: App[Any], theme: Theme, level: GameLevel, workspace: Workspace, journal: ProgressJournal
) -> None:
    """Has the user choose a game for two on a level, or one that others host, and plays it until it is left."""
    games = {game.name: game for game in await to_thread(answering_games, games_folder())}
    choices = [
        PickerItem(name, f"join {name}", f"of {user_name(game.owner)}") for name, game in games.items()
    ]
    choices.append(PickerItem(PROGRAM, "tag", "against a program: of the house, or your own"))
    for key, (mode, _) in HOSTED.items():
        choices.append(PickerItem(key, mode.value, WHO_MAY_JOIN[key.rpartition(" ")[2]]))
    picked = await app.push_screen_wait(Picker(f"Tag or race on {level.title}", choices))
    try:
        if picked in games:
            client = await to_thread(SharedGameClient, games[picked], own_user_name(), plays=True)
            await app.push_screen_wait(SharedGuestScreen(theme, client, workspace))
        elif picked == PROGRAM:
            await _play_a_program(app, theme, level, workspace, journal)
        elif picked is not None:
            mode, audience = HOSTED[picked]
            name, folder = own_user_name(), games_folder()
            await _host(app, SharedHostScreen(theme, level, mode, name, folder, audience, workspace))
    except (
        SharedGameError,
        CannotShare,
        UnknownLevel,
        LookupError,
        WorldError,
        OSError,
        ProgressError,
    ) as error:
        app.push_screen(MessageDialog("No game for two", str(error)))


async def _play_a_program(
    app: App[Any], theme: Theme, level: GameLevel, workspace: Workspace, journal: ProgressJournal
) -> None:
    with private_folder() as folder:
        known = {each.name: each for each in house_controllers(folder)}
        known |= {f"own {each.name}": each for each in user_controllers(workspace.controllers)}
        beaten = {event.subject for event in journal.events(EventKind.TAG) if event.content.get("won")}
        choices = [
            PickerItem(key, each.name, f"{each.title}{BEATEN if key in beaten else ''}")
            for key, each in known.items()
        ]
        picked = await app.push_screen_wait(Picker("Who plays tag against you?", choices))
        if picked is not None:
            screen = SharedHostScreen(
                theme, level, SharedMode.TAG, own_user_name(), folder, Audience(), workspace, known[picked]
            )
            await _host(app, screen)
            if screen.has_won:
                journal.add(EventKind.TAG, picked, {"won": True, "level": level.id})


async def _host(app: App[Any], screen: SharedHostScreen) -> None:
    await app.push_screen_wait(screen)
    if (film := await to_thread(screen.save_film)) is not None:
        app.push_screen(MessageDialog("The game is saved", [row(f"To replay it: kit replay {film}")]))
