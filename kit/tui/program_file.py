"""A program's file while it is edited here: what is on disk, what is not saved yet, and whether somebody else saved it."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Final

from kit.controllers import ControllerFile, find_controller, kit_controllers
from kit.workspace import write_atomically

DRAFT_SUFFIX: Final = ".unsaved"
"""Ending of the file beside the program that keeps what was typed and not saved when the screen was left."""
MAX_BYTES: Final = 1_000_000
"""A file larger than this is no program that anybody types."""


class ProgramFileError(Exception):
    """The file cannot be edited here; the message says why and what to do instead."""


class ProgramFile:
    """The file of one program. Raises ProgramFileError when opened, if it cannot be read as text."""

    def __init__(self, file: Path) -> None:
        self.file: Final = file
        self._known = self._read()
        self.draft = self._read_draft()
        """What was typed the last time and never saved; None where there is nothing of the kind."""

    @property
    def text(self) -> str:
        """As it was read or saved last."""
        return self._known

    @property
    def draft_file(self) -> Path:
        """Where a draft is kept."""
        return self.file.with_name(f".{self.file.name}{DRAFT_SUFFIX}")

    def newer_text(self) -> str | None:
        """What somebody else has saved since; None where nobody has."""
        with suppress(ProgramFileError):
            if (found := self._read()) != self._known:
                return found
        return None

    def accept(self, text: str) -> None:
        """Takes what somebody else has saved as known."""
        self._known = text

    def save(self, text: str) -> None:
        """Writes the file at once or not at all. Raises ProgramFileError."""
        try:
            write_atomically(self.file, text.encode())
        except OSError as error:
            raise ProgramFileError(f"{self.file} could not be saved: {error.strerror}.") from error
        self._known = text
        self.drop_draft()

    def keep_draft(self, text: str) -> None:
        """Keeps what is not saved beside the file, for the next time. What cannot be kept is lost, silently: nobody looks
        any more."""
        with suppress(OSError):
            if text != self._known:
                write_atomically(self.draft_file, text.encode())

    def drop_draft(self) -> None:
        """Forgets the draft."""
        self.draft = None
        with suppress(OSError):
            self.draft_file.unlink(missing_ok=True)

    def _read_draft(self) -> str | None:
        try:
            found = self.draft_file.read_bytes().decode()
        except (OSError, UnicodeDecodeError):
            return None
        return None if found == self._known else found

    def _read(self) -> str:
        try:
            if self.file.stat().st_size > MAX_BYTES:
                raise ProgramFileError(f"{self.file} is too large to be edited here.")
            return self.file.read_bytes().decode()
        except OSError as error:
            raise ProgramFileError(f"{self.file} cannot be read: {error.strerror}.") from error
        except UnicodeDecodeError as error:
            text = f"{self.file} is not text in UTF-8 (byte {error.start}). Save it as UTF-8 with another editor first."
            raise ProgramFileError(text) from error


def editable_controller(controller: ControllerFile, folder: Path, generated: Path) -> ControllerFile:
    """The controller itself where its file is the user's, else a copy in the user's ``folder``, ``my_NAME.py``.

    A copy that exists is used as it is. ``generated``: the folder of runs, whose nodes are written anew each time.
    Raises ProgramFileError.
    """
    kits = {each.file for each in kit_controllers()}
    if controller.file not in kits and generated not in controller.file.parents:
        return controller
    copy = folder / f"my_{controller.name}.py"
    try:
        if not copy.exists():
            folder.mkdir(parents=True, exist_ok=True)
            write_atomically(copy, controller.file.read_bytes())
    except OSError as error:
        text = f"{controller.name} is not your own, and could not be copied to {copy}: {error.strerror}."
        raise ProgramFileError(text) from error
    return find_controller(str(copy))
