"""Packs a task with its world and its reward into one zip file to send, and unpacks such a file safely.

The archive holds one folder with the task's name: ``NAME/task.yaml``, and beside it what the task reads, at the same
places as on the sender's disk. Maps of the kit are not packed: every kit has them.
"""

from __future__ import annotations

import io
import lzma
import shutil
import zipfile
import zlib
from pathlib import Path, PurePosixPath
from typing import Final

from kit.learning.authoring.task_check import check_task
from kit.learning.tasks.task_reader import TASK_FILE, read_task, task_name
from kit.plain_text import is_printable, quoted
from kit.sim.simulation import load_world
from kit.workspace import errors_name_file, write_atomically
from kit.world.catalogue import allowed_root_of, maps_folder
from kit.world.documents import collected_reads

MAX_FILES: Final = 200
MAX_BYTES: Final = 64 * 1024 * 1024
"""Largest total size of all files, unpacked."""
EARLIEST: Final = (1980, 1, 1, 0, 0, 0)
"""The date of every file in the archive: the same task makes the same bytes."""


PACKAGE_FILE: Final = "package.xml"


class TaskArchiveError(Exception):
    """A task cannot be packed, or a file is no packed task; the message says why and what to do."""


def pack_task(file: Path, archive: Path) -> tuple[Path, ...]:
    """Checks a task and writes it with all that it reads into a zip file; returns the packed files.

    Raises WorldError, UnsupportedWorld and RewardFileError if the task is not sound, TaskArchiveError if it reads files
    outside its folder or too many, and OSError.
    """
    task_file = file.resolve()
    folder, kit_maps = task_file.parent, maps_folder().resolve()
    with collected_reads() as found:
        read = read_task(task_file)
        check_task(read)
        for card in read.task.map_cards:
            if not card.world_file.resolve().is_relative_to(kit_maps):
                load_world(card.world_file, root=card.root)
    files = {each.resolve() for each in found if not each.resolve().is_relative_to(kit_maps)} | {task_file}
    if read.task.reward_file is not None:
        files.add(read.task.reward_file.resolve())
    top = _folder_of_all(folder, files)
    if top is None:
        outside = sorted(str(each) for each in files if not each.is_relative_to(folder))
        raise TaskArchiveError(
            f"{file}: it reads {', '.join(outside)}, outside its own folder. Put the task beside its world, or copy "
            "those files into its folder."
        )
    if top != folder and (top / PACKAGE_FILE).is_file():
        files.add(top / PACKAGE_FILE)  # what makes the folder a package, whose worlds may read its models
    if len(files) > MAX_FILES or sum(each.stat().st_size for each in files) > MAX_BYTES:
        raise TaskArchiveError(
            f"{file}: {len(files)} files; at most {MAX_FILES} files with a total of {MAX_BYTES // 2**20} MiB are packed."
        )
    if task_file.name != TASK_FILE and folder / TASK_FILE in files:
        raise TaskArchiveError(f"{file}: it reads another {TASK_FILE}; rename that file.")
    ordered = (task_file, *sorted(files - {task_file}))
    write_atomically(archive, _archive_bytes(task_name(task_file), top, ordered))
    return ordered


def _folder_of_all(folder: Path, files: set[Path]) -> Path | None:
    """The folder of the task, or of the package that it lies in, whichever holds all the files first; None if none does."""
    package = allowed_root_of(folder / TASK_FILE)
    tops = [folder] if package is None else [folder, package.resolve()]
    return next((top for top in tops if all(each.is_relative_to(top) for each in files)), None)


def _archive_bytes(name: str, folder: Path, files: tuple[Path, ...]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as opened:
        for number, each in enumerate(files):
            placed = each.with_name(TASK_FILE) if number == 0 else each
            info = zipfile.ZipInfo(f"{name}/{placed.relative_to(folder).as_posix()}", EARLIEST)
            info.compress_type = zipfile.ZIP_DEFLATED
            opened.writestr(info, each.read_bytes())
    return buffer.getvalue()


def unpack_task(archive: Path, folder: Path) -> Path:
    """Writes a packed task into a new folder of its name in ``folder``, all of it or nothing, and returns the task's file.

    Nothing is written outside that folder, whatever the archive says, and nothing is left of a task that cannot be
    used. Raises TaskArchiveError, OSError if the archive cannot be read or the folder not written, and as ``check_task``.
    """
    contents = _read_archive(archive)
    tops = {path.parts[0] for path in contents}
    found = [path for path in contents if path.name == TASK_FILE]
    task_files = [path for path in found if len(path.parts) == min(len(each.parts) for each in found)]
    if len(tops) != 1 or len(task_files) != 1:
        raise TaskArchiveError(
            f"{archive}: not a packed task; it must contain one folder with a {TASK_FILE}. `kit task pack` creates such a file."
        )
    made = folder / task_files[0].parts[0]
    if made.exists():
        raise TaskArchiveError(
            f"{made} already exists: move it away, or unpack elsewhere with --dest FOLDER."
        )
    file = folder / Path(*task_files[0].parts)
    try:
        for path, data in contents.items():
            target = folder / Path(*path.parts)
            with errors_name_file(target):
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(data)
        check_task(read_task(file))
    except BaseException:  # Ctrl-C too leaves nothing half made
        shutil.rmtree(made, ignore_errors=True)
        raise
    return file


def _read_archive(archive: Path) -> dict[PurePosixPath, bytes]:
    """Names and contents. Raises TaskArchiveError for what is damaged, too large, or leads out of its folder."""
    contents: dict[PurePosixPath, bytes] = {}
    left = MAX_BYTES
    try:
        with zipfile.ZipFile(archive) as opened:
            entries = [entry for entry in opened.infolist() if not entry.is_dir()]
            if len(entries) > MAX_FILES:
                raise TaskArchiveError(f"{archive}: {len(entries)} files; at most {MAX_FILES} are unpacked.")
            for entry in entries:
                path = _checked_path(archive, entry.filename)
                with opened.open(entry) as member:
                    data = member.read(left + 1)
                left -= len(data)
                if left < 0:
                    raise TaskArchiveError(f"{archive}: it unpacks to more than {MAX_BYTES // 2**20} MiB.")
                contents[path] = data
    # RuntimeError: zipfile's, of an encrypted member or an unknown method of packing; MemoryError: a huge dictionary
    except (
        zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, RuntimeError, ValueError, MemoryError,
    ) as error:  # fmt: skip
        raise TaskArchiveError(f"{archive}: damaged, or not a zip file ({error}).") from None
    return contents


def _checked_path(archive: Path, name: str) -> PurePosixPath:
    path = PurePosixPath(name)
    is_safe = is_printable(name) and "\\" not in name and not path.is_absolute() and ".." not in path.parts
    if not is_safe or len(path.parts) < 2 or any(part.startswith(".") for part in path.parts):
        raise TaskArchiveError(
            f"{archive}: it contains a file named {quoted(name)}, which does not belong in a packed task."
        )
    return path
