"""Finds a user's own files: tasks, those of a list to choose from and one by its name."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from kit.learning.tasks.task_reader import task_name
from kit.workspace import WorkspaceError, open_workspace

TASK_KEYS: Final = (
    re.compile(r"^(world|maps):", re.MULTILINE),
    re.compile(r"^(summary|goal|reward|cases):", re.MULTILINE),
)
"""What a task file has at the beginning of a line, unlike a world or a map's card."""
MAX_BYTES: Final = 256 * 1024
PATTERNS: Final = ("*", "*/*", "*/*/*")
"""A folder itself and two floors below it: deep enough for ``worlds/NAME/``, and quick."""
LEFT_OUT: Final = frozenset({"runs", "recordings", "lessons", "controllers"})
"""Folders of the workspace that hold neither."""


def own_task_files(folders: Iterable[Path]) -> tuple[Path, ...]:
    """Every task file in the folders, sorted, each once. Whether it is sound is seen when it is read."""
    return tuple(sorted({file for file in own_files(folders, ".yaml") if _is_task(file)}))


def workspace_task_file(name: str) -> Path | None:
    """The file of the task of that name in the user's workspace; None if there is none, or no workspace."""
    return next((file for file in own_task_files(workspace_folders()) if task_name(file) == name), None)


def workspace_folders() -> tuple[Path, ...]:
    """The folder of the user's workspace; none if there is no workspace."""
    try:
        return (open_workspace(make=False).folder,)
    except WorkspaceError:
        return ()


def own_files(folders: Iterable[Path], ending: str) -> Iterator[Path]:
    """The files whose names end like this, in the folders and not too far below them."""
    for folder in folders:
        for pattern in PATTERNS:
            for file in folder.absolute().glob(pattern + ending):
                inner = file.relative_to(folder.absolute()).parts
                if inner[0] not in LEFT_OUT and not any(part.startswith(".") for part in inner):
                    yield file


def _is_task(file: Path) -> bool:
    text = short_text(file)
    return all(key.search(text) for key in TASK_KEYS)


def short_text(file: Path) -> str:
    """The text of a file; none for one that is long or no text."""
    try:
        return file.read_text(encoding="utf-8") if file.stat().st_size <= MAX_BYTES else ""
    except (OSError, UnicodeDecodeError):
        return ""
