"""Submitted ``.npz`` archives, looked through before numpy reads them: nothing may take more memory than its own bytes."""

from __future__ import annotations

import math
import tokenize
import zipfile
import zlib
from typing import Final

from numpy.lib import format as npy

READ_ERRORS: Final = (
    ValueError, LookupError, TypeError, EOFError, RuntimeError,  # NotImplementedError is one: zipfile's own
    tokenize.TokenError, SyntaxError,  # an array's header is parsed as Python
    zipfile.BadZipFile, zlib.error, OSError,
)  # fmt: skip
"""What damaged archives make zipfile and numpy raise."""


def check_arrays(archive: zipfile.ZipFile, max_bytes: int) -> dict[str, tuple[int, ...]]:
    """The shapes of all arrays, by the names of their files.

    Raises ValueError for what is larger than ``max_bytes`` unpacked, no plain array, or not what its header says; and
    ``READ_ERRORS`` for what is damaged.
    """
    members = archive.infolist()
    if sum(each.file_size for each in members) > max_bytes:
        raise ValueError(f"it is larger than {max_bytes >> 20} MiB, unpacked")
    shapes = {}
    for each in members:
        with archive.open(each) as part:
            if npy.read_magic(part) != (1, 0):
                raise ValueError("an array of an unknown version")
            shape, _, kind = npy.read_array_header_1_0(part)
            if kind.hasobject or math.prod(shape) * kind.itemsize > each.file_size:
                raise ValueError(f"{each.filename} is not what it says")
            if math.prod(shape) * 8 > max_bytes:  # numbers are read as 8 bytes each
                raise ValueError(f"{each.filename} holds too many numbers")
        shapes[each.filename] = shape
    return shapes
