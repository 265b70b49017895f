"""The share folder of a package that was never built: its own folder, or links to what it installs at other places.

The links lie in the temporary folder, which another process may not see (a sandbox has one of its own). So a path that
is sent to another process is first replaced by that of the package's own file: ``with_original_paths``.
"""

from __future__ import annotations

import hashlib
import os
import stat
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from kit.ros.packages import find_packages, installed_files, missing_package, search_folders

PREFIX: Final = "kit-share-"
"""Then comes the user's number: the name of the folder of the links."""

_originals: Final[dict[str, str]] = {}
"""The links that this process has made or found -> the file or folder of the package that each stands for."""


def share_folder(name: str) -> Path:
    """The share folder of a package that is searched for where this program searches. Raises PackageError."""
    folders = search_folders()
    found = find_packages(folders)
    if name not in found:
        raise missing_package(name, folders)
    return installed_share(name, found[name])


def installed_share(name: str, folder: Path) -> Path:
    """The package's own folder, or one made of links where ``setup.py`` installs files at other places.

    The latter has all that the package's own folder has too, so that nothing is missing that lies where it is expected.
    """
    moved = installed_files(name, folder)
    if not moved:
        return folder
    mark = hashlib.sha256(repr((str(folder), sorted(moved))).encode()).hexdigest()[:16]
    share = _links_folder() / mark / name
    share.mkdir(0o700, parents=True, exist_ok=True)
    _originals[str(share)] = str(folder)
    _link_tree(folder, share, moved)
    return share


def with_original_paths(content: Any) -> Any:
    """Returns a text, or a list or dict with texts, in which each path into a share folder of links is that of the package's
    own file."""
    if isinstance(content, str):
        for link in sorted(_originals, key=len, reverse=True) if f"{PREFIX}{os.getuid()}" in content else ():
            content = content.replace(link, _originals[link])
        return content
    if isinstance(content, Mapping):
        return {key: with_original_paths(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [with_original_paths(value) for value in content]
    return content


def _links_folder() -> Path:
    """This user's own folder for the links. Raises OSError where somebody else could change what lies there."""
    folder = Path(tempfile.gettempdir()) / f"{PREFIX}{os.getuid()}"
    with suppress(FileExistsError):
        folder.mkdir(0o700)
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid() or status.st_mode & 0o022:
        raise PermissionError(f"{folder} belongs to somebody else, or others may write into it: remove it")
    return folder


def _link_tree(folder: Path, target: Path, moved: Mapping[str, Path]) -> None:
    """Fills a folder with links to what another one holds, and to some files by their places in it; again, where one was
    filled before and something has been added since."""
    folders = {place.partition("/")[0] for place in moved if "/" in place}
    for entry in folder.iterdir():
        if entry.name in folders and entry.is_dir():
            inner = target / entry.name
            inner.mkdir(exist_ok=True)
            rest = {
                place.partition("/")[2]: source
                for place, source in moved.items()
                if place.startswith(f"{entry.name}/")
            }
            _link_tree(entry, inner, rest)
        else:
            _link(target / entry.name, entry)
    for place, source in moved.items():
        (target / place).parent.mkdir(parents=True, exist_ok=True)
        _link(target / place, source)


def _link(link: Path, original: Path) -> None:
    with suppress(FileExistsError):  # from before, or another process has been quicker
        link.symlink_to(original)
    _originals[str(link)] = str(original)
