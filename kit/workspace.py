"""The workspace: one folder for the user's own files. Nothing is written outside it but caches."""

from __future__ import annotations

import os
import secrets
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from errno import EACCES, EISDIR
from pathlib import Path
from typing import Final

DRAFT_PREFIX: Final = ".new-"
"""Begins the name of a folder while it is filled."""


class WorkspaceError(Exception):
    """The workspace cannot be used; the message says why and what to do."""


@dataclass(frozen=True, slots=True)
class Workspace:
    """The user's folder and the paths in it."""

    folder: Path

    @property
    def controllers(self) -> Path:
        return self.folder / "controllers"

    @property
    def worlds(self) -> Path:
        return self.folder / "worlds"

    @property
    def packages(self) -> Path:
        """ROS 2 packages."""
        return self.folder / "packages"

    @property
    def lessons(self) -> Path:
        """The student's own files of lessons' exercises."""
        return self.folder / "lessons"

    @property
    def recordings(self) -> Path:
        return self.folder / "recordings"

    @property
    def runs(self) -> Path:
        return self.folder / "runs"

    @property
    def parts(self) -> tuple[Path, ...]:
        """The folders that every workspace has."""
        return (
            self.controllers,
            self.lessons,
            self.packages,
            self.worlds,
            self.recordings,
            self.runs,
        )


USUAL_WORKSPACE: Final = "~/robot-kit"


def expand_home(name: str | Path) -> Path:
    """Expands ``~`` and ``~user`` in a path, where such a home folder is known."""
    return Path(os.path.expanduser(name))  # noqa: PTH111  # the method raises where there is no such home


def open_workspace(folder: Path | None = None, *, make: bool = True) -> Workspace:
    """Opens the workspace at ``folder``; by default ``$KIT_WORKSPACE``, else ``robot-kit`` in the home folder.

    Makes the folder and its parts where they are missing, readable by their owner alone, unless ``make`` is false.
    Raises WorkspaceError if the path is a file or not writable, or in a home folder that does not exist.
    """
    if folder is None:
        folder = Path(os.environ.get("KIT_WORKSPACE") or USUAL_WORKSPACE)
    workspace = Workspace(expand_home(folder).absolute())
    if str(folder).startswith("~") and expand_home(folder) == folder:
        raise WorkspaceError(
            f"{folder}: there is no such home folder here. Name another folder with --workspace FOLDER."
        )
    if make:
        # What is there is closed to others only if it is a workspace already: somebody may name a folder of a website.
        is_ours = not workspace.folder.exists() or all(part.is_dir() for part in workspace.parts)
        try:
            for each in (workspace.folder, *workspace.parts) if is_ours else workspace.parts:
                make_private_folder(each)
        except OSError as error:
            raise unusable_workspace_error(workspace.folder, error) from None
    return workspace


def unusable_workspace_error(folder: Path, error: OSError) -> WorkspaceError:
    """The error for a workspace in which a folder or file could not be made."""
    return WorkspaceError(
        f"{folder}: cannot be used as the workspace ({error.strerror}). "
        "Name another folder with --workspace FOLDER."
    )


def check_writable(path: Path) -> None:
    """Raises OSError if ``path`` cannot be written, without writing it. Call it before long work."""
    with errors_name_file(path):
        if path.is_dir():
            raise IsADirectoryError(EISDIR, os.strerror(EISDIR))
        if is_special(path):
            if not os.access(path, os.W_OK):
                raise PermissionError(EACCES, os.strerror(EACCES))
            return
        with tempfile.TemporaryFile(dir=path.resolve().parent):
            pass


def is_special(path: Path) -> bool:
    """Whether ``path`` is a device, a pipe or an open file such as /dev/stdout, which is written to and never replaced."""
    is_open_file = str(path).startswith(("/dev/std", "/dev/fd/", "/proc/self/fd/"))
    return path.exists() and not path.is_dir() and (is_open_file or not path.is_file())


