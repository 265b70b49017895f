"""Paths as a student copies them from the screen into a shell, and how to open a second terminal on this machine.

A path below the home folder begins with ``~``.
"""

from __future__ import annotations

import getpass
import os
import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from kit.workspace import USUAL_WORKSPACE, Workspace, expand_home


def shell_path(path: Path) -> str:
    """A path as a shell takes it, short where it lies in the home folder.

    >>> shell_path(Path.home() / "kit" / "my file.py")
    "~/kit/'my file.py'"
    """
    try:
        below = path.relative_to(Path.home())
    except (ValueError, RuntimeError):  # not below it, or there is no home folder
        return shlex.quote(str(path))
    if not below.parts:
        return "~"
    return "~/" + "/".join(shlex.quote(part) for part in below.parts)


def fill_in_paths(text: str, file: Path | None) -> str:
    """Replaces ``{file}`` and ``{folder}`` by the student's own file and its folder. None: nothing is replaced."""
    if file is None:
        return text
    return text.replace("{file}", shell_path(file)).replace("{folder}", shell_path(file.parent))


def expand_words(words: list[str]) -> list[str]:
    """Words of a command as a shell hands them on: a leading ``~/`` is the home folder."""
    return [str(Path(word).expanduser()) if word.startswith("~/") else word for word in words]


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
    parts.append("Then type the command of the lesson. Your progress is saved when you leave the kit.")
    return "\n\n".join(parts)
