"""The user's desk: the workspace with what a beginner needs to start, laid out once and never overwritten."""

from __future__ import annotations

from pathlib import Path

from kit.controllers import FOLDER
from kit.workspace import Workspace, open_workspace, unusable, write_atomically

TEMPLATE = FOLDER / "template.py"
FIRST_CONTROLLER = "my_controller.py"


def open_desk(folder: Path | None = None) -> Workspace:
    """The workspace, with a controller to start from where there is none. Raises WorkspaceError."""
    workspace = open_workspace(folder)
    if not any(workspace.controllers.glob("*.py")):
        try:
            write_atomically(workspace.controllers / FIRST_CONTROLLER, TEMPLATE.read_bytes())
        except OSError as error:
            raise unusable(workspace.folder, error) from None
    return workspace
