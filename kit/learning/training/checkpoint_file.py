"""A checkpoint's file: named parts in one archive, which is checked before anything of it is unpacked."""

from __future__ import annotations

import io
import json
import math
import os
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from kit.array_archives import check_arrays, check_stored
from kit.field_types import check_field_types
from kit.plain_files import open_plain_file

MAX_CHECKPOINT_BYTES: Final = 4 << 30
"""Bytes of a checkpoint: its replay buffer is the largest part."""
MAX_NUMBER: Final = 1 << 53
"""The largest magnitude of a number of a checkpoint's: a float counts no further."""
COUNTS_PART: Final = "learner.json"


@dataclass(frozen=True, slots=True)
class LearnerCounts:
    """How far a learner is: the numbers of its checkpoint."""

    algorithm: str
    steps: int
    slower: float
    """The factor of the learning rate, at most 1."""
    updates: int = 0
    rounds: int = 0
    """Of demonstrations."""
    largest: list[float] = field(default_factory=list)
    """As ``RecentExperience`` saves it."""

    def pack(self) -> dict[str, bytes]:
        """Its part of a checkpoint."""
        return {COUNTS_PART: json.dumps(asdict(self)).encode()}

    @classmethod
    def unpack(cls, parts: Mapping[str, bytes], algorithm: str) -> LearnerCounts:
        """Reads what ``pack`` returned. Raises ValueError, KeyError and TypeError for anything else, and for that of another
        algorithm."""
        values = read_numbers(parts[COUNTS_PART])
        check_field_types(cls, values)
        counts = cls(**values)
        if counts.algorithm != algorithm:
            raise ValueError(f"it is from {counts.algorithm}, not from {algorithm}")
        if not 0.0 < counts.slower <= 1.0:
            raise ValueError(f"a learning rate that is multiplied by {counts.slower}")
        return counts


def read_numbers(data: bytes) -> Any:
    """A part that is JSON. Raises ValueError where a whole number in it is below 0, and where a number is too large for what it
    counts or measures, or none; negative infinity is the largest of nothing."""
    return json.loads(data, parse_int=_read_count, parse_float=_read_measure, parse_constant=_read_measure)


def _read_count(text: str) -> int:
    if not (len(text) < 20 and 0 <= int(text) <= MAX_NUMBER):
        raise ValueError(f"a count of {text[:20]}")
    return int(text)


def _read_measure(text: str) -> float:
    number = float(text)
    if not (abs(number) <= MAX_NUMBER or number == -math.inf):
        raise ValueError(f"a number of {text[:20]}")
    return number


def check_rows(found: NDArray[Any], own: NDArray[Any]) -> NDArray[Any]:
    """Returns the rows of an array of a checkpoint if they may stand in ``own``. ValueError if they are of another shape or type,
    more than it has, or not finite."""
    if (found.shape[1:], found.dtype) != (own.shape[1:], own.dtype) or found.ndim != own.ndim:
        raise ValueError(f"an array of {found.dtype} {found.shape} for {own.dtype} {own.shape}")
    if len(found) > len(own) or not np.isfinite(found).all():
        raise ValueError("more rows than there is room for, or a number that is not finite")
    return found


def check_actions(found: NDArray[Any], count: int) -> None:
    """ValueError if a number is none of so many actions."""
    if len(found) and not (found.min() >= 0 and found.max() < count):
        raise ValueError(f"an action that is none of {count}")


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
