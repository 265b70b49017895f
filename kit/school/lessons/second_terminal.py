"""How to open a second terminal beside the one that runs the kit: said for the machine that the student sits at."""

from __future__ import annotations

import getpass
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from kit.school.lessons.shell_lines import shell_path
from kit.workspace import USUAL_WORKSPACE, Workspace, expand_home

TITLE: Final = "A second terminal"
WHY: Final = (
    "Some commands look into a world while it runs. The world keeps this terminal busy, so they need another one, on "
    "the same machine and as the same user."
)


def second_terminal_here(workspace: Workspace) -> str:
    """The text for this process: its connection, its Python environment and its workspace."""
    script = Path(sys.prefix) / "bin" / "activate"
    try:
        user = getpass.getuser()
    except (KeyError, OSError):  # a user without a name, as in some containers
        user = "YOUR-NAME"
    return second_terminal_text(
        os.environ,
        user=user,
        activate=script if script.is_file() else None,
        workspace=None if workspace.folder == expand_home(USUAL_WORKSPACE) else workspace.folder,
    )


def second_terminal_text(
    environ: Mapping[str, str], *, user: str, activate: Path | None, workspace: Path | None
) -> str:
    """Explains it in a lesson's markup.

    ``environ``: tells a connection over SSH, and tmux. ``user``: who logs in. ``activate``: the script that puts the
    kit on the path of a new shell; None: it is there anyway. ``workspace``: one that is not the usual one.
    """
    parts = [WHY]
    address = environ.get("SSH_CONNECTION", "").split()
    if environ.get("TMUX"):
        parts.append(
            "You are in **tmux** already. Ctrl-B and then `%` puts a second terminal beside this one, Ctrl-B and an "
            "arrow key goes from one to the other, `exit` closes it."
        )
    else:
        if len(address) == 4:
            parts += [
                "You are here by **ssh**. Open another window on your own computer, and log in once more:",
                f"    ssh {user}@{address[2]}",
                "Or stay in this one window with **tmux**, which shows two terminals in it. Leave the kit, then:",
            ]
        else:
            parts.append(
                "Open another window or tab of your terminal program. Or stay in this one with **tmux**, which "
                "shows two terminals in it. Leave the kit, then:"
            )
        parts += [
            "    tmux\n    kit",
            "Ctrl-B and then `%` opens the second one, Ctrl-B and an arrow key goes across.",
        ]
    settings = []
    if activate is not None:
        settings.append(f"    source {shell_path(activate)}")
    if workspace is not None:
        settings.append(f"    export KIT_WORKSPACE={shell_path(workspace)}")
    if settings:
        parts += ["In the new terminal, so that it finds the kit and your files:", "\n".join(settings)]
    parts.append("Then type the command of the lesson. Your progress is kept when you leave the kit.")
    return "\n\n".join(parts)