def write_atomically(path: Path, data: bytes, *, follows_links: bool = True) -> None:
    """Writes ``data`` to ``path`` so that a reader, or a kill at any moment, sees the old file or the new one.

    Where the file system has files without a name, as those of Linux have, a kill leaves nothing half-written either.
    A new file has the mode that the user's umask gives, one that is replaced keeps its own. A link stays one: what it
    points to is written. So is a device or a pipe, as it is. Without ``follows_links`` all three are replaced, or it is an
    error: so it must be where another user may have put them, to have a file of this user's overwritten. Raises OSError.
    """
    with errors_name_file(path):
        if follows_links and is_special(path):
            with path.open("ab") as device:
                device.write(data)
            return
        if follows_links:
            path = path.resolve()
        temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
        handle, has_name = _open_new(temporary)
        try:
            with os.fdopen(handle, "wb") as file:
                if follows_links:
                    with suppress(FileNotFoundError):
                        os.fchmod(handle, stat.S_IMODE(path.stat().st_mode) & 0o777)
                file.write(data)
                file.flush()
                os.fsync(handle)
                if (
                    not has_name
                ):  # the folder's descriptor is not looked at, but has link() follow what /proc points to
                    os.link(f"/proc/self/fd/{handle}", temporary, src_dir_fd=handle)
            temporary.replace(path)
        except BaseException:  # Ctrl-C too: no half-written file stays; raised again
            with suppress(OSError):
                temporary.unlink()
            raise


def _open_new(path: Path) -> tuple[int, bool]:
    """Opens a new file for writing, without a name where that can be; and whether it has the name."""
    flags = os.O_WRONLY | os.O_CLOEXEC
    if os.access("/proc/self/fd", os.X_OK):
        with suppress(OSError):  # this file system has none, or it is said of the file with a name
            return os.open(path.parent, flags | os.O_TMPFILE, 0o666), False
    return os.open(path, flags | os.O_CREAT | os.O_EXCL, 0o666), True


@contextmanager
def draft_folder(parent: Path) -> Iterator[Path]:
    """Yields an empty hidden folder in ``parent``, to be filled and then renamed to what it shall be: so nobody finds a part of
    it. What has not been renamed when the block ends, in whatever way, is removed. Raises OSError, which names ``parent``.

    >>> with tempfile.TemporaryDirectory() as name, draft_folder(Path(name)) as draft:
    ...     _ = draft.joinpath("map.yaml").write_text("")
    ...     draft.rename(Path(name, "hall")).name
    'hall'
    """
    draft = parent / f"{DRAFT_PREFIX}{secrets.token_hex(8)}"
    try:
        draft.mkdir()
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(parent)) from None
    try:
        yield draft
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def make_private_folder(folder: Path) -> None:
    """Makes a folder that no other user may enter, and those above it that are missing; takes the rights of others from
    one of this user's that is there.

    One that another user owns, or in which anybody may write, such as /tmp, and the home folder and all above it stay as
    they are. Raises OSError.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    status = folder.stat()
    is_shared = status.st_uid != os.geteuid() or status.st_mode & (stat.S_IWOTH | stat.S_ISVTX)
    home = expand_home("~").resolve()
    if status.st_mode & 0o077 and not is_shared and folder.resolve() not in (home, *home.parents):
        folder.chmod(stat.S_IMODE(status.st_mode) & 0o700)


def open_common_folder(folder: Path) -> str:
    """Makes a folder to which every user of the machine may add, if it is not there. Returns what is wrong with it, where
    others could replace there what is this user's; empty if nothing is. Raises OSError."""
    if not folder.exists():
        folder.mkdir(parents=True, exist_ok=True)
        folder.chmod(0o1777)  # and each deletes only their own
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode):
        return "is not a folder"
    if status.st_uid not in (0, os.geteuid()):
        return (
            "belongs to another user, who may remove or close what is there. An administrator makes one for all: "
            f"sudo install -d -o root -m 1777 {folder}"
        )
    if status.st_mode & stat.S_IWOTH and not status.st_mode & stat.S_ISVTX:
        return "any user may replace what is there; `chmod +t` on it prevents that"
    return ""


@contextmanager
def errors_name_file(path: Path) -> Iterator[None]:
    """Makes errors name this file or folder, not a temporary one, or none."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None
