"""A checkpoint's file: named parts in one archive, which is checked before anything of it is unpacked."""

from __future__ import annotations

import io
import os
import zipfile
from pathlib import Path
from typing import Final

from kit.array_archives import check_arrays, check_stored
from kit.plain_files import open_plain_file

MAX_CHECKPOINT_BYTES: Final = 4 << 30
"""Bytes of a checkpoint: its replay buffer is the largest part."""


def read_checkpoint(file: Path) -> dict[str, bytes]:
    """Returns the parts of a checkpoint, which may be somebody else's: none of them unpacks to more than it is. Raises OSError,
    ValueError and zipfile.BadZipFile."""
    with open_plain_file(file) as opened:
        size = os.fstat(opened.fileno()).st_size
        if size > MAX_CHECKPOINT_BYTES:
            raise zipfile.BadZipFile(f"it is larger than {MAX_CHECKPOINT_BYTES >> 30} GiB")
        with zipfile.ZipFile(opened) as archive:
            check_stored(archive, size)
            parts = {name: archive.read(name) for name in archive.namelist()}
    for name, data in parts.items():
        if zipfile.is_zipfile(io.BytesIO(data)):  # arrays, or parameters of torch's
            with zipfile.ZipFile(io.BytesIO(data)) as inner:
                check_stored(inner, len(data))
                if name.endswith(".npz"):
                    check_arrays(inner, MAX_CHECKPOINT_BYTES)
    return parts
