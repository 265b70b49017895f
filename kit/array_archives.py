"""Reads ``.npz`` archives that somebody else may have made: what they unpack to is limited before numpy unpacks it."""

from __future__ import annotations

import ast
import io
import math
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from kit.plain_files import read_plain_file

MAX_PACKED_BYTES: Final = 64 << 20
"""Bytes of an archive."""
MAX_UNPACKED_BYTES: Final = 256 << 20
"""Bytes of all its arrays together."""
MAX_ARRAYS: Final = 1_000
MAX_ARRAY_HEADER: Final = 10_000
"""Bytes, as numpy has it."""

READ_ERRORS: Final = (
    ValueError, LookupError, TypeError, EOFError, RuntimeError,  # NotImplementedError is one: zipfile's own
    tokenize.TokenError, SyntaxError,  # an array's header is parsed as Python
    zipfile.BadZipFile, zlib.error, OSError,
)  # fmt: skip
"""What damaged archives make zipfile and numpy raise."""


def read_arrays(file: Path) -> dict[str, NDArray[Any]]:
    """Returns all arrays of an archive by name. Raises OSError where it cannot be read, and ``READ_ERRORS`` where it is
    damaged, something else, or too large."""
    return unpack_arrays(read_plain_file(file, MAX_PACKED_BYTES), MAX_UNPACKED_BYTES)


def unpack_arrays(data: bytes, max_bytes: int) -> dict[str, NDArray[Any]]:
    """All arrays of an archive of at most ``max_bytes`` unpacked, by name. Raises ``READ_ERRORS`` for any other."""
    if not zipfile.is_zipfile(io.BytesIO(data)):  # of another file numpy says that pickle might read it
        raise ValueError("not an .npz file, or an incomplete one")
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        check_arrays(archive, max_bytes)
    with np.load(io.BytesIO(data), allow_pickle=False) as stored:
        return {name: stored[name] for name in stored.files}


def check_stored(archive: zipfile.ZipFile, size: int) -> None:
    """Checks that what is in an archive is packed as it is, and so takes no more memory than the archive's ``size`` [bytes].

    Raises zipfile.BadZipFile for anything else.
    """
    members = archive.infolist()
    if any(each.compress_type != zipfile.ZIP_STORED for each in members):
        raise zipfile.BadZipFile("a part is compressed, which the kit's never are")
    if len(members) > MAX_ARRAYS or sum(each.file_size for each in members) > size:
        raise zipfile.BadZipFile("its parts are larger than itself")


def check_arrays(archive: zipfile.ZipFile, max_bytes: int) -> dict[str, tuple[int, ...]]:
    """The shapes of all arrays of an ``.npz`` archive, by the names of their files, before numpy reads them.

    Raises ValueError for what is larger than ``max_bytes`` unpacked, no plain array, or not what its header says; and
    ``READ_ERRORS`` for what is damaged.
    """
    members = archive.infolist()
    if len(members) > MAX_ARRAYS or len({each.filename for each in members}) < len(members):
        raise ValueError("it has too many arrays, or two of one name")
    if sum(each.file_size for each in members) > max_bytes:
        raise ValueError(f"it is larger than {max_bytes >> 20} MiB, unpacked")
    shapes = {}
    for each in members:
        with archive.open(each) as part:
            if npy.read_magic(part) != (1, 0):
                raise ValueError("an array of an unknown version")
            length = int.from_bytes(part.read(2), "little")
            if length > MAX_ARRAY_HEADER:
                raise ValueError(f"{each.filename} has a header of {length} bytes")
            # Or numpy reads it as Python 2, and warns of that.
            ast.literal_eval(part.read(length).decode("latin-1"))
            part.seek(npy.MAGIC_LEN)
            shape, _, kind = npy.read_array_header_1_0(part)
            if kind.hasobject or math.prod(shape) * kind.itemsize > each.file_size:
                raise ValueError(f"{each.filename} is not what it says")
            if math.prod(shape) * 8 > max_bytes:  # numbers are read as 8 bytes each
                raise ValueError(f"{each.filename} contains too many numbers")
        shapes[each.filename] = shape
    return shapes
