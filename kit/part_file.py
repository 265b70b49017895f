"""What is written while a program runs: ``.NAME.part`` beside NAME holds what there is, until it is complete.

The program that writes it keeps a lock, which ends with the program, however it ends. So a second writer of the same name
is refused, and the next start knows what a killed program has left.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain, count
from pathlib import Path
from typing import BinaryIO, Final

SUFFIX: Final = ".part"


class BeingWrittenError(OSError):
    """Another program writes there now; the message says what to do."""


def part_path(path: Path) -> Path:
    """Where what is to be ``path`` lies while it is written."""
    return path.with_name(f".{path.name}{SUFFIX}")


def path_of_part(part: Path) -> Path:
    """What a part was to be."""
    return part.with_name(part.name.removeprefix(".").removesuffix(SUFFIX))


def parts_in(folder: Path) -> Iterator[Path]:
    """Yields all parts in a folder, sorted, whether they are being written or were left by a program that was killed."""
    with suppress(OSError):  # it may not be there, or not be readable
        yield from sorted(folder.glob(f".?*{SUFFIX}"))


def lock_part(lock: Path, path: Path) -> BinaryIO:
    """Opens the file ``lock`` for reading and appending, and keeps other programs out of it until it is closed.

    ``path``: what is written, for the message. A file system without locks keeps nobody out. Raises BeingWrittenError if
    another program has it, and OSError.
    """
    while True:
        file = lock.open("a+b")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.close()
            raise BeingWrittenError(
                f"{path}: another program is writing it now. Choose another name, or end that program first."
            ) from None
        except OSError:
            pass  # there are no locks here
        if _is_at(lock, file):  # and not one that its writer has just removed
            return file
        file.close()


def unused_path(path: Path, wanted: Path | None = None) -> Path:
    """``path``, or the first of ``NAME-2.ending``, ``NAME-3.ending``... that is not there, and is not ``wanted``."""
    numbered = (path.with_name(f"{path.stem}-{number}{path.suffix}") for number in count(2))
    free = (each for each in chain([path], numbered) if not each.exists())
    return next(each for each in free if wanted is None or each.absolute() != wanted.absolute())


def _is_at(path: Path, file: BinaryIO) -> bool:
    with suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    return False
